// SPDX-License-Identifier: GPL-2.0-or-later
#include "Overlap.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace masonry {

using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

namespace {

// Depths below this are zero, over the size of both blocks: some fifty times the round-off of a depth.
constexpr double tiny = 1e-14;
constexpr int mostEdgePairs = 400;
constexpr double leastAxis = 1e-12; // square of the sine between two edges below which they count as parallel

PlainVector plain(const Vector& v) { return {v[0], v[1], v[2]}; }
Vector eigen(const PlainVector& v) { return {v.x, v.y, v.z}; }

// How far the corners of a block reach along a direction, in its own axes [m times the length of the direction].
double reachAlong(const ContactBlock& block, const Vector& direction) {
    const double *x = block.corners[0].data(), *y = block.corners[1].data(), *z = block.corners[2].data();
    double most = -HUGE_VAL;
    for (int i = 0; i < block.cornerCount(); ++i)
        most = std::max(most, direction[0] * x[i] + direction[1] * y[i] + direction[2] * z[i]);
    return most;
}

// The gap between two blocks along the axis of `find`, times the length of that axis; below 0 if they overlap along it.
double gapAlong(const ContactBlock& one, const ContactBlock& other, const RelativePose& pose, int axis,
                double& length) {
    const int faces = one.faceCount(), all = faces + other.faceCount(), pair = axis - all;
    length = 1;
    const auto gap = [&](const Vector& d, double ofOne, double ofOther) { return d.dot(pose.place) - ofOne - ofOther; };
    if (axis < faces) {
        const auto& face = one.faces[axis];
        return gap(face.normal, face.offset, reachAlong(other, -(pose.turn.transpose() * face.normal)));
    }
    if (axis < all) {
        const auto& face = other.faces[axis - faces];
        const Vector d = -(pose.turn * face.normal);
        return gap(d, reachAlong(one, d), face.offset);
    }
    const int others = int(other.edges.size());
    if (pair >= int(one.edges.size()) * others) return -HUGE_VAL;
    const Vector d = one.edges[pair / others].cross(pose.turn * other.edges[pair % others]);
    if (d.squaredNorm() < leastAxis) return -HUGE_VAL;
    length = d.norm();
    const Vector back = pose.turn.transpose() * d;
    return std::max(gap(d, reachAlong(one, d), reachAlong(other, -back)),
                    gap(-d, reachAlong(one, -d), reachAlong(other, back)));
}

} // namespace

void OverlapFinder::provideFor(const ContactBlock& block) {
    const auto corners = std::size_t(block.cornerCount()), faces = std::size_t(block.faceCount());
    for (auto* side : {&one_, &other_}) {
        side->corners.resize(std::max(corners, side->corners.size()));
        side->planes.resize(std::max(faces, side->planes.size()));
    }
    for (auto* side : {&one_, &other_})
        side->depths.resize(side->corners.size() * side->planes.size());
    // A cut adds at most one corner to a convex polygon. A polygon is cut by the planes of the opposite block, by those
    // between its cells, and that of a wall between two cells by those of its own block, too.
    const auto most = one_.corners.size() + 3 * one_.planes.size() + 4;
    for (auto* polygon : {&polygon_, &spare_, &whole_})
        polygon->resize(most);
    signs_.resize(most);
    least_.resize(one_.planes.size());
    nearest_.resize(one_.planes.size());
    cells_.resize(one_.planes.size());
    patches_.reserve(2 * one_.planes.size());
}

void OverlapFinder::place(const ContactBlock& one, const ContactBlock& other, const RelativePose& pose) {
    one_.block = &one;
    other_.block = &other;
    one_.least = other_.least = HUGE_VAL;
    tolerance_ = tiny * (one.radius + other.radius);
    for (int i = 0; i < one.cornerCount(); ++i)
        one_.corners[i] = vectorAt(one.corners, i);
    for (int f = 0; f < one.faceCount(); ++f)
        one_.planes[f] = {plain(one.faces[f].normal), one.faces[f].offset};
    const PlainVector r[3] = {plain(pose.turn.row(0)), plain(pose.turn.row(1)), plain(pose.turn.row(2))};
    const PlainVector place = plain(pose.place);
    const auto turned = [&](const PlainVector& v) { return PlainVector{dot(r[0], v), dot(r[1], v), dot(r[2], v)}; };
    for (int i = 0; i < other.cornerCount(); ++i)
        other_.corners[i] = place + turned(vectorAt(other.corners, i));
    for (int f = 0; f < other.faceCount(); ++f) {
        const PlainVector normal = turned(plain(other.faces[f].normal));
        other_.planes[f] = {normal, other.faces[f].offset + dot(normal, place)};
    }
}

