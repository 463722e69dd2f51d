// SPDX-License-Identifier: GPL-2.0-or-later
// Subcontacts: the points of a joint at which its law is followed, each with its share of the joint's area. Sums over
// them stand for integrals over the joint: points and shares are those of a quadrature.
//
// Where blocks rock, a joint opens about its edge. So its edges and corners have points of their own, which the rule of
// Gauss and Lobatto gives. With points at the centres of n equal parts a joint would open fully about its edge at
// 1 - 1/n of the true moment.
#pragma once
#include "FaceContact.hpp"

namespace masonry {

// Points and weights of a quadrature from 0 to 1. The weights are above 0 and add up to 1.
struct LineRule {
    std::vector<double> places, weights;
};

// The rule of Gauss and Lobatto with n >= 1 points. From two points on the ends are points, and the rule is exact for
// polynomials of degree 2n - 3. One point stands in the middle. In terms of the half length, two points are the ends,
// 1/2 each; three the ends, 1/6 each, and the middle, 2/3; four the ends, 1/12 each, and ±1/√5, 5/12 each.
//
// A row of length L of n points of elastic stiffness k per area has the rotational stiffness k·area·L²/12 from three
// points on, which is the true one. With two points it is k·area·L²/4, three times as large; with one it is zero.
LineRule gaussLobatto(int n);

// A part of a joint, to which the joint law is applied at one point.
struct Subcontact {
    Point centre; // the point, which may lie on an edge or corner of the joint
    double area;  // [m²] that it stands for
};

// Subcontacts of a joint: `along` of them in the given direction (a unit vector in the plane of the joint), `across` at
// right angles to it. Their areas are above 0 and add up to that of the polygon.
//
// - One by one: the centroid.
// - One row, along or across: points in the middle of the polygon's width. In a rectangle they are those of
//   gaussLobatto. Where the width changes, it changes linearly between two corners; every such stretch has the points
//   of gaussLobatto, at least three. With three points a stretch or more, the polygon's moments of the first and second
//   order in the direction of the row are kept.
// - Two rows or more, four corners: `along` by `across` points of gaussLobatto, mapped onto the polygon, so that its
//   corners are points. The count `along` belongs to the two opposite edges that are nearest to the direction. If the
//   polygon is no parallelogram, there are at least three by three. From three by three on, all moments of the first
//   and second order are kept.
// - Two rows or more, any other polygon: the triangles from its centroid to its edges, each divided into m² equal ones,
//   m = n / 2 rounded down, for the larger count n. Every small triangle has 3/4 of its area at its centroid and
//   1/12 at each corner, which keeps its moments of the first and second order. Equal points are merged.
std::vector<Subcontact> subdivide(const Polygon&, const Point& normal, const Point& direction, int along, int across);

} // namespace masonry
