// SPDX-License-Identifier: GPL-2.0-or-later
#include "CriticalTimeStep.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/bodies/BodyStep.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/contacts/Contacts.hpp"
#include "engine/store/SceneStore.hpp"
#include "engine/units/Zones.hpp"
#include "motion/LargestEigenvalue.hpp"
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>

namespace masonry {

using yade::Matrix3r;
using yade::State;

namespace {

// The stages of a run ask again and again for the limit of the same bricks: the bounds of the largest eigenvalue that
// were found last, by the content of the matrices [1/s²].
struct FoundBounds {
    std::deque<std::pair<std::uint64_t, double>> found;
};

// Stiffness over mass of a scene: the operator S^T K S with S = sqrt(1 / M). Where masses of deformable units are
// scaled, S = sqrt(1 / M) (Q + (I - Q) / sqrt(1 + s)), in which Q projects on the rigid motions of the blocks, and a
// further part for those of cracked bricks: then S S^T is the inverse of the scaled masses (blocks/BlockLanes.hpp). The
// degrees of freedom are three of every node and six of every rigid body that has a joint; those that are blocked are
// left out. Damping divides every damped mass by 1 + alpha. The two parts of every brick that can crack move against
// each other: bricks do crack during a run, whose time step stays, and one that moves as a whole has no higher
// eigenvalues, because its masses are larger.
class Dynamics {
public:
    enum Damping { Each, AsIfAllWereDamped }; // by its own alpha, or by the largest
    Dynamics(SceneStore&, Damping);

    // The largest eigenvalue, at most 2.1 % above it [1/s²].
    double highest() const;
    // The two bodies whose joint has most of the elastic energy of the highest mode, or twice the body of the unit that
    // has.
    std::pair<int, int> stiffest() const;

private:
    // A joint between rigid bodies, one subcontact of a joint with a deformable side, or a connector.
    struct Part {
        std::vector<int> degrees; // the degrees of freedom on which it acts
        Eigen::MatrixXd stiffness;
        int body1, body2;
    };
    struct Scaled { // a block whose masses are scaled
        Zones::Block block;
        std::vector<int> degrees, rows; // degrees of freedom that can move, and their rows among those of the block
        std::vector<double> roots;      // of their masses
        // Rigid motions of the block, and of its parts if they move against each other, times the roots of the masses:
        // orthonormal columns.
        Eigen::MatrixXd whole, parts;
        Eigen::MatrixXd moving(const Eigen::MatrixXd& motions) const; // such columns of these motions
    };
    void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
    void slow(Eigen::VectorXd& x) const; // multiplies by what stands beside sqrt(1 / M)
    std::vector<bool> moves() const;
    void addDegree(double mass, double damping, bool blocked) {
        scale_.push_back(blocked ? 0 : std::sqrt(1 / mass));
        damping_.push_back(damping);
    }
    void addBody(int id, const char* holder);
    void addBodies(const JointView&);
    void splitDamping(Damping);
    template <class F> void eachPartOf(const JointView&, F&& visit) const;
    Part partOf(const Connectors&, int connector) const;
    template <class F> void eachPart(F&& visit) const;
    void assemble();
    void addBlocks();

