// SPDX-License-Identifier: GPL-2.0-or-later
#include "Refinement.hpp"
#include "blocks/JointPoints.hpp"
#include "common/Text.hpp"
#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>

namespace masonry {

namespace {

using Points = std::vector<JointPoint>;

constexpr double close = 1e-9; // over the length of a row: points that are nearer to each other are one

// ---- points -----------------------------------------------------------------------------------------------------

Points pointsOf(const JointGeometry& geom) {
    Points all;
    for (int p = 0; p < geom.points(); ++p)
        all.push_back({geom.offset(p), geom.area(p)});
    return all;
}

// The tangent of a joint, 1 or 2, along which its points stand in one row; 0 if they do not, or if they are too few for
// the true rotational stiffness.
int rowOf(const Points& points) {
    double extent[3] = {0, 0, 0};
    for (int d = 1; d < 3; ++d) {
        const auto by = [&](const JointPoint& a, const JointPoint& b) { return a.offset[d] < b.offset[d]; };
        const auto [low, high] = std::minmax_element(points.begin(), points.end(), by);
        if (low != points.end()) extent[d] = high->offset[d] - low->offset[d];
    }
    const int along = extent[1] >= extent[2] ? 1 : 2;
    const bool row = extent[3 - along] <= close * extent[along];
    return row && int(points.size()) >= Refinement::fewest ? along : 0;
}

// As many points in the row of a joint.
Points inRow(const JointReference& r, int along, int count) {
    Points all;
    const bool first = along == 1;
    for (const auto& part : subdivide(r.polygon(), r.normal, r.tangent, first ? count : 1, first ? 1 : count))
        all.push_back({r.axes().transpose() * (part.centre - r.sides[0].position), part.area});
    return all;
}

// Columns of one joint alone, with these points and without a state.
struct Alone {
    shared_ptr<JointShapes> shapes;
    shared_ptr<JointStates> states;

    Alone(const JointView& joint, const Points& points)
        : shapes(new JointShapes(1, int(points.size()))),
          states(new JointStates(joint.phys->propertySet(), joint.phys->stiffness(), 1, int(points.size()))) {
        shapes->joints[0] = joint.geom->reference();
        shapes->byPoints[0] = 1;
        for (int p = 0; p < shapes->points; ++p)
            shapes->setShape(p, 0, points[p].offset, points[p].area);
    }
    LawColumns& columns() const { return *states->columns.asTheyStand(); }
    void giveTo(const JointView& joint) const {
        joint.geom->group = shapes;
        joint.phys->group = states;
        joint.geom->index = joint.phys->index = 0;
        joint.geom->step.reset();
    }
    // Elastic and dissipated energy [J].
    double energy() const {
        const auto sums = columns().energies(shapes->area.data(), false);
        double all = 0;
        for (const auto& e : {sums.stored, sums.dissipated})
            all += e.tension + e.shear + e.compression;
        return all;
    }
};

// ---- state ------------------------------------------------------------------------------------------------------

// The numbers of a subcontact by their names, as its law gives them.
class Numbers {
public:
    Numbers(const LawColumns& columns, int point, int joint) {
        columns.read(point, joint, [&](const char* name, double number) { all_.emplace_back(name, number); });
    }
    double operator[](const char* name) const {
        for (const auto& [each, number] : all_)
            if (std::strcmp(each, name) == 0) return number;
        return 0;
    }
    void set(const char* name, double value) {
        for (auto& [each, number] : all_)
            if (std::strcmp(each, name) == 0) number = value;
    }
    void writeTo(LawColumns& columns, int point) const {
        columns.write(point, 0, [&](const char* name, double& number) { number = (*this)[name]; });
    }
    double irreversible() const { return (*this)["crushing"] - (*this)["dilation"]; }
    double elasticOpening() const { return (*this)["opening"] + irreversible(); }
    // How far a crack has opened here at most; of a point that has none, how far it is open or closed now.
    double crack() const { return (*this)["tensionDamage"] > 0 ? (*this)["largestOpening"] : elasticOpening(); }

