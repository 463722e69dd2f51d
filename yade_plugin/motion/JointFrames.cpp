// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointFrames.hpp"
#include "common/Vectorised.hpp"
#include <cmath>
#include <cstdint>
#include <cstring>

namespace masonry {

namespace {

// Finds the joint's frame and the rotation `half` from it to side 2.
[[gnu::always_inline]] inline void align(int n, const int* body1, const int* body2, const double* const* q,
                                         const double* const* f1, const double* const* f2,
                                         JointFrames& __restrict out) {
    const double *qw = q[0], *qx = q[1], *qy = q[2], *qz = q[3];
    // Suffix 1 and 2: the joint's axes as bodies 1 and 2 have carried them along.
    const double *aw = f1[0], *ax = f1[1], *ay = f1[2], *az = f1[3];
    const double *bw = f2[0], *bx = f2[1], *by = f2[2], *bz = f2[3];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const int one = body1[i], two = body2[i];
        const double w1 = qw[one] * aw[i] - qx[one] * ax[i] - qy[one] * ay[i] - qz[one] * az[i];
        const double x1 = qw[one] * ax[i] + qx[one] * aw[i] + qy[one] * az[i] - qz[one] * ay[i];
        const double y1 = qw[one] * ay[i] + qy[one] * aw[i] + qz[one] * ax[i] - qx[one] * az[i];
        const double z1 = qw[one] * az[i] + qz[one] * aw[i] + qx[one] * ay[i] - qy[one] * ax[i];
        double w2 = qw[two] * bw[i] - qx[two] * bx[i] - qy[two] * by[i] - qz[two] * bz[i];
        double x2 = qw[two] * bx[i] + qx[two] * bw[i] + qy[two] * bz[i] - qz[two] * by[i];
        double y2 = qw[two] * by[i] + qy[two] * bw[i] + qz[two] * bx[i] - qx[two] * bz[i];
        double z2 = qw[two] * bz[i] + qz[two] * bw[i] + qx[two] * by[i] - qy[two] * bx[i];
        // A quaternion and its negative are the same rotation; take the one that is nearer.
        const double same = w1 * w2 + x1 * x2 + y1 * y2 + z1 * z2 < 0 ? -1.0 : 1.0;
        w2 *= same;
        x2 *= same;
        y2 *= same;
        z2 *= same;
        double w = w1 + w2, x = x1 + x2, y = y1 + y2, z = z1 + z2;
        const double size = 1 / std::sqrt(w * w + x * x + y * y + z * z);
        w *= size;
        x *= size;
        y *= size;
        z *= size;
        out.w[i] = w * w2 + x * x2 + y * y2 + z * z2;
        out.v[0][i] = w * x2 - x * w2 - (y * z2 - z * y2);
        out.v[1][i] = w * y2 - y * w2 - (z * x2 - x * z2);
        out.v[2][i] = w * z2 - z * w2 - (x * y2 - y * x2);
        out.axes[0][i] = 1 - 2 * (y * y + z * z);
        out.axes[1][i] = 2 * (x * y - w * z);
        out.axes[2][i] = 2 * (x * z + w * y);
        out.axes[3][i] = 2 * (x * y + w * z);
        out.axes[4][i] = 1 - 2 * (x * x + z * z);
        out.axes[5][i] = 2 * (y * z - w * x);
        out.axes[6][i] = 2 * (x * z - w * y);
        out.axes[7][i] = 2 * (y * z + w * x);
        out.axes[8][i] = 1 - 2 * (x * x + y * y);
    }
}

} // namespace

