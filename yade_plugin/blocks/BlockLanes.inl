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

void move(const NodeMotion& m, LaneUnits& units) {
    const BlockMatrix matrix = units.matrix;
    const double alpha = dampingShare(m.combined) * m.damping;
    const double steady = 0.5 * m.dt * meanOverStep(m.massDamping, m.dt);
    for (int part = 0; part < parts; ++part) {
        Lanes* us = at(units.displacements, part);
        Lanes* vs = at(units.velocities, part);
        Lanes* fs = at(units.forces, part);
        Lanes* lasts = at(units.lastForces, part);
        const Lanes inUse = *at(&units.present, part);
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
        *at(&units.sums.kinetic, part) = kinetic;
        *at(&units.sums.gravityWork, part) = gravityWork;
        *at(&units.sums.damping, part) = damping;
        *at(&units.sums.pending, part) = pending;
        for (int direction = 0; direction < 3; ++direction)
            *at(units.sums.moved + direction, part) = moved[direction];
    }
}

// Sums over the nodes of a block, of which its rigid motion follows. In the plane a vector has two components, those of
// the plane, and a spin has one.
template <bool plane> struct RigidSums {
    static constexpr int directions = plane ? 2 : 3, axes = plane ? 1 : 3;
    Lanes mass;                  // [kg]
    Lanes first[directions];     // sum of m x [kg m]
    Lanes second[plane ? 1 : 6]; // sum of m x·x; in space of m x x^T: xx, yy, zz, yz, zx, xy [kg m²]
    struct Vector {
        Lanes sum[directions]; // of m v [kg m/s]
        Lanes about[axes];     // of x × m v [kg m²/s]
    };
    // Of the velocities, of their changes in half a step, and of the changes of the forces since the last step.
    Vector velocity, half, forceChange;
};

template <bool plane> inline void addCross(const Lanes* x, const Lanes* v, Lanes* out) {
    if constexpr (plane)
        out[0] += x[0] * v[1] - x[1] * v[0];
    else
        for (int k = 0; k < 3; ++k)
            out[k] += x[(k + 1) % 3] * v[(k + 2) % 3] - x[(k + 2) % 3] * v[(k + 1) % 3];
}

// What turns momentum and spin of a block into its rigid motion.
template <bool plane> struct RigidBlock {
    static constexpr int directions = plane ? 2 : 3, axes = plane ? 1 : 3;
    Lanes mass, centre[directions];
    Lanes inverse[plane ? 1 : 9]; // of the inertia about the centre; zero for axes about which nodes cannot turn

    RigidBlock() = default;
    RigidBlock(const RigidSums<plane>& s, const bool* turns) : mass(s.mass) {
        const Lanes zero = {}, one = zero + 1;
        for (int d = 0; d < directions; ++d)
            centre[d] = s.first[d] / mass;
        if constexpr (plane) {
            inverse[0] = turns[0] ? 1 / (s.second[0] - mass * (centre[0] * centre[0] + centre[1] * centre[1])) : zero;
        } else {
            Lanes m[9];
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const Lanes product = s.second[i == j ? i : 6 - i - j] - mass * centre[i] * centre[j];
                    if (!turns[i] || !turns[j])
                        m[3 * i + j] = i == j ? one : zero;
                    else
                        m[3 * i + j] = -product;
                }
            for (int i = 0; i < 3; ++i) {
                const int j = (i + 1) % 3, k = (i + 2) % 3;
                if (turns[i])
                    m[4 * i] =
                        (s.second[j] - mass * centre[j] * centre[j]) + (s.second[k] - mass * centre[k] * centre[k]);
            }
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
                    inverse[3 * i + j] = m[3 * i1 + j1] * m[3 * i2 + j2] - m[3 * i1 + j2] * m[3 * i2 + j1];
                }
            const Lanes determinant = m[0] * inverse[0] + m[1] * inverse[1] + m[2] * inverse[2];
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    inverse[3 * i + j] = turns[i] && turns[j] ? inverse[3 * i + j] / determinant : zero;
        }
    }
    struct Motion {
        Lanes drift[directions]; // of a point of the block at the origin
        Lanes spin[axes];
    };
    Motion motion(const typename RigidSums<plane>::Vector& v) const {
        Motion m;
        Lanes turn[axes] = {}; // of the momenta about the centre
        addCross<plane>(centre, v.sum, turn);
        for (int k = 0; k < axes; ++k)
            turn[k] = v.about[k] - turn[k];
        for (int k = 0; k < axes; ++k) {
            m.spin[k] = inverse[axes * k] * turn[0];
            if constexpr (!plane) m.spin[k] += inverse[axes * k + 1] * turn[1] + inverse[axes * k + 2] * turn[2];
        }
        for (int d = 0; d < directions; ++d)
            m.drift[d] = v.sum[d] / mass - spun(m, centre, d);
        return m;
    }
    // The part in a direction of the velocity that the spin gives a point x.
    static Lanes spun(const Motion& m, const Lanes* x, int d) {
        if constexpr (plane) return d == 0 ? -m.spin[0] * x[1] : m.spin[0] * x[0];
        const int i = (d + 1) % 3, j = (d + 2) % 3;
        return m.spin[i % axes] * x[j % directions] - m.spin[j % axes] * x[i % directions];
    }
    // The part of a direction of a motion at a point x.
    static Lanes at(const Motion& m, const Lanes* x, int d) { return m.drift[d] + spun(m, x, d); }
    // The sum of the products of momenta with the velocities of a motion [J].
    static Lanes product(const typename RigidSums<plane>::Vector& v, const Motion& m) {
        Lanes sum = {};
        for (int d = 0; d < directions; ++d)
            sum += v.sum[d] * m.drift[d];
        for (int k = 0; k < axes; ++k)
            sum += v.about[k] * m.spin[k];
        return sum;
    }
};