    SceneStore& store_;
    std::vector<double> scale_, damping_; // of a degree of freedom: sqrt(1 / mass), 0 where it is blocked; and alpha
    double common_ = 1;                   // a factor 1 + alpha of all that moves, which is not in `scale_`
    std::map<int, int> firstOfBody_;      // first degree of freedom of a rigid body
    Eigen::SparseMatrix<double, Eigen::RowMajor> matrix_; // stiffness, scaled from both sides
    std::vector<Scaled> blocks_;
    double slowness_ = 1, slownessOfParts_ = 1; // 1 / sqrt(1 + s), also of parts of a brick against each other
};

Dynamics::Dynamics(SceneStore& store, Damping damping) : store_(store) {
    if (store.zones)
        for (const auto& unit : store.zones->units())
            for (double mass : unit.elasticity->masses())
                for (int d = 0; d < 3; ++d)
                    addDegree(mass, store.zones->damping, store.zones->holds(d));
    for (const auto& joint : store.joints)
        addBodies(joint);
    for (const auto* connectors : store.connectors)
        for (const auto* ids : {&connectors->bodies1, &connectors->bodies2})
            for (int id : *ids)
                if (id != Connectors::ground) addBody(id, "a connector holds body");
    splitDamping(damping);
    assemble();
    addBlocks();
}

void Dynamics::addBody(int id, const char* holder) {
    const auto& body = bodyAt(store_.scene(), id, holder);
    if (!firstOfBody_.emplace(body.id, int(scale_.size())).second) return;
    if (const auto wrong = problemsOf(body); !wrong.empty()) throw std::invalid_argument(joined(wrong));
    const State& s = *body.state;
    for (int d = 0; d < 6; ++d)
        addDegree(d < 3 ? s.mass : s.inertia[d - 3], s.isDamped ? store_.damping() : 0, isBlocked(s, d));
}

void Dynamics::addBodies(const JointView& joint) {
    const auto& r = joint.geom->reference();
    if (r.attached && r.attached->zones.get() != store_.zones)
        throw std::invalid_argument("the joint of bodies " + std::to_string(r.sides[0].body) + " and " +
                                    std::to_string(r.sides[1].body) + " needs its " + nameOf(ClassRole::Units) +
                                    " in O.engines, and not dead");
    for (int side = 0; side < 2; ++side)
        if (r.rigid(side)) addBody(r.sides[side].body, "a joint holds body");
}

// Where damping is the same everywhere, the matrix without it is the same for every damping.
void Dynamics::splitDamping(Damping damping) {
    double least = HUGE_VAL, most = 0;
    for (std::size_t i = 0; i < scale_.size(); ++i) {
        if (scale_[i] == 0) continue;
        least = std::min(least, damping_[i]);
        most = std::max(most, damping_[i]);
    }
    if (damping == AsIfAllWereDamped || !(least < most)) {
        common_ = 1 + most;
        return;
    }
    for (std::size_t i = 0; i < scale_.size(); ++i)
        scale_[i] *= std::sqrt(1 + damping_[i]);
}

template <class F> void Dynamics::eachPartOf(const JointView& joint, F&& visit) const {
    const auto& geom = *joint.geom;
    const auto& r = geom.reference();
    const Matrix3r axes = r.axes();
    Part part{{}, {}, r.sides[0].body, r.sides[1].body};
    for (int p = 0; p < geom.points(); ++p) {
        part.degrees.clear();
        std::vector<Vector3r> rows; // derivative of the jump by each of these degrees of freedom
        const auto add = [&](int degree, const Vector3r& moved) {
            if (scale_[degree] == 0) return;
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
            const auto& body = bodyAt(store_.scene(), r.sides[side].body, "a joint holds body");
            const State& s = *body.state;
            const int first = firstOfBody_.at(body.id);
            const Matrix3r own = rotationRestrained(s) ? Matrix3r(Matrix3r::Identity()) : s.ori.toRotationMatrix();
            const Vector3r arm = geom.centre(p) - r.sides[side].position;
            for (int d = 0; d < 6; ++d)
                add(first + d, sign * (d < 3 ? Vector3r(Vector3r::Unit(d)) : own.col(d - 3).cross(arm)));
        }
        const auto& stiffness = joint.phys->stiffness();
        const Vector3r k = geom.area(p) * Vector3r(stiffness.normal, stiffness.shear, stiffness.shear);
        if (r.attached || p == 0) part.stiffness.setZero(rows.size(), rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j < rows.size(); ++j)
                part.stiffness(i, j) += rows[i].dot(k.cwiseProduct(rows[j]));
        if (r.attached || p + 1 == geom.points()) visit(part);
    }
}

Dynamics::Part Dynamics::partOf(const Connectors& connectors, int connector) const {
    const auto c = std::size_t(connector);
    Part part{{}, {}, connectors.bodies1[c], connectors.bodies2[c]};
    std::vector<Vector3r> moved, turned; // derivatives of the relative motion of both ends
    for (int end = 0; end < 2; ++end) {
        const int id = (end ? connectors.bodies2 : connectors.bodies1)[c];
        if (id == Connectors::ground) continue;
        const State& s = *bodyAt(store_.scene(), id, "a connector holds body").state;
        const int first = firstOfBody_.at(id);
        const Matrix3r own = rotationRestrained(s) ? Matrix3r(Matrix3r::Identity()) : s.ori.toRotationMatrix();
        const Vector3r point = (end ? connectors.points2 : connectors.points1)[c];
        const Vector3r arm = s.ori * (s.refOri.conjugate() * (point - s.refPos));
        const double sign = end ? 1 : -1;
        for (int d = 0; d < 6; ++d) {
            if (scale_[first + d] == 0) continue;
            part.degrees.push_back(first + d);
            moved.push_back(sign * (d < 3 ? Vector3r(Vector3r::Unit(d)) : Vector3r(own.col(d - 3).cross(arm))));
            turned.push_back(d < 3 ? Vector3r(Vector3r::Zero()) : Vector3r(sign * own.col(d - 3)));
        }
    }
    const Vector3r k = connectors.stiffnessOf(connector), turning = connectors.rotationalStiffnessOf(connector);
    part.stiffness.setZero(moved.size(), moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i)
        for (std::size_t j = 0; j < moved.size(); ++j)
            part.stiffness(i, j) =
                moved[i].dot(k.cwiseProduct(moved[j])) + turned[i].dot(turning.cwiseProduct(turned[j]));
    return part;
}

// Calls `visit(body1, body2, degree1, degree2, stiffness)` for all entries of the stiffness matrices of joints and
// connectors and units.
template <class F> void Dynamics::eachPart(F&& visit) const {
    const auto visitAll = [&](const Part& part) {
        for (std::size_t i = 0; i < part.degrees.size(); ++i)
            for (std::size_t j = 0; j < part.degrees.size(); ++j)
                visit(part.body1, part.body2, part.degrees[i], part.degrees[j], part.stiffness(i, j));
    };
    for (const auto& joint : store_.joints)
        eachPartOf(joint, visitAll);
    for (const auto* connectors : store_.connectors)
        for (int c = 0; c < connectors->count(); ++c)
            visitAll(partOf(*connectors, c));
    if (!store_.zones) return;
    for (const auto& unit : store_.zones->units()) {
        const auto matrix = unit.elasticity->matrix();
        const int first = 3 * unit.firstNode;
        for (int r = 0; r < matrix.rowCount; ++r)
            for (int e = matrix.rows[r].first; e < matrix.rows[r].beyond; ++e)
                visit(unit.body, unit.body, first + matrix.rows[r].degree, first + matrix.columns[e], matrix.values[e]);
    }
}

void Dynamics::assemble() {
    const auto size = Eigen::Index(scale_.size());
    matrix_.resize(size, size);
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&] {
        Eigen::SparseMatrix<double, Eigen::RowMajor> some(size, size);
        some.setFromTriplets(entries.begin(), entries.end());
        matrix_ += some;
        entries.clear();
    };
    constexpr std::size_t many = 2000000; // more would take more memory than the matrix
    eachPart([&](int, int, int row, int column, double stiffness) {
        const double value = scale_[row] * stiffness * scale_[column];
        if (value == 0) return;
        entries.emplace_back(row, column, value);
        if (entries.size() == many) add();
    });
    add();
}

void Dynamics::addBlocks() {
    if (!store_.zones || store_.zones->massScaling == 0) return;
    slowness_ = 1 / std::sqrt(1 + store_.zones->massScaling);
    slownessOfParts_ = 1 / std::sqrt(1 + sharedScaling * store_.zones->massScaling);
    for (const auto& block : store_.zones->blocks()) {
        Scaled made{block, {}, {}, {}, {}, {}};
        int row = 0;
        for (const auto* unit : block.units) {
            const auto& masses = unit->elasticity->masses();
            for (int i = 0; i < 3 * int(masses.size()); ++i, ++row) {
                const int degree = 3 * unit->firstNode + i;
                if (scale_[degree] == 0) continue;
                made.degrees.push_back(degree);
                made.rows.push_back(row);
                made.roots.push_back(std::sqrt(masses[i / 3]));
            }
        }
        made.whole = made.moving(store_.zones->rigidMotions(block.units));
        if (block.units.size() > 1) made.parts = made.moving(store_.zones->motionsOfParts(block));
        blocks_.push_back(std::move(made));
    }
}

Eigen::MatrixXd Dynamics::Scaled::moving(const Eigen::MatrixXd& motions) const {
    Eigen::MatrixXd found(rows.size(), motions.cols());
    for (std::size_t i = 0; i < rows.size(); ++i)
        found.row(i) = roots[i] * motions.row(rows[i]);
    return found;
}

void Dynamics::slow(Eigen::VectorXd& x) const {
    Eigen::VectorXd own, amounts, moved;
    for (const auto& block : blocks_) {
        own.resize(Eigen::Index(block.degrees.size()));
        for (std::size_t i = 0; i < block.degrees.size(); ++i)
            own[i] = x[block.degrees[i]];
        // Q x + slowness (x - Q x), and beside it that of the parts
        const bool apart = block.parts.size() > 0;
        amounts.noalias() = block.whole.transpose() * own;
        amounts *= apart ? 1 - slownessOfParts_ : 1 - slowness_;
        moved.noalias() = block.whole * amounts;
        moved += slowness_ * own;
        if (apart) {
            amounts.noalias() = block.parts.transpose() * own;
            amounts *= slownessOfParts_ - slowness_;
            moved.noalias() += block.parts * amounts;
        }
        for (std::size_t i = 0; i < block.degrees.size(); ++i)
            x[block.degrees[i]] = moved[Eigen::Index(i)];
    }
}

void Dynamics::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    if (blocks_.empty()) {
        y.noalias() = matrix_ * x;
        return;
    }
    Eigen::VectorXd slowed = x;
    slow(slowed);
    y.noalias() = matrix_ * slowed;
    slow(y);
}

