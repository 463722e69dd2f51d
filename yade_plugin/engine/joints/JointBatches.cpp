// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointBatches.hpp"
#include "common/Parallel.hpp"
#include "engine/units/Zones.hpp"
#include "motion/JointFrames.hpp"
#include <algorithm>
#include <numeric>

namespace masonry {

namespace {

// Gives cosine and sine of half the angle of a rotation about y. Returns whether the rotation is about y at all.
bool aboutY(const Quaternionr& q, double& cosine, double& sine) {
    cosine = q.w();
    sine = q.y();
    return std::abs(q.x()) + std::abs(q.z()) < outOfPlaneTolerance;
}

// The rotation from the axes (normal z, tangent x, second tangent y) to a joint's axes in the reference state. It is
// about y for joints of a planar run. The constant quaternion is the rotation that takes x, y, z to y, z, x.
Quaternionr fromPlane(const yade::State& s, const Quaternionr& frame) {
    return s.refOri * frame * Quaternionr(0.5, 0.5, 0.5, 0.5);
}

// In a planar run the law is called without the stress out of the plane. Sets to zero what round-off has left of it.
void dropStressOutOfPlane(SceneContents& store) {
    for (const auto& joint : store.joints)
        for (int p = 0; p < joint.geom->points(); ++p)
            joint.phys->group->columns->dropShearStressB(p, joint.phys->index);
}

} // namespace

void Receivers::fill(const std::vector<std::vector<Item>>& lists) {
    receivers.clear();
    items.clear();
    start.assign(1, 0);
    for (std::size_t r = 0; r < lists.size(); ++r) {
        if (lists[r].empty()) continue;
        receivers.push_back(int(r));
        items.insert(items.end(), lists[r].begin(), lists[r].end());
        start.push_back(int(items.size()));
    }
}

// Whether the run is planar: the normal and the first tangent of every joint lie in a plane y = constant, its blocks
// can only move and turn in that plane, and stress and jump out of it are round-off at most.
bool JointBatches::liesInPlane(const SceneContents& store) const {
    double cosine, sine;
    for (const auto& joint : store.joints) {
        const auto& r = joint.geom->reference();
        if ((r.normal.cross(r.tangent) - Vector3r::UnitY()).norm() > outOfPlaneTolerance) return false;
        for (int side = 0; side < 2; ++side) {
            const int id = r.sides[side].body;
            const auto& s = store.bodies.state(id);
            const bool held = zones && zones->unitOf(id) ? zones->holds(1) : isHeldInPlane(store.bodies, id);
            if (!held || !(std::abs(s.pos.y() - s.refPos.y()) < outOfPlaneTolerance) ||
                !aboutY(fromPlane(s, r.frame(side)), cosine, sine) ||
                !aboutY(s.ori * s.refOri.conjugate(), cosine, sine))
                return false;
        }
        for (int p = 0; p < joint.geom->points(); ++p) {
            const double elastic =
                *joint.phys->group->columns->shearStressB(p, joint.phys->index) / joint.phys->stiffness().shear;
            if (!(std::abs(elastic) + std::abs(joint.geom->jump(p)[2]) < outOfPlaneTolerance)) return false;
        }
    }
    return true;
}

void JointBatches::build(SceneContents& store, bool mayBePlane) {
    zones = nullptr;
    for (const auto& kind : store.kinds)
        if (kind.attached) zones = kind.shapes->joints[0].attached->zones.get();
    if (zones) {
        zones->units();
        zones->dropDependentRows();
    }
    for (int b = 0; b < store.bodies.size(); ++b)
        if (store.bodies.has(b)) store.bodies.detectAnyChange(b);
    for (const auto& kind : store.kinds)
        kind.shapes->synchronise();
    plane = mayBePlane && liesInPlane(store);
    if (plane) dropStressOutOfPlane(store);
    onBodies.clear();
    betweenNodes.clear();
    batches.clear();
    kinds.assign(store.kinds.size(), {});

    const int count = store.bodies.size();
    Lists atBodies(count), atPlaces;
    std::map<std::array<double, 6>, int> known; // places of points between nodes
    int joints = 0, points = 0;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const auto& kind = store.kinds[k];
        const int stride = (int(kind.shapes->joints.size()) + lanes - 1) / lanes * lanes;
        kinds[k].first = joints;
        kinds[k].firstPoint = points;
        joints += stride;
        if (kind.attached) points += stride * kind.shapes->points;
        const int all = int(kind.shapes->joints.size());
        for (int from = 0; from < all; from += JointFrames::most)
            batches.push_back({int(k), from, std::min(JointFrames::most, all - from)});
        buildKind(store, kind, kinds[k], atBodies);
        if (kind.attached) buildPlaces(kind, kinds[k], atPlaces, known);
        findIntact(kind, kinds[k]);
    }
    referenceY.assign(count, 0);
    momentPlace.assign(count, -1);
    joined.assign(count, 0);
    jointedArea.assign(count, 0);
    for (const auto& joint : store.joints)
        for (int p = 0; p < joint.geom->points(); ++p)
            for (const auto& side : joint.geom->reference().sides)
                jointedArea[side.body] += joint.geom->area(p);
    for (auto& column : turn)
        column.assign(count, 0);
    for (int b = 0; b < count; ++b) {
        joined[b] = !atBodies[b].empty();
        referenceY[b] = store.bodies.referencePosition[1][b];
        const auto* unit = zones ? zones->unitOf(b) : nullptr;
        if (unit) momentPlace[b] = unit->momentPlace;
    }
    onJoints.assign(std::size_t(numbersOfJoint(plane)) * joints, 0);
    onPoints.assign(std::size_t(numbersOfPoint(plane)) * points, 0);
    toBodies.fill(atBodies);
    toNodes.fill(atPlaces);
    listShares();
    orderBatches();
    Parallel::instance().sceneChanged();
}