// The sum of two vectors of lanes, each with a factor.
template <class Vectors> inline Vectors weighted(Lanes a, const Vectors& one, Lanes b, const Vectors& two) {
    Vectors sum = one;
    Lanes* to = reinterpret_cast<Lanes*>(&sum);
    const Lanes* from = reinterpret_cast<const Lanes*>(&two);
    for (std::size_t i = 0; i < sizeof sum / sizeof(Lanes); ++i)
        to[i] = a * to[i] + b * from[i];
    return sum;
}

// What the loops over the nodes of units with scaled masses need, of one part of their lanes. Each phase of ScaledStep
// has a copy: the compiler then sees that no node's numbers are among these.
template <bool plane> struct ScaledNodes {
    static constexpr int directions = plane ? 2 : 3;
    const NodeMotion m;
    const double scaling;
    LaneUnits* const units;
    const int count, part;
    Lanes* const kept; // three numbers for every node and direction
    const double alpha, share, apart, steady;
    int direction[3];
    bool free[3], turns[3];

    ScaledNodes(const NodeMotion& motion, double scaling, LaneUnits* units, int count, Row* scratch, int part)
        : m(motion),
          scaling(scaling),
          units(units),
          count(count),
          part(part),
          kept(at(scratch, 0)),
          alpha(dampingShare(m.combined) * m.damping),
          share(1 / (1 + scaling)),
          apart(1 / (1 + sharedScaling * scaling)),
          steady(0.5 * m.dt * meanOverStep(m.massDamping, m.dt)) {
        const int across = plane ? units[0].matrix.across : 2;
        for (int d = 0; d < 3; ++d) {
            direction[d] = (across + 1 + d) % 3;
            free[d] = !m.held[direction[d]];
        }
        for (int k = 0; k < 3; ++k)
            turns[k] = plane ? free[0] && free[1] : free[(k + 1) % 3] && free[(k + 2) % 3];
    }
    // Calls `visit(x, node, keep)` for all nodes of a unit with the place of the node and its scratch.
    template <class Visit> MASONRY_INLINED void eachNode(int k, Visit&& visit) const {
        const auto& unit = units[k];
        Lanes* keep = kept + (k ? 3 * directions * units[0].matrix.nodeCount : 0);
        for (int n = 0; n < unit.matrix.nodeCount; ++n, keep += 3 * directions) {
            Lanes x[directions];
            for (int d = 0; d < directions; ++d) {
                const int row = direction[d];
                x[d] = (unit.matrix.nodes[3 * n + row] + *at(unit.offset + row, part)) +
                       (*at(unit.displacements + 3 * n + row, part) - *at(units[0].displacements + row, part));
            }
            visit(x, n, keep);
        }
    }
    MASONRY_INLINED Lanes weightOf(int k, int n, int d) const {
        return units[k].matrix.masses[n] * m.gravity[direction[d]] * *at(&units[k].present, part);
    }
};

