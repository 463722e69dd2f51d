// SPDX-License-Identifier: GPL-2.0-or-later
#include "RigidParts.hpp"
#include "common/Vectorised.hpp"
#include <cmath>

namespace masonry {

MASONRY_VECTORISED void placeParts(int n, const double* const* position, const double* const* orientation,
                                   const double* const* velocity, const double* const* local,
                                   const double* const* turned, double* const* arm, double* const* to) {
    const double *px = position[0], *py = position[1], *pz = position[2];
    const double *qw = orientation[0], *qx = orientation[1], *qy = orientation[2], *qz = orientation[3];
    const double *vx = velocity[0], *vy = velocity[1], *vz = velocity[2];
    const double *wx = velocity[3], *wy = velocity[4], *wz = velocity[5];
    const double *lx = local[0], *ly = local[1], *lz = local[2];
    const double *tw = turned[0], *tx = turned[1], *ty = turned[2], *tz = turned[3];
    double *ax = arm[0], *ay = arm[1], *az = arm[2];
    double *ox = to[0], *oy = to[1], *oz = to[2], *ow = to[3], *oa = to[4], *ob = to[5], *oc = to[6];
    double *ux = to[7], *uy = to[8], *uz = to[9], *sx = to[10], *sy = to[11], *sz = to[12];
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const double w = qw[i], x = qx[i], y = qy[i], z = qz[i];
        // The rotated vector is l + w (2q × l) + q × (2q × l).
        const double l0 = lx[i], l1 = ly[i], l2 = lz[i];
        const double t0 = 2 * (y * l2 - z * l1), t1 = 2 * (z * l0 - x * l2), t2 = 2 * (x * l1 - y * l0);
        const double r0 = l0 + w * t0 + (y * t2 - z * t1), r1 = l1 + w * t1 + (z * t0 - x * t2),
                     r2 = l2 + w * t2 + (x * t1 - y * t0);
        const double m0 = 0.5 * (ax[i] + r0), m1 = 0.5 * (ay[i] + r1), m2 = 0.5 * (az[i] + r2);
        ax[i] = r0;
        ay[i] = r1;
        az[i] = r2;
        ox[i] = px[i] + r0;
        oy[i] = py[i] + r1;
        oz[i] = pz[i] + r2;
        const double b = tw[i], c = tx[i], d = ty[i], e = tz[i];
        ow[i] = w * b - x * c - y * d - z * e;
        oa[i] = w * c + x * b + y * e - z * d;
        ob[i] = w * d + y * b + z * c - x * e;
        oc[i] = w * e + z * b + x * d - y * c;
        const double s0 = wx[i], s1 = wy[i], s2 = wz[i];
        ux[i] = vx[i] + (s1 * m2 - s2 * m1);
        uy[i] = vy[i] + (s2 * m0 - s0 * m2);
        uz[i] = vz[i] + (s0 * m1 - s1 * m0);
        sx[i] = s0;
        sy[i] = s1;
        sz[i] = s2;
    }
}

namespace {

MASONRY_INLINED void into(double w, double x, double y, double z, double& a, double& b, double& c) {
    const double t0 = 2 * (z * b - y * c), t1 = 2 * (x * c - z * a), t2 = 2 * (y * a - x * b);
    const double r0 = a + w * t0 + (z * t1 - y * t2), r1 = b + w * t1 + (x * t2 - z * t0),
                 r2 = c + w * t2 + (y * t0 - x * t1);
    a = r0;
    b = r1;
    c = r2;
}

} // namespace

void turnInto(double w, double x, double y, double z, double (&v)[3]) { into(w, x, y, z, v[0], v[1], v[2]); }

