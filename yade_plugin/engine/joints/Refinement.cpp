// SPDX-License-Identifier: GPL-2.0-or-later
#include "Refinement.hpp"
#include "blocks/JointPoints.hpp"
#include "common/Text.hpp"
#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

namespace masonry {

namespace {

using Points = std::vector<JointPoint>;

constexpr double leastParallel = 0.7;   // cosine of the angle between joints whose blocks are no corners of a structure
constexpr double parallelBeds = 0.9998; // the same between both beds of a block that is no wedge

constexpr double close = 1e-9; // over the length of a row: points that are nearer to each other are one

// ---- points -----------------------------------------------------------------------------------------------------

Points pointsOf(const JointGeometry& geom) {
    Points all;
    for (int p = 0; p < geom.points(); ++p)
        all.push_back({geom.offset(p), geom.area(p)});
    return all;
}

// Points of the first joint of a kind. All joints of a kind are alike in whether their points stand in a row.
Points pointsOf(const JointKind& kind) {
    Points all;
    for (int p = 0; p < kind.shapes->points; ++p)
        all.push_back({kind.shapes->offsetAt(p, 0), kind.shapes->areaAt(p, 0)});
    return all;
}

// Whether points stand in one row along the joint's tangent, as those of a joint whose blocks move in a plane.
bool isRow(const Points& points) {
    const auto apart = [&](int d) {
        const auto by = [&](const JointPoint& a, const JointPoint& b) { return a.offset[d] < b.offset[d]; };
        const auto [low, high] = std::minmax_element(points.begin(), points.end(), by);
        return high->offset[d] - low->offset[d];
    };
    return apart(2) <= close * apart(1);
}

Points refinedPoints(const JointReference& r, const PointCounts& counts) {
    Points all;
    for (const auto& part : subdivide(r.polygon(), r.normal, r.tangent, counts.along, counts.across))
        all.push_back({r.axes().transpose() * (part.centre - r.sides[0].position), part.area});
    return all;
}

// The points among which a place of a joint lies, with weights that keep what is linear over the face: one point, the
// ends of the shortest stretch of a row, or the corners of the smallest triangle. In a rectangle of four points two
// triangles are equally small, and each counts for a half.
struct Share {
    int point;
    double weight;
};
std::vector<Share> sharesAt(const Vector3r& place, const Points& points) {
    const int count = int(points.size());
    std::vector<double> distances; // squares [m²]
    for (const auto& point : points)
        distances.push_back((place - point.offset).squaredNorm());
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    const int closest = int(std::min_element(distances.begin(), distances.end()) - distances.begin());
    double smallest = HUGE_VAL;
    std::vector<std::vector<Share>> found;
    // Whether a stretch or triangle around the place with a side of this length, or a corner at this distance from the
    // place, can be small enough: the squares of a triangle's sides are 1.5 times the square of either in sum, or more.
    const bool row = isRow(points);
    const auto fits = [&](double squared) { return (row ? 1 : 1.5) * squared <= smallest * (1 + 1e-6); };
    const auto take = [&](double size, std::initializer_list<Share> shares) {
        for (const auto& share : shares)
            if (share.weight < -1e-6) return;
        if (size > smallest * (1 + 1e-6)) return;
        if (size < smallest * (1 - 1e-6)) found.clear();
        smallest = std::min(size, smallest);
        found.emplace_back(shares);
    };
    const auto between = [&](int from, int to) { return Vector3r(points[to].offset - points[from].offset); };
    const auto search = [&] {
        found.clear();
        const auto isNear = [&](std::size_t n) { return n < order.size() && fits(distances[order[n]]); };
        for (std::size_t i = 0; isNear(i); ++i) {
            const int a = order[i];
            const Vector3r there = place - points[a].offset;
            for (std::size_t j = i + 1; isNear(j); ++j) {
                const int b = order[j];
                const Vector3r ab = between(a, b);
                if (!fits(ab.squaredNorm())) continue;
                if (row) {
                    const double t = there.dot(ab) / ab.squaredNorm();
                    take(ab.squaredNorm(), {{a, 1 - t}, {b, t}});
                    continue;
                }
                for (std::size_t k = j + 1; isNear(k); ++k) {
                    const int c = order[k];
                    const Vector3r ac = between(a, c);
                    if (!fits(ac.squaredNorm())) continue;
                    const double sides = ab.squaredNorm() + ac.squaredNorm();
                    const double size = sides + between(b, c).squaredNorm(), area = ab.cross(ac)[0];
                    if (size > smallest * (1 + 1e-6) || std::abs(area) <= 1e-6 * sides) continue;
                    const double u = there.cross(ac)[0] / area, v = ab.cross(there)[0] / area;
                    take(size, {{a, 1 - u - v}, {b, u}, {c, v}});
                }
            }
        }
    };
    // The first search begins with the nearest points and finds the smallest size; the second one takes those that are
    // near enough in their own order, in which weights are summed.
    std::sort(order.begin(), order.end(), [&](int a, int b) { return distances[a] < distances[b]; });
    search();
    order.erase(std::partition_point(order.begin(), order.end(), [&](int p) { return fits(distances[p]); }),
                order.end());
    std::sort(order.begin(), order.end());
    search();
    std::vector<double> weights(count, 0.0);
    for (const auto& shares : found)
        for (const auto& [point, weight] : shares)
            weights[point] += weight / found.size();
    if (distances[closest] <= close * smallest) {
        weights.assign(count, 0.0);
        weights[closest] = 1;
    }
    std::vector<Share> all;
    for (int p = 0; p < count; ++p)
        if (std::abs(weights[p]) > close) all.push_back({p, weights[p]});
    return all;
}

// Columns of one joint alone, with these points and without a state.
struct SingleJointColumns {
    shared_ptr<JointShapes> shapes;
    shared_ptr<JointStates> states;