// Decides which joints are intact: those whose points say so, and that were never advanced by their points.
void JointBatches::findIntact(const JointKind& kind, KindInStep& made) {
    auto& shapes = *kind.shapes;
    const int count = int(shapes.joints.size());
    if (!kind.attached) shapes.findMiddles();
    if (kind.attached || !shapes.law->knowsIntact()) {
        std::fill_n(shapes.pointwise.begin(), count, 1);
        return;
    }
    if (plane) // nothing yields the plane; there may be round-off of a run in space
        for (auto* field : {&shapes.linear, &shapes.damped})
            for (auto* column : {&field->middle[2], &field->turn[0], &field->turn[1]})
                std::fill(column->begin(), column->end(), 0.0);
    for (int j = 0; j < count; ++j)
        if (!shapes.pointwise[j] && !shapes.isIntact(j)) shapes.pointwise[j] = 1;
    shapes.synchronise();
    for (int first = 0; first < count; first += lanes) {
        const auto from = shapes.pointwise.begin() + first, beyond = from + std::min(lanes, count - first);
        if (std::find(from, beyond, 1) != beyond) // joints side by side are intact together
            std::fill(from, beyond, 1);
        else
            made.intact = true;
    }
    shapes.stale = made.intact;
}

// Bodies are numbered course by course as a rule. A thread that takes the joints of the bodies that it moves itself
// finds them in its own cache.
void JointBatches::orderBatches() {
    std::vector<double> middle; // mean number of the bodies of a batch
    for (const auto& batch : batches) {
        const auto& plan = kinds[batch.kind];
        const int count = batch.count;
        double sum = 0;
        for (int j = batch.from; j < batch.from + count; ++j)
            sum += plan.body1[j] + plan.body2[j];
        middle.push_back(sum / (2 * count));
    }
    order.resize(batches.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return middle[a] < middle[b]; });
}

void JointBatches::buildKind(SceneContents& store, const JointKind& kind, KindInStep& made, Lists& atBodies) {
    const int count = int(kind.shapes->joints.size());
    const int stride = (count + lanes - 1) / lanes * lanes;
    for (auto* columns : {made.frame1, made.frame2})
        for (int d = 0; d < 4; ++d)
            columns[d].resize(stride);
    for (auto& column : made.span)
        column.resize(stride);
    made.body1.resize(stride);
    made.body2.resize(stride);
    const auto put = [&](std::vector<double>* columns, int j, const JointReference& r, int side) {
        const Quaternionr q = r.frame(side);
        if (plane) {
            aboutY(fromPlane(store.bodies.state(r.sides[side].body), q), columns[0][j], columns[1][j]);
            return;
        }
        columns[0][j] = q.w();
        for (int d = 0; d < 3; ++d)
            columns[1 + d][j] = q.vec()[d];
    };
    for (int j = 0; j < stride; ++j) { // places after the last joint, up to whole lanes, are filled with its numbers
        const auto& r = kind.shapes->joints[std::min(j, count - 1)];
        made.body1[j] = r.sides[0].body;
        made.body2[j] = r.sides[1].body;
        put(made.frame1, j, r, 0);
        put(made.frame2, j, r, 1);
        const Vector3r span = r.span();
        for (int d = 0; d < 3; ++d)
            made.span[d][j] = span[d];
        if (j >= count) continue;
        atBodies[made.body1[j]].push_back({made.first + j, false});
        atBodies[made.body2[j]].push_back({made.first + j, true});
    }
    // If all joints have the same frames and spans, those of one batch are kept and serve all. They then stay in the
    // innerJointFrames::most cache.
    const double length = std::hypot(made.span[0][0], made.span[1][0], made.span[2][0]);
    struct Shared {
        std::vector<double>* column;
        double scale;
    };
    std::vector<Shared> shared;
    for (int d = 0; d < 4; ++d)
        shared.insert(shared.end(), {{&made.frame1[d], 1}, {&made.frame2[d], 1}});
    for (auto& column : made.span)
        shared.push_back({&column, length});
    bool alike = stride >= JointFrames::most;
    for (const auto& s : shared)
        for (int j = 0; alike && j < count; ++j)
            alike = sameButRoundOff((*s.column)[j], (*s.column)[0], s.scale);
    if (!alike) return;
    made.alike = true;
    for (const auto& s : shared) {
        s.column->resize(JointFrames::most);
        s.column->shrink_to_fit();
    }
}

