// SPDX-License-Identifier: GPL-2.0-or-later
#include "Contacts.hpp"
#include "common/Parallel.hpp"
#include "contact/ContactStep.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>

namespace masonry {

namespace {

constexpr unsigned allAxes = 63;

bool isHeld(const SceneContents& contents, int body) { return contents.bodies.blockedAxes(body) == allAxes; }

} // namespace

std::vector<std::string> Contacts::problems() const {
    auto sorted = bodies;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) return {"body " + std::to_string(*twice) + " stands in bodies twice"};
    return {};
}

std::vector<int> Contacts::idsOf(const SceneContents& contents) const {
    if (!bodies.empty()) {
        auto sorted = bodies;
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    }
    std::vector<int> all;
    for (const auto& body : contents.scene().bodies->body)
        if (body && body->state && isBlock(body->shape.get())) all.push_back(body->id);
    return all;
}

void Contacts::checkBodies(const SceneContents& contents) const {
    if (!(normalStiffness > 0))
        throw std::invalid_argument(nameOf(ClassRole::Contacts) + ".normalStiffness " + text(normalStiffness) +
                                    " Pa/m must be given, above 0");
    if (!(friction >= 0))
        throw std::invalid_argument(nameOf(ClassRole::Contacts) + ".friction " + text(friction) +
                                    " must be given, at least 0");
    if (takesJoints && !contents.loop && !contents.joints.empty())
        throw std::invalid_argument(nameOf(ClassRole::Contacts) + ".takesJoints needs " + nameOf(ClassRole::Joints) +
                                    ": the functors go on with joints "
                                    "that were handed over");
    for (int id : idsOf(contents)) {
        const auto& body = bodyAt(contents.scene(), id, ": body", ClassRole::Contacts);
        const auto name = nameOf(ClassRole::Contacts) + ": body " + std::to_string(id);
        if (!isBlock(body.shape.get())) throw std::invalid_argument(name + " is no block");
        if (contents.bodies.isUnit[id])
            throw std::invalid_argument(name +
                                        " is a deformable unit, which has no contacts: give the ids of rigid "
                                        "blocks in " +
                                        nameOf(ClassRole::Contacts) + ".bodies");
    }
}

void Contacts::prepare(const SceneContents& contents) {
    if (revision_ == contents.stiffnessRevision()) return;
    ids_ = idsOf(contents);
    const int count = contents.bodies.size();
    blocks_.assign(count, ContactBlock{});
    turns_.assign(count, Matrix3r::Identity());
    double thinnest = HUGE_VAL;
    finders_.clear();
    OverlapFinder finder;
    for (int id : ids_) {
        const auto surface = blockOf(*contents.scene().bodies->body[id]->shape);
        auto& block = blocks_[id];
        try {
            block = contactBlock(surface.vertices, surface.triangles);
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(nameOf(ClassRole::Contacts) + ": body " + std::to_string(id) + ": " +
                                        error.what());
        }
        if (!isHeld(contents, id)) thinnest = std::min(thinnest, block.thickness);
        finder.provideFor(block);
    }
    finders_.push_back(finder);
    // A tenth of the thinnest block that moves: few blocks are that near without touching, and it takes some time to go
    // so far.
    if (!restored_) usedSkin_ = skin > 0 ? skin : thinnest < HUGE_VAL ? 0.1 * thinnest : 0.01;
    joined_.clear();
    contents.eachJoint([&](const JointView& joint) {
        joined_.emplace_back(std::minmax(joint.interaction->id1, joint.interaction->id2));
    });
    std::sort(joined_.begin(), joined_.end());
    stale_ = !restored_ || placed_.size() != ids_.size();
    revision_ = contents.stiffnessRevision();
}

// Whether a body has left its box. A point of a block is moved by a rotation of the angle a by at most a times its
// distance from the centre, and a is at most 2.3 times the distance of the two unit quaternions up to a quarter turn.
bool Contacts::moved(const SceneContents& contents) const {
    const auto& all = contents.bodies;
    for (std::size_t i = 0; i < ids_.size(); ++i) {
        const int id = ids_[i];
        const auto& then = placed_[i];
        const double shift = (all.placeOf(id) - then.position).norm();
        double same = 0, opposite = 0;
        for (int d = 0; d < 4; ++d) {
            same += std::pow(all.orientation[d][id] - then.orientation[d], 2);
            opposite += std::pow(all.orientation[d][id] + then.orientation[d], 2);
        }
        const double turn = 2.3 * std::sqrt(std::min(same, opposite));
        if (!(shift + turn * blocks_[id].radius <= 0.5 * usedSkin_)) return true;
    }
    return false;
}