    SingleJointColumns(const JointView& joint, const Points& points)
        : shapes(new JointShapes(1, int(points.size()))),
          states(new JointStates(joint.phys->propertySet(), joint.phys->stiffness(), 1, int(points.size()))) {
        shapes->joints[0] = joint.geom->reference();
        shapes->refined[0] = joint.geom->refined();
        shapes->pointwise[0] = 1;
        for (int p = 0; p < shapes->points; ++p)
            shapes->setShape(p, 0, points[p].offset, points[p].area);
    }
    LawColumns& columns() const { return *states->columns.unsynchronised(); }
    void attachTo(const JointView& joint) const {
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

double sum(const Energies& e) { return e.tension + e.shear + e.compression; }

// Gives a point of a joint the state among old points. Jumps and shear stresses are linear over the face. All else
// comes from that of the old points which has lost least: the law itself opens or closes it as far as the face is open
// or closed here, and last returns a shear stress beyond the strength. So no number of a law needs to be known.
void follow(LawColumns& to, int point, const LawColumns& from, const std::vector<Share>& shares) {
    int whole = shares[0].point;
    double opening = 0;
    Shear stress;
    for (const auto& [old, weight] : shares) {
        if (sum(from.dissipated(old, 0)) < sum(from.dissipated(whole, 0))) whole = old;
        opening += weight * from.state(old, 0).opening;
        stress.a += weight * *from.shearStressA(old, 0);
        stress.b += weight * *from.shearStressB(old, 0);
    }
    to.take(point, 0, from, whole, 0);
    if (shares.size() == 1) return;
    to.advanceOne(point, 0, {opening - from.state(whole, 0).opening, {}});
    to.setElastic(point, 0, opening, stress.a / to.stiffness().shear, stress.b / to.stiffness().shear);
    to.advanceOne(point, 0, {});
}

// Gives a joint other points, which take over its state. Returns the energy that it gets by that [J].
double refine(const JointView& joint, const PointCounts& counts) {
    auto& shapes = *joint.geom->group;
    const int j = joint.geom->index;
    const auto old = pointsOf(*joint.geom);
    SingleJointColumns before(joint, old);
    before.shapes->take(0, shapes, j);
    before.states->take(0, *joint.phys->group, joint.phys->index);
    const auto& from = before.columns();

    SingleJointColumns after(joint, refinedPoints(joint.geom->reference(), counts));
    const auto& coarse = joint.geom->refined().coarse;
    after.shapes->refined[0] = {counts, coarse ? coarse : std::make_shared<const Points>(old)};
    auto& to = after.columns();
    std::vector<std::vector<Share>> shares;
    std::vector<double> areas(old.size(), 0.0); // of the new points, by the old ones
    for (int p = 0; p < after.shapes->points; ++p) {
        shares.push_back(sharesAt(after.shapes->offsetAt(p, 0), old));
        for (const auto& [o, weight] : shares.back())
            areas[o] += weight * after.shapes->areaAt(p, 0);
    }
    for (int p = 0; p < after.shapes->points; ++p) {
        Vector3r jump = Vector3r::Zero(), viscous = Vector3r::Zero();
        Energies lost;
        for (const auto& [o, weight] : shares[p]) {
            jump += weight * before.shapes->jumpAt(o, 0);
            viscous += weight * before.shapes->viscousAt(o, 0);
            const auto e = from.dissipated(o, 0);
            const double part = weight * old[o].area / areas[o];
            lost.tension += part * e.tension;
            lost.shear += part * e.shear;
            lost.compression += part * e.compression;
        }
        follow(to, p, from, shares[p]);
        after.shapes->setJump(p, 0, jump);
        after.shapes->setViscous(p, 0, viscous);
        if (shares[p].size() == 1) after.shapes->setImpact(p, 0, before.shapes->impactAt(shares[p][0].point, 0));
        to.setDissipated(p, 0, lost);
    }
    after.attachTo(joint);
    return after.energy() - before.energy();
}

// What is linear over the face of a joint, by its values at the points.
class LinearOver {
public:
    explicit LinearOver(const JointGeometry& geom) : middle_(geom.offset(0)) {
        Eigen::MatrixXd places(geom.points(), 3);
        for (int p = 0; p < geom.points(); ++p)
            places.row(p) = row(geom.offset(p));
        solver_.compute(places);
    }
    void fit(const std::vector<Vector3r>& values) {
        Eigen::MatrixXd given(values.size(), 3);
        for (std::size_t p = 0; p < values.size(); ++p)
            given.row(p) = values[p].transpose();
        field_ = solver_.solve(given);
    }
    Vector3r at(const Vector3r& offset) const { return (row(offset) * field_).transpose(); }

private:
    Eigen::RowVector3d row(const Vector3r& offset) const { return {1, offset[1] - middle_[1], offset[2] - middle_[2]}; }
    Vector3r middle_;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver_; // points in a row leave one direction open
    Eigen::MatrixXd field_;
};

// Extent of a joint along one of its axes [m].
double ownExtentOf(const JointReference& r, int axis) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const auto& corner : r.polygon()) {
        const double place = r.axes().col(axis).dot(corner);
        low = std::min(low, place);
        high = std::max(high, place);
    }
    return high - low;
}

} // namespace

// ---- where ------------------------------------------------------------------------------------------------------

// Whether points of a joint have the area and the moments of others: with fewer than three along a side they have not.
bool sameMoments(const Points& one, const Points& other) {
    const auto moments = [](const Points& points) {
        Eigen::Matrix3d sums = Eigen::Matrix3d::Zero(); // of 1, b1, b2 with each other
        for (const auto& p : points) {
            const Vector3r arm = p.offset - points[0].offset;
            const Vector3r terms(1, arm[1], arm[2]);
            sums += p.area * terms * terms.transpose();
        }
        return sums;
    };
    return moments(one).isApprox(moments(other), 1e-6);
}

Refinement::Limit::Limit(const JointKind& kind, int wanted) : columns_(kind.states->columns.unsynchronised().get()) {
    const auto& columns = *columns_;
    const auto& p = columns.law().properties();
    const auto& first = kind.shapes->joints[0];
    const auto& coarse = kind.shapes->refined[0].coarse;
    dry_ = !(p.tensileStrength > 0 || p.cohesion > 0);
    if (p.elastic || kind.attached) return;
    const auto now = coarse ? *coarse : pointsOf(kind);
    row_ = isRow(now);
    opens_ = dry_ || columns.column(Role::BondDamage, 0, 0);
    const auto found = [&](int along, int across) {
        const PointCounts counts{along, row_ ? 1 : across};
        const auto then = refinedPoints(first, counts);
        return then.size() > now.size() && sameMoments(now, then) ? counts : PointCounts{};
    };
    if (opens_) {
        const int most = row_ || first.polygon().size() == 4 ? pointsOfOpening : pointsOfFan;
        opened_ = found(wanted ? wanted : most, fewest);
    }
    if (coarse && !dry_) return;
    const int count = wanted ? wanted : row_ ? pointsOfRow : pointsOfSide;
    const auto counts = found(count, count);
    if (!counts.along) return;
    elasticLimit_ = columns.law().compression().elasticLimit;
    cracks_ = (elasticLimit_ == 0 || !row_) && columns.column(Role::BondDamage, 0, 0) && !dry_;
    if (elasticLimit_ == 0 && !cracks_) return;
    yielded_ = counts;
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
    const double squared = a * a + b * b, limit = part * elasticLimit_;
    if (limit > 0 && columns_->law().squaredCapStress(sigma, squared) > limit * limit) return true;
    return cracks_ && (sigma > tension_ || squared > slip_ * slip_) && yields(sigma / part, a / part, b / part);
}

bool Refinement::Limit::yields(double sigma, double a, double b) const {
    const auto f = columns_->yieldingUnder(sigma, {a, b});
    return f.tension > 0 || f.slip > 0;
}

// Whether a point of a joint has lost bond.
bool Refinement::hasCracked(const JointShapes& shapes, int j) {
    for (int p = 0; p < shapes.points && shapes.pointwise[j]; ++p)
        if (const double* damage = shapes.law->column(Role::BondDamage, p, j); damage && *damage > 0) return true;
    return false;
}

// Points of a joint that has reached this part of what opens it, if its bed is compliant.
PointCounts Refinement::countsIfOpening(SceneContents& store, const JointKind& kind, const Limit& limit, double part,
                                        int j) {
    const auto& shapes = *kind.shapes;
    if (!limit.dry() && !hasCracked(shapes, j)) return {};
    const auto& columns = *kind.states->columns.unsynchronised();
    const double k = columns.stiffness().normal;
    const auto stressAt = [&](int p) {
        return shapes.pointwise[j] ? columns.state(p, j).normalStress : k * shapes.intactJumpAt(p, j)[0];
    };
    double force = 0, area = 0, highest = -HUGE_VAL;
    Vector3r middle = Vector3r::Zero(), pressed = Vector3r::Zero();
    for (int p = 0; p < shapes.points; ++p) {
        const double stress = stressAt(p), a = shapes.areaAt(p, j);
        highest = std::max(highest, stress);
        area += a;
        force += a * stress;
        middle += a * shapes.offsetAt(p, j);
        pressed += a * stress * shapes.offsetAt(p, j);
    }
    if (!(force < 0) || highest * area < (1 - part) * force) return {};
    middle /= area;
    const Vector3r lever = pressed / force - middle; // of the force
    double along = 0, across = 0;                    // squares of what opens the joint along and across it
    for (int p = 0; p < shapes.points; ++p) {
        const Vector3r arm = shapes.offsetAt(p, j) - middle;
        along += shapes.areaAt(p, j) * arm[2] * arm[2] * lever[1] * lever[1];
        across += shapes.areaAt(p, j) * arm[1] * arm[1] * lever[2] * lever[2];
    }
    const bool turned = !limit.row() && across > along;
    const auto& r = shapes.joints[j];
    const double height = extentOf(r, 0), closure = -force / area / k; // mean closure [m]
    const int axis = turned ? 2 : 1, few = limit.row() ? fewest : fewest * fewest;
    const bool isEstimated = limit.dry() && shapes.points <= few;
    const auto leansOver = [&](double width) {
        return closure * height * height >= leastLean * r.span()[0] * width * width;
    };
    // The section is at least as wide as the joint, and its width takes a search among all joints.
    if (!points_ && !isEstimated && !leansOver(ownExtentOf(r, axis))) return {};
    if (limit.dry() && isBridged(r)) return {};
    const double width = widthOf(store, r, axis);
    if (!limit.opened().along || (!points_ && !leansOver(width))) {
        auto& estimate = store.loop->overestimate;
        if (isEstimated)
            estimate = std::max(estimate, 1.8 * std::cbrt(closure * (height + r.span()[0]) / (width * width)));
        return {};
    }
    auto counts = limit.opened();
    if (limit.row()) return counts;
    if (turned) std::swap(counts.along, counts.across);
    if (std::min(along, across) > both * both * std::max(along, across))
        counts.along = counts.across = std::min(pointsOfBoth, std::max(counts.along, counts.across));
    return counts;
}

// Extent of the joints of a connected part [m] along an axis of one of them.
double Refinement::extentOf(const JointReference& r, int axis) const {
    for (const auto& side : r.sides)
        if (const auto found = sizes_.find(partOf_[side.body]); found != sizes_.end())
            return found->second.sizes().dot(r.axes().col(axis).cwiseAbs());
    return 0;
}

// Width of a structure [m] along an axis of one of its joints: the extent of the joints without a gap beside it that
// lie in its plane, to half of the distance of its blocks; where a block is a wedge, the extent of the part.
double Refinement::widthOf(const SceneContents& store, const JointReference& r, int axis) {
    const auto place = std::make_pair(r.corners.get(), axis);
    if (const auto known = widths_.find(place); known != widths_.end()) return known->second;
    const auto axes = r.axes();
    const auto boxOf = [&](const Polygon& corners) { // in the axes of the joint
        Eigen::AlignedBox3d box;
        for (const auto& corner : corners)
            box.extend(Vector3r(axes.transpose() * (corner - r.polygon()[0])));
        return box;
    };
    const auto own = boxOf(r.polygon());
    const double gap = 0.1 * own.sizes()[axis], apart = 0.5 * r.span()[0];
    const int other = 3 - axis;
    std::vector<std::pair<double, double>> beside; // stretches along the axis
    for (std::size_t n = 0; n < places_.size(); ++n) {
        const auto& that = places_[n];
        const double parallel = std::abs(that.normal.dot(r.normal));
        if (parallel < leastParallel) continue;
        for (const auto& side : r.sides)
            for (int body : that.bodies)
                if (side.body == body && partOf_[body] >= 0 && parallel < parallelBeds)
                    return widths_[place] = extentOf(r, axis);
        const double rise = 1.001 * apart + 0.5 * that.box.sizes().dot(r.normal.cwiseAbs());
        if (std::abs((that.box.center() - r.polygon()[0]).dot(r.normal)) > rise) continue; // far, whatever its corners
        const auto box = boxOf(store.joints[n].geom->reference().polygon());
        const double common =
            std::min(box.max()[other], own.max()[other]) - std::max(box.min()[other], own.min()[other]);
        if (std::abs(box.center()[0] - own.center()[0]) < apart && common > close * own.sizes()[other])
            beside.emplace_back(box.min()[axis], box.max()[axis]);
    }
    double low = own.min()[axis], high = own.max()[axis];
    std::sort(beside.begin(), beside.end());
    for (const auto& [from, to] : beside)
        if (from <= high + gap) high = to >= low ? std::max(high, to) : high;
    std::sort(beside.begin(), beside.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    for (const auto& [from, to] : beside)
        if (to >= low - gap) low = std::min(low, from);
    return widths_[place] = high - low;
}

// Parts of a scene that hang together by joints and bodies that can move.
void Refinement::readParts(const SceneContents& store) {
    std::vector<int> roots(store.bodies.size());
    std::iota(roots.begin(), roots.end(), 0);
    const auto root = [&](int body) {
        while (roots[body] != body)
            body = roots[body] = roots[roots[body]];
        return body;
    };
    const auto held = [&](int body) { return (store.bodies.blockedAxes(body) & 7) == 7; };
    for (const auto& joint : store.joints) {
        const auto& sides = joint.geom->reference().sides;
        if (!held(sides[0].body) && !held(sides[1].body)) roots[root(sides[0].body)] = root(sides[1].body);
    }
    partOf_.assign(roots.size(), -1);
    sizes_.clear();
    for (const auto& joint : store.joints)
        for (const auto& side : joint.geom->reference().sides) {
            if (held(side.body)) continue;
            const int part = partOf_[side.body] = root(side.body);
            for (const auto& corner : joint.geom->reference().polygon())
                sizes_[part].extend(corner);
        }
    widths_.clear();
    places_.clear();
    bonds_.assign(roots.size(), {});
    for (const auto& joint : store.joints) {
        const auto& r = joint.geom->reference();
        const auto& p = joint.phys->law().properties();
        for (int side = 0; side < 2 && (p.tensileStrength > 0 || p.cohesion > 0); ++side)
            bonds_[r.sides[side].body].emplace_back(r.sides[1 - side].body, joint.geom.get());
        places_.push_back({r.normal, {}, {r.sides[0].body, r.sides[1].body}});
        for (const auto& corner : r.polygon())
            places_.back().box.extend(corner);
    }
    stiffnessRevision_ = store.stiffnessRevision();
}

// Whether both blocks of a dry joint are bonded to a third one, or to two that are bonded to each other, as the halves
// of a brick: head joints without bond turn with bonded beds, also with cracked ones. Those that became contacts do not
// count.
bool Refinement::isBridged(const JointReference& r) const {
    const auto bondedTo = [&](int body) {
        std::set<int> all;
        for (const auto& [other, bond] : bonds_[body])
            if (!bond->converted()) all.insert(other);
        return all;
    };
    const auto other = bondedTo(r.sides[1].body);
    const auto isOfOther = [&](int body) { return other.count(body) > 0; };
    const auto one = bondedTo(r.sides[0].body);
    return std::any_of(one.begin(), one.end(), [&](int body) {
        const auto next = bondedTo(body);
        return isOfOther(body) || std::any_of(next.begin(), next.end(), isOfOther);
    });
}

// Whether a point of a joint has reached this part of the limit, or was beyond it already.
bool Refinement::yields(const JointKind& kind, const Limit& limit, double part, int j) const {
    const auto& shapes = *kind.shapes;
    const auto& columns = *kind.states->columns.unsynchronised();
    for (int p = 0; p < shapes.points && !shapes.pointwise[j]; ++p) {
        const auto& k = columns.stiffness();
        const Vector3r jump = shapes.intactJumpAt(p, j);
        if (limit.isReached(part, k.normal * jump[0], k.shear * jump[1], k.shear * jump[2])) return true;
    }
    for (int p = 0; p < shapes.points && shapes.pointwise[j]; ++p) {
        const double a = *columns.shearStressA(p, j), b = *columns.shearStressB(p, j);
        const double* damage = limit.cracks() ? columns.column(Role::BondDamage, p, j) : nullptr;
        if ((damage && *damage > 0) || *columns.regime(p, j) == Regime::Crushing) return true;
        if (limit.isReached(part, columns.stressIfClosed(p, j), a, b) &&
            limit.isReached(part, columns.state(p, j).normalStress, a, b))
            return true;
    }
    return false;
}

// The points that a joint gets which has reached this part of a limit; none if it keeps those that it has.
PointCounts Refinement::countsIfDue(SceneContents& store, const JointKind& kind, const Limit& limit, double part,
                                    int j) {
    if (kind.shapes->converted[j]) return {};
    const auto now = kind.shapes->refined[j].points;
    auto then = now;
    const auto add = [&](const PointCounts& more) {
        then = {std::max(then.along, more.along), std::max(then.across, more.across)};
    };
    const auto lacks = [&](const PointCounts& more) { return more.along > now.along || more.across > now.across; };
    if (lacks(limit.yielded()) && yields(kind, limit, part, j)) add(limit.yielded());
    if (limit.opens() && (!limit.row() || now.along == 0 || lacks(limit.opened())))
        add(countsIfOpening(store, kind, limit, part, j));
    return then == now ? PointCounts{} : then;
}

void Refinement::readLimits(const SceneContents& store) {
    limits_.clear();
    if (store.stiffnessRevision() != stiffnessRevision_) readParts(store);
    for (const auto& kind : store.kinds)
        limits_.emplace_back(kind, store.loop->points);
    revision_ = store.revision();
    points_ = store.loop->points;
}

bool Refinement::look(SceneContents& store) {
    changed_.clear();
    if (store.revision() != revision_ || store.loop->points != points_) readLimits(store);
    if (store.scene().iter % every != 0) return false;
    std::map<std::pair<const JointShapes*, int>, PointCounts> due; // joints, and the points that they get
    bool any = false;
    for (std::size_t k = 0; k < store.kinds.size(); ++k) {
        const auto& kind = store.kinds[k];
        if (!limits_[k].yielded().along && !limits_[k].opens()) continue;
        for (int j = 0; j < int(kind.shapes->joints.size()); ++j) {
            const auto counts = countsIfDue(store, kind, limits_[k], company, j);
            if (!counts.along) continue;
            due[{kind.shapes.get(), j}] = counts;
            any = any || countsIfDue(store, kind, limits_[k], share, j).along;
        }
    }
    if (!any) return false;
    const auto add = [](Changed& to, double sign) {
        const auto& geom = *to.joint.geom;
        to.forces.reserve(to.forces.size() + geom.points());
        for (int p = 0; p < geom.points(); ++p) {
            const auto s = to.joint.phys->state(p);
            const Vector3r stress =
                Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b) + geom.group->stressBesideLaw(p, geom.index);
            to.forces.push_back({geom.offset(p), sign * geom.area(p) * stress});
        }
    };
    for (const auto& joint : store.joints) { // in the host's order, so that the sum does not depend on addresses
        const auto found = due.find({joint.geom->group.get(), joint.geom->index});
        if (found != due.end()) {
            Changed change{joint, {}, {}};
            add(change, 1);
            store.loop->refiningEnergy += refine(joint, found->second);
            add(change, -1);
            for (int p = 0; p < joint.geom->points(); ++p)
                change.jumps.push_back(joint.geom->jump(p));
            changed_.push_back(std::move(change));
        }
    }
    return true;
}

void Refinement::count(SceneContents& store) {
    for (const auto& change : changed_) {
        const auto& geom = *change.joint.geom;
        std::vector<Vector3r> moved;
        for (int p = 0; p < geom.points(); ++p)
            moved.push_back(geom.jump(p) - change.jumps[p]);
        LinearOver jump(geom);
        jump.fit(moved);
        for (const auto& [place, force] : change.forces)
            store.loop->refiningEnergy -= 0.5 * force.dot(jump.at(place));
    }
    changed_.clear();
}

bool Refinement::setPoints(SceneContents& store, const std::vector<PointCounts>& refined) {
    std::vector<std::pair<const JointView*, PointCounts>> change; // joints and their new numbers of points
    for (std::size_t n = 0; n < store.joints.size(); ++n) {
        const auto& joint = store.joints[n];
        const auto counts = refined[n];
        if (counts == joint.geom->refined().points) continue;
        const auto fit = [](int count) { return count >= fewest && count <= most; };
        const bool row = isRow(pointsOf(*joint.geom));
        const bool fits =
            counts == PointCounts{} || (fit(counts.along) && (row ? counts.across == 1 : fit(counts.across)));
        if (!fits || joint.geom->reference().attached) return false;
        change.emplace_back(&joint, counts);
    }
    for (const auto& [joint, counts] : change) {
        const auto& coarse = joint->geom->refined().coarse;
        const auto first = coarse ? coarse : std::make_shared<const Points>(pointsOf(*joint->geom));
        const SingleJointColumns fresh(*joint, counts.along ? refinedPoints(joint->geom->reference(), counts) : *first);
        fresh.shapes->refined[0] = {counts, counts.along ? first : nullptr};
        fresh.shapes->scene = joint->geom->group->scene;
        fresh.shapes->settled = true;
        fresh.attachTo(*joint);
    }
    return true;
}

} // namespace masonry
