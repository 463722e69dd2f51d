// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointForces.hpp"
#include "common/Parallel.hpp"
#include "engine/units/Zones.hpp"
#include "motion/JointFrames.hpp"
#include <algorithm>

namespace masonry {

namespace {

constexpr int nodesAtOnce = 64; // how many nodes, or rows of them, a thread takes at a time
using HostForces = yade::ForceContainer::Sums;

} // namespace

template <bool plane> void moveDependentPoints(const JointBatches& all, const SceneContents& store) {
    double* rows = all.zones->displacementRows();
    const int count = int(all.betweenNodes.size()), next = plane ? 2 : 1;
    Parallel::instance().overPieces(count, nodesAtOnce, [&](int first, int beyond) {
        for (int n = first; n < beyond; ++n) {
            const auto& point = all.betweenNodes[n];
            const bool two = point.weights[2] == 0;
            for (int d = 0; d < 3; d += next) {
                double* to = rows + point.place + d * lanes;
                const double *a = rows + point.nodes[0] + d * lanes, *b = rows + point.nodes[1] + d * lanes,
                             *c = rows + point.nodes[2] + d * lanes;
                const double u = point.weights[0], v = point.weights[1], w = point.weights[2];
                if (two)
                    for (int lane = 0; lane < lanes; ++lane)
                        to[lane] = u * a[lane] + v * b[lane];
                else
                    for (int lane = 0; lane < lanes; ++lane)
                        to[lane] = u * a[lane] + v * b[lane] + w * c[lane];
            }
        }
    });
    for (const auto& point : all.onBodies) {
        const auto& s = store.bodies.state(point.body);
        const Vector3r moved = s.pos + s.ori * point.local - point.reference;
        for (int d = 0; d < 3; ++d)
            rows[point.place + d * lanes] = moved[d];
    }
}

namespace {

// Sums up for every body the forces and torques of its joints.
template <bool plane> void bringToBodies(const JointBatches& all, const HostForces& sums) {
    const auto& to = all.toBodies;
    Parallel::instance().overPieces(int(to.receivers.size()), bodiesAtOnce, [&](int first, int beyond) {
        for (int r = first; r < beyond; ++r) {
            Vector3r force = Vector3r::Zero(), torque = Vector3r::Zero();
            const auto* item = &to.items[to.start[r]];
            const auto* end = item + (to.start[r + 1] - to.start[r]);
            for (; item != end; ++item) {
                const double* on = &all.onJoints[numbersOfJoint(plane) * item->source];
                const double sign = item->second ? -1 : 1;
                if constexpr (plane) {
                    force[0] += sign * on[0];
                    force[2] += sign * on[1];
                    torque[1] += on[2 + item->second];
                } else
                    for (int d = 0; d < 3; ++d) {
                        force[d] += sign * on[d];
                        torque[d] += on[3 + 3 * item->second + d];
                    }
            }
            const int body = to.receivers[r];
            if (all.momentPlace[body] >= 0) {
                for (int d = 0; d < 3; ++d)
                    (all.zones->momentRows() + all.momentPlace[body])[d * lanes] = torque[d];
            } else {
                sums.forces[body] += force;
                sums.torques[body] += torque;
            }
        }
    });
}

// Sums up for every node the forces of its subcontacts. Those at dependent points go on to their body or nodes.
template <bool plane> void bringToNodes(const JointBatches& all, const SceneContents& store, const HostForces& sums) {
    double* forces = all.zones->forceRows();
    const auto& toNodes = all.toNodes;
    Parallel::instance().overPieces(int(toNodes.receivers.size()), nodesAtOnce, [&](int first, int beyond) {
        for (int r = first; r < beyond; ++r) {
            double sum[3] = {0, 0, 0};
            for (int n = toNodes.start[r]; n < toNodes.start[r + 1]; ++n) {
                const auto& item = toNodes.items[n];
                const double sign = item.second ? -1 : 1;
                const double* on = &all.onPoints[numbersOfPoint(plane) * item.source];
                if constexpr (plane) {
                    sum[0] += sign * on[0];
                    sum[2] += sign * on[1];
                } else
                    for (int d = 0; d < 3; ++d)
                        sum[d] += sign * on[d];
            }
            for (int d = 0; d < 3; ++d)
                (forces + toNodes.receivers[r])[d * lanes] = sum[d];
        }
    });
    const auto& shares = all.shares;
    const int next = plane ? 2 : 1;
    Parallel::instance().overPieces(int(shares.nodes.size()), nodesAtOnce, [&](int first, int beyond) {
        for (int n = first; n < beyond; ++n)
            for (int d = 0; d < 3; d += next) {
                double sum[lanes];
                double* to = forces + shares.nodes[n] + d * lanes;
                std::copy_n(to, lanes, sum);
                for (int i = shares.start[n]; i < shares.start[n + 1]; ++i) {
                    const double* from = forces + shares.points[i] + d * lanes;
                    const double weight = shares.weights[i];
                    for (int lane = 0; lane < lanes; ++lane)
                        sum[lane] += weight * from[lane];
                }
                std::copy_n(sum, lanes, to);
            }
    });
    for (const auto& point : all.onBodies) {
        const double* on = forces + point.place;
        const Vector3r force(on[0], on[lanes], on[2 * lanes]);
        sums.forces[point.body] += force;
        sums.torques[point.body] += (store.bodies.state(point.body).ori * point.local).cross(force);
    }
}

} // namespace

template <bool plane> void gatherForces(const JointBatches& all, const SceneContents& store) {
    const auto sums = store.scene().forces().sums(store.bodies.size());
    bringToBodies<plane>(all, sums);
    if (all.zones) bringToNodes<plane>(all, store, sums);
}

template void moveDependentPoints<true>(const JointBatches&, const SceneContents&);
template void moveDependentPoints<false>(const JointBatches&, const SceneContents&);
template void gatherForces<true>(const JointBatches&, const SceneContents&);
template void gatherForces<false>(const JointBatches&, const SceneContents&);

} // namespace masonry