template <>
MASONRY_VECTORISED void JointArithmetic<false>::alignRigid(int n, const int* body1, const int* body2,
                                                           const double* const* position, const double* const* q,
                                                           const double* const* f1, const double* const* f2,
                                                           const double* const* span, JointFrames& __restrict out) {
    align(n, body1, body2, q, f1, f2, out);
    const double *px = position[0], *py = position[1], *pz = position[2];
    const double *sx = span[0], *sy = span[1], *sz = span[2];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = px[body2[i]] - px[body1[i]], y = py[body2[i]] - py[body1[i]], z = pz[body2[i]] - pz[body1[i]];
        out.between[0][i] = x;
        out.between[1][i] = y;
        out.between[2][i] = z;
        const double v0 = out.v[0][i], v1 = out.v[1][i], v2 = out.v[2][i], w = out.w[i];
        const double t0 = 2 * (v1 * sz[i] - v2 * sy[i]), t1 = 2 * (v2 * sx[i] - v0 * sz[i]),
                     t2 = 2 * (v0 * sy[i] - v1 * sx[i]); // for half d = d + w (2v × d) + v × (2v × d)
        out.common[0][i] =
            out.axes[0][i] * x + out.axes[3][i] * y + out.axes[6][i] * z - (sx[i] + w * t0 + (v1 * t2 - v2 * t1));
        out.common[1][i] =
            out.axes[1][i] * x + out.axes[4][i] * y + out.axes[7][i] * z - (sy[i] + w * t1 + (v2 * t0 - v0 * t2));
        out.common[2][i] =
            out.axes[2][i] * x + out.axes[5][i] * y + out.axes[8][i] * z - (sz[i] + w * t2 + (v0 * t1 - v1 * t0));
        for (int d = 0; d < 3; ++d)
            out.force[d][i] = out.torque[d][i] = 0;
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::alignNodal(int n, const int* body1, const int* body2,
                                                           const double* const* q, const double* const* f1,
                                                           const double* const* f2, JointFrames& __restrict out) {
    align(n, body1, body2, q, f1, f2, out);
    for (auto& component : out.torque)
        for (int i = 0; i < n; ++i)
            component[i] = 0;
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::jumpRigid(int n, const double* __restrict ax,
                                                          const double* __restrict ay, const double* __restrict az,
                                                          double* __restrict jx, double* __restrict jy,
                                                          double* __restrict jz, JointFrames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double v0 = out.v[0][i], v1 = out.v[1][i], v2 = out.v[2][i], turn = 4 * out.w[i];
        const double a0 = ax[i], a1 = ay[i], a2 = az[i];
        const double c0 = out.common[0][i], c1 = out.common[1][i], c2 = out.common[2][i];
        const double j0 = c0 + turn * (v1 * a2 - v2 * a1), j1 = c1 + turn * (v2 * a0 - v0 * a2),
                     j2 = c2 + turn * (v0 * a1 - v1 * a0);
        out.step[0][i] = j0 - jx[i];
        out.step[1][i] = j1 - jy[i];
        out.step[2][i] = j2 - jz[i];
        jx[i] = j0;
        jy[i] = j1;
        jz[i] = j2;
        const double shrink = 1 - 2 * (v0 * v0 + v1 * v1 + v2 * v2), along = 2 * (v0 * a0 + v1 * a1 + v2 * a2);
        // half^T a + jump / 2, as forces act at the middle of the jump
        out.arm[0][i] = shrink * a0 + along * v0 + 0.5 * c0;
        out.arm[1][i] = shrink * a1 + along * v1 + 0.5 * c1;
        out.arm[2][i] = shrink * a2 + along * v2 + 0.5 * c2;
    }
}

// Multiplies stress by area. Tension is positive, so a joint in tension pulls body 1 along the normal.
template <>
MASONRY_VECTORISED void JointArithmetic<false>::pullRigid(int n, const double* area, const double* normal,
                                                          const double* shearA, const double* shearB, const double*,
                                                          const double*, JointFrames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = area[i] * normal[i], y = area[i] * shearA[i], z = area[i] * shearB[i];
        out.force[0][i] += x;
        out.force[1][i] += y;
        out.force[2][i] += z;
        out.torque[0][i] += out.arm[1][i] * z - out.arm[2][i] * y;
        out.torque[1][i] += out.arm[2][i] * x - out.arm[0][i] * z;
        out.torque[2][i] += out.arm[0][i] * y - out.arm[1][i] * x;
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::finishRigid(int n, const JointFrames& f, double* __restrict onJoints) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        double* out = onJoints + 9 * i;
        const auto turned = [&](const double(&c)[3][JointFrames::most], int d) {
            return f.axes[3 * d][i] * c[0][i] + f.axes[3 * d + 1][i] * c[1][i] + f.axes[3 * d + 2][i] * c[2][i];
        };
        const double fx = turned(f.force, 0), fy = turned(f.force, 1), fz = turned(f.force, 2);
        const double tx = turned(f.torque, 0), ty = turned(f.torque, 1), tz = turned(f.torque, 2);
        const double bx = f.between[0][i], by = f.between[1][i], bz = f.between[2][i];
        out[0] = fx; // on body 1
        out[1] = fy;
        out[2] = fz;
        out[3] = tx;
        out[4] = ty;
        out[5] = tz;
        out[6] = by * fz - bz * fy - tx; // the arms of body 2 are shorter by `between`
        out[7] = bz * fx - bx * fz - ty;
        out[8] = bx * fy - by * fx - tz;
    }
}