MASONRY_VECTORISED void findHalfForces(int n, const HalfForces& of) {
    const double *mass = of.mass, *ix = of.inertia[0], *iy = of.inertia[1], *iz = of.inertia[2];
    const double *wx = of.spin[0], *wy = of.spin[1], *wz = of.spin[2];
    const double *qw = of.orientation[0], *qx = of.orientation[1], *qy = of.orientation[2], *qz = of.orientation[3];
    const double *fx = of.force[0], *fy = of.force[1], *fz = of.force[2], *tx = of.force[3], *ty = of.force[4],
                 *tz = of.force[5];
    const double *free0 = of.free[0], *free1 = of.free[1], *free2 = of.free[2], *free3 = of.free[3],
                 *free4 = of.free[4], *free5 = of.free[5];
    const double *mass1 = of.mass1, *jx = of.inertia1[0], *jy = of.inertia1[1], *jz = of.inertia1[2];
    const double *rx = of.arm1[0], *ry = of.arm1[1], *rz = of.arm1[2];
    const double *gx = of.force1[0], *gy = of.force1[1], *gz = of.force1[2];
    const double *hx = of.torque1[0], *hy = of.torque1[1], *hz = of.torque1[2];
    const double *bw = of.face[0], *bx = of.face[1], *by = of.face[2], *bz = of.face[3];
    const double *mx = of.middle[0], *my = of.middle[1], *mz = of.middle[2];
    double *ox = of.resultForce[0], *oy = of.resultForce[1], *oz = of.resultForce[2];
    double *ux = of.resultMoment[0], *uy = of.resultMoment[1], *uz = of.resultMoment[2];
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const double r0 = rx[i], r1 = ry[i], r2 = rz[i], w0 = wx[i], w1 = wy[i], w2 = wz[i];
        const double a0 = free3[i] * tx[i] / ix[i], a1 = free4[i] * ty[i] / iy[i], a2 = free5[i] * tz[i] / iz[i];
        const double v0 = w1 * r2 - w2 * r1, v1 = w2 * r0 - w0 * r2, v2 = w0 * r1 - w1 * r0;
        const double perMass = 1 / mass[i], m = mass1[i];
        double c0 = free0[i] * (m * (perMass * fx[i] + (a1 * r2 - a2 * r1) + (w1 * v2 - w2 * v1)) - gx[i]);
        double c1 = free1[i] * (m * (perMass * fy[i] + (a2 * r0 - a0 * r2) + (w2 * v0 - w0 * v2)) - gy[i]);
        double c2 = free2[i] * (m * (perMass * fz[i] + (a0 * r1 - a1 * r0) + (w0 * v1 - w1 * v0)) - gz[i]);
        double k0 = free3[i] * (jx[i] * a0 - hx[i]), k1 = free4[i] * (jy[i] * a1 - hy[i]),
               k2 = free5[i] * (jz[i] * a2 - hz[i]);
        const double b = bw[i], c = bx[i], d = by[i], e = bz[i];
        const double w = qw[i] * b - qx[i] * c - qy[i] * d - qz[i] * e;
        const double x = qw[i] * c + qx[i] * b + qy[i] * e - qz[i] * d;
        const double y = qw[i] * d + qy[i] * b + qz[i] * c - qx[i] * e;
        const double z = qw[i] * e + qz[i] * b + qx[i] * d - qy[i] * c;
        into(w, x, y, z, c0, c1, c2);
        into(w, x, y, z, k0, k1, k2);
        ox[i] = c0;
        oy[i] = c1;
        oz[i] = c2;
        ux[i] = k0 - (my[i] * c2 - mz[i] * c1);
        uy[i] = k1 - (mz[i] * c0 - mx[i] * c2);
        uz[i] = k2 - (mx[i] * c1 - my[i] * c0);
    }
}

MASONRY_VECTORISED void compareWithBox(int n, const FaceStresses& of) {
    const double *fx = of.force[0], *fy = of.force[1], *fz = of.force[2];
    const double *mx = of.moment[0], *my = of.moment[1], *mz = of.moment[2];
    const double *perArea = of.perArea, *zz = of.bend[0], *yz = of.bend[1], *yy = of.bend[2], *twist = of.twist;
    const double *reachY = of.reach[0], *reachZ = of.reach[1];
    const double *low = of.box[0], *high = of.box[1], *most = of.box[2];
    unsigned char* outside = of.outside;
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const double alongZ = zz[i] * my[i] - yz[i] * mz[i], alongY = yz[i] * my[i] - yy[i] * mz[i];
        const double mean = perArea[i] * fx[i], bent = reachZ[i] * std::abs(alongZ) + reachY[i] * std::abs(alongY);
        const double turned = std::abs(twist[i] * mx[i]);
        const double a = std::abs(perArea[i] * fy[i]) + turned * reachZ[i],
                     b = std::abs(perArea[i] * fz[i]) + turned * reachY[i];
        const bool inside = (mean + bent <= high[i]) & (mean - bent >= low[i]) & (a * a + b * b <= most[i] * most[i]);
        outside[i] = !inside;
    }
}

} // namespace masonry
