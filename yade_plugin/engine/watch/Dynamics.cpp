// SPDX-License-Identifier: GPL-2.0-or-later
#include "Dynamics.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/bodies/Load.hpp"
#include "engine/connectors/Connectors.hpp"
#include "motion/LargestEigenvalue.hpp"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>

namespace masonry {

using yade::Matrix3r;
using yade::State;

namespace {

// The stages of a run ask again and again for the limit of the same bricks: the bounds of the largest eigenvalue that
// were found last, by the content of the matrices [1/s²].
struct FoundBounds {
    std::deque<std::pair<std::uint64_t, double>> found;
};

} // namespace

Dynamics::Dynamics(SceneStore& store, Damping damping, Machines machines) : store_(store), machines_(machines) {
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
    for (const auto* load : store.loads)
        if (hasMachine(*load)) addBody(load->body, "a testing machine loads body");
    splitDamping(damping);
    assemble();
    addBlocks();
}

bool Dynamics::hasMachine(const Load& load) const {
    return (load.engaged || machines_ == All) && !load.machineStiffness().isZero(0);
}

void Dynamics::addBody(int id, const char* holder) {
    const auto& body = bodyAt(store_.scene(), id, holder);
    if (!firstOfBody_.emplace(body.id, int(scale_.size())).second) return;
    if (const auto wrong = problemsOf(body); !wrong.empty()) throw std::invalid_argument(joined(wrong));
    const State& s = *body.state;
    const double factor = store_.inertiaFactor(id);
    for (int d = 0; d < 6; ++d)
        addDegree(factor * (d < 3 ? s.mass : s.inertia[d - 3]), s.isDamped ? store_.damping() : 0, isBlocked(s, d));
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
            const Matrix3r own = ownAxes(s);
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

Dynamics::Part Dynamics::partOf(const Spring& spring) const {
    Part part{{}, {}, spring.bodies[0], spring.bodies[1]};
    std::vector<Vector3r> moved, turned; // derivatives of the relative motion of both ends
    for (int end = 0; end < 2; ++end) {
        const int id = spring.bodies[end];
        if (id == Connectors::ground) continue;
        const State& s = *bodyAt(store_.scene(), id, "a connector holds body").state;
        const int first = firstOfBody_.at(id);
        const Matrix3r own = ownAxes(s);
        const Vector3r arm = s.ori * (s.refOri.conjugate() * (spring.points[end] - s.refPos));
        const double sign = end ? 1 : -1;
        for (int d = 0; d < 6; ++d) {
            if (scale_[first + d] == 0) continue;
            part.degrees.push_back(first + d);
            moved.push_back(sign * (d < 3 ? Vector3r(Vector3r::Unit(d)) : Vector3r(own.col(d - 3).cross(arm))));
            turned.push_back(d < 3 ? Vector3r(Vector3r::Zero()) : Vector3r(sign * own.col(d - 3)));
        }
    }
    const Vector3r &k = spring.stiffness, &turning = spring.rotationalStiffness;
    part.stiffness.setZero(moved.size(), moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i)
        for (std::size_t j = 0; j < moved.size(); ++j)
            part.stiffness(i, j) =
                moved[i].dot(k.cwiseProduct(moved[j])) + turned[i].dot(turning.cwiseProduct(turned[j]));
    return part;
}

// Calls `visit(body1, body2, degree1, degree2, stiffness)` for all entries of the stiffness matrices of joints,
// connectors, testing machines and units.
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
            visitAll(partOf({{connectors->bodies1[c], connectors->bodies2[c]},
                             {connectors->points1[c], connectors->points2[c]},
                             connectors->stiffnessOf(c),
                             connectors->rotationalStiffnessOf(c)}));
    for (const auto* load : store_.loads)
        if (hasMachine(*load))
            visitAll(partOf({{load->body, Connectors::ground},
                             {load->point, load->point},
                             load->machineStiffness(),
                             Vector3r::Zero()}));
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

void Dynamics::scaleMasses(Eigen::VectorXd& x) const {
    for (const auto& block : blocks_) {
        Eigen::VectorXd own(Eigen::Index(block.degrees.size()));
        for (std::size_t i = 0; i < block.degrees.size(); ++i)
            own[i] = x[block.degrees[i]];
        Eigen::VectorXd added = own - block.whole * (block.whole.transpose() * own);
        if (block.block.split) {
            const Eigen::VectorXd ofParts = own - block.parts * (block.parts.transpose() * own);
            added = ofParts + sharedScaling * (added - ofParts);
        }
        for (std::size_t i = 0; i < block.degrees.size(); ++i)
            x[block.degrees[i]] += store_.zones->massScaling * added[Eigen::Index(i)];
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

std::map<int, double> Dynamics::highestAlone() const {
    std::map<int, double> found;
    for (const auto& [body, first] : firstOfBody_) {
        const Eigen::MatrixXd own = matrix_.block(first, first, 6, 6);
        found[body] =
            common_ * Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(own, Eigen::EigenvaluesOnly).eigenvalues()[5];
    }
    return found;
}

} // namespace masonry