// ---- intact joints ----------------------------------------------------------------------------------------------

template <>
MASONRY_VECTORISED void JointArithmetic<false>::spreadIntact(int n, const IntactFaces& faces,
                                                             JointFrames& __restrict out) {
    const double *m0 = faces.middle[0], *m1 = faces.middle[1], *m2 = faces.middle[2];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double twist = 4 * out.w[i];
        const double t0 = twist * out.v[0][i], t1 = twist * out.v[1][i], t2 = twist * out.v[2][i];
        out.turn[0][i] = t0;
        out.turn[1][i] = t1;
        out.turn[2][i] = t2;
        out.middle[0][i] = out.common[0][i] + (t1 * m2[i] - t2 * m1[i]);
        out.middle[1][i] = out.common[1][i] + (t2 * m0[i] - t0 * m2[i]);
        out.middle[2][i] = out.common[2][i] + (t0 * m1[i] - t1 * m0[i]);
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::jumpIntact(int n, const IntactFaces& faces, const double* a1,
                                                           const double* a2, JointFrames& __restrict out) {
    const double *m1 = faces.middle[1], *m2 = faces.middle[2];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double b1 = a1[i] - m1[i], b2 = a2[i] - m2[i], t0 = out.turn[0][i];
        out.step[0][i] = out.middle[0][i] + (out.turn[1][i] * b2 - out.turn[2][i] * b1);
        out.step[1][i] = out.middle[1][i] - t0 * b2;
        out.step[2][i] = out.middle[2][i] + t0 * b1;
    }
}

MASONRY_VECTORISED void openIntact(int n, const IntactFaces& faces, const double* a1, const double* a2,
                                   JointFrames& __restrict out) {
    const double *m1 = faces.middle[1], *m2 = faces.middle[2];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i)
        out.step[0][i] = out.middle[0][i] + (out.turn[1][i] * (a2[i] - m2[i]) - out.turn[2][i] * (a1[i] - m1[i]));
}

namespace {

// Integral over a face of a product of two fields, each component times its stiffness [J].
[[gnu::always_inline]] inline double productOver(const IntactFaces& faces, int i, const double* a, const double* b) {
    const double I11 = faces.inertia[0][i], I22 = faces.inertia[1][i], I12 = faces.inertia[2][i];
    const double normal =
        faces.area[i] * a[0] * b[0] + a[4] * b[4] * I22 - (a[4] * b[5] + a[5] * b[4]) * I12 + a[5] * b[5] * I11;
    const double shear = faces.area[i] * (a[1] * b[1] + a[2] * b[2]) + a[3] * b[3] * (I11 + I22);
    return faces.normal * normal + faces.shear * shear;
}

} // namespace

MASONRY_VECTORISED void keepIntact(int n, const JointFrames& frames, double* const* jumps) {
    for (int d = 0; d < 3; ++d)
        for (int i = 0; i < n; ++i) {
            jumps[d][i] = frames.middle[d][i];
            jumps[3 + d][i] = frames.turn[d][i];
        }
}

double dampIntact(int n, const IntactFaces& faces, double times, double* const* jumps, double* const* damped,
                  JointFrames& out) {
    double taken = 0;
    for (int i = 0; i < n; ++i) {
        double change[6], both[6];
        for (int d = 0; d < 6; ++d) {
            double& field = d < 3 ? out.middle[d][i] : out.turn[d - 3][i];
            change[d] = field - jumps[d][i];
            jumps[d][i] = field;
            const double now = times * change[d];
            both[d] = now + damped[d][i];
            damped[d][i] = now;
            field += now;
        }
        taken += 0.5 * productOver(faces, i, both, change);
    }
    return taken;
}