// A step of units whose masses are scaled, of one part of their lanes. A motion v has a rigid part P v: W v, that of
// both units together, where they are whole, else H v, that of each for itself. By the scaled masses M* an acceleration
// M^-1 f becomes P* M^-1 f + (1 - P) M^-1 f / (1 + s), with P* = W where units are whole, else (1 - t) W + t H,
// t = 1 / (1 + sharedScaling s).
template <bool plane> class ScaledStep {
public:
    ScaledStep(const ScaledNodes<plane>& nodes, const Row& whole)
        : nodes(nodes), together(*at(&whole, nodes.part)), split(1 - together) {}
    MASONRY_INLINED void predict();
    MASONRY_INLINED void filter();
    MASONRY_INLINED void correct();
    MASONRY_INLINED void sumUp();

private:
    using Sums = RigidSums<plane>;
    using Block = RigidBlock<plane>;
    using Vector = typename Sums::Vector;
    using Motion = typename Block::Motion;
    static constexpr int directions = Sums::directions;

    // The rigid motions of momenta: `ofWhole` W + `ofOwn` H.
    void rigidPart(const Vector* v, Lanes ofWhole, Lanes ofOwn, Motion* motions) const {
        if (nodes.count == 1) {
            motions[0] = own[0].motion(v[0]);
            return;
        }
        const Lanes one = Lanes{} + 1;
        const auto whole = both.motion(weighted(one, v[0], one, v[1]));
        for (int k = 0; k < nodes.count; ++k)
            motions[k] = weighted(ofWhole, whole, ofOwn, own[k].motion(v[k]));
    }
    Lanes scaled(const Lanes& plain, int k, const Vector* a, const Vector* b) const;

    const ScaledNodes<plane> nodes;
    const Lanes together, split;
    const Lanes left = together + split * (1 - nodes.apart);
    Block own[2], both;
    Vector olds[2] = {}, ofRigid[2] = {}, ofRest[2] = {}, means[2] = {}, nows[2] = {}; // momenta
    Motion old[2], half[2], halfScaled[2], forceChange[2], damped[2], rest[2];
    Lanes kinetics[2], befores[2], afters[2], withOld[2], withNow[2];
};

// Predictor: the rigid parts of the velocities, P v, of their changes in half a step without damping, P dt f / 2M and
// P* dt f / 2M, and of the changes of the forces.
template <bool plane> void ScaledStep<plane>::predict() {
    const auto s = nodes;
    const Lanes zero = {}, one = zero + 1;
    Sums sums[2] = {};
    for (int k = 0; k < s.count; ++k) {
        const auto& unit = s.units[k];
        auto& sum = sums[k];
        s.eachNode(
            k, [&](const Lanes* x, int n, Lanes*) __attribute__((always_inline)) {
                const double mass = unit.matrix.masses[n];
                Lanes momentum[directions], impulse[directions], grown[directions];
                for (int d = 0; d < directions; ++d) {
                    const int row = 3 * n + s.direction[d];
                    momentum[d] = s.free[d] ? mass * *at(unit.velocities + row, s.part) : zero;
                    const Lanes force = *at(unit.forces + row, s.part) + s.weightOf(k, n, d);
                    impulse[d] = s.free[d] ? 0.5 * s.m.dt * force : zero;
                    grown[d] = s.free[d] ? force - *at(unit.lastForces + row, s.part) : zero;
                    sum.first[d] += mass * x[d];
                    sum.velocity.sum[d] += momentum[d];
                    sum.half.sum[d] += impulse[d];
                    sum.forceChange.sum[d] += grown[d];
                }
                sum.mass += mass;
                if constexpr (plane)
                    sum.second[0] += mass * (x[0] * x[0] + x[1] * x[1]);
                else
                    for (int i = 0; i < 3; ++i) {
                        sum.second[i] += mass * x[i] * x[i];
                        sum.second[3 + i] += mass * x[(i + 1) % 3] * x[(i + 2) % 3];
                    }
                addCross<plane>(x, momentum, sum.velocity.about);
                addCross<plane>(x, impulse, sum.half.about);
                addCross<plane>(x, grown, sum.forceChange.about);
            });
    }
    Vector halves[2], forceChanges[2];
    for (int k = 0; k < s.count; ++k) {
        own[k] = {sums[k], s.turns};
        olds[k] = sums[k].velocity;
        halves[k] = sums[k].half;
        forceChanges[k] = sums[k].forceChange;
    }
    both = {s.count == 1 ? sums[0] : weighted(one, sums[0], one, sums[1]), s.turns};
    rigidPart(olds, together, split, old);
    rigidPart(halves, together, split, half);
    rigidPart(halves, left, split * s.apart, halfScaled);
    rigidPart(forceChanges, together, split, forceChange);
}

