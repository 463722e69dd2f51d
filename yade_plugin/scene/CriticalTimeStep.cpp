// SPDX-License-Identifier: GPL-2.0-or-later
#include "CriticalTimeStep.hpp"
#include "BodyCheck.hpp"
#include "BodyStep.hpp"
#include "SceneStore.hpp"
#include "Zones.hpp"
#include "motion/LargestEigenvalue.hpp"
#include <algorithm>
#include <map>

namespace masonry {

using yade::Matrix3r;
using yade::State;

namespace {

// Stiffness over mass of a scene: the operator S^T K S with S = sqrt((1 + alpha) / M), as a sum over joints and
// deformable units. Where masses of deformable units are scaled, S = sqrt((1 + alpha) / M) (Q + (I - Q) / sqrt(1 + s)),
// in which Q projects on the rigid motions of the blocks, and a further part for those of cracked bricks: then
// S S^T / (1 + alpha) is the inverse of the scaled masses (blocks/BlockLanes.hpp). The degrees of freedom are three of
// every node and six of every rigid body that has a joint; those that are blocked are left out.
class Dynamics {
public:
    // With `allSplit` the two parts of every brick that could crack move against each other (blocks/BlockLanes.hpp).
    Dynamics(SceneStore&, bool allSplit);

    // Whether there are bricks with scaled masses whose parts move as one, but need not for ever.
    bool mayCrack() const {
        return std::any_of(blocks_.begin(), blocks_.end(), [](const Scaled& b) { return b.mayCrack; });
    }
    std::vector<bool> moves; // whether a degree of freedom can move, that is, is not blocked
    void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
    // The bodies of the joint that has most of a mode's elastic energy, or twice the body of the unit that has.
    std::pair<int, int> stiffest(const Eigen::VectorXd& mode) const;

private:
    struct Joint {                // a joint between rigid bodies, or one subcontact of a joint with a deformable side
        std::vector<int> degrees; // the degrees of freedom on which it acts
        Eigen::MatrixXd stiffness;
        int body1, body2;
    };
    struct Scaled { // a block whose masses are scaled
        std::vector<int> degrees;
        // Rigid motions of the block, and of its parts if they move against each other, times the roots of the masses:
        // orthonormal columns.
        Eigen::MatrixXd whole, parts;
        bool mayCrack;
    };
    void slow(Eigen::VectorXd& x) const;                    // multiplies by what stands beside sqrt((1 + alpha) / M)
    Eigen::VectorXd scaled(const Eigen::VectorXd& x) const; // S x
    struct Unit {                                           // a deformable unit
        BlockMatrix matrix;
        int first; // its first degree of freedom
        int body;
    };
    void addDegree(double mass, double damping, bool blocked) {
        moves.push_back(!blocked);
        scale_.push_back(blocked ? 0 : std::sqrt((1 + damping) / mass));
    }
    void addJoint(const SceneStore&, const JointView&);
    // Calls `visit(body1, body2, degree, force)` for every degree of freedom of every joint and unit, with the force
    // that the joint or unit has there under these displacements.
    template <class F> void eachForce(const Eigen::VectorXd& motion, F&& visit) const;