// With b from the middle of the face, its arm is half^T (middle + b) + jump / 2 (see jumpRigid), and the stress is the
// stiffness times the field. The first moments of b are zero.
template <>
MASONRY_VECTORISED void JointArithmetic<false>::pullIntact(int n, const IntactFaces& faces,
                                                           JointFrames& __restrict out) {
    const double *m0 = faces.middle[0], *m1 = faces.middle[1], *m2 = faces.middle[2], *area = faces.area;
    const double *i11 = faces.inertia[0], *i22 = faces.inertia[1], *i12 = faces.inertia[2];
    const double kn = faces.normal, ks = faces.shear;
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = kn * area[i] * out.middle[0][i], y = ks * area[i] * out.middle[1][i],
                     z = ks * area[i] * out.middle[2][i];
        const double t0 = out.turn[0][i], t1 = out.turn[1][i], t2 = out.turn[2][i];
        const double v0 = out.v[0][i], v1 = out.v[1][i], v2 = out.v[2][i];
        const double a0 = m0[i], a1 = m1[i], a2 = m2[i];
        const double shrink = 1 - 2 * (v0 * v0 + v1 * v1 + v2 * v2), along = 2 * (v0 * a0 + v1 * a1 + v2 * a2);
        const double r0 = shrink * a0 + along * v0 + 0.5 * out.common[0][i];
        const double r1 = shrink * a1 + along * v1 + 0.5 * out.common[1][i];
        const double r2 = shrink * a2 + along * v2 + 0.5 * out.common[2][i];
        // integrals of b × stress, and of (v · b) stress
        const double bend1 = kn * (t1 * i22[i] - t2 * i12[i]), bend2 = kn * (t2 * i11[i] - t1 * i12[i]);
        const double twist = ks * t0 * (i11[i] + i22[i]);
        const double h0 = v2 * bend1 - v1 * bend2;
        const double h1 = -ks * t0 * (v1 * i12[i] + v2 * i22[i]), h2 = ks * t0 * (v1 * i11[i] + v2 * i12[i]);
        out.force[0][i] = x;
        out.force[1][i] = y;
        out.force[2][i] = z;
        out.torque[0][i] = r1 * z - r2 * y + shrink * twist + 2 * (v1 * h2 - v2 * h1);
        out.torque[1][i] = r2 * x - r0 * z + shrink * bend1 + 2 * (v2 * h0 - v0 * h2);
        out.torque[2][i] = r0 * y - r1 * x + shrink * bend2 + 2 * (v0 * h1 - v1 * h0);
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::jumpNodal(int n, const int* place1, const int* place2, const double* u,
                                                          double* __restrict jx, double* __restrict jy,
                                                          double* __restrict jz, JointFrames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const int one = place1[i], two = place2[i];
        const double x = u[two] - u[one], y = u[two + lanes] - u[one + lanes],
                     z = u[two + 2 * lanes] - u[one + 2 * lanes];
        const double j0 = out.axes[0][i] * x + out.axes[3][i] * y + out.axes[6][i] * z;
        const double j1 = out.axes[1][i] * x + out.axes[4][i] * y + out.axes[7][i] * z;
        const double j2 = out.axes[2][i] * x + out.axes[5][i] * y + out.axes[8][i] * z;
        out.step[0][i] = j0 - jx[i];
        out.step[1][i] = j1 - jy[i];
        out.step[2][i] = j2 - jz[i];
        jx[i] = j0;
        jy[i] = j1;
        jz[i] = j2;
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::pullNodal(int n, const double* area, const double* normal,
                                                          const double* shearA, const double* shearB, const double* jx,
                                                          const double* jy, const double* jz, JointFrames& __restrict f,
                                                          double* __restrict onPoints) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = area[i] * normal[i], y = area[i] * shearA[i], z = area[i] * shearB[i];
        onPoints[3 * i] = f.axes[0][i] * x + f.axes[1][i] * y + f.axes[2][i] * z;
        onPoints[3 * i + 1] = f.axes[3][i] * x + f.axes[4][i] * y + f.axes[5][i] * z;
        onPoints[3 * i + 2] = f.axes[6][i] * x + f.axes[7][i] * y + f.axes[8][i] * z;
        f.torque[0][i] += jy[i] * z - jz[i] * y;
        f.torque[1][i] += jz[i] * x - jx[i] * z;
        f.torque[2][i] += jx[i] * y - jy[i] * x;
    }
}

// The jump is measured in axes that turn with the mean rotation of the two blocks. So the joint does work on that
// rotation, too, and each block takes half of the moment. With it the two forces, which act apart by the jump, have no
// resulting moment.
template <>
MASONRY_VECTORISED void JointArithmetic<false>::finishNodal(int n, const JointFrames& f, double* __restrict onJoints) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i)
        for (int d = 0; d < 3; ++d)
            onJoints[9 * i + 3 + d] = onJoints[9 * i + 6 + d] =
                0.5 * (f.axes[3 * d][i] * f.torque[0][i] + f.axes[3 * d + 1][i] * f.torque[1][i] +
                       f.axes[3 * d + 2][i] * f.torque[2][i]);
}