// Finds the depths of all corners of a block below one face of the opposite block, and whether none is below it.
bool OverlapFinder::separates(const Side& of, Side& from, int face) {
    const int count = from.block->cornerCount();
    const Plane plane = of.planes[face];
    double* depths = &from.depths[face * count];
    const Corner* corners = from.corners.data();
    double deepest = -HUGE_VAL;
    for (int i = 0; i < count; ++i) {
        depths[i] = plane.depth(corners[i]);
        deepest = std::max(deepest, depths[i]);
    }
    if (deepest < from.least) {
        from.least = deepest;
        from.shallow = face;
    }
    return deepest <= tolerance_;
}

// Whether the plane along an edge of each block separates them. The numbers of both edges are one number.
bool OverlapFinder::edgesSeparate(const RelativePose& pose, int edges) const {
    const auto& others = other_.block->edges;
    const Vector axis = one_.block->edges[std::size_t(edges) / others.size()].cross(
        pose.turn * others[std::size_t(edges) % others.size()]);
    if (axis.squaredNorm() < leastAxis) return false;
    const PlainVector direction = plain(axis);
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int side = 0; side < 2; ++side) {
        const Side& s = side ? other_ : one_;
        for (int i = 0; i < s.block->cornerCount(); ++i) {
            const double along = dot(direction, s.corners[i]);
            low[side] = std::min(low[side], along);
            high[side] = std::max(high[side], along);
        }
    }
    return high[0] <= low[1] || high[1] <= low[0];
}

bool OverlapFinder::cut(const Plane& plane, bool kept) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    const Corner* from = polygon_.data();
    double* signs = signs_.data();
    for (int i = 0; i < size_; ++i) {
        signs[i] = plane.depth(from[i]);
        low = std::min(low, signs[i]);
        high = std::max(high, signs[i]);
    }
    if (low >= -tolerance_) return high > tolerance_ || kept;
    if (high <= tolerance_) return false;
    Corner* to = spare_.data();
    int count = 0;
    for (int i = 0; i < size_; ++i) {
        const int next = i + 1 < size_ ? i + 1 : 0;
        const double s = signs[i], t = signs[next];
        if (s >= -tolerance_) to[count++] = from[i];
        if ((s > tolerance_ && t < -tolerance_) || (s < -tolerance_ && t > tolerance_)) {
            // From the inner corner, so that neighbouring parts have the same point.
            const Corner &in = s > 0 ? from[i] : from[next], &out = s > 0 ? from[next] : from[i];
            const double share = (s > 0 ? s : t) / (s > 0 ? s - t : t - s);
            to[count++] = in + share * (out - in);
        }
    }
    polygon_.swap(spare_);
    size_ = count;
    return count > 2;
}

