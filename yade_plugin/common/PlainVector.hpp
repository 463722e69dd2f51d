// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors and quaternions of plain numbers, for loops over columns that the compiler makes for the vector units.
#pragma once
#include "Vectorised.hpp"

namespace masonry {

struct PlainVector {
    double x, y, z;
};

MASONRY_INLINED PlainVector operator+(const PlainVector& a, const PlainVector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
MASONRY_INLINED PlainVector operator-(const PlainVector& a, const PlainVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
MASONRY_INLINED PlainVector operator*(double f, const PlainVector& a) { return {f * a.x, f * a.y, f * a.z}; }
// Component by component.
MASONRY_INLINED PlainVector operator*(const PlainVector& a, const PlainVector& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
MASONRY_INLINED PlainVector operator/(const PlainVector& a, const PlainVector& b) {
    return {a.x / b.x, a.y / b.y, a.z / b.z};
}
MASONRY_INLINED double dot(const PlainVector& a, const PlainVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
MASONRY_INLINED PlainVector cross(const PlainVector& a, const PlainVector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct PlainQuaternion {
    double w;
    PlainVector v;

    // A vector turned by this rotation, and by its inverse.
    MASONRY_INLINED PlainVector turn(const PlainVector& a) const {
        const PlainVector twice = 2 * cross(v, a);
        return a + w * twice + cross(v, twice);
    }
    MASONRY_INLINED PlainVector turnBack(const PlainVector& a) const {
        const PlainVector twice = 2 * cross(a, v);
        return a + w * twice + cross(twice, v);
    }
};

MASONRY_INLINED PlainQuaternion operator*(const PlainQuaternion& a, const PlainQuaternion& b) {
    return {a.w * b.w - a.v.x * b.v.x - a.v.y * b.v.y - a.v.z * b.v.z,
            {a.w * b.v.x + a.v.x * b.w + a.v.y * b.v.z - a.v.z * b.v.y,
             a.w * b.v.y + a.v.y * b.w + a.v.z * b.v.x - a.v.x * b.v.z,
             a.w * b.v.z + a.v.z * b.w + a.v.x * b.v.y - a.v.y * b.v.x}};
}
MASONRY_INLINED PlainQuaternion operator*(double f, const PlainQuaternion& a) { return {f * a.w, f * a.v}; }
MASONRY_INLINED double dot(const PlainQuaternion& a, const PlainQuaternion& b) {
    return a.w * b.w + a.v.x * b.v.x + a.v.y * b.v.y + a.v.z * b.v.z;
}

// What columns hold at a place, three of them or four.
template <class Columns> MASONRY_INLINED PlainVector vectorAt(const Columns& c, int i) {
    return {c[0][i], c[1][i], c[2][i]};
}
template <class Columns> MASONRY_INLINED PlainQuaternion quaternionAt(const Columns& c, int i) {
    return {c[0][i], {c[1][i], c[2][i], c[3][i]}};
}
template <class Columns> MASONRY_INLINED void put(Columns& c, int i, const PlainVector& v) {
    c[0][i] = v.x;
    c[1][i] = v.y;
    c[2][i] = v.z;
}
MASONRY_INLINED void store(double* to, const PlainVector& v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

} // namespace masonry