    // Between two subcontacts, at the share t of the way from the first.
    static Numbers between(const Numbers& a, const Numbers& b, double t) {
        Numbers made = a;
        for (std::size_t n = 0; n < made.all_.size(); ++n)
            made.all_[n].second = (1 - t) * a.all_[n].second + t * b.all_[n].second;
        return made;
    }

private:
    std::vector<std::pair<const char*, double>> all_;
};

// Where a new point stands between the points that there were.
struct Between {
    int first, second;
    double share; // of the way from the first to the second
};

Between placeOf(double at, const std::vector<double>& places, const std::vector<int>& order) {
    const double length = places[order.back()] - places[order.front()];
    std::size_t n = 1;
    while (n + 1 < order.size() && places[order[n]] < at)
        ++n;
    const int a = order[n - 1], b = order[n];
    const double t = (at - places[a]) / (places[b] - places[a]);
    if (std::abs(at - places[a]) <= close * length) return {a, b, 0};
    if (std::abs(at - places[b]) <= close * length) return {a, b, 1};
    return {a, b, std::clamp(t, 0.0, 1.0)};
}

// Gives a new point the state between two. All that is linear along an elastic joint is linear here: jumps and shear
// stresses. The damage of a crack is no mean of damages: the law opens the point as far as the crack was open at most
// there, and closes it to where it is. Last, the law returns a shear stress beyond the strength.
void follow(LawColumns& columns, int point, const Numbers& a, const Numbers& b, double t) {
    const auto now = Numbers::between(a, b, t);
    const double opening = now.elasticOpening(), crack = (1 - t) * a.crack() + t * b.crack();
    auto start = now;
    start.set("opening", -now.irreversible());
    for (const char* name : {"shearStressA", "shearStressB", "largestOpening", "tensionDamage", "regime"})
        start.set(name, 0);
    start.writeTo(columns, point);
    double at = 0;
    if (crack > std::max(opening, 0.0)) {
        columns.advanceOne(point, 0, {crack, {}});
        at = crack;
    }
    columns.advanceOne(point, 0, {opening - at, {}});
    Numbers last(columns, point, 0);
    for (const char* name : {"shearStressA", "shearStressB"})
        last.set(name, now[name]);
    last.writeTo(columns, point);
    columns.advanceOne(point, 0, {});
}

// Gives a joint other points in its row, which take over its state. Returns the elastic energy that it gets by that.
double refine(const JointView& joint, int along, int count) {
    auto& shapes = *joint.geom->group;
    const int j = joint.geom->index;
    if (!shapes.byPoints[j]) shapes.endIntact(j);
    const auto old = pointsOf(*joint.geom);
    Alone before(joint, old);
    before.shapes->take(0, shapes, j);
    before.states->take(0, *joint.phys->group, joint.phys->index);
    const auto& from = before.columns();

    Alone after(joint, inRow(joint.geom->reference(), along, count));
    auto& r = after.shapes->joints[0];
    r.refined = count;
    r.coarse = std::make_shared<const Points>(old);
    auto& to = after.columns();
    std::vector<double> places;
    std::vector<Numbers> numbers;
    std::vector<int> order(old.size());
    for (std::size_t p = 0; p < old.size(); ++p) {
        places.push_back(old[p].offset[along]);
        numbers.emplace_back(from, int(p), 0);
    }
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return places[a] < places[b]; });

    // What was dissipated goes to the new points around, by their areas.
    std::vector<Between> between;
    std::vector<double> areas(old.size(), 0.0); // of the new points, by the old ones
    for (int p = 0; p < after.shapes->points; ++p) {
        const auto b = placeOf(after.shapes->offsetAt(p, 0)[along], places, order);
        areas[b.first] += (1 - b.share) * after.shapes->areaAt(p, 0);
        areas[b.second] += b.share * after.shapes->areaAt(p, 0);
        between.push_back(b);
    }
    for (int p = 0; p < after.shapes->points; ++p) {
        const auto [a, b, t] = between[p];
        if (t == 0 || t == 1)
            numbers[t == 0 ? a : b].writeTo(to, p);
        else
            follow(to, p, numbers[a], numbers[b], t);
        after.shapes->setJump(p, 0, (1 - t) * before.shapes->jumpAt(a, 0) + t * before.shapes->jumpAt(b, 0));
        after.shapes->setViscous(p, 0, (1 - t) * before.shapes->viscousAt(a, 0) + t * before.shapes->viscousAt(b, 0));
        after.shapes->setImpact(p, 0, before.shapes->impactAt(t < 0.5 ? a : b, 0));
        Energies lost;
        for (const auto& [i, part] : {std::pair(a, 1 - t), std::pair(b, t)}) {
            if (part == 0) continue;
            const auto e = from.dissipated(i, 0);
            const double all = part * old[i].area / areas[i];
            lost.tension += all * e.tension;
            lost.shear += all * e.shear;
            lost.compression += all * e.compression;
        }
        to.setDissipated(p, 0, lost);
    }
    after.giveTo(joint);
    return after.energy() - before.energy();
}

} // namespace

