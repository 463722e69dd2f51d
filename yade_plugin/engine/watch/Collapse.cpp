// SPDX-License-Identifier: GPL-2.0-or-later
#include "Collapse.hpp"
#include "common/Text.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/store/SceneStore.hpp"
#include <cmath>
#include <cstdio>

namespace masonry {

using yade::Quaternionr;
using yade::State;

namespace {

// Largest distance of two corners [m].
double diameter(const std::vector<Vector3r>& corners) {
    double most = 0;
    for (const auto& a : corners)
        for (const auto& b : corners)
            most = std::max(most, (a - b).squaredNorm());
    return std::sqrt(most);
}

std::string degrees(double angle) { return text(std::round(angle * 1800 / M_PI) / 10) + "°"; }
std::string metres(double length) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.3g m", length);
    return buffer;
}

// How far a body has come from its reference place: its way, and that of a point `size` off its centre [m].
double moved(const State& s, double size) { return (s.pos - s.refPos).norm() + size * s.ori.angularDistance(s.refOri); }

// What depends on the reference state of a scene's joints.
struct Sizes {
    struct Joint {
        int body1, body2;
        Quaternionr back;     // rotation from block 2 to block 1 in the reference state
        double along, across; // extents of the polygon along the joint's two tangents [m]
        double depth;         // smaller extent of the two blocks along the normal [m]
        double size;          // largest extent of the smaller block [m]
    };
    long revision = -1;        // of the store, for which they were found
    std::vector<Joint> joints; // of SceneStore::kinds, one kind after the other

    void measure(const yade::Scene&, const std::vector<JointKind>&);
};

void Sizes::measure(const yade::Scene& scene, const std::vector<JointKind>& kinds) {
    joints.clear();
    const auto& bodies = scene.bodies->body;
    std::vector<double> sizes(bodies.size(), 0);
    const auto cornersOf = [&](int body) -> const std::vector<Vector3r>* {
        const auto* corners = masonry::cornersOf(bodies[body]->shape.get());
        return corners && !corners->empty() ? corners : nullptr;
    };
    for (const auto& kind : kinds)
        for (const auto& r : kind.shapes->joints) {
            Joint joint{r.sides[0].body,
                        r.sides[1].body,
                        r.sides[1].orientation.conjugate() * r.sides[0].orientation,
                        extent(r.polygon(), r.tangent),
                        extent(r.polygon(), r.normal.cross(r.tangent)),
                        HUGE_VAL,
                        HUGE_VAL};
            for (const auto& side : r.sides)
                if (const auto* corners = cornersOf(side.body)) {
                    auto& size = sizes[side.body];
                    if (size == 0) size = diameter(*corners);
                    joint.depth = std::min(joint.depth, extent(*corners, side.orientation.conjugate() * r.normal));
                    joint.size = std::min(joint.size, size);
                }
            joints.push_back(joint);
        }
}

} // namespace

std::optional<RunEnded> Collapse::ended() const {
    if (block < 0) return std::nullopt;
    return RunEnded("collapsed", "collapsed: " + what, block);
}

Collapse findCollapse(SceneStore& store, const CollapseLimits& limits) {
    auto& columns = store.bodies;
    const auto& scene = store.scene();
    const auto& kinds = store.kinds;
    for (int b = 0; (!store.loop || !store.integrator) && b < columns.size(); ++b)
        if (columns.has(b)) columns.detectMove(b); // the host has moved it
    auto& sizes = store.kept<Sizes>();
    if (sizes.revision != store.revision()) sizes.measure(scene, kinds);
    sizes.revision = store.revision();
    double farthest = 1;
    enum { None, Turn, Slide, Closure, Opening } how = None;
    std::size_t where = 0;
    double size = 0, of = 0; // what was found, and the size it is compared with
    // |w| of the relative rotation falls from 1 as it grows
    const double upright = std::cos(0.5 * std::min(limits.turnLimit, M_PI));
    std::size_t n = 0; // number of the joint
    const auto note = [&](double share, auto kind, double found, double bound) {
        if (!(share > farthest)) return;
        farthest = share;
        how = kind;
        where = n;
        size = found;
        of = bound;
    };
    const double* const q[4] = {columns.orientation[0].data(), columns.orientation[1].data(),
                                columns.orientation[2].data(), columns.orientation[3].data()};
    for (const auto& kind : kinds) {
        auto& shapes = *kind.shapes;
        shapes.synchronise();
        const double each = 1.0 / shapes.points;
        for (int j = 0; j < int(shapes.joints.size()); ++j, ++n) {
            if (shapes.converted[j]) continue;
            const auto& joint = sizes.joints[n];
            const Quaternionr one(q[0][joint.body1], q[1][joint.body1], q[2][joint.body1], q[3][joint.body1]);
            const Quaternionr two(q[0][joint.body2], q[1][joint.body2], q[2][joint.body2], q[3][joint.body2]);
            const double w = std::abs((one.conjugate() * two * joint.back).w());
            if (w < upright) {
                const double angle = 2 * std::acos(std::min(w, 1.0));
                note(angle / limits.turnLimit, Turn, angle, limits.turnLimit);
            }
            double least = HUGE_VAL, along = 0, across = 0;
            for (int p = 0; p < shapes.points; ++p) {
                const std::size_t i = shapes.at(p, j);
                least = std::min(least, shapes.jump[0][i]);
                along += shapes.jump[1][i];
                across += shapes.jump[2][i];
            }
            if (!std::isfinite(least + along + across)) continue; // other checks tell that
            const double slides[] = {std::abs(along) * each, std::abs(across) * each};
            const double extents[] = {joint.along, joint.across};
            for (int d = 0; d < 2; ++d)
                if (slides[d] > limits.slideLimit * extents[d])
                    note(slides[d] / (limits.slideLimit * extents[d]), Slide, slides[d], extents[d]);
            if (-least > limits.closureLimit * joint.depth)
                note(-least / (limits.closureLimit * joint.depth), Closure, -least, joint.depth);
            if (least > limits.openingLimit * joint.size)
                note(least / (limits.openingLimit * joint.size), Opening, least, joint.size);
        }
    }
    if (how == None) return {};
    const auto& joint = sizes.joints[where];
    const State &one = columns.state(joint.body1), &two = columns.state(joint.body2);
    const auto isHeld = [&](int body) { return columns.blockedAxes(body) == 63 && !columns.isUnit[body]; };
    const bool held = isHeld(joint.body1), alike = held == isHeld(joint.body2);
    const bool second = alike ? moved(two, joint.size) > moved(one, joint.size) : held;
    const int block = second ? joint.body2 : joint.body1, other = second ? joint.body1 : joint.body2;
    const std::string neighbour = "block " + std::to_string(other);
    std::string what = "block " + std::to_string(block);
    if (how == Turn)
        what += " has turned by " + degrees(size) + " against " + neighbour + ", the limit is " + degrees(of);
    else if (how == Slide)
        what += " has slid " + metres(size) + " along its joint with " + neighbour + ", which is " + metres(of) +
                " long in that direction";
    else if (how == Closure)
        what += " lies " + metres(size) + " deep in " + neighbour + ", and the smaller of the two is " + metres(of) +
                " thick there";
    else
        what += " has left " + neighbour + " by " + metres(size) + ", more than the size of the smaller block, " +
                metres(of);
    return {block, what + ", at step " + std::to_string(scene.iter) + ", " + text(scene.time) +
                       " s. Joints are for small displacements: their geometry is that of the reference state, so what "
                       "would follow means nothing and the run ends here"};
}

} // namespace masonry