// Filter of modes: damping takes d from the rigid part of a velocity and e from the rest, each for itself as it would
// from a motion without the other. What it takes of the motion is P* d + (e - P e).
template <bool plane> void ScaledStep<plane>::filter() {
    const auto s = nodes;
    const Lanes zero = {};
    for (int k = 0; k < s.count; ++k) {
        const auto& unit = s.units[k];
        const Motion before = old[k], change = half[k], scaledChange = halfScaled[k], ofForces = forceChange[k];
        Vector rigid = {}, others = {};
        s.eachNode(
            k, [&](const Lanes* x, int n, Lanes* keep) __attribute__((always_inline)) {
                const double mass = unit.matrix.masses[n];
                Lanes takenRigid[directions], takenRest[directions];
                for (int d = 0; d < directions; ++d) {
                    takenRigid[d] = takenRest[d] = zero;
                    if (!s.free[d]) continue;
                    const int row = 3 * n + s.direction[d];
                    const Lanes force = *at(unit.forces + row, s.part) + s.weightOf(k, n, d);
                    Lanes* last = at(unit.lastForces + row, s.part);
                    const Lanes grown = Block::at(ofForces, x, d);
                    const Lanes signs[2] = {s.m.combined ? sign(grown) : zero,
                                            s.m.combined ? sign((force - *last) / mass - grown) : zero};
                    *last = force;
                    // Changes of velocity in half a step, and velocities without damping: of the rigid part and the
                    // rest.
                    const Lanes changes[2] = {Block::at(scaledChange, x, d),
                                              s.share * (0.5 * (s.m.dt / mass) * force - Block::at(change, x, d))};
                    const Lanes oldRigid = Block::at(before, x, d);
                    const Lanes undamped[2] = {oldRigid + changes[0],
                                               *at(unit.velocities + row, s.part) - oldRigid + changes[1]};
                    const auto taken = [&](int i) {
                        const Lanes reach = s.alpha * (changes[i] < zero ? -changes[i] : changes[i]);
                        return dampingTaken(Lanes(0.5 * undamped[i]), reach, signs[i]);
                    };
                    const Lanes first = taken(0), second = taken(1);
                    keep[3 * d] = undamped[0] + undamped[1];
                    keep[3 * d + 1] = second;
                    takenRigid[d] = mass * first;
                    takenRest[d] = mass * second;
                    rigid.sum[d] += takenRigid[d];
                    others.sum[d] += takenRest[d];
                }
                addCross<plane>(x, takenRigid, rigid.about);
                addCross<plane>(x, takenRest, others.about);
            });
        ofRigid[k] = rigid;
        ofRest[k] = others;
    }
    rigidPart(ofRigid, left, split * s.apart, damped);
    rigidPart(ofRest, together, split, rest);
}