void Contacts::findPairs(const SceneContents& contents) {
    const auto& all = contents.bodies;
    std::vector<Box> boxes;
    std::vector<unsigned char> awake;
    placed_.clear();
    for (int id : ids_) {
        const auto& block = blocks_[id];
        Box box;
        for (int d = 0; d < 3; ++d) {
            const Vector3r row = turns_[id].row(d).transpose();
            double low = HUGE_VAL, high = -HUGE_VAL;
            for (std::size_t c = 0; c < block.corners[0].size(); ++c) {
                const double x =
                    row[0] * block.corners[0][c] + row[1] * block.corners[1][c] + row[2] * block.corners[2][c];
                low = std::min(low, x);
                high = std::max(high, x);
            }
            box.low[d] = all.position[d][id] + low - 0.5 * usedSkin_;
            box.high[d] = all.position[d][id] + high + 0.5 * usedSkin_;
        }
        boxes.push_back(box);
        awake.push_back(isAwake(contents, id));
        Placed placed{all.placeOf(id), {}};
        for (int d = 0; d < 4; ++d)
            placed.orientation[d] = all.orientation[d][id];
        placed_.push_back(placed);
    }
    // Ids are sorted, so pairs of ids are, too.
    std::vector<Pair> found;
    auto known = pairs_.begin();
    const auto precedes = [](const Pair& a, const std::pair<int, int>& b) {
        return a.one != b.first ? a.one < b.first : a.other < b.second;
    };
    for (const auto& [i, j] : overlappingBoxes(boxes, awake)) {
        const std::pair<int, int> ids(ids_[i], ids_[j]);
        while (known != pairs_.end() && precedes(*known, ids))
            lostInFriction += endFriction((known++)->memory.friction);
        const bool same = known != pairs_.end() && known->one == ids.first && known->other == ids.second;
        if (std::binary_search(joined_.begin(), joined_.end(), ids)) continue;
        found.push_back(same ? *known++ : Pair{ids.first, ids.second});
    }
    for (; known != pairs_.end(); ++known)
        lostInFriction += endFriction(known->memory.friction);
    pairs_ = std::move(found);
    effects_.assign(pairs_.size(), Effect());
    stale_ = false;
    unbounded_ = true;
}

RelativePose Contacts::poseOf(const SceneContents& contents, const Pair& pair) const {
    auto pose = relativePose(turns_[pair.one], contents.bodies.placeOf(pair.one), turns_[pair.other],
                             contents.bodies.placeOf(pair.other));
    pose.place += pair.gap;
    return pose;
}

ContactBody Contacts::bodyOf(const SceneContents& contents, int body) const {
    const auto& all = contents.bodies;
    return {turns_[body],         all.placeOf(body), BodyColumns::row(all.velocity, body),
            all.spinOf(body),     all.mass[body],    BodyColumns::row(all.inertia, body),
            all.blockedAxes(body)};
}

void Contacts::actOn(const SceneContents& contents, OverlapFinder& finder, Pair& pair, Effect& effect) const {
    const auto pose = poseOf(contents, pair);
    effect.touches = finder.find(blocks_[pair.one], blocks_[pair.other], pose, pair.axis, effect.overlap);
    const Vector3r gap = pair.gap;
    if (!effect.touches) {
        if (!gap.isZero(0)) { // once the blocks are apart as they stand, nothing is left of the joint
            Overlap without;
            const RelativePose stands{pose.turn, pose.place - gap};
            if (!finder.find(blocks_[pair.one], blocks_[pair.other], stands, pair.axis, without)) pair.gap.setZero();
        }
        // Most pairs are only near each other.
        if (!pair.memory.touched()) {
            effect.acts = false;
            effect.lost = effect.damped = effect.dampingCoefficient = 0;
            pair.memory.elastic.excess = 0;
            return;
        }
    }
    const auto one = bodyOf(contents, pair.one), other = bodyOf(contents, pair.other);
    actOnPair(law(), {blocks_[pair.one], blocks_[pair.other], one, other, pose, gap}, contents.scene().dt, finder,
              pair.memory, effect);
}