// Finds the places of both sides of subcontacts with deformable sides in the rows of Zones: that of the node, or
// that of a dependent point. Sides that move with the same nodes by the same weights share one. Those of congruent
// units stand in the lanes of the same rows, as their nodes do, so that they are calculated side by side.
void JointBatches::buildPlaces(const JointKind& kind, KindInStep& made, Lists& atPlaces,
                               std::map<std::array<double, 6>, int>& known) {
    const int count = int(kind.shapes->joints.size()), points = kind.shapes->points;
    const int stride = int(made.body1.size());
    made.place1.assign(std::size_t(stride) * points, 0);
    made.place2 = made.place1;
    const auto placeOf = [&](const JointReference& r, int side, const Vector3r& reference, int p) {
        const auto& attached = r.attached->sides[side];
        if (attached.empty()) {
            const auto& from = r.sides[side];
            const Vector3r local = from.orientation.conjugate() * (reference - from.position);
            const bool newRows = onBodies.size() % lanes == 0;
            const int place = newRows ? zones->addDependentRows() : onBodies.back().place + 1;
            onBodies.push_back({place, from.body, reference, local});
            return place;
        }
        const auto& a = attached[p];
        if (a.weights[0] == 1) return zones->placeOf(a.nodes[0]);
        const int lane = zones->placeOf(a.nodes[0]) % lanes; // that of the unit
        std::array<double, 6> key;
        std::array<int, 3> nodes;
        for (int n = 0; n < 3; ++n) {
            nodes[n] = zones->placeOf(a.nodes[n]) - lane;
            key[n] = a.weights[n] != 0 ? nodes[n] : -1;
            key[3 + n] = std::round(1e9 * a.weights[n]);
        }
        auto at = known.find(key);
        if (at == known.end()) {
            at = known.emplace(key, zones->addDependentRows()).first;
            betweenNodes.push_back({at->second, nodes, a.weights});
        }
        return at->second + lane;
    };
    for (int j = 0; j < count; ++j) {
        const auto& r = kind.shapes->joints[j];
        for (int p = 0; p < points; ++p) {
            const Vector3r reference = r.sides[0].position + r.axes() * kind.shapes->offsetAt(p, j);
            for (int side = 0; side < 2; ++side) {
                const int place = placeOf(r, side, reference, p), i = p * stride + j;
                (side ? made.place2 : made.place1)[i] = place;
                if (int(atPlaces.size()) <= place) atPlaces.resize(place + 1);
                atPlaces[place].push_back({made.firstPoint + i, side == 1});
            }
        }
    }
}

// Lists for every node the points between nodes that it carries a part of.
void JointBatches::listShares() {
    std::map<int, std::vector<std::pair<int, double>>> lists;
    for (const auto& point : betweenNodes)
        for (int n = 0; n < 3; ++n)
            if (point.weights[n] != 0) lists[point.nodes[n]].push_back({point.place, point.weights[n]});
    shares = {};
    shares.start.push_back(0);
    for (const auto& [node, list] : lists) {
        shares.nodes.push_back(node);
        for (const auto& [point, weight] : list) {
            shares.points.push_back(point);
            shares.weights.push_back(weight);
        }
        shares.start.push_back(int(shares.points.size()));
    }
}

} // namespace masonry
