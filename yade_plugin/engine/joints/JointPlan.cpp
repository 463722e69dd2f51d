// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointPlan.hpp"
#include "JointImpact.hpp"
#include "common/Memory.hpp"
#include "common/Parallel.hpp"
#include "common/Vectorised.hpp"
#include "engine/units/Zones.hpp"
#include "law/common/JointDamping.hpp"
#include "motion/JointFrames.hpp"
#include <algorithm>
#include <atomic>
#include <numeric>

namespace masonry {

namespace {

constexpr int most = JointFrames::most; // largest number of joints in a batch
constexpr int bodiesAPiece = 64;        // how many bodies a thread takes at a time
constexpr int nodesAPiece = 64;         // how many nodes, or rows of them, a thread takes at a time
constexpr unsigned char atRest = 2;     // of JointShapes::converted
constexpr double flat = 1e-9; // distances [m], angles [rad] and directions out of the plane below this count as none

// Whether a body can only move and turn in a plane y = constant.
bool heldInPlane(const BodyColumns& bodies, int body) {
    return bodies.isBlocked(body, 1) && bodies.isBlocked(body, 3) && bodies.isBlocked(body, 5);
}

// Gives cosine and sine of half the angle of a rotation about y. Returns whether the rotation is about y at all.
bool aboutY(const Quaternionr& q, double& cosine, double& sine) {
    cosine = q.w();
    sine = q.y();
    return std::abs(q.x()) + std::abs(q.z()) < flat;
}

// The rotation from the axes (normal z, tangent x, second tangent y) to a joint's axes in the reference state. It is
// about y for joints of a planar run. The constant quaternion is the rotation that takes x, y, z to y, z, x.
Quaternionr fromPlane(const yade::State& s, const Quaternionr& frame) {
    return s.refOri * frame * Quaternionr(0.5, 0.5, 0.5, 0.5);
}

} // namespace

void JointPlan::Receivers::fill(const std::vector<std::vector<Item>>& lists) {
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

// ---- when the scene has changed ---------------------------------------------------------------------------------

// Whether the run is planar: the normal and the first tangent of every joint lie in a plane y = constant, its blocks
// can only move and turn in that plane, and stress and jump out of it are round-off at most.
bool JointPlan::liesInPlane(const SceneContents& store) const {
    double cosine, sine;
    for (const auto& joint : store.joints) {
        const auto& r = joint.geom->reference();
        if ((r.normal.cross(r.tangent) - Vector3r::UnitY()).norm() > flat) return false;
        for (int side = 0; side < 2; ++side) {
            const int id = r.sides[side].body;
            const auto& s = store.bodies.state(id);
            const bool held = zones_ && zones_->unitOf(id) ? zones_->holds(1) : heldInPlane(store.bodies, id);
            if (!held || !(std::abs(s.pos.y() - s.refPos.y()) < flat) ||
                !aboutY(fromPlane(s, r.frame(side)), cosine, sine) ||
                !aboutY(s.ori * s.refOri.conjugate(), cosine, sine))
                return false;
        }
        for (int p = 0; p < joint.geom->points(); ++p) {
            const double elastic = joint.phys->state(p).shearStress.b / joint.phys->stiffness().shear;
            if (!(std::abs(elastic) + std::abs(joint.geom->jump(p)[2]) < flat)) return false;
        }
    }
    return true;
}

// In a planar run the law is called without the stress out of the plane. Sets to zero what round-off has left of it.
void JointPlan::dropStressOutOfPlane(SceneContents& store) {
    for (const auto& joint : store.joints)
        for (int p = 0; p < joint.geom->points(); ++p)
            joint.phys->group->columns->dropShearStressB(p, joint.phys->index);
}

void JointPlan::build(SceneContents& store, bool mayBePlane) {
    zones_ = nullptr;
    for (const auto& kind : store.kinds)
        if (kind.attached) zones_ = kind.shapes->joints[0].attached->zones.get();
    if (zones_) {
        zones_->units();
        zones_->dropDependentRows();
    }
    for (int b = 0; b < store.bodies.size(); ++b)
        if (store.bodies.has(b)) store.bodies.detectAnyChange(b);
    for (const auto& kind : store.kinds)
        kind.shapes->synchronise();
    plane_ = mayBePlane && liesInPlane(store);
    if (plane_) dropStressOutOfPlane(store);
    onBodies_.clear();
    betweenNodes_.clear();
    batches_.clear();
    kinds_.assign(store.kinds.size(), Kind());

    const int count = store.bodies.size();
    std::vector<std::vector<Receivers::Item>> atBodies(count), atPlaces;
    std::map<std::array<double, 6>, int> known; // places of points between nodes
    int joints = 0, points = 0;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        const auto& kind = store.kinds[k];
        const int stride = (int(kind.shapes->joints.size()) + lanes - 1) / lanes * lanes;
        kinds_[k].first = joints;
        kinds_[k].firstPoint = points;
        joints += stride;
        if (kind.attached) points += stride * kind.shapes->points;
        const int all = int(kind.shapes->joints.size());
        for (int from = 0; from < all; from += most)
            batches_.push_back({int(k), from, std::min(most, all - from)});
        buildKind(store, kind, kinds_[k], atBodies);
        if (kind.attached) buildPlaces(kind, kinds_[k], atPlaces, known);
        findIntact(kind, kinds_[k]);
    }
    referenceY_.assign(count, 0);
    momentPlace_.assign(count, -1);
    joined_.assign(count, 0);
    jointedArea_.assign(count, 0);
    for (const auto& joint : store.joints)
        for (int p = 0; p < joint.geom->points(); ++p)
            for (const auto& side : joint.geom->reference().sides)
                jointedArea_[side.body] += joint.geom->area(p);
    for (auto& column : turn_)
        column.assign(count, 0);
    for (int b = 0; b < count; ++b) {
        joined_[b] = !atBodies[b].empty();
        referenceY_[b] = store.bodies.referencePosition[1][b];
        const auto* unit = zones_ ? zones_->unitOf(b) : nullptr;
        if (unit) momentPlace_[b] = unit->momentPlace;
    }
    onJoints_.assign(std::size_t(plane_ ? 4 : 9) * joints, 0);
    onPoints_.assign(std::size_t(plane_ ? 2 : 3) * points, 0);
    toBodies_.fill(atBodies);
    toNodes_.fill(atPlaces);
    shareOut();
    orderBatches();
    store_ = &store;
    revision_ = store.revision();
    Parallel::instance().sceneChanged();
}

// Decides which joints are intact: those whose points say so, and that were never advanced by their points.
void JointPlan::findIntact(const JointKind& kind, Kind& made) {
    auto& shapes = *kind.shapes;
    const int count = int(shapes.joints.size());
    if (!kind.attached) shapes.findMiddles();
    if (kind.attached || !shapes.law->knowsIntact()) {
        std::fill_n(shapes.pointwise.begin(), count, 1);
        return;
    }
    if (plane_) // nothing yields the plane; there may be round-off of a run in space
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

// From now on the joints of a kind are advanced by their points.
void JointPlan::endIntact(const JointKind& kind) {
    for (int first = 0; first < int(kind.shapes->joints.size()); first += lanes)
        kind.shapes->endIntact(first);
}

// Bodies are numbered course by course as a rule. A thread that takes the joints of the bodies that it moves itself
// finds them in its own cache.
void JointPlan::orderBatches() {
    std::vector<double> middle; // mean number of the bodies of a batch
    for (const auto& batch : batches_) {
        const auto& plan = kinds_[batch.kind];
        const int count = batch.count;
        double sum = 0;
        for (int j = batch.from; j < batch.from + count; ++j)
            sum += plan.body1[j] + plan.body2[j];
        middle.push_back(sum / (2 * count));
    }
    order_.resize(batches_.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return middle[a] < middle[b]; });
}

void JointPlan::buildKind(SceneContents& store, const JointKind& kind, Kind& made,
                          std::vector<std::vector<Receivers::Item>>& atBodies) {
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
        if (plane_) {
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
    // innermost cache.
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
    bool alike = stride >= most;
    for (const auto& s : shared)
        for (int j = 0; alike && j < count; ++j)
            alike = sameButRoundOff((*s.column)[j], (*s.column)[0], s.scale);
    if (!alike) return;
    made.alike = true;
    for (const auto& s : shared) {
        s.column->resize(most);
        s.column->shrink_to_fit();
    }
}

// Finds the places of both sides of subcontacts with deformable sides in the rows of Zones: that of the node, or
// that of a dependent point. Sides that move with the same nodes by the same weights share one. Those of congruent
// units stand in the lanes of the same rows, as their nodes do, so that they are calculated side by side.
void JointPlan::buildPlaces(const JointKind& kind, Kind& made, std::vector<std::vector<Receivers::Item>>& atPlaces,
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
            const bool newRows = onBodies_.size() % lanes == 0;
            const int place = newRows ? zones_->addDependentRows() : onBodies_.back().place + 1;
            onBodies_.push_back({place, from.body, reference, local});
            return place;
        }
        const auto& a = attached[p];
        if (a.weights[0] == 1) return zones_->placeOf(a.nodes[0]);
        const int lane = zones_->placeOf(a.nodes[0]) % lanes; // that of the unit
        std::array<double, 6> key;
        std::array<int, 3> nodes;
        for (int n = 0; n < 3; ++n) {
            nodes[n] = zones_->placeOf(a.nodes[n]) - lane;
            key[n] = a.weights[n] != 0 ? nodes[n] : -1;
            key[3 + n] = std::round(1e9 * a.weights[n]);
        }
        auto at = known.find(key);
        if (at == known.end()) {
            at = known.emplace(key, zones_->addDependentRows()).first;
            betweenNodes_.push_back({at->second, nodes, a.weights});
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
void JointPlan::shareOut() {
    std::map<int, std::vector<std::pair<int, double>>> lists;
    for (const auto& point : betweenNodes_)
        for (int n = 0; n < 3; ++n)
            if (point.weights[n] != 0) lists[point.nodes[n]].push_back({point.place, point.weights[n]});
    shares_ = {};
    shares_.start.push_back(0);
    for (const auto& [node, list] : lists) {
        shares_.nodes.push_back(node);
        for (const auto& [point, weight] : list) {
            shares_.points.push_back(point);
            shares_.weights.push_back(weight);
        }
        shares_.start.push_back(int(shares_.points.size()));
    }
}

// ---- a step -----------------------------------------------------------------------------------------------------

// Takes from the host the bodies that somebody else has moved. Returns false if the plan is for a planar run and a body
// has left the plane, or is no longer held in it.
bool JointPlan::detectChanges(SceneContents& store) {
    auto& bodies = store.bodies;
    std::atomic<bool> fits{true};
    Parallel::instance().overPieces(bodies.size(), bodiesAPiece, [&](int first, int beyond) {
        double aside = 0; // largest distance of a body from its plane [m]
        bool held = true;
        for (int b = first; b < beyond; ++b) {
            if (!joined_[b]) continue;
            bodies.detectMove(b);
            aside = std::max(aside, std::abs(bodies.position[1][b] - referenceY_[b]));
            held = held && (bodies.isUnit[b] || !plane_ || heldInPlane(bodies, b));
        }
        if (!plane_) return;
        const double* orientation[4];
        const double* fromReference[4];
        for (int d = 0; d < 4; ++d) {
            orientation[d] = &bodies.orientation[d][first];
            fromReference[d] = &bodies.fromReference[d][first];
        }
        const double turned =
            turnsInPlane(beyond - first, orientation, fromReference, &turn_[0][first], &turn_[1][first]);
        if (!(held && aside < flat && turned < flat)) fits = false; // also if a number is not finite
    });
    return fits;
}

// Joints side by side in the columns of a kind. Numbers that belong to them begin at the first of them.
struct JointPlan::Run {
    const JointKind& kind;
    const Kind& plan;
    const BodyColumns& bodies;
    int from, n; // number of the first joint within its kind, and of joints
    double dt, stiffnessDamping;
    bool impacts;
    JointFrames frames;

    Run(const JointKind& kind, const Kind& plan, const SceneContents& store)
        : kind(kind),
          plan(plan),
          bodies(store.bodies),
          dt(store.scene().dt),
          stiffnessDamping(store.loop->stiffnessDamping),
          impacts(store.loop->impacts) {}

    JointShapes& shapes() const { return *kind.shapes; }
    LawColumns& states() const { return *kind.states->columns.unsynchronised(); } // the step brings them up to date
    const double* offset(int d, int p) const {
        return &shapes().offset[d][shapes().alike ? shapes().shape(p, 0) : shapes().at(p, from)];
    }
};

// Joints are advanced in runs of whole lanes, which are either all intact or all not. Where contacts have taken the
// place of all joints in some lanes, there is nothing to do: these joints keep their state, and have no forces.
JointPlan::Taken JointPlan::advanceBatch(SceneContents& store, const JointKind& kind, const Kind& plan, int from,
                                         int n) {
    Run run(kind, plan, store);
    const unsigned char* pointwise = &kind.shapes->pointwise[from];
    const auto replaced = [&](int first) {
        const auto* joint = &kind.shapes->converted[from + first];
        return std::all_of(joint, joint + std::min(lanes, n - first), [](unsigned char c) { return c == atRest; });
    };
    Taken taken;
    for (int first = 0; first < n;) {
        const bool still = replaced(first);
        int beyond = first + lanes;
        while (beyond < n && pointwise[beyond] == pointwise[first] && replaced(beyond) == still)
            beyond += lanes;
        run.from = from + first;
        run.n = std::min(beyond, n) - first;
        if (still) {
            const std::size_t width = plane_ ? 4 : 9;
            std::fill_n(&onJoints_[width * (plan.first + run.from)], width * run.n, 0.0);
            first = beyond;
            continue;
        }
        align(run);
        if (pointwise[first]) {
            const Taken more = advancePoints(run);
            taken.damping += more.damping;
            taken.impacts += more.impacts;
        } else if (!advanceIntact(run, taken.damping))
            continue; // again, because some joints of the run are not intact any more
        first = beyond;
    }
    return taken;
}

void JointPlan::align(Run& run) const {
    const auto& bodies = run.bodies;
    const auto& plan = run.plan;
    const int own = plan.alike ? 0 : run.from;
    // In a planar run the complex number z + ix stands for a place (see JointFrames.hpp).
    const double* const position[3] = {bodies.position[plane_ ? 2 : 0].data(), bodies.position[plane_ ? 0 : 1].data(),
                                       bodies.position[plane_ ? 1 : 2].data()};
    const double *turn[4], *frame1[4], *frame2[4], *span[3];
    for (int d = 0; d < 4; ++d) {
        turn[d] = plane_ ? turn_[d].data() : bodies.orientation[d].data();
        frame1[d] = &plan.frame1[d][own];
        frame2[d] = &plan.frame2[d][own];
    }
    for (int d = 0; d < 3; ++d)
        span[d] = &plan.span[d][own];
    const int *body1 = &plan.body1[run.from], *body2 = &plan.body2[run.from];
    if (run.kind.attached)
        (plane_ ? alignNodalInPlane : alignNodal)(run.n, body1, body2, turn, frame1, frame2, run.frames);
    else
        (plane_ ? alignRigidInPlane : alignRigid)(run.n, body1, body2, position, turn, frame1, frame2, span,
                                                  run.frames);
}

// Advances intact joints. If one of them is about to yield, it and those in the same lanes are no longer intact; then
// nothing else happens and the answer is false. Adds the energy that damping takes [J] to `taken`.
bool JointPlan::advanceIntact(Run& run, double& taken) {
    auto& shapes = run.shapes();
    auto& states = run.states();
    auto& frames = run.frames;
    const int n = run.n;
    const std::size_t face = shapes.alike ? 0 : run.from;
    const IntactFaces faces{{&shapes.middle[0][face], &shapes.middle[1][face], &shapes.middle[2][face]},
                            &shapes.faceArea[face],
                            {&shapes.inertia[0][face], &shapes.inertia[1][face], &shapes.inertia[2][face]},
                            states.stiffness().normal,
                            states.stiffness().shear};
    (plane_ ? spreadIntactInPlane : spreadIntact)(n, faces, frames);
    if (endsIntact(run, faces)) return false;
    for (int p = 0; p < shapes.points; ++p) {
        openIntact(n, faces, run.offset(1, p), run.offset(2, p), frames);
        states.remember(p, run.from, n, frames.step[0]);
    }
    const auto columns = [&](LinearField& field) {
        return std::array<double*, 6>{&field.middle[0][run.from], &field.middle[1][run.from],
                                      &field.middle[2][run.from], &field.turn[0][run.from],
                                      &field.turn[1][run.from],   &field.turn[2][run.from]};
    };
    const auto jumps = columns(shapes.linear);
    if (shapes.damped.empty())
        keepIntact(n, frames, jumps.data());
    else
        taken +=
            dampIntact(n, faces, run.stiffnessDamping / run.dt, jumps.data(), columns(shapes.damped).data(), frames);
    (plane_ ? pullIntactInPlane : pullIntact)(n, faces, frames);
    finish(run);
    return true;
}

// Looks whether intact joints are about to yield, and ends their being intact.
bool JointPlan::endsIntact(Run& run, const IntactFaces& faces) const {
    auto& shapes = run.shapes();
    auto& frames = run.frames;
    Mask yielding[most] = {};
    const auto look = [&](int p) {
        plane_ ? jumpIntactInPlane(run.n, faces, run.offset(1, p), frames)
               : jumpIntact(run.n, faces, run.offset(1, p), run.offset(2, p), frames);
        run.states().findYielding(run.n, frames.step[0], frames.step[1], plane_ ? nullptr : frames.step[2], yielding);
    };
    const bool convex = run.states().isConvex();
    for (int p = 0; p < (convex ? int(shapes.rim.size()) : shapes.points); ++p)
        look(convex ? shapes.rim[p] : p);
    Mask any = 0;
    for (int i = 0; i < run.n; ++i)
        any |= yielding[i];
    for (int first = 0; any && first < run.n; first += lanes) {
        const int beyond = std::min(first + lanes, run.n);
        if (std::any_of(yielding + first, yielding + beyond, [](Mask m) { return m != 0; }))
            shapes.endIntact(run.from + first);
    }
    return any != 0;
}

void JointPlan::finish(Run& run) {
    double* onJoints = &onJoints_[std::size_t(plane_ ? 4 : 9) * (run.plan.first + run.from)];
    if (run.kind.attached)
        (plane_ ? finishNodalInPlane : finishNodal)(run.n, run.frames, onJoints);
    else
        (plane_ ? finishRigidInPlane : finishRigid)(run.n, run.frames, onJoints);
}

// Advances joints by their points.
JointPlan::Taken JointPlan::advancePoints(Run& run) {
    const auto& kind = run.kind;
    const auto& plan = run.plan;
    auto& shapes = run.shapes();
    auto& states = run.states();
    auto& frames = run.frames;
    const int from = run.from, n = run.n;
    const int stride = int(plan.body1.size());
    const auto& k = states.stiffness();
    const auto& properties = states.law().properties();
    const double times = run.stiffnessDamping / run.dt;
    const JointDamping damping{times * k.normal, times * k.shear, properties.elastic, states.isBonded(),
                               properties.friction};
    static constexpr double none[most] = {};
    double sumA[most], sumB[most]; // shear stresses of the law and of what is added to them
    Taken taken;
    int still[most], stills = 0; // joints that contacts have taken the place of: they keep their state
    Vector3r kept[most];         // and their jumps at a point
    for (int i = 0; i < n; ++i)
        if (shapes.converted[from + i]) still[stills++] = i;
    for (int p = 0; p < shapes.points; ++p) {
        const std::size_t i = shapes.at(p, from), shape = shapes.alike ? shapes.shape(p, 0) : i;
        const std::size_t first = std::size_t(p) * stride + from;
        const double *area = &shapes.area[shape], *a0 = &shapes.offset[0][shape], *a1 = &shapes.offset[1][shape],
                     *a2 = &shapes.offset[2][shape];
        double *j0 = &shapes.jump[0][i], *j1 = &shapes.jump[1][i], *j2 = &shapes.jump[2][i];
        if (kind.attached) {
            const int *place1 = &plan.place1[first], *place2 = &plan.place2[first];
            const double* u = zones_->displacementRows();
            plane_ ? jumpNodalInPlane(n, place1, place2, u, j0, j1, frames)
                   : jumpNodal(n, place1, place2, u, j0, j1, j2, frames);
        } else {
            for (int s = 0; s < stills; ++s)
                kept[s] = {j0[still[s]], j1[still[s]], j2[still[s]]};
            plane_ ? jumpRigidInPlane(n, a0, a1, j0, j1, frames) : jumpRigid(n, a0, a1, a2, j0, j1, j2, frames);
            for (int s = 0; s < stills; ++s) {
                const int joint = still[s];
                j0[joint] = kept[s][0];
                j1[joint] = kept[s][1];
                j2[joint] = kept[s][2];
                for (auto& step : frames.step)
                    step[joint] = 0;
            }
        }
        states.advance(p, from, n, frames.step[0], frames.step[1], plane_ ? nullptr : frames.step[2],
                       frames.normalStress);
        const double *normal = frames.normalStress, *a = states.shearStressA(p, from),
                     *b = states.shearStressB(p, from);
        const double* const change[3] = {frames.step[0], frames.step[1], plane_ ? none : frames.step[2]};
        const bool meets =
            !shapes.closing.empty() && std::find(shapes.rim.begin(), shapes.rim.end(), p) != shapes.rim.end();
        if (!shapes.viscous[0].empty() || meets) {
            std::copy_n(a, n, sumA);
            plane_ ? std::fill_n(sumB, n, 0.0) : std::copy_n(b, n, sumB);
            a = sumA;
            b = sumB;
        }
        if (!shapes.viscous[0].empty()) {
            double* const viscous[3] = {&shapes.viscous[0][i], &shapes.viscous[1][i], &shapes.viscous[2][i]};
            taken.damping +=
                addJointDamping(n, damping, states.regime(p, from), states.column(Role::BondDamage, p, from), area,
                                change, frames.normalStress, sumA, sumB, viscous);
        }
        if (meets)
            taken.impacts += addImpacts({run.bodies, jointedArea_, run.dt, run.impacts}, shapes, p, from, n, area,
                                        change, frames.normalStress, sumA, sumB);
        if (kind.attached) {
            double* onPoints = &onPoints_[(plane_ ? 2 : 3) * (plan.firstPoint + first)];
            plane_ ? pullNodalInPlane(n, area, normal, a, j0, j1, frames, onPoints)
                   : pullNodal(n, area, normal, a, b, j0, j1, j2, frames, onPoints);
        } else
            plane_ ? pullRigidInPlane(n, area, normal, a, a0, a1, frames) : pullRigid(n, area, normal, a, b, frames);
    }
    finish(run);
    const int width = plane_ ? 4 : 9;
    for (int s = 0; s < stills; ++s) {
        shapes.converted[from + still[s]] = atRest;
        std::fill_n(&onJoints_[std::size_t(width) * (plan.first + from + still[s])], width, 0.0);
    }
    return taken;
}

// Finds the displacements of all dependent points. In a planar run nothing moves along y.
void JointPlan::moveDependentPoints(const SceneContents& store) {
    double* rows = zones_->displacementRows();
    const int count = int(betweenNodes_.size()), next = plane_ ? 2 : 1;
    Parallel::instance().overPieces(count, nodesAPiece, [&](int first, int beyond) {
        for (int n = first; n < beyond; ++n) {
            const auto& point = betweenNodes_[n];
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
    for (const auto& point : onBodies_) {
        const auto& s = store.bodies.state(point.body);
        const Vector3r moved = s.pos + s.ori * point.local - point.reference;
        for (int d = 0; d < 3; ++d)
            rows[point.place + d * lanes] = moved[d];
    }
}

// Sums up for every body the forces and torques of its joints.
void JointPlan::bringToBodies() {
    const int count = int(toBodies_.receivers.size());
    Parallel::instance().overPieces(count, bodiesAPiece, [&](int first, int beyond) {
        for (int r = first; r < beyond; ++r) {
            Vector3r force = Vector3r::Zero(), torque = Vector3r::Zero();
            const auto* item = &toBodies_.items[toBodies_.start[r]];
            const auto* end = item + (toBodies_.start[r + 1] - toBodies_.start[r]);
            if (plane_) {
                double x = 0, z = 0, aboutY = 0;
                for (; item != end; ++item) {
                    const double* on = &onJoints_[4 * item->source];
                    const double sign = item->second ? -1 : 1;
                    x += sign * on[0];
                    z += sign * on[1];
                    aboutY += on[2 + item->second];
                }
                force = {x, 0, z};
                torque = {0, aboutY, 0};
            } else
                for (; item != end; ++item) {
                    const double* on = &onJoints_[9 * item->source];
                    const double sign = item->second ? -1 : 1;
                    for (int d = 0; d < 3; ++d) {
                        force[d] += sign * on[d];
                        torque[d] += on[3 + 3 * item->second + d];
                    }
                }
            const int body = toBodies_.receivers[r];
            if (momentPlace_[body] >= 0) {
                for (int d = 0; d < 3; ++d)
                    (zones_->momentRows() + momentPlace_[body])[d * lanes] = torque[d];
            } else {
                forces_[body] += force;
                torques_[body] += torque;
            }
        }
    });
}

// Sums up for every node the forces of its subcontacts. Those at dependent points go on to their body or nodes.
void JointPlan::bringToNodes(SceneContents& store) {
    double* forces = zones_->forceRows();
    const int count = int(toNodes_.receivers.size());
    Parallel::instance().overPieces(count, nodesAPiece, [&](int first, int beyond) {
        for (int r = first; r < beyond; ++r) {
            double sum[3] = {0, 0, 0};
            for (int n = toNodes_.start[r]; n < toNodes_.start[r + 1]; ++n) {
                const auto& item = toNodes_.items[n];
                const double sign = item.second ? -1 : 1;
                if (plane_) {
                    const double* on = &onPoints_[2 * item.source];
                    sum[0] += sign * on[0];
                    sum[2] += sign * on[1];
                } else {
                    const double* on = &onPoints_[3 * item.source];
                    for (int d = 0; d < 3; ++d)
                        sum[d] += sign * on[d];
                }
            }
            for (int d = 0; d < 3; ++d)
                (forces + toNodes_.receivers[r])[d * lanes] = sum[d];
        }
    });
    const int sharing = int(shares_.nodes.size()), next = plane_ ? 2 : 1;
    Parallel::instance().overPieces(sharing, nodesAPiece, [&](int first, int beyond) {
        for (int n = first; n < beyond; ++n)
            for (int d = 0; d < 3; d += next) {
                double sum[lanes];
                double* to = forces + shares_.nodes[n] + d * lanes;
                std::copy_n(to, lanes, sum);
                for (int i = shares_.start[n]; i < shares_.start[n + 1]; ++i) {
                    const double* from = forces + shares_.points[i] + d * lanes;
                    const double weight = shares_.weights[i];
                    for (int lane = 0; lane < lanes; ++lane)
                        sum[lane] += weight * from[lane];
                }
                std::copy_n(sum, lanes, to);
            }
    });
    for (const auto& point : onBodies_) {
        const double* on = forces + point.place;
        const Vector3r force(on[0], on[lanes], on[2 * lanes]);
        forces_[point.body] += force;
        torques_[point.body] += (store.bodies.state(point.body).ori * point.local).cross(force);
    }
}

void JointPlan::advance(SceneContents& store) {
    const double stiffnessDamping = store.loop->stiffnessDamping;
    if (store_ != &store || revision_ != store.revision()) {
        build(store, true);
        giveMemoryBack();
    }
    if (!detectChanges(store)) {
        build(store, false);
        detectChanges(store);
    }
    if (zones_) moveDependentPoints(store);
    if (stiffnessDamping > 0)
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            const auto& kind = store.kinds[k];
            kind.shapes->makeViscous();
            const auto& law = *kind.shapes->law;
            if (!kinds_[k].intact || law.law().properties().elastic || law.isBonded()) continue;
            endIntact(kind); // without a bond the stress of damping is cut point by point
            kinds_[k].intact = false;
        }
    for (auto& kind : store.kinds)
        if (store.loop->impacts && !kind.attached && kind.shapes->law->law().properties().restitution < 1)
            kind.shapes->makeImpacts();
    const int count = int(order_.size());
    taken_.assign(batches_.size(), {});
    Parallel::instance().overPieces(count, 1, [&](int first, int beyond) {
        for (int place = first; place < beyond; ++place) {
            const int n = order_[place];
            const auto& batch = batches_[n];
            taken_[n] = advanceBatch(store, store.kinds[batch.kind], kinds_[batch.kind], batch.from, batch.count);
        }
    });
    for (std::size_t k = 0; k < kinds_.size(); ++k)
        if (kinds_[k].intact) store.kinds[k].shapes->stale = true;
    // The step that follows damping or an impact has taken half of its work; after that there is nothing left of it.
    for (auto& kind : store.kinds) {
        if (stiffnessDamping == 0) kind.shapes->dropViscous();
        if (!store.loop->impacts) kind.shapes->dropImpacts();
    }
    const auto sums = store.scene().forces().sums(store.bodies.size());
    forces_ = sums.forces;
    torques_ = sums.torques;
    bringToBodies();
    if (zones_) bringToNodes(store);
    for (const auto& taken : taken_) {
        store.loop->dampingWork += taken.damping;
        store.loop->impactWork += taken.impacts;
    }
}

} // namespace masonry
