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

ElasticSolution::ElasticSolution()
    : scene_(*StillScene()),
      dynamics_(scene_, Dynamics::AsIfAllWereDamped, Dynamics::Engaged),
      scale_(dynamics_.scale().data(), Eigen::Index(dynamics_.scale().size())),
      places_(dynamics_.scale().size(), -1) {
    const StillScene still;
    Dissection blocks;
    std::vector<int> blockOf(places_.size()), first;
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
    for (int block : blocks.order())
        for (std::size_t i = std::size_t(first[block]); i < places_.size() && blockOf[i] == block; ++i)
            if (scale_[i] != 0) places_[i] = count_++;
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < matrix.rows(); ++row)
        for (Entry e(matrix, row); e; ++e)
            if (places_[row] >= places_[e.col()]) entries.emplace_back(places_[row], places_[e.col()], e.value());
    Eigen::SparseMatrix<double> lower(count_, count_);
    lower.setFromTriplets(entries.begin(), entries.end());
    factors_.compute(lower);
    if (factors_.info() != Eigen::Success) throw std::invalid_argument("something can move without resistance");
}

// Between all degrees of freedom and those that can move, in the order of the factors.
ElasticSolution::Vector ElasticSolution::ordered(const Vector& all) const {
    Vector found(count_);
    for (Eigen::Index i = 0; i < all.size(); ++i)
        if (places_[i] >= 0) found[places_[i]] = all[i];
    return found;
}

ElasticSolution::Vector ElasticSolution::spread(const Vector& ordered) const {
    Vector found = Vector::Zero(Eigen::Index(places_.size()));
    for (Eigen::Index i = 0; i < found.size(); ++i)
        if (places_[i] >= 0) found[i] = ordered[places_[i]];
    return found;
}

// The forces on what can move, times its scale.
ElasticSolution::Vector ElasticSolution::imbalance() const {
    Vector all = Vector::Zero(scale_.size());
    if (scene_.zones) {
        const auto onNodes = scene_.zones->lastForces(); // with weights
        for (std::size_t n = 0; n < onNodes.size(); ++n)
            all.segment<3>(3 * n) = onNodes[n];
    }
    const auto on = scene_.scene().forces().sums(scene_.bodies.size());
    for (const auto& [body, first] : dynamics_.firstOfBody()) {
        const State& s = scene_.bodies.state(body);
        all.segment<6>(first) << on.forces[body] + s.mass * scene_.gravity(), ownAxes(s).transpose() * on.torques[body];
    }
    return ordered(all.cwiseProduct(scale_));
}

// The derivative of the motion of a driven point by what can move, times its scale.
ElasticSolution::Vector ElasticSolution::alongDrive(const Load& load) const {
    Vector all = Vector::Zero(scale_.size());
    const Vector3r along = load.direction.normalized();
    for (std::size_t n = 0; n <= load.others.size(); ++n) {
        const int body = n ? load.others[n - 1] : load.body;
        const auto first = dynamics_.firstOfBody().find(body);
        if (first == dynamics_.firstOfBody().end()) continue;
        const State& s = scene_.bodies.state(body);
        const Vector3r arm = s.ori * (s.refOri.conjugate() * ((n ? load.otherPoints[n - 1] : load.point) - s.refPos));
        all.segment<6>(first->second) << along, ownAxes(s).transpose() * arm.cross(along);
        all.segment<6>(first->second) *= load.shares.empty() ? 1 : load.shares[n];
    }
    return ordered(all.cwiseProduct(scale_));
}

// The motion, divided by the scale, under forces, which are multiplied by it, while drives hold.
ElasticSolution::Vector ElasticSolution::motionUnder(const Vector& forces) const {
    Vector moved = factors_.solve(forces);
    std::vector<Vector> held;
    for (const auto* load : scene_.loads)
        if (load->driven) held.push_back(alongDrive(*load));
    if (held.empty()) return moved;
    Eigen::MatrixXd drives(count_, Eigen::Index(held.size()));
    for (std::size_t i = 0; i < held.size(); ++i)
        drives.col(Eigen::Index(i)) = held[i];
    const Eigen::MatrixXd yields = factors_.solve(drives);
    return moved - yields * (drives.transpose() * yields).eval().ldlt().solve(drives.transpose() * moved);
}