// ---- where ------------------------------------------------------------------------------------------------------

Refinement::Limit::Limit(const LawColumns& columns) : columns_(&columns) {
    const auto& p = columns.law().properties();
    if (p.elastic) return;
    crushes_ = p.cap && columns.law().compression().elasticLimit > 0;
    cracks_ = !p.cap;
    normal_ = p.capNormal;
    shear_ = p.capShear;
    linear_ = p.capLinear;
    elasticLimit_ = columns.law().compression().elasticLimit;
    if (!cracks_) return;
    const auto within = [&](double sigma, double tau) { return !yields(sigma / company, tau / company, 0); };
    constexpr double most = 1e12, least = 1; // [Pa]
    for (tension_ = most; tension_ > least && !within(tension_, 0);)
        tension_ *= 0.5;
    tension_ *= 0.5; // so that some shear stress is within, too
    for (slip_ = most; slip_ > least && !within(tension_, slip_);)
        slip_ *= 0.5;
}

bool Refinement::Limit::isReached(double part, double sigma, double a, double b) const {
    const double squared = a * a + b * b, pressed = std::min(sigma, 0.0), limit = part * elasticLimit_;
    if (crushes_) return (normal_ * pressed + linear_) * pressed + shear_ * squared > limit * limit;
    return (sigma > tension_ || squared > slip_ * slip_) && yields(sigma / part, a / part, b / part);
}

bool Refinement::Limit::yields(double sigma, double a, double b) const {
    const auto f = columns_->yieldingUnder(sigma, {a, b});
    return f.tension > 0 || f.slip > 0;
}

// Whether a point of a joint has reached this part of the limit, or was beyond it already.
bool Refinement::isDue(const JointKind& kind, const Limit& limit, double part, int j) const {
    const auto& shapes = *kind.shapes;
    const auto& columns = *kind.states->columns.asTheyStand();
    for (int p = 0; p < shapes.points && !shapes.byPoints[j]; ++p) {
        const auto& k = columns.stiffness();
        const Vector3r jump = shapes.intactJumpAt(p, j);
        if (limit.isReached(part, k.normal * jump[0], k.shear * jump[1], k.shear * jump[2])) return true;
    }
    for (int p = 0; p < shapes.points && shapes.byPoints[j]; ++p) {
        const double a = *columns.shearStressA(p, j), b = *columns.shearStressB(p, j);
        const double* damage = limit.cracks() ? columns.tensionDamage(p, j) : nullptr;
        if ((damage && *damage > 0) || (!limit.cracks() && *columns.regime(p, j) == Regime::Crushing)) return true;
        if (limit.isReached(part, columns.stressIfClosed(p, j), a, b) &&
            limit.isReached(part, columns.state(p, j).normalStress, a, b))
            return true;
    }
    return false;
}

void Refinement::readLimits(const SceneStore& store) {
    limits_.clear();
    for (const auto& kind : store.kinds)
        limits_.emplace_back(*kind.states->columns.asTheyStand());
    revision_ = store.revision();
}

void Refinement::check(const SceneStore& store, int points) {
    if (points < fewest || points > most)
        throw std::invalid_argument("MasonryJointLoop.refinement " + std::to_string(points) + " must be 0, or " +
                                    std::to_string(fewest) + " to " + std::to_string(most));
    for (std::size_t k = 0; k < store.kinds.size(); ++k) {
        const auto& shapes = *store.kinds[k].shapes;
        for (std::size_t j = 0; j < shapes.joints.size() && limits_[k].isNeeded() && !store.kinds[k].attached; ++j) {
            const auto& r = shapes.joints[j];
            Points all;
            for (int p = 0; p < shapes.points && !r.coarse; ++p)
                all.push_back({shapes.offsetAt(p, int(j)), shapes.areaAt(p, int(j))});
            if (r.coarse || rowOf(all)) continue;
            throw std::invalid_argument(
                "MasonryJointLoop.refinement " + std::to_string(points) + ": the joint of bodies " +
                std::to_string(r.sides[0].body) + " and " + std::to_string(r.sides[1].body) + " has " +
                std::to_string(shapes.points) + " points, and only joints with one row of at least " +
                std::to_string(fewest) +
                " points can be refined, as those of blocks that move in a plane: set the refinement to 0, and give "
                "joints in space as many subcontacts and rows from the beginning as are needed");
        }
    }
    checkedPoints_ = points;
}