MASONRY_VECTORISED double turnsInPlane(int n, const double* const* q, const double* const* r, double* cosine,
                                       double* sine) {
    const double *a = q[0], *b = q[1], *c = q[2], *d = q[3], *e = r[0], *f = r[1], *g = r[2], *h = r[3];
    // Bits of the largest part that is not about y. Positive numbers are ordered as their bits are. A comparison of
    // bits also finds a NaN, and the compiler can vectorise it.
    std::int64_t out = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        cosine[i] = a[i] * e[i] - b[i] * f[i] - c[i] * g[i] - d[i] * h[i];
        sine[i] = a[i] * g[i] + c[i] * e[i] + d[i] * f[i] - b[i] * h[i];
        const double x = a[i] * f[i] + b[i] * e[i] + c[i] * h[i] - d[i] * g[i];
        const double z = a[i] * h[i] + d[i] * e[i] + b[i] * g[i] - c[i] * f[i];
        const double away = std::abs(x) + std::abs(z);
        std::int64_t bits;
        std::memcpy(&bits, &away, sizeof bits);
        out = bits > out ? bits : out;
    }
    double largest;
    std::memcpy(&largest, &out, sizeof largest);
    return largest;
}

// ---- in the plane -----------------------------------------------------------------------------------------------

namespace {

[[gnu::always_inline]] inline void alignPlane(int n, const int* body1, const int* body2, const double* const* turn,
                                              const double* const* f1, const double* const* f2,
                                              JointFrames& __restrict out) {
    const double *cosine = turn[0], *sine = turn[1], *ac = f1[0], *as = f1[1], *bc = f2[0], *bs = f2[1];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const int one = body1[i], two = body2[i];
        const double c1 = cosine[one] * ac[i] - sine[one] * as[i], s1 = cosine[one] * as[i] + sine[one] * ac[i];
        double c2 = cosine[two] * bc[i] - sine[two] * bs[i], s2 = cosine[two] * bs[i] + sine[two] * bc[i];
        const double same = c1 * c2 + s1 * s2 < 0 ? -1.0 : 1.0;
        c2 *= same;
        s2 *= same;
        double c = c1 + c2, s = s1 + s2;
        const double size = 1 / std::sqrt(c * c + s * s);
        c *= size;
        s *= size;
        out.w[i] = c * c2 + s * s2;
        out.v[2][i] = c * s2 - s * c2;
        out.axes[0][i] = c * c - s * s;
        out.axes[1][i] = 2 * c * s;
    }
}

} // namespace

template <>
MASONRY_VECTORISED void JointArithmetic<true>::alignRigid(int n, const int* body1, const int* body2,
                                                          const double* const* position, const double* const* turn,
                                                          const double* const* f1, const double* const* f2,
                                                          const double* const* span, JointFrames& __restrict out) {
    alignPlane(n, body1, body2, turn, f1, f2, out);
    const double *pz = position[0], *px = position[1], *along = span[0], *aside = span[1];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double z = pz[body2[i]] - pz[body1[i]], x = px[body2[i]] - px[body1[i]];
        const double m = out.axes[0][i], k = out.axes[1][i], w = out.w[i], v = out.v[2][i];
        const double d0 = along[i], d1 = aside[i];
        out.between[0][i] = z;
        out.between[1][i] = x;
        out.common[0][i] = m * z + k * x - (d0 - 2 * v * (w * d1 + v * d0));
        out.common[1][i] = m * x - k * z - (d1 + 2 * v * (w * d0 - v * d1));
        out.force[0][i] = out.force[1][i] = out.torque[2][i] = 0;
    }
}

template <>
MASONRY_VECTORISED void
JointArithmetic<true>::jumpRigid(int n, const double* __restrict a0, const double* __restrict a1, const double*,
                                 double* __restrict j0, double* __restrict j1, double*, JointFrames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double twist = 4 * out.w[i] * out.v[2][i];
        const double n0 = out.common[0][i] - twist * a1[i], n1 = out.common[1][i] + twist * a0[i];
        out.step[0][i] = n0 - j0[i];
        out.step[1][i] = n1 - j1[i];
        j0[i] = n0;
        j1[i] = n1;
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<true>::pullRigid(int n, const double* area, const double* normal,
                                                         const double* shear, const double*, const double* a0,
                                                         const double* a1, JointFrames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = area[i] * normal[i], y = area[i] * shear[i];
        out.force[0][i] += x;
        out.force[1][i] += y;
        out.torque[2][i] += a0[i] * y - a1[i] * x;
    }
}