// The dashpots act last, one pair after the other, on the velocities in the middle of the step, and so take energy at
// any time step (engine/watch/CriticalTimeStep.hpp).
template <class Strike> void Contacts::damp(const SceneContents& contents, const Vector3r& gravity, Strike&& strike) {
    const double dt = contents.scene().dt;
    const auto sums = contents.scene().forces().sums(contents.bodies.size());
    middle_.resize(std::size_t(contents.bodies.size()));
    isKnown_.assign(middle_.size(), 0);
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        if (!(effects_[p].dampingCoefficient > 0)) continue;
        for (int body : {pairs_[p].one, pairs_[p].other}) {
            if (isKnown_[body]) continue;
            isKnown_[body] = 1;
            middle_[body] = bodyOf(contents, body);
            push(middle_[body], sums.forces[body] + middle_[body].mass * gravity, sums.torques[body], 0.5 * dt);
        }
    }
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        if (!(effects_[p].dampingCoefficient > 0)) continue;
        auto& pair = pairs_[p];
        const auto &a = blocks_[pair.one], &b = blocks_[pair.other];
        auto &one = middle_[pair.one], &other = middle_[pair.other];
        const auto oneNow = bodyOf(contents, pair.one), otherNow = bodyOf(contents, pair.other);
        const auto pose = poseOf(contents, pair);
        const auto dashpot = dampPair(law(), {a, b, oneNow, otherNow, pose, pair.gap},
                                      {a, b, one, other, pose, pair.gap}, dt, pair.memory, effects_[p]);
        strike(pair, dashpot);
        push(one, -dashpot.force, dashpot.torques[0], dt);
        push(other, dashpot.force, dashpot.torques[1], dt);
    }
}

void Contacts::turnBlocks(const SceneContents& contents) {
    for (int id : ids_)
        turns_[id] = contents.bodies.turnOf(id).toRotationMatrix();
}

void Contacts::act(SceneContents& contents, const Vector3r& gravity) {
    prepare(contents);
    restored_ = false;
    auto& all = contents.bodies;
    for (int id : ids_)
        if (!contents.loop) all.detectChange(id); // that engine has looked whether scripts have moved bodies
    turnBlocks(contents);
    if (takesJoints && contents.scene().iter % lookEvery == 0) wake(contents);
    if (stale_ || moved(contents)) findPairs(contents);
    countChanges(contents);
    if (ratioOf_ != restitution) dampingRatio_ = dampingRatio(restitution);
    ratioOf_ = restitution;
    const int count = int(pairs_.size());
    finders_.resize(std::max<std::size_t>(1, (pairs_.size() + piece - 1) / piece), finders_.front());
    Parallel::instance().overPieces((count + piece - 1) / piece, 1, [&](int first, int beyond) {
        for (int n = first; n < beyond; ++n)
            for (int p = n * piece; p < std::min(count, (n + 1) * piece); ++p)
                actOn(contents, finders_[n], pairs_[p], effects_[p]);
    });
    const auto sums = contents.scene().forces().sums(all.size());
    impulses_.resize(std::size_t(all.size()), Vector3r::Zero());
    const auto add = [&](int body, const Vector3r& force, const Vector3r& torque) {
        sums.forces[body] += force;
        sums.torques[body] += torque;
        if (isHeld(contents, body)) impulses_[std::size_t(body)] += contents.scene().dt * force;
    };
    const auto strike = [&](const Pair& pair, const Wrench& wrench) {
        add(pair.one, -wrench.force, wrench.torques[0]);
        add(pair.other, wrench.force, wrench.torques[1]);
    };
    for (std::size_t p = 0; p < pairs_.size(); ++p)
        if (effects_[p].acts) strike(pairs_[p], effects_[p].wrench);
    damp(contents, gravity, strike);
    for (const auto& effect : effects_) {
        lostInFriction += effect.lost;
        lostInDamping += effect.damped;
    }
    if (!begun) given = elastic(contents); // blocks that a script has put into each other
    begun = true;
}

// ---- joints that are handed over --------------------------------------------------------------------------------

// Whether a body may come near blocks that it has no joint with. Where no joints are handed over, all may that can
// move.
bool Contacts::isAwake(const SceneContents& contents, int body) const {
    return !isHeld(contents, body) && (!takesJoints || awake_.count(body));
}