// Corrector: with the mean velocity of the step without viscous damping, w = v + dt a* / 2 - P* d - (e - P e), the
// velocity after it is v' = 2 (1 - steady) w - v, and the displacement u' = u + dt v'.
template <bool plane> void ScaledStep<plane>::correct() {
    const auto s = nodes;
    const Lanes zero = {};
    for (int k = 0; k < s.count; ++k) {
        auto& unit = s.units[k];
        const Motion ofDamped = damped[k], ofOthers = rest[k];
        Vector mean = {}, now = {};
        Lanes kinetic = zero, gravityWork = zero, damping = zero, pending = zero, before = zero, after = zero;
        Lanes moved[3] = {zero, zero, zero};
        s.eachNode(
            k, [&](const Lanes* x, int n, Lanes* keep) __attribute__((always_inline)) {
                const double mass = unit.matrix.masses[n];
                Lanes momentum[directions], afterwards[directions];
                for (int d = 0; d < directions; ++d) {
                    momentum[d] = afterwards[d] = zero;
                    const int row = 3 * n + s.direction[d];
                    *at(unit.forces + row, s.part) = zero;
                    if (!s.free[d]) continue;
                    const Lanes previous = *at(unit.velocities + row, s.part);
                    const Lanes taken = keep[3 * d + 1];
                    const Lanes middle = keep[3 * d] - Block::at(ofDamped, x, d) - (taken - Block::at(ofOthers, x, d));
                    const Lanes next = 2 * (middle - s.steady * middle) - previous;
                    gravityWork += s.weightOf(k, n, d) * *at(unit.displacements + row, s.part);
                    damping += mass * taken * previous;
                    pending += mass * taken * next;
                    before += mass * middle * previous;
                    after += mass * middle * next;
                    kinetic += mass * previous * next;
                    keep[3 * d] = next;
                    momentum[d] = mass * middle;
                    afterwards[d] = mass * next;
                    mean.sum[d] += momentum[d];
                    now.sum[d] += afterwards[d];
                }
                addCross<plane>(x, momentum, mean.about);
                addCross<plane>(x, afterwards, now.about);
            });
        means[k] = mean;
        nows[k] = now;
        kinetics[k] = kinetic;
        befores[k] = before;
        afters[k] = after;
        withOld[k] = damping;
        withNow[k] = pending;
        *at(&unit.sums.gravityWork, s.part) = gravityWork;
        const Lanes* keep = s.kept + (k ? 3 * directions * s.units[0].matrix.nodeCount : 0);
        for (int n = 0; n < unit.matrix.nodeCount; ++n, keep += 3 * directions)
            for (int d = 0; d < directions; ++d) {
                if (!s.free[d]) continue;
                const int row = 3 * n + s.direction[d];
                Lanes& u = *at(unit.displacements + row, s.part);
                *at(unit.velocities + row, s.part) = keep[3 * d];
                // places of the next unit count from the first node, which must not have moved yet
                if (k > 0 || n > 0) u += s.m.dt * keep[3 * d];
                moved[s.direction[d]] += unit.matrix.masses[n] * (k > 0 || n > 0 ? u : u + s.m.dt * keep[3 * d]);
            }
        for (int d = 0; d < 3; ++d)
            *at(unit.sums.moved + d, s.part) = moved[d];
    }
    for (int d = 0; d < directions; ++d)
        if (s.free[d])
            *at(s.units[0].displacements + s.direction[d], s.part) +=
                s.m.dt * *at(s.units[0].velocities + s.direction[d], s.part);
}

// The product of velocities a and b with the scaled masses: (1 + s) a M b - (s - t) a M H b - t a M W b, with the
// factor 1 + t on the motion of the two units of a block against each other. That of W stands with the first unit.
template <bool plane>
Lanes ScaledStep<plane>::scaled(const Lanes& plain, int k, const Vector* a, const Vector* b) const {
    const Lanes one = Lanes{} + 1, against = together * nodes.scaling + split * (nodes.scaling * sharedScaling);
    if (nodes.count == 1)
        return (1 + nodes.scaling) * plain - nodes.scaling * Block::product(a[0], own[0].motion(b[0]));
    const Lanes sum =
        (1 + nodes.scaling) * plain - (nodes.scaling - against) * Block::product(a[k], own[k].motion(b[k]));
    if (k > 0) return sum;
    return sum - against * Block::product(weighted(one, a[0], one, a[1]), both.motion(weighted(one, b[0], one, b[1])));
}

// Energies. What damping takes has the true masses in the rigid part, and 1 + s times these in the rest.
template <bool plane> void ScaledStep<plane>::sumUp() {
    Motion now[2];
    rigidPart(nows, together, split, now);
    for (int k = 0; k < nodes.count; ++k) {
        auto& result = nodes.units[k].sums;
        *at(&result.kinetic, nodes.part) = 0.5 * scaled(kinetics[k], k, olds, nows);
        *at(&result.damping, nodes.part) =
            Block::product(ofRigid[k], old[k]) + (1 + nodes.scaling) * (withOld[k] - Block::product(ofRest[k], old[k]));
        *at(&result.pending, nodes.part) =
            Block::product(ofRigid[k], now[k]) + (1 + nodes.scaling) * (withNow[k] - Block::product(ofRest[k], now[k]));
        if (nodes.steady == 0) continue;
        *at(&result.damping, nodes.part) += nodes.steady * scaled(befores[k], k, olds, means);
        *at(&result.pending, nodes.part) += nodes.steady * scaled(afters[k], k, nows, means);
    }
}

template <bool plane>
void moveIn(const NodeMotion& m, double scaling, LaneUnits* units, int count, const Row& whole, Row* scratch) {
    for (int part = 0; part < parts; ++part) {
        ScaledStep<plane> step(ScaledNodes<plane>(m, scaling, units, count, scratch, part), whole);
        step.predict();
        step.filter();
        step.correct();
        step.sumUp();
    }
}

void moveScaledUnits(const NodeMotion& m, double scaling, LaneUnits* units, int count, const Row& whole, Row* scratch) {
    (units[0].matrix.across >= 0 ? moveIn<true> : moveIn<false>)(m, scaling, units, count, whole, scratch);
}