std::vector<bool> Dynamics::moves() const {
    std::vector<bool> found;
    for (double scale : scale_)
        found.push_back(scale != 0);
    return found;
}

double Dynamics::highest() const {
    std::uint64_t content = 1469598103934665603u; // FNV-1a, a number at a time
    const auto add = [&](std::uint64_t number) {
        content = (content ^ number) * 1099511628211u;
        content ^= content >> 32;
    };
    const auto mix = [&](const double* numbers, Eigen::Index count) {
        for (Eigen::Index i = 0; i < count; ++i) {
            std::uint64_t number;
            std::memcpy(&number, numbers + i, sizeof number);
            add(number);
        }
    };
    mix(scale_.data(), Eigen::Index(scale_.size()));
    mix(matrix_.valuePtr(), matrix_.nonZeros());
    for (Eigen::Index e = 0; e < matrix_.nonZeros(); ++e)
        add(std::uint64_t(matrix_.innerIndexPtr()[e]));
    for (const auto& block : blocks_) {
        mix(block.whole.data(), block.whole.size());
        mix(block.parts.data(), block.parts.size());
    }
    const double slowness[2] = {slowness_, slownessOfParts_};
    mix(slowness, 2);
    auto& found = store_.kept<FoundBounds>().found;
    for (const auto& [known, bound] : found)
        if (known == content) return common_ * bound;
    const auto bound =
        largestEigenvalue(moves(), [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { multiply(x, y); });
    found.emplace_front(content, bound);
    if (found.size() > 8) found.pop_back();
    return common_ * bound;
}

std::pair<int, int> Dynamics::stiffest() const {
    Eigen::VectorXd motion = highMode(moves(), [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { multiply(x, y); });
    slow(motion);
    for (std::size_t i = 0; i < scale_.size(); ++i)
        motion[Eigen::Index(i)] *= scale_[i];
    std::map<std::pair<int, int>, double> energies;
    eachPart([&](int body1, int body2, int row, int column, double stiffness) {
        energies[{body1, body2}] += motion[row] * stiffness * motion[column];
    });
    const auto most = std::max_element(energies.begin(), energies.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == energies.end() ? std::pair(-1, -1) : most->first;
}

// The largest eigenvalue without contacts of a scene that is kept, and what it was found for.
struct KnownEigenvalue {
    long revision = -1;
    double damping = 0, zoneDamping = 0, massScaling = 0;
    double connectors = 0; // sum of their stiffness
    double value = 0;      // [1/s²]
    bool isForSame(const KnownEigenvalue& o) const {
        return revision == o.revision && damping == o.damping && zoneDamping == o.zoneDamping &&
               massScaling == o.massScaling && connectors == o.connectors;
    }
};

constexpr double growth = 1.1; // of the time step that follows the state: less is not worth a change

// The time step at which a motion of this eigenvalue is on the verge of being unstable [s].
double stepOf(double eigenvalue, double stiffnessDamping) {
    if (!(eigenvalue > 0)) return HUGE_VAL;
    const double dt = 2 / std::sqrt(eigenvalue);
    const double ratio = stiffnessDamping / dt; // of the damping of the highest mode to the critical one
    return dt * (std::sqrt(1 + ratio * ratio) - ratio);
}

} // namespace

double timeStepLimit(SceneStore& store, bool anew) {
    double stiffnessOfConnectors = 0;
    for (const auto* connectors : store.connectors)
        for (int c = 0; c < connectors->count(); ++c)
            stiffnessOfConnectors += connectors->stiffnessOf(c).sum() + connectors->rotationalStiffnessOf(c).sum();
    auto& known = store.kept<KnownEigenvalue>();
    KnownEigenvalue now{store.stiffnessRevision(), store.damping(), store.zones ? store.zones->damping : 0,
                        store.zones ? store.zones->massScaling : 0, stiffnessOfConnectors};
    const auto limit = [&] {
        double all = now.value;
        for (auto* one : store.contacts)
            all = one->largestEigenvalue(store, all, now.damping, anew);
        return stepOf(all, store.stiffnessDamping());
    };
    if (!anew && now.isForSame(known)) {
        now = known;
        return limit();
    }
    // A bound that does not depend on which of the bodies are damped is enough if it is kept to.
    if (!anew) now.value = Dynamics(store, Dynamics::AsIfAllWereDamped).highest();
    if (anew || !(store.scene().dt <= limit())) now.value = Dynamics(store, Dynamics::Each).highest();
    known = now;
    return limit();
}

void beginFollowing(SceneStore& store) {
    for (auto* one : store.contacts)
        one->boundPairs(store, store.damping());
    const double limit = timeStepLimit(store, true);
    for (auto* one : store.contacts) {
        one->jointEigenvalue = store.kept<KnownEigenvalue>().value;
        if (one->stepShare > 0) store.scene().dt = one->stepShare * limit;
    }
}

// New pairs are near each other, or press as their joint did, so the step that found them was not too long.
void followTimeStep(SceneStore& store) {
    for (auto* one : store.contacts) {
        if (!(one->stepShare > 0)) continue;
        one->boundPairs(store, store.damping());
        const double all = one->largestEigenvalue(store, one->jointEigenvalue, store.damping(), false);
        const double wanted = one->stepShare * stepOf(all, store.stiffnessDamping());
        double& dt = store.scene().dt;
        if (dt > wanted || growth * dt < wanted) dt = wanted;
    }
}

std::pair<int, int> limitingBodies(SceneStore& store) { return Dynamics(store, Dynamics::Each).stiffest(); }

std::string describedLimit(SceneStore& store) {
    std::string what = "the time step is " + text(store.scene().dt) + " s";
    double limit = HUGE_VAL;
    int id1 = -1, id2 = -1;
    try {
        limit = timeStepLimit(store, true);
        std::tie(id1, id2) = limitingBodies(store);
    } catch (const std::invalid_argument&) { // of bodies whose numbers are not finite nothing is known any more
        limit = timeStepLimit(store, false);
    }
    if (!std::isfinite(limit)) return what;
    what += ", its limit " + text(limit) + " s";
    if (id1 < 0) return what;
    what += ", which ";
    if (id1 == id2) return what + "unit " + std::to_string(id1) + " sets";
    std::string name;
    for (const auto& joint : store.joints)
        if (joint.interaction->id1 == id1 && joint.interaction->id2 == id2) name = joint.phys->propertySet()->name;
    if (name.empty() && id2 == Connectors::ground)
        return what + "the connector of body " + std::to_string(id1) + " to the ground sets";
    if (name.empty())
        return what + "the connector of bodies " + std::to_string(id1) + " and " + std::to_string(id2) + " sets";
    return what + "joint \"" + name + "\" between bodies " + std::to_string(id1) + " and " + std::to_string(id2) +
           " sets";
}

} // namespace masonry