void Refinement::look(SceneStore& store) {
    const int points = store.loop->refinement;
    changed_.clear();
    if (points == 0) return;
    const bool read = store.revision() != revision_;
    if (read) readLimits(store);
    if (read || points != checkedPoints_) check(store, points);
    if (store.scene().iter % every != 0 && store.splits.empty()) return;
    std::set<std::pair<const JointShapes*, int>> due;
    bool any = false;
    for (std::size_t k = 0; k < store.kinds.size(); ++k) {
        const auto& kind = store.kinds[k];
        const auto& whole = kind.shapes->whole;
        if (kind.attached || kind.handed || kind.shapes->points >= points || !limits_[k].isNeeded()) continue;
        for (int j = 0; j < int(kind.shapes->joints.size()); ++j) {
            if ((!whole.empty() && whole[j]) || !isDue(kind, limits_[k], company, j)) continue;
            due.emplace(kind.shapes.get(), j);
            any = any || isDue(kind, limits_[k], share, j);
        }
    }
    if (!any) return;
    const auto add = [](Changed& to, double sign) {
        const auto& geom = *to.joint.geom;
        for (int p = 0; p < geom.points(); ++p) {
            const auto s = to.joint.phys->state(p);
            const Vector3r stress =
                Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b) + geom.group->stressBesideLaw(p, geom.index);
            to.forces.push_back({geom.offset(p)[to.along], sign * geom.area(p) * stress});
        }
    };
    for (const auto& joint : store.joints) // in the host's order, so that the sum does not depend on addresses
        if (due.count({joint.geom->group.get(), joint.geom->index})) {
            Changed change{joint, {}, rowOf(pointsOf(*joint.geom)), {}};
            add(change, 1);
            store.loop->refiningEnergy += refine(joint, change.along, points);
            add(change, -1);
            for (int p = 0; p < joint.geom->points(); ++p)
                change.jumps.push_back(joint.geom->jump(p));
            changed_.push_back(std::move(change));
        }
    store.jointsChanged();
    readLimits(store);
}

void Refinement::count(SceneStore& store) {
    for (const auto& change : changed_) {
        const auto& geom = *change.joint.geom;
        // The jump grows linearly along the row.
        const int last = int(change.jumps.size()) - 1;
        const double from = geom.offset(0)[change.along], length = geom.offset(last)[change.along] - from;
        const Vector3r first = geom.jump(0) - change.jumps[0];
        const Vector3r slope = (geom.jump(last) - change.jumps[last] - first) / length;
        for (const auto& [place, force] : change.forces)
            store.loop->refiningEnergy -= 0.5 * force.dot(first + (place - from) * slope);
    }
    changed_.clear();
}

bool Refinement::setPoints(SceneStore& store, const std::vector<double>& refined) {
    std::vector<std::pair<const JointView*, int>> change; // joints and their new numbers of points
    for (std::size_t n = 0; n < store.joints.size(); ++n) {
        const auto& joint = store.joints[n];
        const auto& r = joint.geom->reference();
        const double count = refined[n];
        if (count == r.refined) continue;
        const bool fits = count == 0 || (count >= fewest && count <= most && count == std::floor(count));
        if (!fits || r.attached || !rowOf(r.coarse ? *r.coarse : pointsOf(*joint.geom))) return false;
        change.emplace_back(&joint, int(count));
    }
    if (change.empty()) return true;
    for (const auto& [joint, count] : change) {
        const auto& r = joint->geom->reference();
        const auto first = r.coarse ? *r.coarse : pointsOf(*joint->geom);
        const Alone fresh(*joint, count ? inRow(r, rowOf(first), count) : first);
        fresh.shapes->joints[0].refined = count;
        fresh.shapes->joints[0].coarse = count ? std::make_shared<const Points>(first) : nullptr;
        fresh.giveTo(*joint);
    }
    store.jointsChanged();
    return true;
}

} // namespace masonry