int OverlapFinder::clip(const Side& of, const Side& inside, int face) {
    const auto& outline = of.block->faces[face];
    const int* numbers = of.block->outlines.data();
    const int corners = of.block->cornerCount(), planes = inside.block->faceCount();
    double bound = HUGE_VAL; // no point of the face is deeper inside the opposite block
    int cutting = 0;         // planes that cut the face come first in `nearest_`
    const auto look = [&](int j) {
        const double* depths = of.depths.data() + j * corners;
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = outline.first; k < outline.beyond; ++k) {
            const double depth = depths[numbers[k]];
            low = std::min(low, depth);
            high = std::max(high, depth);
        }
        if (high <= tolerance_) return false;
        bound = std::min(bound, high);
        least_[j] = low;
        if (low < -tolerance_) nearest_[cutting++] = j;
        return true;
    };
    // Most faces look away, and lie outside this plane.
    if (!look(of.shallow)) return 0;
    for (int j = 0; j < planes; ++j)
        if (j != of.shallow && !look(j)) return 0;
    size_ = 0;
    for (int k = outline.first; k < outline.beyond; ++k)
        corner(size_++) = of.corners[numbers[k]];
    for (int c = 0; c < cutting; ++c)
        if (!cut(inside.planes[nearest_[c]], false)) return 0;
    // Which faces of the opposite block can be the nearest one: those below which some point is less deep than all
    // points are below some other face.
    // Of two that are equally deep everywhere it is the first.
    int count = 0, first = 0;
    double highest = HUGE_VAL;
    for (int j = 0; j < planes; ++j) {
        if (least_[j] > bound) continue;
        const Plane& plane = inside.planes[j];
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int i = 0; i < size_; ++i) {
            const double depth = plane.depth(corner(i));
            low = std::min(low, depth);
            high = std::max(high, depth);
        }
        if (low > bound) continue;
        bound = std::min(bound, high);
        if (high < highest - tolerance_) {
            highest = high;
            first = count;
        }
        least_[j] = low;
        nearest_[count++] = j;
    }
    std::swap(nearest_[0], nearest_[first]);
    const Plane& main = inside.planes[nearest_[0]];
    int possible = 1;
    for (int c = 1; c < count; ++c) {
        const int j = nearest_[c];
        if (least_[j] > bound) continue;
        const Plane less = main - inside.planes[j];
        bool some = false;
        for (int i = 0; i < size_ && !some; ++i)
            some = less.depth(corner(i)) > tolerance_;
        if (some) nearest_[possible++] = j;
    }
    if (possible > 1) {
        wholeSize_ = size_;
        std::copy_n(polygon_.begin(), size_, whole_.begin());
    }
    return possible;
}

bool OverlapFinder::cell(const Side& inside, int number, int count) {
    const Plane& nearest = inside.planes[nearest_[number]];
    size_ = wholeSize_;
    std::copy_n(whole_.begin(), wholeSize_, polygon_.begin());
    // Where a part is as deep below two faces, it belongs to the first of them.
    for (int d = 0; d < count; ++d)
        if (d != number && !cut(inside.planes[nearest_[d]] - nearest, nearest_[number] < nearest_[d])) return false;
    return true;
}

// Integrals over the present polygon, exact for triangles with a linear pressure. With barycentric coordinates l: the
// mean of l_i l_j is 1/12, of l_i² 1/6; that of l_i l_j l_k 1/60, of l_i² l_j 1/30, of l_i³ 1/10.
void OverlapFinder::addParts(const Plane& pressure, const Plane& face, bool area, Sums& sums) const {
    const Corner* p = polygon_.data();
    const Corner& o = p[0];
    const auto next = [](const Corner& c) { return Corner{c.y, c.z, c.x}; };
    const double p0 = pressure.depth(o), oo = dot(o, o);
    double p1 = pressure.depth(p[1]), ss = dot(p[1], p[1]);
    for (int i = 2; i < size_; ++i) {
        const Corner &s = p[i - 1], &t = p[i], all = o + s + t;
        const double twice = dot(face.normal, cross(s - o, t - o));
        const double p2 = pressure.depth(t), sum = p0 + p1 + p2;
        const double part = twice / 24, sumPart = part * sum;
        sums.pressure += 4 * sumPart;
        sums.first = sums.first + ((sumPart + part * p0) * o + (sumPart + part * p1) * s + (sumPart + part * p2) * t);
        const double tt = dot(t, t);
        const double weighted = p0 * (oo + dot(o, all)) + p1 * (ss + dot(s, all)) + p2 * (tt + dot(t, all));
        sums.square += twice / 120 * (sum * (dot(all, all) + (oo + ss + tt)) + 2 * weighted);
        p1 = p2;
        ss = tt;
        if (!area) continue;
        sums.area += 0.5 * twice;
        sums.firstOfArea = sums.firstOfArea + twice / 6 * all;
        sums.squares = sums.squares + part * (all * all + (o * o + s * s + t * t));
        sums.mixed = sums.mixed + part * (all * next(all) + (o * next(o) + s * next(s) + t * next(t)));
    }
}

