// SPDX-License-Identifier: GPL-2.0-or-later
#include "ElasticSolution.hpp"
#include "engine/bodies/Integrator.hpp"
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

namespace masonry {

using yade::Matrix3r;
using yade::State;

namespace {

// The order in which blocks are eliminated: nested dissection of their places. It depends on no library, and neither do
// the last digits of a solution.
class Dissection {
public:
    std::vector<Vector3r> places;             // of every block [m]
    std::vector<std::vector<int>> neighbours; // of every block

    std::vector<int> order() {
        side_.assign(places.size(), 0);
        std::vector<int> all(places.size());
        for (std::size_t b = 0; b < all.size(); ++b)
            all[b] = int(b);
        divide(all);
        return std::move(order_);
    }

private:
    // Appends the two halves of some blocks, and then those between them.
    void divide(std::vector<int>& some) {
        constexpr std::size_t few = 8;
        Vector3r low = Vector3r::Constant(HUGE_VAL), high = -low;
        for (int b : some) {
            low = low.cwiseMin(places[b]);
            high = high.cwiseMax(places[b]);
        }
        int axis = 0;
        if (!some.empty()) (high - low).maxCoeff(&axis);
        std::sort(some.begin(), some.end(),
                  [&](int a, int b) { return std::pair(places[a][axis], a) < std::pair(places[b][axis], b); });
        if (some.size() <= few) {
            order_.insert(order_.end(), some.begin(), some.end());
            return;
        }
        const auto middle = some.size() / 2;
        for (std::size_t i = 0; i < some.size(); ++i)
            side_[some[i]] = i < middle ? 1 : 2;
        std::vector<int> beside[2]; // blocks of one half with a neighbour in the other
        for (int b : some)
            if (std::any_of(neighbours[b].begin(), neighbours[b].end(),
                            [&](int other) { return side_[other] == 3 - side_[b]; }))
                beside[side_[b] - 1].push_back(b);
        const auto& between = beside[beside[0].size() < beside[1].size() ? 0 : 1];
        for (int b : between)
            side_[b] = 0;
        std::vector<int> halves[2];
        for (int b : some)
            if (side_[b]) halves[side_[b] - 1].push_back(b);
        for (int b : some)
            side_[b] = 0;
        divide(halves[0]);
        divide(halves[1]);
        order_.insert(order_.end(), between.begin(), between.end());
    }

    std::vector<int> side_, order_;
};

} // namespace

ElasticSolution::ElasticSolution() : scene_(*StillScene()), dynamics_(scene_, Dynamics::AsIfAllWereDamped) {
    const StillScene still;
    Dissection blocks;
    const auto& scale = dynamics_.scale();
    std::vector<int> blockOf(scale.size()), first;
    const auto addBlock = [&](int body, int from, int beyond) {
        std::fill(blockOf.begin() + from, blockOf.begin() + beyond, int(first.size()));
        blocks.places.push_back(scene_.bodies.placeOf(body));
        first.push_back(from);
    };
    if (scene_.zones)
        for (const auto& unit : scene_.zones->units())
            addBlock(unit.body, 3 * unit.firstNode, 3 * (unit.firstNode + int(unit.elasticity->masses().size())));
    for (const auto& [body, from] : dynamics_.firstOfBody())
        addBlock(body, from, from + 6);
    blocks.neighbours.resize(first.size());
    const auto& matrix = dynamics_.matrix();
    using Entry = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;
    for (int row = 0; row < matrix.rows(); ++row)
        for (Entry e(matrix, row); e; ++e) {
            auto& known = blocks.neighbours[blockOf[row]];
            const int other = blockOf[e.col()];
            if (other != blockOf[row] && (known.empty() || known.back() != other)) known.push_back(other);
        }
    places_.assign(scale.size(), -1);
    for (int block : blocks.order())
        for (std::size_t i = std::size_t(first[block]); i < scale.size() && blockOf[i] == block; ++i)
            if (scale[i] != 0) places_[i] = count_++;
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < matrix.rows(); ++row)
        for (Entry e(matrix, row); e; ++e)
            if (places_[row] >= places_[e.col()]) entries.emplace_back(places_[row], places_[e.col()], e.value());
    Eigen::SparseMatrix<double> ordered(count_, count_);
    ordered.setFromTriplets(entries.begin(), entries.end());
    factors_.compute(ordered);
    if (factors_.info() != Eigen::Success) throw std::invalid_argument("something can move without resistance");
}