// The arms are those of jumpRigid: 1 - 2 v² times the offset, plus half of the common part of the jump. Here v stands
// across all offsets. Factor and common part are the same for all subcontacts, so they are applied to the sums.
template <>
MASONRY_VECTORISED void JointArithmetic<true>::finishRigid(int n, const JointFrames& f, double* __restrict onJoints) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double m = f.axes[0][i], k = f.axes[1][i], v = f.v[2][i], f0 = f.force[0][i], f1 = f.force[1][i];
        const double fz = m * f0 - k * f1, fx = m * f1 + k * f0;
        const double t = (1 - 2 * v * v) * f.torque[2][i] + 0.5 * (f.common[0][i] * f1 - f.common[1][i] * f0);
        double* out = onJoints + 4 * i;
        out[0] = fx;
        out[1] = fz;
        out[2] = t;
        out[3] = f.between[0][i] * fx - f.between[1][i] * fz - t;
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<true>::spreadIntact(int n, const IntactFaces& faces,
                                                            JointFrames& __restrict out) {
    const double *m0 = faces.middle[0], *m1 = faces.middle[1];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double twist = 4 * out.w[i] * out.v[2][i];
        out.turn[0][i] = out.turn[1][i] = out.middle[2][i] = 0;
        out.turn[2][i] = twist;
        out.middle[0][i] = out.common[0][i] - twist * m1[i];
        out.middle[1][i] = out.common[1][i] + twist * m0[i];
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<true>::jumpIntact(int n, const IntactFaces& faces, const double* a1,
                                                          const double*, JointFrames& __restrict out) {
    const double* m1 = faces.middle[1];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        out.step[0][i] = out.middle[0][i] - out.turn[2][i] * (a1[i] - m1[i]);
        out.step[1][i] = out.middle[1][i];
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<true>::pullIntact(int n, const IntactFaces& faces,
                                                          JointFrames& __restrict out) {
    const double *m0 = faces.middle[0], *m1 = faces.middle[1], *area = faces.area, *i11 = faces.inertia[0];
    const double kn = faces.normal, ks = faces.shear;
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = kn * area[i] * out.middle[0][i], y = ks * area[i] * out.middle[1][i];
        out.force[0][i] = x;
        out.force[1][i] = y;
        out.torque[2][i] = m0[i] * y - m1[i] * x + kn * out.turn[2][i] * i11[i];
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<true>::alignNodal(int n, const int* body1, const int* body2,
                                                          const double* const* turn, const double* const* f1,
                                                          const double* const* f2, JointFrames& __restrict out) {
    alignPlane(n, body1, body2, turn, f1, f2, out);
    for (int i = 0; i < n; ++i)
        out.torque[2][i] = 0;
}

template <>
MASONRY_VECTORISED void JointArithmetic<true>::jumpNodal(int n, const int* place1, const int* place2, const double* u,
                                                         double* __restrict j0, double* __restrict j1, double*,
                                                         JointFrames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const int one = place1[i], two = place2[i];
        const double x = u[two] - u[one], z = u[two + 2 * lanes] - u[one + 2 * lanes];
        const double m = out.axes[0][i], k = out.axes[1][i], n0 = m * z + k * x, n1 = m * x - k * z;
        out.step[0][i] = n0 - j0[i];
        out.step[1][i] = n1 - j1[i];
        j0[i] = n0;
        j1[i] = n1;
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<true>::pullNodal(int n, const double* area, const double* normal,
                                                         const double* shear, const double*, const double* j0,
                                                         const double* j1, const double*, JointFrames& __restrict f,
                                                         double* __restrict onPoints) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = area[i] * normal[i], y = area[i] * shear[i], m = f.axes[0][i], k = f.axes[1][i];
        onPoints[2 * i] = m * y + k * x;
        onPoints[2 * i + 1] = m * x - k * y;
        f.torque[2][i] += j0[i] * y - j1[i] * x;
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<true>::finishNodal(int n, const JointFrames& f, double* __restrict onJoints) {
    for (int i = 0; i < n; ++i)
        onJoints[4 * i + 2] = onJoints[4 * i + 3] = 0.5 * f.torque[2][i];
}

} // namespace masonry