// A body is awake from when one of its joints is handed over, or if it has none, or when it has moved from its
// reference place by half of the skin. Where it overlaps a block then that it has no joint with, the gap of the pair is
// as wide: neighbours that share an edge only are pressed a little into each other by the stress of the joints around.
void Contacts::wake(const SceneContents& contents) {
    std::vector<unsigned char> jointed(contents.bodies.size(), 0);
    contents.eachJoint([&](const JointView& joint) {
        for (const auto& side : joint.geom->reference().sides)
            jointed[side.body] = 1;
    });
    const auto before = awake_.size();
    for (int id : ids_) {
        if (awake_.count(id) || isHeld(contents, id)) continue;
        const auto& s = contents.bodies.state(id);
        const double moved = (contents.bodies.placeOf(id) - s.refPos).norm();
        const double turn = (turns_[id] - s.refOri.toRotationMatrix()).norm();
        if (!jointed[id] || moved + turn * blocks_[id].radius > 0.5 * usedSkin_) awake_.insert(id);
    }
    if (awake_.size() > before) findPairsOfWoken(contents);
}

// Finds the pairs anew, and gives those that there were not before a gap as wide as they overlap. In the first step
// there are none before: what overlaps then was built so, and presses.
void Contacts::findPairsOfWoken(const SceneContents& contents) {
    std::vector<std::pair<int, int>> known;
    for (const auto& pair : pairs_)
        known.emplace_back(pair.one, pair.other);
    findPairs(contents);
    for (auto& pair : pairs_)
        if (begun && !std::binary_search(known.begin(), known.end(), std::pair(pair.one, pair.other)))
            settle(contents, pair, Vector3r::Zero(), Vector3r::Zero());
}

Contacts::Pair* Contacts::pairOf(int one, int other) {
    for (auto& pair : pairs_)
        if (std::minmax(pair.one, pair.other) == std::minmax(one, other)) return &pair;
    return nullptr;
}

// Sets the gap of a pair so that its elastic force along a normal, which points from the one to the other body, is that
// of `onOther` [N], and gives its friction what the limit allows of the tangential part; both in global axes. Without a
// normal the gap goes along the present force, and the blocks just touch. Returns the elastic energy of the pair [J].
double Contacts::settle(const SceneContents& contents, Pair& pair, const Vector3r& normal, const Vector3r& onOther) {
    auto& finder = finders_.front();
    const auto &one = blocks_[pair.one], &other = blocks_[pair.other];
    const Matrix3r back = turns_[pair.one].transpose();
    pair.gap.setZero();
    pair.memory = PairMemory{};
    const RelativePose stands = poseOf(contents, pair);
    Overlap overlap;
    Vector3r axis = back * normal;
    const double wanted = std::max(0.0, onOther.dot(normal));
    const auto pressAt = [&](double gap) {
        const RelativePose pose{stands.turn, stands.place + gap * axis};
        return finder.find(one, other, pose, pair.axis, overlap) ? normalStiffness * overlap.force.norm() : 0.0;
    };
    const double present = pressAt(0);
    if (normal.isZero(0)) {
        if (present == 0) return 0;
        axis = overlap.normal;
    }
    // The force falls as the gap grows: two gaps that enclose the one that is wanted, then the middle between them.
    const double size = std::min(one.thickness, other.thickness);
    double low = 0, high = 0;
    if (present > wanted)
        for (high = 1e-6 * size; high < size && pressAt(high) > wanted; high *= 2)
            low = high;
    else if (present < wanted)
        for (low = -1e-6 * size; - low < size && pressAt(low) < wanted; low *= 2)
            high = low;
    for (int n = 0; n < 60 && low < high; ++n) {
        const double middle = 0.5 * (low + high);
        (pressAt(middle) > wanted ? low : high) = middle;
    }
    pair.gap = high * axis;
    const double press = pressAt(high);
    if (press == 0) return 0;
    const RelativePose pose = poseOf(contents, pair);
    const double energy = normalStiffness * finder.potential(one, other, pose);
    if (!(overlap.area > 0)) return energy;
    Vector3r shear = back * onOther;
    shear -= shear.dot(overlap.normal) * overlap.normal;
    const double limit = friction * press;
    if (shear.norm() > limit) shear *= limit / shear.norm();
    auto& s = pair.memory.friction;
    s.stiffness = tangentialRatio * normalStiffness * overlap.area;
    s.shear = shear;
    s.normal = overlap.normal;
    s.turn = pose.turn;
    s.place = pose.place;
    return energy + elasticEnergyOf(s);
}