// The forces on what can move, in the order of the factors, times its scale.
ElasticSolution::Vector ElasticSolution::imbalance() const {
    Vector all = Vector::Zero(count_);
    const auto& scale = dynamics_.scale();
    const auto put = [&](int degree, double force) {
        if (places_[degree] >= 0) all[places_[degree]] = scale[degree] * force;
    };
    const Vector3r gravity = scene_.gravity();
    const auto onNodes = scene_.zones ? scene_.zones->lastForces() : std::vector<Vector3r>();
    for (std::size_t i = 0; i < 3 * onNodes.size(); ++i)
        put(int(i), onNodes[i / 3][i % 3]); // weights are among them
    const auto on = scene_.scene().forces().sums(scene_.bodies.size());
    for (const auto& [body, first] : dynamics_.firstOfBody()) {
        const State& s = scene_.bodies.state(body);
        const Vector3r force = on.forces[body] + s.mass * gravity, torque = ownAxes(s).transpose() * on.torques[body];
        for (int d = 0; d < 6; ++d)
            put(first + d, d < 3 ? force[d] : torque[d - 3]);
    }
    return all;
}

// How the point that a drive holds moves with every degree of freedom, as imbalance().
ElasticSolution::Vector ElasticSolution::alongDrive(const Load& load) const {
    Vector all = Vector::Zero(count_);
    const Vector3r along = load.direction.normalized();
    for (std::size_t n = 0; n <= load.others.size(); ++n) {
        const int body = n ? load.others[n - 1] : load.body;
        const State& s = scene_.bodies.state(body);
        const Vector3r arm = s.ori * (s.refOri.conjugate() * ((n ? load.otherPoints[n - 1] : load.point) - s.refPos));
        const Vector3r turning = ownAxes(s).transpose() * arm.cross(along);
        const double share = load.shares.empty() ? 1 : load.shares[n];
        const auto first = dynamics_.firstOfBody().find(body);
        for (int d = 0; first != dynamics_.firstOfBody().end() && d < 6; ++d) {
            const int degree = first->second + d;
            if (places_[degree] >= 0)
                all[places_[degree]] = dynamics_.scale()[degree] * share * (d < 3 ? along[d] : turning[d - 3]);
        }
    }
    return all;
}

void ElasticSolution::holdDrives(Vector& moved) const {
    std::vector<Vector> held;
    for (const auto* load : scene_.loads)
        if (load->driven) held.push_back(alongDrive(*load));
    if (held.empty()) return;
    Eigen::MatrixXd drives(count_, Eigen::Index(held.size()));
    for (std::size_t i = 0; i < held.size(); ++i)
        drives.col(Eigen::Index(i)) = held[i];
    const Eigen::MatrixXd yields = factors_.solve(drives);
    moved -= yields * (drives.transpose() * yields).eval().ldlt().solve(drives.transpose() * moved);
}

double ElasticSolution::move() {
    const StillScene still;
    const Vector forces = imbalance();
    Vector moved = factors_.solve(forces);
    holdDrives(moved);
    const double work = forces.dot(moved);
    struct Motion {
        Vector3r vel = Vector3r::Zero(), angVel = Vector3r::Zero();
    };
    std::vector<Motion> motions(scene_.bodies.size());
    for (const auto& [body, first] : dynamics_.firstOfBody())
        motions[body] = {motionOf(moved, first), ownAxes(scene_.bodies.state(body)) * motionOf(moved, first + 3)};
    double grown = 0; // work of loads that have grown in this move
    for (auto* load : scene_.loads) {
        const double before = load->work;
        load->workBefore(first_ ? 1 : 2, [&](int body) { return motions[body]; });
        if (first_) grown += load->work - before;
    }
    scene_.integrator->damped += 0.5 * work - grown;
    first_ = false;
    displace(moved);
    return std::sqrt(std::max(0.0, work));
}

// What three degrees of freedom from this one on have of a motion [m] or [rad].
Vector3r ElasticSolution::motionOf(const Vector& moved, int degree) const {
    Vector3r found = Vector3r::Zero();
    for (int d = 0; d < 3; ++d)
        if (places_[degree + d] >= 0) found[d] = dynamics_.scale()[degree + d] * moved[places_[degree + d]];
    return found;
}

