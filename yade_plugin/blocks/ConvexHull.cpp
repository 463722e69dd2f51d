// SPDX-License-Identifier: GPL-2.0-or-later
#include "ConvexHull.hpp"
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/convex_hull_3.h>
#include <algorithm>
#include <map>
#include <stdexcept>

namespace masonry {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Polyhedron_3<Kernel>;

// Two planes with unit coefficient vectors count as one below this squared difference. It is the limit of YADE's
// Polyhedra, so that both kinds of block have the same faces.
constexpr double samePlane = 1e-9;

// Coefficients of the plane through the first three corners of a facet, as a unit vector.
Eigen::Vector4d planeOf(const Surface::Facet& facet) {
    const auto h = facet.halfedge();
    const Kernel::Plane_3 plane(h->vertex()->point(), h->next()->vertex()->point(),
                                h->next()->next()->vertex()->point());
    const Eigen::Vector4d coefficients(plane.a(), plane.b(), plane.c(), plane.d());
    return coefficients / coefficients.norm();
}

// Removes one edge between two facets in one plane. Returns whether there was such an edge. A corner that is left with
// two edges goes as a whole.
bool removeOneEdge(Surface& surface, const std::map<const Surface::Facet*, Eigen::Vector4d>& planes) {
    for (auto edge = surface.edges_begin(); edge != surface.edges_end(); ++edge) {
        const auto *one = &*edge->facet(), *two = &*edge->opposite()->facet();
        if ((planes.at(one) - planes.at(two)).squaredNorm() >= samePlane) continue;
        if (edge->vertex()->vertex_degree() < 3)
            surface.erase_center_vertex(edge);
        else if (edge->opposite()->vertex()->vertex_degree() < 3)
            surface.erase_center_vertex(edge->opposite());
        else
            surface.join_facet(edge);
        return true;
    }
    return false;
}

// CGAL takes some vertices and facets in the order of their addresses. The first 14 of each stand in one piece of
// memory, in the order in which they were made; the order of others is one of chance. The hull of so many points has 12
// triangles at most.
constexpr std::size_t orderedVertices = 8;

// Numbers the corners in the order of the given points, and puts the faces in the order of their corners.
ConvexHull ordered(const ConvexHull& hull, const std::vector<Eigen::Vector3d>& points) {
    ConvexHull all;
    std::vector<int> numbers(hull.corners.size(), -1);
    for (const auto& p : points)
        for (std::size_t c = 0; c < hull.corners.size(); ++c)
            if (numbers[c] < 0 && hull.corners[c] == p) {
                numbers[c] = int(all.corners.size());
                all.corners.push_back(p);
            }
    for (auto face : hull.faces) {
        for (int& corner : face)
            corner = numbers[corner];
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        all.faces.push_back(face);
    }
    std::sort(all.faces.begin(), all.faces.end());
    return all;
}

} // namespace

ConvexHull convexHull(const std::vector<Eigen::Vector3d>& points) {
    std::vector<Kernel::Point_3> given;
    for (const auto& p : points)
        given.emplace_back(p[0], p[1], p[2]);
    Surface surface;
    CGAL::convex_hull_3(given.begin(), given.end(), surface);
    std::map<const Surface::Facet*, Eigen::Vector4d> planes;
    for (auto facet = surface.facets_begin(); facet != surface.facets_end(); ++facet)
        planes[&*facet] = planeOf(*facet);
    while (surface.size_of_facets() >= 4 && removeOneEdge(surface, planes)) {
    }
    if (surface.size_of_facets() < 4) throw std::invalid_argument("the corners of the block have no volume");

    ConvexHull hull;
    std::map<const Surface::Vertex*, int> numbers;
    for (auto vertex = surface.vertices_begin(); vertex != surface.vertices_end(); ++vertex) {
        numbers[&*vertex] = int(hull.corners.size());
        const auto& p = vertex->point();
        hull.corners.emplace_back(p.x(), p.y(), p.z());
    }
    for (auto facet = surface.facets_begin(); facet != surface.facets_end(); ++facet) {
        hull.faces.emplace_back();
        auto around = facet->facet_begin();
        do
            hull.faces.back().push_back(numbers[&*around->vertex()]);
        while (++around != facet->facet_begin());
    }
    return points.size() > orderedVertices ? ordered(hull, points) : hull;
}

} // namespace masonry