// The force of a joint goes on as that of a contact: along the normal it is the same, and along the face it is cut to
// friction. What remains are moments, and what is not the same counts as given: the difference of the elastic energies
// here, and the work of the difference of both forces in the half step that follows (countChanges).
void Contacts::takeOver(const SceneContents& contents, const std::vector<Joint>& joints) {
    prepare(contents);
    for (const auto& joint : joints) {
        changes_.push_back({joint.body1, joint.force, joint.torque1});
        changes_.push_back({joint.body2, -joint.force, joint.torque2});
        awake_.insert(joint.body1);
        awake_.insert(joint.body2);
        const auto pair = std::pair<int, int>(std::minmax(joint.body1, joint.body2));
        const auto joined = std::lower_bound(joined_.begin(), joined_.end(), pair);
        if (joined != joined_.end() && *joined == pair) joined_.erase(joined);
    }
    converted += int(joints.size());
    turnBlocks(contents);
    findPairsOfWoken(contents);
    for (const auto& joint : joints) {
        auto* pair = pairOf(joint.body1, joint.body2);
        if (!pair) continue;
        const double sign = pair->one == joint.body1 ? 1 : -1;
        conversionEnergy += settle(contents, *pair, sign * joint.normal, -sign * joint.force);
        const auto pose = poseOf(contents, *pair);
        Overlap overlap;
        if (!finders_.front().find(blocks_[pair->one], blocks_[pair->other], pose, pair->axis, overlap)) continue;
        const Matrix3r& turn = turns_[pair->one];
        const Vector3r& shear = pair->memory.friction.shear;
        const Vector3r force = normalStiffness * overlap.force + shear;
        const Vector3r moment = normalStiffness * overlap.moment + overlap.centre.cross(shear);
        changes_.push_back({pair->one, turn * force, turn * (moment - pair->gap.cross(force))});
        changes_.push_back({pair->other, -(turn * force), -(turn * (moment - pose.place.cross(force)))});
    }
}

void Contacts::countChanges(const SceneContents& contents) {
    const double half = 0.5 * contents.scene().dt;
    for (const auto& change : changes_)
        conversionEnergy += half * (change.force.dot(BodyColumns::row(contents.bodies.velocity, change.body)) +
                                    change.torque.dot(contents.bodies.spinOf(change.body)));
    changes_.clear();
}

double Contacts::elastic(const SceneContents& contents) {
    prepare(contents);
    double sum = 0;
    for (const auto& pair : pairs_) {
        sum += energyBesidePotential(pair.memory);
        if (!pair.memory.touched()) continue;
        const auto& s = pair.memory.friction;
        const RelativePose pose{s.turn, s.place};
        sum += normalStiffness * finders_.front().potential(blocks_[pair.one], blocks_[pair.other], pose);
    }
    return sum;
}

// Finds the stiffness of every joint between rigid bodies against motions of each, where they stood when it was made.
void Contacts::measureJoints(const SceneContents& contents) {
    shares_.clear();
    for (const auto& joint : contents.joints) {
        const auto& r = joint.geom->reference();
        if (r.attached) continue;
        JointShare share{joint, {r.sides[0].body, r.sides[1].body}, {}};
        const auto& k = joint.phys->stiffness();
        const Matrix3r axes = r.axes(),
                       spring = axes * Vector3r(k.normal, k.shear, k.shear).asDiagonal() * axes.transpose();
        for (int side = 0; side < 2; ++side) {
            const Matrix3r back = r.sides[side].orientation.toRotationMatrix().transpose();
            share.stiffness[side].setZero();
            for (int p = 0; p < joint.geom->points(); ++p)
                addSpring(back * (joint.geom->centre(p) - r.sides[side].position),
                          joint.geom->area(p) * back * spring * back.transpose(), share.stiffness[side]);
        }
        shares_.push_back(share);
    }
    measuredRevision_ = contents.stiffnessRevision();
}

