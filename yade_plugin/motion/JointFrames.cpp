// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointFrames.hpp"
#include "common/PlainVector.hpp"
#include <cmath>
#include <cstdint>
#include <cstring>

namespace masonry {

namespace {

// Finds the joint's frame and the rotation `half` from it to side 2.
MASONRY_INLINED void align(int n, const int* body1, const int* body2, const double* const* q, const double* const* f1,
                           const double* const* f2, JointFrames& __restrict out) {
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        // The joint's axes as bodies 1 and 2 have carried them along.
        const PlainQuaternion one = quaternionAt(q, body1[i]) * quaternionAt(f1, i);
        PlainQuaternion two = quaternionAt(q, body2[i]) * quaternionAt(f2, i);
        // A quaternion and its negative are the same rotation; take the one that is nearer.
        two = (dot(one, two) < 0 ? -1.0 : 1.0) * two;
        PlainQuaternion mean{one.w + two.w, one.v + two.v};
        mean = 1 / std::sqrt(dot(mean, mean)) * mean;
        out.w[i] = dot(mean, two);
        put(out.v, i, mean.w * two.v - two.w * mean.v - cross(mean.v, two.v));
        const double w = mean.w, x = mean.v.x, y = mean.v.y, z = mean.v.z;
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

// A vector of the global axes in a joint's frame, and the other way.
MASONRY_INLINED PlainVector inFrame(const JointFrames& f, int i, const PlainVector& v) {
    return {f.axes[0][i] * v.x + f.axes[3][i] * v.y + f.axes[6][i] * v.z,
            f.axes[1][i] * v.x + f.axes[4][i] * v.y + f.axes[7][i] * v.z,
            f.axes[2][i] * v.x + f.axes[5][i] * v.y + f.axes[8][i] * v.z};
}
MASONRY_INLINED PlainVector ofFrame(const JointFrames& f, int i, const PlainVector& v) {
    return {f.axes[0][i] * v.x + f.axes[1][i] * v.y + f.axes[2][i] * v.z,
            f.axes[3][i] * v.x + f.axes[4][i] * v.y + f.axes[5][i] * v.z,
            f.axes[6][i] * v.x + f.axes[7][i] * v.y + f.axes[8][i] * v.z};
}

// The arm half^T a + jump / 2 of a force at the offset a, as forces act at the middle of the jump.
MASONRY_INLINED PlainVector armOf(const PlainVector& v, const PlainVector& a, const PlainVector& common) {
    const double shrink = 1 - 2 * dot(v, v), along = 2 * dot(v, a);
    return shrink * a + along * v + 0.5 * common;
}

} // namespace

template <>
MASONRY_VECTORISED void JointArithmetic<false>::alignRigid(int n, const int* body1, const int* body2,
                                                           const double* const* position, const double* const* q,
                                                           const double* const* f1, const double* const* f2,
                                                           const double* const* span, JointFrames& __restrict out) {
    align(n, body1, body2, q, f1, f2, out);
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainVector between = vectorAt(position, body2[i]) - vectorAt(position, body1[i]);
        put(out.between, i, between);
        const PlainQuaternion half{out.w[i], vectorAt(out.v, i)};
        put(out.common, i, inFrame(out, i, between) - half.turn(vectorAt(span, i)));
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
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainVector v = vectorAt(out.v, i), a{ax[i], ay[i], az[i]}, common = vectorAt(out.common, i);
        const PlainVector jump = common + 4 * out.w[i] * cross(v, a);
        put(out.step, i, jump - PlainVector{jx[i], jy[i], jz[i]});
        jx[i] = jump.x;
        jy[i] = jump.y;
        jz[i] = jump.z;
        put(out.arm, i, armOf(v, a, common));
    }
}

// Multiplies stress by area. Tension is positive, so a joint in tension pulls body 1 along the normal.
template <>
MASONRY_VECTORISED void JointArithmetic<false>::pullRigid(int n, const double* area, const double* normal,
                                                          const double* shearA, const double* shearB, const double*,
                                                          const double*, JointFrames& __restrict out) {
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainVector force = area[i] * PlainVector{normal[i], shearA[i], shearB[i]};
        put(out.force, i, vectorAt(out.force, i) + force);
        put(out.torque, i, vectorAt(out.torque, i) + cross(vectorAt(out.arm, i), force));
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::finishRigid(int n, const JointFrames& f, double* __restrict onJoints) {
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainVector force = ofFrame(f, i, vectorAt(f.force, i)), torque = ofFrame(f, i, vectorAt(f.torque, i));
        const PlainVector other = cross(vectorAt(f.between, i), force) - torque; // whose arms are shorter by `between`
        double* out = onJoints + 9 * i;
        store(out, force);
        store(out + 3, torque);
        store(out + 6, other);
    }
}

// ---- intact joints ----------------------------------------------------------------------------------------------

template <>
MASONRY_VECTORISED void JointArithmetic<false>::spreadIntact(int n, const IntactFaces& faces,
                                                             JointFrames& __restrict out) {
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainVector turn = 4 * out.w[i] * vectorAt(out.v, i);
        put(out.turn, i, turn);
        put(out.middle, i, vectorAt(out.common, i) + cross(turn, vectorAt(faces.middle, i)));
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::jumpIntact(int n, const IntactFaces& faces, const double* a1,
                                                           const double* a2, JointFrames& __restrict out) {
    const double *m1 = faces.middle[1], *m2 = faces.middle[2];
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i)
        out.step[0][i] = out.middle[0][i] + (out.turn[1][i] * (a2[i] - m2[i]) - out.turn[2][i] * (a1[i] - m1[i]));
}

namespace {

// Integral over a face of a product of two fields, each component times its stiffness [J].
MASONRY_INLINED double productOver(const IntactFaces& faces, int i, const double* a, const double* b) {
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
    const double *area = faces.area, *i11 = faces.inertia[0], *i22 = faces.inertia[1], *i12 = faces.inertia[2];
    const double kn = faces.normal, ks = faces.shear;
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainVector force{kn * area[i] * out.middle[0][i], ks * area[i] * out.middle[1][i],
                                ks * area[i] * out.middle[2][i]};
        const double t0 = out.turn[0][i], t1 = out.turn[1][i], t2 = out.turn[2][i];
        const PlainVector v = vectorAt(out.v, i);
        const PlainVector arm = armOf(v, vectorAt(faces.middle, i), vectorAt(out.common, i));
        // integrals of b × stress, and of (v · b) stress
        const PlainVector moment{ks * t0 * (i11[i] + i22[i]), kn * (t1 * i22[i] - t2 * i12[i]),
                                 kn * (t2 * i11[i] - t1 * i12[i])};
        const PlainVector mixed{v.z * moment.y - v.y * moment.z, -ks * t0 * (v.y * i12[i] + v.z * i22[i]),
                                ks * t0 * (v.y * i11[i] + v.z * i12[i])};
        put(out.force, i, force);
        put(out.torque, i, cross(arm, force) + (1 - 2 * dot(v, v)) * moment + 2 * cross(v, mixed));
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::jumpNodal(int n, const int* place1, const int* place2, const double* u,
                                                          double* __restrict jx, double* __restrict jy,
                                                          double* __restrict jz, JointFrames& __restrict out) {
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const int one = place1[i], two = place2[i];
        const PlainVector jump = inFrame(
            out, i, {u[two] - u[one], u[two + lanes] - u[one + lanes], u[two + 2 * lanes] - u[one + 2 * lanes]});
        put(out.step, i, jump - PlainVector{jx[i], jy[i], jz[i]});
        jx[i] = jump.x;
        jy[i] = jump.y;
        jz[i] = jump.z;
    }
}

template <>
MASONRY_VECTORISED void JointArithmetic<false>::pullNodal(int n, const double* area, const double* normal,
                                                          const double* shearA, const double* shearB, const double* jx,
                                                          const double* jy, const double* jz, JointFrames& __restrict f,
                                                          double* __restrict onPoints) {
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainVector force = area[i] * PlainVector{normal[i], shearA[i], shearB[i]};
        const PlainVector turned = ofFrame(f, i, force);
        store(onPoints + 3 * i, turned);
        put(f.torque, i, vectorAt(f.torque, i) + cross({jx[i], jy[i], jz[i]}, force));
    }
}

// The jump is measured in axes that turn with the mean rotation of the two blocks. So the joint does work on that
// rotation, too, and each block takes half of the moment. With it the two forces, which act apart by the jump, have no
// resulting moment.
template <>
MASONRY_VECTORISED void JointArithmetic<false>::finishNodal(int n, const JointFrames& f, double* __restrict onJoints) {
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i)
        for (int d = 0; d < 3; ++d)
            onJoints[9 * i + 3 + d] = onJoints[9 * i + 6 + d] =
                0.5 * (f.axes[3 * d][i] * f.torque[0][i] + f.axes[3 * d + 1][i] * f.torque[1][i] +
                       f.axes[3 * d + 2][i] * f.torque[2][i]);
}

MASONRY_VECTORISED double turnsInPlane(int n, const double* const* q, const double* const* r, double* cosine,
                                       double* sine) {
    // Bits of the largest part that is not about y. Positive numbers are ordered as their bits are. A comparison of
    // bits also finds a NaN, and the compiler can vectorise it.
    std::int64_t out = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainQuaternion turn = quaternionAt(q, i) * quaternionAt(r, i);
        cosine[i] = turn.w;
        sine[i] = turn.v.y;
        const double away = std::abs(turn.v.x) + std::abs(turn.v.z);
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

MASONRY_INLINED void alignPlane(int n, const int* body1, const int* body2, const double* const* turn,
                                const double* const* f1, const double* const* f2, JointFrames& __restrict out) {
    const double *cosine = turn[0], *sine = turn[1], *ac = f1[0], *as = f1[1], *bc = f2[0], *bs = f2[1];
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
    MASONRY_INDEPENDENT
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