    std::vector<double> scale_;      // sqrt((1 + alpha) / mass) of a degree of freedom; 0 where it is blocked
    std::map<int, int> firstOfBody_; // first degree of freedom of a rigid body
    std::vector<Joint> joints_;
    std::vector<Unit> units_;
    std::vector<Scaled> blocks_;
    double slowness_ = 1, slownessOfParts_ = 1; // 1 / sqrt(1 + s), also of parts of a brick against each other
};

Dynamics::Dynamics(SceneStore& store, bool allSplit) {
    if (store.zones)
        for (const auto& unit : store.zones->units()) {
            units_.push_back({unit.elasticity->matrix(), 3 * unit.firstNode, unit.body});
            for (double mass : unit.elasticity->masses())
                for (int d = 0; d < 3; ++d)
                    addDegree(mass, store.zones->damping, store.zones->holds(d));
        }
    if (store.zones && store.zones->massScaling > 0) {
        slowness_ = 1 / std::sqrt(1 + store.zones->massScaling);
        slownessOfParts_ = 1 / std::sqrt(1 + sharedScaling * store.zones->massScaling);
        for (const auto& block : store.zones->blocks()) {
            const bool apart = block.units.size() > 1 && (allSplit || block.split);
            Scaled made{{}, store.zones->rigidMotions(block.units), {}, block.units.size() > 1 && !apart};
            if (apart) made.parts = store.zones->motionsOfParts(block);
            for (const auto* unit : block.units)
                for (std::size_t n = 0; n < unit->elasticity->masses().size(); ++n)
                    for (int d = 0; d < 3; ++d) {
                        const auto row = Eigen::Index(made.degrees.size());
                        const double root = std::sqrt(unit->elasticity->masses()[n]);
                        made.whole.row(row) *= root;
                        if (apart) made.parts.row(row) *= root;
                        made.degrees.push_back(3 * (unit->firstNode + int(n)) + d);
                    }
            blocks_.push_back(std::move(made));
        }
    }
    for (const auto& joint : store.joints)
        addJoint(store, joint);
}

void Dynamics::addJoint(const SceneStore& store, const JointView& joint) {
    const auto& geom = *joint.geom;
    const auto& r = geom.reference();
    if (r.attached && r.attached->zones.get() != store.zones)
        throw std::invalid_argument("the joint of bodies " + std::to_string(r.sides[0].body) + " and " +
                                    std::to_string(r.sides[1].body) +
                                    " needs its MasonryZones in O.engines, and not dead");
    const Matrix3r axes = r.axes();
    for (int p = 0; p < geom.points(); ++p) {
        Joint part{{}, {}, r.sides[0].body, r.sides[1].body};
        std::vector<Vector3r> rows; // derivative of the jump by each of these degrees of freedom
        const auto add = [&](int degree, const Vector3r& moved) {
            if (!moves[degree]) return;
            part.degrees.push_back(degree);
            rows.push_back(axes.transpose() * moved);
        };
        for (int side = 0; side < 2; ++side) {
            const double sign = side ? 1 : -1;
            if (!r.rigid(side)) {
                const auto& a = r.attached->sides[side][p];
                for (int n = 0; n < 3; ++n)
                    for (int d = 0; a.weights[n] != 0 && d < 3; ++d)
                        add(3 * a.nodes[n] + d, sign * a.weights[n] * Vector3r::Unit(d));
                continue;
            }
            const auto& body = bodyAt(store.scene(), r.sides[side].body, "a joint holds body");
            const State& s = *body.state;
            const auto [first, fresh] = firstOfBody_.emplace(body.id, int(moves.size()));
            if (fresh)
                if (const auto wrong = problemsOf(body); !wrong.empty()) throw std::invalid_argument(joined(wrong));
            for (int d = 0; fresh && d < 6; ++d)
                addDegree(d < 3 ? s.mass : s.inertia[d - 3], s.isDamped ? store.damping() : 0, isBlocked(s, d));
            const Matrix3r own = rotationRestrained(s) ? Matrix3r(Matrix3r::Identity()) : s.ori.toRotationMatrix();
            const Vector3r arm = geom.centre(p) - r.sides[side].position;
            for (int d = 0; d < 6; ++d)
                add(first->second + d, sign * (d < 3 ? Vector3r(Vector3r::Unit(d)) : own.col(d - 3).cross(arm)));
        }
        const auto& stiffness = joint.phys->stiffness();
        const Vector3r k = geom.area(p) * Vector3r(stiffness.normal, stiffness.shear, stiffness.shear);
        part.stiffness.resize(rows.size(), rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j < rows.size(); ++j)
                part.stiffness(i, j) = rows[i].dot(k.cwiseProduct(rows[j]));
        if (r.attached || p == 0)
            joints_.push_back(std::move(part));
        else
            joints_.back().stiffness += part.stiffness;
    }
}

template <class F> void Dynamics::eachForce(const Eigen::VectorXd& motion, F&& visit) const {
    for (const auto& joint : joints_)
        for (std::size_t i = 0; i < joint.degrees.size(); ++i) {
            double force = 0;
            for (std::size_t j = 0; j < joint.degrees.size(); ++j)
                force += joint.stiffness(j, i) * motion[joint.degrees[j]];
            visit(joint.body1, joint.body2, joint.degrees[i], force);
        }
    for (const auto& unit : units_)
        for (int r = 0; r < unit.matrix.rowCount; ++r) {
            const auto& row = unit.matrix.rows[r];
            double force = 0;
            for (int e = row.first; e < row.beyond; ++e)
                force += unit.matrix.values[e] * motion[unit.first + unit.matrix.columns[e]];
            visit(unit.body, unit.body, unit.first + row.degree, force);
        }
}

void Dynamics::slow(Eigen::VectorXd& x) const {
    Eigen::VectorXd own;
    for (const auto& block : blocks_) {
        own.resize(Eigen::Index(block.degrees.size()));
        for (std::size_t i = 0; i < block.degrees.size(); ++i)
            own[i] = x[block.degrees[i]];
        Eigen::VectorXd rigid = block.whole * (block.whole.transpose() * own);
        Eigen::VectorXd slowed = rigid + slowness_ * (own - rigid);
        if (block.parts.size() > 0)
            slowed += (slownessOfParts_ - slowness_) * (block.parts * (block.parts.transpose() * own) - rigid);
        for (std::size_t i = 0; i < block.degrees.size(); ++i)
            x[block.degrees[i]] = slowed[Eigen::Index(i)];
    }
}

Eigen::VectorXd Dynamics::scaled(const Eigen::VectorXd& x) const {
    Eigen::VectorXd slowed = x;
    slow(slowed);
    return Eigen::Map<const Eigen::VectorXd>(scale_.data(), Eigen::Index(scale_.size())).cwiseProduct(slowed);
}

void Dynamics::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    const Eigen::Map<const Eigen::VectorXd> scale(scale_.data(), Eigen::Index(scale_.size()));
    y.setZero();
    eachForce(scaled(x), [&](int, int, int degree, double force) { y[degree] += force; });
    y.array() *= scale.array();
    slow(y);
}

std::pair<int, int> Dynamics::stiffest(const Eigen::VectorXd& mode) const {
    const Eigen::VectorXd motion = scaled(mode);
    std::map<std::pair<int, int>, double> energies;
    eachForce(motion, [&](int body1, int body2, int degree, double force) {
        energies[{body1, body2}] += motion[degree] * force;
    });
    const auto most = std::max_element(energies.begin(), energies.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == energies.end() ? std::pair(-1, -1) : most->first;
}

// What the limit that is kept was found for.
struct Known {
    const SceneStore* store = nullptr;
    long revision = -1;
    double damping = 0, zoneDamping = 0, stiffnessDamping = 0, massScaling = 0;
    bool operator==(const Known& o) const {
        return store == o.store && revision == o.revision && damping == o.damping && zoneDamping == o.zoneDamping &&
               stiffnessDamping == o.stiffnessDamping && massScaling == o.massScaling;
    }
};

} // namespace

TimeStepLimit timeStepLimit(SceneStore& store, bool anew) {
    static Known known;
    static TimeStepLimit last;
    const Known now{&store,
                    store.revision(),
                    store.damping(),
                    store.zones ? store.zones->damping : 0,
                    store.stiffnessDamping(),
                    store.zones ? store.zones->massScaling : 0};
    if (!anew && now == known) return last;
    last = {HUGE_VAL, -1, -1};
    const auto lower = [&](const Dynamics& dynamics) {
        const auto highest = largestEigenvalue(
            dynamics.moves, [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { dynamics.multiply(x, y); });
        double dt = highest.bound > 0 ? 2 / std::sqrt(highest.bound) : HUGE_VAL;
        const double ratio = now.stiffnessDamping / dt; // of the damping of the highest mode to the critical one
        dt *= std::sqrt(1 + ratio * ratio) - ratio;
        if (!(dt < last.dt)) return;
        last.dt = dt;
        std::tie(last.id1, last.id2) = dynamics.stiffest(highest.mode);
    };
    const Dynamics present(store, false);
    lower(present);
    if (present.mayCrack()) lower(Dynamics(store, true)); // bricks crack during the run, whose time step stays
    known = now;
    return last;
}

std::string described(const SceneStore& store, const TimeStepLimit& limit) {
    std::string what = "the time step is " + text(store.scene().dt) + " s";
    if (limit.id1 < 0) return what;
    what += ", its limit " + text(limit.dt) + " s, which ";
    if (limit.id1 == limit.id2) return what + "unit " + std::to_string(limit.id1) + " sets";
    std::string name;
    for (const auto& joint : store.joints)
        if (joint.interaction->id1 == limit.id1 && joint.interaction->id2 == limit.id2)
            name = joint.phys->propertySet()->name;
    return what + "joint \"" + name + "\" between bodies " + std::to_string(limit.id1) + " and " +
           std::to_string(limit.id2) + " sets";
}

} // namespace masonry