void OverlapFinder::addPatches(const Side& of, const Side& inside, double sign) {
    for (int f = 0; f < of.block->faceCount(); ++f) {
        const int count = clip(of, inside, f);
        if (count == 0) continue;
        const Plane& face = of.planes[f];
        Patch patch{face.normal, sign, {}};
        // The depth below the first face everywhere, then how much less deep the cells of the others are.
        const Plane& first = inside.planes[nearest_[0]];
        addParts(first, face, true, patch.sums);
        for (int c = 1; c < count; ++c)
            if (cell(inside, c, count)) addParts(inside.planes[nearest_[c]] - first, face, false, patch.sums);
        if (patch.sums.pressure > 0) patches_.push_back(patch);
    }
}

bool OverlapFinder::find(const ContactBlock& one, const ContactBlock& other, const RelativePose& pose, int& axis,
                         Overlap& found) {
    const double reach = one.radius + other.radius;
    if (pose.place.squaredNorm() >= reach * reach) return false;
    // Most pairs are separated by the plane of the last step. A gap above the round-off of depths is certain.
    double length;
    if (const double gap = gapAlong(one, other, pose, axis, length); gap > tiny * reach * length) return false;
    place(one, other, pose);
    const int faces = one.faceCount(), all = faces + other.faceCount();
    const auto separated = [&](int face) {
        return face < faces ? separates(one_, other_, face) : separates(other_, one_, face - faces);
    };
    const int edges = int(one.edges.size() * other.edges.size());
    if (axis < all ? separated(axis) : axis < all + edges && edgesSeparate(pose, axis - all)) return false;
    for (int face = 0; face < all; ++face)
        if (separated(face)) {
            axis = face;
            return false;
        }
    patches_.clear();
    addPatches(other_, one_, -1);
    addPatches(one_, other_, 1);
    if (patches_.empty()) {
        // They do not overlap, but no face separates them: two edges do. For blocks of very many edges the search would
        // take longer than what it saves.
        if (edges <= mostEdgePairs)
            for (int pair = 0; pair < edges; ++pair)
                if (edgesSeparate(pose, pair)) {
                    axis = all + pair;
                    break;
                }
        return false;
    }

    Vector force = Vector::Zero(), moment = Vector::Zero(), first = Vector::Zero();
    double pressing = 0, square = 0, touched = 0;
    for (const auto& patch : patches_) {
        const Vector normal = patch.sign * eigen(patch.normal), p = eigen(patch.sums.first);
        force += patch.sums.pressure * normal;
        moment += p.cross(normal);
        first += p;
        pressing += patch.sums.pressure;
        square += patch.sums.square;
        touched += patch.sums.area;
    }
    found.force = 0.5 * force;
    found.moment = 0.5 * moment;
    found.touched = 0.5 * touched;
    found.pressing = pressing;
    found.centre = first / pressing;
    found.meanSquare = std::max(0.0, square / pressing - found.centre.squaredNorm());
    found.area = 0;
    found.firstMoment.setZero();
    found.secondMoment.setZero();
    const double size = force.norm();
    // A force that is round-off of the pressures has no direction.
    if (!(size > 1e-12 * pressing)) {
        found.normal.setZero();
        return true;
    }
    found.normal = force / size;
    for (const auto& patch : patches_) {
        const auto& s = patch.sums;
        const double cosine = patch.sign * found.normal.dot(eigen(patch.normal));
        if (cosine <= 0) continue;
        const double share = 0.5 * cosine;
        found.area += share * s.area;
        found.firstMoment += share * eigen(s.firstOfArea);
        Matrix second;
        const auto &q = s.squares, &m = s.mixed;
        second << q.x, m.x, m.z, m.x, q.y, m.y, m.z, m.y, q.z;
        found.secondMoment += share * second;
    }
    return true;
}

// The integral of the square of a depth over the present polygon.
double OverlapFinder::squareOf(const Plane& depth, const Vector& normal) const {
    const Vector o = eigen(polygon_[0]);
    const double p0 = depth.depth(polygon_[0]);
    double sum = 0;
    for (int i = 2; i < size_; ++i) {
        const auto &s = polygon_[i - 1], &t = polygon_[i];
        const double twice = normal.dot((eigen(s) - o).cross(eigen(t) - o)), p1 = depth.depth(s), p2 = depth.depth(t);
        sum += twice / 12 * (p0 * p0 + p1 * p1 + p2 * p2 + p0 * p1 + p1 * p2 + p2 * p0);
    }
    return sum;
}