// The bounds are derived in contact/README.md.
void Contacts::boundPairs(const SceneContents& contents, double damping, bool anew) {
    const double tangential = tangentialRatio * normalStiffness;
    const std::array<double, 3> now{damping, normalStiffness, tangential};
    if (!anew && !unbounded_ && boundFor_ == now) return;
    boundFor_ = now;
    prepare(contents);
    turnBlocks(contents);
    if (measuredRevision_ != contents.stiffnessRevision()) measureJoints(contents);
    std::map<int, BlockStiffness> found;
    const auto at = [&](int body) -> auto& {
        return found.emplace(body, BlockStiffness(BlockStiffness::Zero())).first->second;
    };
    const auto share = [&](int body, int other) {
        return isHeld(contents, body) ? 0.0 : isHeld(contents, other) ? 1.0 : 2.0;
    };
    const auto largest = [&] {
        double most = 0;
        for (const auto& [body, stiffness] : found) {
            if (isHeld(contents, body)) continue;
            const auto own = bodyOf(contents, body);
            const double factor = contents.bodies.isDamped(body) ? 1 + damping : 1;
            most = std::max(most, factor * largestEigenvalueOf(stiffness, own));
        }
        return most;
    };
    for (const auto& pair : pairs_)
        for (int side = 0; side < 2; ++side) {
            const int body = side ? pair.other : pair.one, other = side ? pair.one : pair.other;
            const double times = share(body, other);
            if (times == 0) continue;
            const auto pose = relativePose(turns_[body], contents.bodies.placeOf(body), turns_[other],
                                           contents.bodies.placeOf(other));
            addNearSurface(blocks_[body], blocks_[other], pose, usedSkin_ + pair.gap.norm(), times * normalStiffness,
                           times * tangential, at(body));
        }
    ofPairs_ = largest();
    for (const auto& joint : shares_)
        for (int side = 0; side < 2 && !joint.joint.geom->converted(); ++side)
            if (const double times = share(joint.bodies[side], joint.bodies[1 - side]); times > 0)
                at(joint.bodies[side]) += times * joint.stiffness[side];
    // Beside connectors no bound is known. It is finite, as every number of a checkpoint must be.
    ofAll_ = contents.connectors.empty() ? largest() : std::numeric_limits<double>::max();
    unbounded_ = false;
}

double Contacts::largestEigenvalue(const SceneContents& contents, double ofJoints, double damping, bool anew) {
    if (stepShare > 0) return ofPairs_ > 0 ? std::min(ofJoints + ofPairs_, ofAll_) : ofJoints;
    if (anew || boundRevision_ != contents.stiffnessRevision() || boundStiffness_ != normalStiffness ||
        boundRatio_ != tangentialRatio) {
        checkBodies(contents);
        embedded_ = 0;
        for (int id : idsOf(contents)) {
            if (isHeld(contents, id)) continue;
            const auto surface = blockOf(*contents.scene().bodies->body[id]->shape);
            const auto& s = contents.bodies.state(id);
            embedded_ = std::max(embedded_,
                                 2 * embeddedEigenvalue(contactBlock(surface.vertices, surface.triangles), s.mass,
                                                        s.inertia, normalStiffness, tangentialRatio * normalStiffness));
        }
        boundRevision_ = contents.stiffnessRevision();
        boundStiffness_ = normalStiffness;
        boundRatio_ = tangentialRatio;
    }
    return ofJoints + embedded_ * (1 + damping);
}

std::vector<FallenBlocks::Size> Contacts::sizes() const {
    std::vector<FallenBlocks::Size> found;
    for (const auto& block : blocks_)
        found.push_back({2 * block.radius, block.thickness});
    return found;
}

std::vector<Contacts::PairForce> Contacts::pairForces() const {
    std::vector<PairForce> found;
    for (std::size_t p = 0; p < pairs_.size() && p < effects_.size(); ++p)
        if (effects_[p].acts)
            found.push_back({pairs_[p].one, pairs_[p].other, effects_[p].wrench.force, effects_[p].wrench.torques[1]});
    return found;
}

int Contacts::touching() const {
    return int(std::count_if(effects_.begin(), effects_.end(), [](const auto& effect) { return effect.touches; }));
}

Vector3r Contacts::forceOf(int id1, int id2) const {
    for (const auto& of : pairForces())
        if (std::minmax(id1, id2) == std::minmax(of.one, of.other))
            return of.other == id2 ? of.force : Vector3r(-of.force);
    return Vector3r::Zero();
}

Vector3r Contacts::impulseOn(int body) const {
    const auto b = std::size_t(body);
    return b < impulses_.size() ? impulses_[b] : Vector3r(Vector3r::Zero());
}

void Contacts::visitState(StateNumbers& n) {
    std::vector<int> awake(awake_.begin(), awake_.end());
    effects_.resize(pairs_.size());
    n(awake, changes_, pairs_, effects_, impulses_, placed_, usedSkin_, unbounded_, ofPairs_, ofAll_, boundFor_,
      jointEigenvalue, stepShare);
    if (!n.back) return;
    if (effects_.size() != pairs_.size()) n.refuse();
    awake_ = {awake.begin(), awake.end()};
    restored_ = true;
    stale_ = placed_.size() != ids_.size();
}

} // namespace masonry