void ElasticSolution::displace(const Vector& moved) {
    if (auto* zones = scene_.zones) {
        auto displacements = zones->displacements();
        for (std::size_t n = 0; n < displacements.size(); ++n)
            displacements[n] += motionOf(moved, 3 * int(n));
        zones->setDisplacements(displacements);
    }
    for (const auto& [body, first] : dynamics_.firstOfBody()) {
        const State& s = scene_.bodies.state(body);
        const Vector3r turn = ownAxes(s) * motionOf(moved, first + 3);
        const double angle = turn.norm();
        Quaternionr turned = s.ori;
        if (angle > 0) turned = Quaternionr(Eigen::AngleAxisd(angle, turn / angle)) * turned;
        scene_.bodies.setPlace(body, s.pos + motionOf(moved, first), turned.normalized());
    }
}

// The masses of the scene times a motion; the scale stands for those that are not scaled.
ElasticSolution::Vector ElasticSolution::inertia(const Vector& motion) const {
    Vector all(dynamics_.scale().size());
    for (Eigen::Index i = 0; i < all.size(); ++i)
        all[i] = places_[i] < 0 ? 0 : motion[places_[i]];
    dynamics_.scaleMasses(all);
    Vector found(count_);
    for (Eigen::Index i = 0; i < all.size(); ++i)
        if (places_[i] >= 0) found[places_[i]] = all[i];
    return found;
}

// By the method of Lanczos: with the flexibility, from the displacements under a uniform acceleration on. Let c be the
// share of a mode in the mass and w its angular frequency; these displacements have c/w⁴ of it, and the momentum c/w.
double ElasticSolution::findMode(const Vector3r& direction) {
    constexpr int most = 60;
    constexpr double exact = 1e-9;
    const StillScene still;
    Vector uniform = Vector::Zero(count_);
    const auto put = [&](int degree, double value) {
        if (places_[degree] >= 0) uniform[places_[degree]] = value / dynamics_.scale()[degree];
    };
    const auto nodes = scene_.zones ? scene_.zones->displacements().size() : 0;
    for (std::size_t i = 0; i < 3 * nodes; ++i)
        put(int(i), direction[i % 3]);
    for (const auto& [body, first] : dynamics_.firstOfBody())
        for (int d = 0; d < 3; ++d)
            put(first + d, direction[d]);
    const Vector mass = inertia(uniform);
    const auto flexible = [&](const Vector& forces) {
        Vector moved = factors_.solve(forces);
        holdDrives(moved);
        return moved;
    };
    std::vector<Vector> bases, massesOfBases;
    Vector next = flexible(mass);
    std::vector<double> diagonal, beside;
    while (true) {
        const Vector heavy = inertia(next);
        const double size = std::sqrt(next.dot(heavy));
        if (!(size > 0)) return 0;
        if (!bases.empty()) beside.push_back(size);
        bases.push_back(next / size);
        massesOfBases.push_back(heavy / size);
        next = flexible(massesOfBases.back());
        diagonal.push_back(next.dot(massesOfBases.back()));
        for (int twice = 0; twice < 2; ++twice)
            for (std::size_t i = 0; i < bases.size(); ++i)
                next -= next.dot(massesOfBases[i]) * bases[i];
        const int count = int(bases.size());
        Eigen::MatrixXd small = Eigen::MatrixXd::Zero(count, count);
        for (int i = 0; i < count; ++i) {
            small(i, i) = diagonal[i];
            if (i > 0) small(i, i - 1) = small(i - 1, i) = beside[i - 1];
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(small);
        int best = 0;
        double largest = 0;
        for (int i = 0; i < count; ++i) {
            const double flexibility = solved.eigenvalues()[i], share = solved.eigenvectors()(0, i);
            const double momentum = flexibility > 0 ? share * share * std::pow(flexibility, -1.5) : 0;
            if (momentum <= largest) continue;
            largest = momentum;
            best = i;
        }
        const double flexibility = solved.eigenvalues()[best];
        const double error = std::sqrt(next.dot(inertia(next))) * std::abs(solved.eigenvectors()(count - 1, best));
        if (error * error > exact * flexibility * flexibility && count < std::min(most, count_)) continue;
        if (error * error > exact * flexibility * flexibility) return 0;
        mode_ = Vector::Zero(count_);
        for (int i = 0; i < count; ++i)
            mode_ += solved.eigenvectors()(i, best) * bases[i];
        participation_ = mode_.dot(mass);
        return 1 / flexibility;
    }
}

double ElasticSolution::force() const {
    const StillScene still;
    return mode_.dot(imbalance());
}

} // namespace masonry