// The integral over the overlap of the depth below the nearest face of `inside`. With g the gradient of the depth, the
// divergence of g depth²/2 is the depth. So the cell of every nearest face has a surface integral: over what it has of
// the surface of `of`, and over its walls to other cells.
double OverlapFinder::depthIntegral(const Side& of, const Side& inside) {
    const auto normalOf = [](const Plane& p) { return eigen(p.normal); };
    double sum = 0;
    std::fill(cells_.begin(), cells_.end(), false);
    for (int f = 0; f < of.block->faceCount(); ++f) {
        const Vector outward = normalOf(of.planes[f]);
        const int count = clip(of, inside, f);
        for (int c = 0; c < count; ++c) {
            cells_[nearest_[c]] = true;
            const Plane& nearest = inside.planes[nearest_[c]];
            if (count == 1 || cell(inside, c, count))
                sum -= 0.5 * normalOf(nearest).dot(outward) * squareOf(nearest, outward);
        }
    }
    const int faces = inside.block->faceCount(), bounds = of.block->faceCount();
    // From any point of a cell the line towards its face stays in the cell, and ends at the surface of the one block,
    // in a part that was found above, or at that face. Walls stand between such cells only. A face has no end of such a
    // line if it lies outside one plane of the one block.
    const int corners = inside.block->cornerCount();
    for (int i = 0; i < faces; ++i) {
        const auto& outline = inside.block->faces[i];
        const auto outside = [&](int plane) {
            const double* depths = inside.depths.data() + plane * corners;
            for (int k = outline.first; k < outline.beyond; ++k)
                if (depths[inside.block->outlines[k]] >= -tolerance_) return false;
            return true;
        };
        bool near = true;
        for (int plane = 0; plane < bounds && near; ++plane)
            near = !outside(plane);
        if (near) cells_[i] = true;
    }
    for (int i = 0; i < faces; ++i)
        for (int j = i + 1; j < faces; ++j) {
            if (!cells_[i] || !cells_[j]) continue;
            const Plane& mine = inside.planes[i];
            const Plane wall = inside.planes[j] - mine;
            const Vector across = normalOf(wall); // from cell i to cell j the difference of depths falls along this
            const double steep = across.norm();
            if (!(steep > 0)) continue;
            const Vector n = across / steep, e1 = n.unitOrthogonal(), e2 = n.cross(e1);
            const Vector middle = wall.offset / steep * n;
            const double wide = 2 * (of.block->radius + inside.block->radius);
            if (middle.norm() > wide) continue;
            size_ = 0;
            for (const auto& [u, v] : {std::pair(1, 1), std::pair(-1, 1), std::pair(-1, -1), std::pair(1, -1)}) {
                const Vector at = middle + wide * (u * e1 + v * e2);
                corner(size_++) = plain(at);
            }
            bool some = cut(mine, true);
            for (int k = 0; k < faces && some; ++k)
                if (k != i && k != j) some = cut(inside.planes[k] - mine, true);
            for (int k = 0; k < bounds && some; ++k) {
                // A wall in a face of the block bounds the overlap. It is counted where that face was given to the cell
                // outside, which is cell i, the first, if the overlap lies in cell j.
                const Plane& face = of.planes[k];
                some = cut(face, normalOf(face).dot(across) < 0);
            }
            if (some) sum += 0.5 * steep * squareOf(mine, n);
        }
    return sum;
}

double OverlapFinder::potential(const ContactBlock& one, const ContactBlock& other, const RelativePose& pose) {
    const double reach = one.radius + other.radius;
    if (pose.place.squaredNorm() >= reach * reach) return 0;
    place(one, other, pose);
    for (int face = 0; face < one.faceCount(); ++face)
        if (separates(one_, other_, face)) return 0;
    for (int face = 0; face < other.faceCount(); ++face)
        if (separates(other_, one_, face)) return 0;
    return 0.5 * (depthIntegral(other_, one_) + depthIntegral(one_, other_));
}

} // namespace masonry
