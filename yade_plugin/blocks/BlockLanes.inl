// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of BlockLanes.hpp for vectors of WIDTH numbers. A row is handled in several parts of that width.

typedef double Lanes __attribute__((vector_size(8 * WIDTH), may_alias));
constexpr int parts = lanes / WIDTH; // vectors in a row

// A part of the first of some rows; the same part of the next row lies `parts` vectors further on.
inline const Lanes* at(const Row* rows, int part) { return reinterpret_cast<const Lanes*>(rows->lane + part * WIDTH); }
inline Lanes* at(Row* rows, int part) { return reinterpret_cast<Lanes*>(rows->lane + part * WIDTH); }

inline Lanes sign(Lanes x) {
    const Lanes zero = {}, one = zero + 1;
    return (x > zero ? one : zero) - (x < zero ? one : zero);
}

// Replaces F by the rotation in its polar decomposition, by Newton's iteration F <- (F + F^-T) / 2. At elastic strains
// three steps reach round-off.
inline void polar(Lanes (&f)[9]) {
    for (int iteration = 0; iteration < 3; ++iteration) {
        Lanes c[9]; // the cofactors of F, which are det F times F^-T
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
                const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
                c[3 * i + j] = f[3 * i1 + j1] * f[3 * i2 + j2] - f[3 * i1 + j2] * f[3 * i2 + j1];
            }
        const Lanes half = 0.5 / (f[0] * c[0] + f[1] * c[1] + f[2] * c[2]);
        for (int i = 0; i < 9; ++i)
            f[i] = 0.5 * f[i] + half * c[i];
    }
}

// In memory, where the compiler sees a loop for the vector units.
inline Lanes rootOf(Lanes x) {
    alignas(64) double y[WIDTH];
    for (int i = 0; i < WIDTH; ++i)
        y[i] = x[i];
    for (int i = 0; i < WIDTH; ++i)
        y[i] = __builtin_sqrt(y[i]);
    Lanes z;
    for (int i = 0; i < WIDTH; ++i)
        z[i] = y[i];
    return z;
}

// As addForces, of plane units. `a` and `b` are the directions of the plane.
void addForcesInPlane(const BlockMatrix& m, const Row* displacements, const Row* moments, Row* forces, Row* rotation,
                      Row* energy, Row* scratch) {
    const int count = m.nodeCount, across = m.across, a = (across + 1) % 3, b = (across + 2) % 3;
    for (int part = 0; part < parts; ++part) {
        const Lanes* ua = at(displacements + a, part);
        const Lanes* ub = at(displacements + b, part);
        Lanes* fa = at(forces + a, part);
        Lanes* fb = at(forces + b, part);
        Lanes* d = at(scratch, 0); // displacements relative to the turned block, in axes that turn with it, two a node
        const Lanes zero = {}, one = zero + 1;
        // The rotation in the polar decomposition of a plane gradient is that of (Faa + Fbb, Fba - Fab).
        Lanes along = zero + 2, aside = zero;
        for (int n = 0; n < count; ++n) {
            const Lanes x = ua[3 * n * parts], y = ub[3 * n * parts];
            const double ga = m.gradients[3 * n + a], gb = m.gradients[3 * n + b];
            along += x * ga + y * gb;
            aside += y * ga - x * gb;
        }
        const Lanes size = 1 / rootOf(along * along + aside * aside);
        const Lanes c = along * size, s = aside * size; // cosine and sine of the rotation about the direction across
        // The first node serves as origin, because a translation of the block causes no forces.
        const double oa = m.nodes[a], ob = m.nodes[b];
        for (int n = 0; n < count; ++n) {
            const double pa = m.nodes[3 * n + a] - oa, pb = m.nodes[3 * n + b] - ob;
            const Lanes x = pa + (ua[3 * n * parts] - ua[0]), y = pb + (ub[3 * n * parts] - ub[0]);
            d[2 * n] = c * x + s * y - pa;
            d[2 * n + 1] = c * y - s * x - pb;
        }
        // A moment does the same work as nodal forces, see addForces.
        const Lanes half = 0.5 * *at(moments + across, part);
        const Lanes mc = half * c, ms = half * s;
        Lanes stored = zero;
        for (int n = 0; n < count; ++n) {
            Lanes x = zero, y = zero;
            for (int e = m.pairStart[n]; e < m.pairStart[n + 1]; ++e) {
                const double* k = m.pairValues + 4 * e;
                const Lanes p = d[2 * m.pairNode[e]], q = d[2 * m.pairNode[e] + 1];
                x += k[0] * p + k[1] * q;
                y += k[2] * p + k[3] * q;
            }
            stored += x * d[2 * n] + y * d[2 * n + 1];
            const double ga = m.gradients[3 * n + a], gb = m.gradients[3 * n + b];
            fa[3 * n * parts] -= (ms * ga + mc * gb) + (c * x - s * y);
            fb[3 * n * parts] += (mc * ga - ms * gb) - (s * x + c * y);
        }
        for (int i = 0; i < 9; ++i)
            *at(rotation + i, part) = i % 4 == 0 ? one : zero;
        *at(rotation + 4 * a, part) = *at(rotation + 4 * b, part) = c;
        *at(rotation + 3 * a + b, part) = -s;
        *at(rotation + 3 * b + a, part) = s;
        *at(energy, part) = 0.5 * stored;
    }
}