double ElasticSolution::move() {
    const StillScene still;
    const Vector forces = imbalance();
    const Vector moved = motionUnder(forces), all = displacements(moved);
    const double work = forces.dot(moved);
    struct Motion {
        Vector3r vel = Vector3r::Zero(), angVel = Vector3r::Zero();
    };
    std::vector<Motion> motions(scene_.bodies.size());
    for (const auto& [body, first] : dynamics_.firstOfBody())
        motions[body] = {all.segment<3>(first), ownAxes(scene_.bodies.state(body)) * all.segment<3>(first + 3)};
    double grown = 0; // work of loads that have grown in this move
    for (auto* load : scene_.loads) {
        const double before = load->work;
        load->workBefore(first_ ? 1 : 2, [&](int body) { return motions[body]; });
        if (first_) grown += load->work - before;
    }
    // The end of the move before was not in equilibrium if points of joints opened in it.
    const double workAtEnd = first_ ? 0 : 0.5 * forces.dot(moved_);
    scene_.integrator->damped += workAtEnd + 0.5 * work - grown;
    first_ = false;
    moved_ = moved;
    moveBy(all);
    return std::sqrt(std::max(0.0, work));
}

void ElasticSolution::displace(double amount) {
    const StillScene still;
    moveBy(displacements(amount * mode_));
}

// Of all degrees of freedom [m, rad].
ElasticSolution::Vector ElasticSolution::displacements(const Vector& moved) const {
    return spread(moved).cwiseProduct(scale_);
}

void ElasticSolution::moveBy(const Vector& all) {
    if (auto* zones = scene_.zones) {
        auto displacements = zones->displacements();
        for (std::size_t n = 0; n < displacements.size(); ++n)
            displacements[n] += all.segment<3>(3 * n);
        zones->setDisplacements(displacements);
    }
    for (const auto& [body, first] : dynamics_.firstOfBody()) {
        const State& s = scene_.bodies.state(body);
        const Vector3r turn = ownAxes(s) * all.segment<3>(first + 3);
        const double angle = turn.norm();
        Quaternionr turned = s.ori;
        if (angle > 0) turned = Quaternionr(Eigen::AngleAxisd(angle, turn / angle)) * turned;
        scene_.bodies.setPlace(body, s.pos + all.segment<3>(first), turned.normalized());
    }
}

// The scaled masses times a motion, divided by the scale as in motionUnder().
ElasticSolution::Vector ElasticSolution::inertia(const Vector& motion) const {
    Vector all = spread(motion);
    dynamics_.scaleMasses(all);
    return ordered(all);
}

// The method of Lanczos with the flexibility begins with the displacements under a uniform acceleration. Of a mode with
// the share c of the mass and the angular frequency w they have the share c/w⁴, and its momentum is c/w.
double ElasticSolution::findMode(const Vector3r& direction) {
    constexpr int most = 60;
    constexpr double exact = 3e-5; // of a vector; the eigenvalue has the square of this error
    const StillScene still;
    Vector uniform = Vector::Zero(scale_.size());
    if (scene_.zones) {
        const auto nodes = Eigen::Index(scene_.zones->displacements().size());
        uniform.head(3 * nodes) = direction.replicate(nodes, 1);
    }
    for (const auto& [body, first] : dynamics_.firstOfBody())
        uniform.segment<3>(first) = direction;
    const Vector mass = inertia(ordered(uniform.cwiseQuotient(scale_)));
    std::vector<Vector> bases, massesOfBases;
    Vector next = motionUnder(mass);
    std::vector<double> diagonal, beside;
    while (true) {
        const Vector heavy = inertia(next);
        const double size = std::sqrt(next.dot(heavy));
        if (!(size > 0)) return 0;
        if (!bases.empty()) beside.push_back(size);
        bases.push_back(next / size);
        massesOfBases.push_back(heavy / size);
        next = motionUnder(massesOfBases.back());
        diagonal.push_back(next.dot(massesOfBases.back()));
        for (int twice = 0; twice < 2; ++twice)
            for (std::size_t i = 0; i < bases.size(); ++i)
                next -= next.dot(massesOfBases[i]) * bases[i];
        const int count = int(bases.size());
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved;
        solved.computeFromTridiagonal(Eigen::Map<Vector>(diagonal.data(), count),
                                      Eigen::Map<Vector>(beside.data(), count - 1));
        const auto momentum = [&](int i) { // 0 where the flexibility is round-off
            const double flexibility = solved.eigenvalues()[i], share = solved.eigenvectors()(0, i);
            return flexibility > 0 ? share * share * std::pow(flexibility, -1.5) : 0;
        };
        int best = 0;
        for (int i = 1; i < count; ++i)
            if (momentum(i) > momentum(best)) best = i;
        const double flexibility = solved.eigenvalues()[best];
        const double error = std::sqrt(next.dot(inertia(next))) * std::abs(solved.eigenvectors()(count - 1, best));
        if (!(error <= exact * flexibility)) {
            if (count < std::min(most, count_)) continue;
            return 0;
        }
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