void addForces(const BlockMatrix& m, const Row* displacements, const Row* moments, Row* forces, Row* rotation,
               Row* energy, Row* scratch) {
    if (m.across >= 0) return addForcesInPlane(m, displacements, moments, forces, rotation, energy, scratch);
    const int count = m.nodeCount;
    for (int part = 0; part < parts; ++part) {
        const Lanes* u = at(displacements, part);
        Lanes* f = at(forces, part);
        Lanes* d = at(scratch, 0);    // displacements relative to the turned block, in axes that turn with it
        Lanes* local = d + 3 * count; // elastic forces in these axes
        const Lanes zero = {}, one = zero + 1;
        Lanes r[9] = {one, zero, zero, zero, one, zero, zero, zero, one}; // mean deformation gradient
        for (int n = 0; n < count; ++n)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    r[3 * i + j] += u[(3 * n + i) * parts] * m.gradients[3 * n + j];
        polar(r);

        // The first node serves as origin, because a translation of the block causes no forces.
        const double* origin = m.nodes;
        for (int n = 0; n < count; ++n) {
            const double* node = m.nodes + 3 * n;
            Lanes now[3];
            for (int i = 0; i < 3; ++i)
                now[i] = (node[i] - origin[i]) + (u[(3 * n + i) * parts] - u[i * parts]);
            for (int i = 0; i < 3; ++i) {
                d[3 * n + i] = r[i] * now[0] + r[3 + i] * now[1] + r[6 + i] * now[2] - (node[i] - origin[i]);
                local[3 * n + i] = zero;
            }
        }
        Lanes stored = zero;
        for (int row = 0; row < m.rowCount; ++row) {
            const auto& entries = m.rows[row];
            Lanes sum = zero;
            for (int e = entries.first; e < entries.beyond; ++e)
                sum += m.values[e] * d[m.columns[e]];
            stored += sum * d[entries.degree];
            local[entries.degree] = sum;
        }
        // Displacements du of the nodes turn the block by the sum of (R g) x du / 2 over the nodes, with R the rotation
        // and g the mean gradients. So a moment M does the same work as nodal forces M x (R g) / 2.
        const Lanes moment[3] = {*at(moments, part), *at(moments + 1, part), *at(moments + 2, part)};
        for (int n = 0; n < count; ++n) {
            const double* g = m.gradients + 3 * n;
            Lanes turned[3];
            for (int i = 0; i < 3; ++i)
                turned[i] = 0.5 * (r[3 * i] * g[0] + r[3 * i + 1] * g[1] + r[3 * i + 2] * g[2]);
            for (int i = 0; i < 3; ++i) {
                const int j = (i + 1) % 3, k = (i + 2) % 3;
                f[(3 * n + i) * parts] +=
                    moment[j] * turned[k] - moment[k] * turned[j] -
                    (r[3 * i] * local[3 * n] + r[3 * i + 1] * local[3 * n + 1] + r[3 * i + 2] * local[3 * n + 2]);
            }
        }
        for (int i = 0; i < 9; ++i)
            *at(rotation + i, part) = r[i];
        *at(energy, part) = 0.5 * stored;
    }
}

void move(const BlockMatrix& matrix, const NodeMotion& m, const Row& present, Row* displacements, Row* velocities,
          Row* forces, Row* lastForces, NodeSums& sums) {
    const double alpha = dampingShare(m.combined) * m.damping;
    const double steady = 0.5 * m.dt * meanOverStep(m.massDamping, m.dt);
    for (int part = 0; part < parts; ++part) {
        Lanes* us = at(displacements, part);
        Lanes* vs = at(velocities, part);
        Lanes* fs = at(forces, part);
        Lanes* lasts = at(lastForces, part);
        const Lanes inUse = *at(&present, part);
        const Lanes zero = {};
        Lanes kinetic = zero, gravityWork = zero, damping = zero, pending = zero;
        Lanes moved[3] = {zero, zero, zero};
        for (int n = 0; n < matrix.nodeCount; ++n) {
            const double mass = matrix.masses[n];
            const double perMass = m.dt / mass;
            for (int direction = 0; direction < 3; ++direction) {
                if (direction == matrix.across) continue;
                const int i = (3 * n + direction) * parts;
                const Lanes weight = mass * m.gravity[direction] * inUse;
                const Lanes force = fs[i] + weight;
                const Lanes old = vs[i];
                fs[i] = zero;
                if (m.held[direction]) continue;
                gravityWork += weight * us[i];
                // `half` is the change of velocity in half a step without damping.
                const Lanes half = 0.5 * perMass * force;
                const Lanes middle = 0.5 * (old + half);
                const Lanes reach = alpha * (half < zero ? -half : half);
                const Lanes change = m.combined ? sign(force - lasts[i]) : zero;
                const Lanes opposed = dampingTaken(middle, reach, change);
                const Lanes taken = opposed + steady * (old + half - opposed);
                lasts[i] = force;
                const Lanes now = old + 2 * (half - taken); // paper eq. (2)
                // Work by the trapezoidal rule, and kinetic energy at the time of the forces.
                damping += mass * taken * old;
                pending += mass * taken * now;
                kinetic += 0.5 * mass * old * now;
                vs[i] = now;
                us[i] += m.dt * now; // paper eq. (1)
                moved[direction] += mass * us[i];
            }
        }
        *at(&sums.kinetic, part) = kinetic;
        *at(&sums.gravityWork, part) = gravityWork;
        *at(&sums.damping, part) = damping;
        *at(&sums.pending, part) = pending;
        for (int direction = 0; direction < 3; ++direction)
            *at(sums.moved + direction, part) = moved[direction];
    }
}
