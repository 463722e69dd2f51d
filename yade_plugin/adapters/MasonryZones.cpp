#include "MasonryZones.hpp"
#include "MasonryJointGeom.hpp"
#include "MasonryMat.hpp"
#include "SceneCheck.hpp"
#include "common/Text.hpp"
#include <algorithm>

BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryZones)

namespace masonry {

void MasonryZones::postLoad() {
    std::vector<std::string> wrong;
    if (divisions.size() != 3) wrong.push_back("divisions must be three whole numbers");
    for (int n : divisions)
        if (n < 1 || n > 100) wrong.push_back("divisions " + std::to_string(n) + " must be 1 to 100");
    if (!(damping >= 0 && damping <= 0.99)) wrong.push_back("damping " + text(damping) + " must be 0 to 0.99");
    if (dampingKind != "combined" && dampingKind != "local")
        wrong.push_back("dampingKind '" + dampingKind + "' must be 'combined' or 'local'");
    if (blocked.find_first_not_of("xyz") != std::string::npos)
        wrong.push_back("blocked '" + blocked + "' must be made of x, y and z");
    if (!gravity.allFinite()) wrong.push_back("gravity must be finite numbers [m/s²]");
    auto sorted = bodies;
    std::sort(sorted.begin(), sorted.end());
    if (!sorted.empty() && sorted[0] < 0) wrong.push_back("body " + std::to_string(sorted[0]) + " does not exist");
    if (const auto twin = std::adjacent_find(sorted.begin(), sorted.end()); twin != sorted.end())
        wrong.push_back("body " + std::to_string(*twin) + " stands twice in bodies");
    if (!laidOut.empty() && laidOut != layout())
        wrong.push_back("bodies and divisions cannot change once joints or a run know their nodes");
    if (!wrong.empty()) throw std::invalid_argument("MasonryZones: " + joined(wrong, "; "));
    refresh();
    units_.clear(), batches_.clear(); // meshed again when needed: after loading, or for other bodies
    ++changes;
}

void MasonryZones::refresh() {
    if (!ahead_) return;
    ahead_ = false;
    for (std::size_t node = 0; node < places_.size(); ++node) {
        displacements[node] = at(displacements_, places_[node]);
        velocities[node] = at(velocities_, places_[node]);
        lastForces[node] = at(lastForces_, places_[node]);
    }
}

int MasonryZones::addGuest() {
    const int row = int(displacements_.size()), lane = guests_++ % lanes;
    if (lane == 0) displacements_.resize(row + 3, Row{}), forces_.resize(row + 3, Row{});
    return lanes * (int(displacements_.size()) - 3) + lane;
}

const std::vector<MasonryZones::Unit>& MasonryZones::units() {
    if (!units_.empty() || (bodies.empty() && displacements.empty())) return units_;
    const auto& all = Singleton<yade::Omega>::instance().getScene()->bodies->body;
    struct Kind {
        std::vector<Vector3r> corners;
        const MasonryMat* mat;
        std::shared_ptr<const BlockElasticity> elasticity;
    };
    std::vector<Kind> kinds;
    const int held = blocked.size() == 1 ? int(blocked[0] - 'x') : -1;
    unitOfBody_.assign(all.size(), -1);
    std::vector<std::string> wrong;
    int next = 0;
    for (int id : bodies) {
        const auto fail = [&](const std::string& what) {
            wrong.push_back("MasonryZones: body " + std::to_string(id) + " " + what);
        };
        if (id < 0 || std::size_t(id) >= all.size() || !all[id]) {
            fail("does not exist");
            continue;
        }
        auto* shape = dynamic_cast<yade::Polyhedra*>(all[id]->shape.get());
        const auto* mat = dynamic_cast<const MasonryMat*>(all[id]->material.get());
        if (!shape || !mat) {
            fail("is no Polyhedra of MasonryMat");
            continue;
        }
        const auto& state = *all[id]->state;
        ConvexBlock block = blockOf(*shape, state.refPos, state.refOri);
        for (auto& v : block.vertices)
            v -= state.refPos;
        auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) {
            if (k.mat != mat || k.corners.size() != block.vertices.size()) return false;
            for (std::size_t i = 0; i < k.corners.size(); ++i)
                if ((k.corners[i] - block.vertices[i]).norm() > 1e-9 * block.size()) return false;
            return true;
        });
        if (kind == kinds.end()) {
            try {
                kinds.push_back(
                    {block.vertices, mat,
                     std::make_shared<const BlockElasticity>(divide(block, {divisions[0], divisions[1], divisions[2]}),
                                                             mat->young, mat->poisson, mat->density, held)});
            } catch (const std::invalid_argument& e) {
                fail(std::string("cannot be divided: ") + e.what());
                continue;
            }
            kind = std::prev(kinds.end());
        }
        unitOfBody_[id] = int(units_.size());
        units_.push_back({id, next, 0, kind->elasticity, state.refPos, state.refOri});
        next += int(kind->elasticity->masses().size());
    }
    if (!displacements.empty() && displacements.size() != std::size_t(next))
        wrong.push_back("MasonryZones: bodies of " + std::to_string(next) + " nodes do not fit the state of " +
                        std::to_string(displacements.size()) + " nodes");
    if (!wrong.empty()) {
        units_.clear();
        throw std::invalid_argument(firstOf(wrong));
    }
    for (int id : bodies) {
        auto& state = *all[id]->state;
        state.blockedDOFs = 63; // the host's integrator leaves it alone
        state.vel = state.angVel = Vector3r::Zero();
    }
    if (displacements.empty()) {
        laidOut = layout();
        displacements.assign(next, Vector3r::Zero());
        velocities = lastForces = displacements;
    }
    batches_.clear(), guests_ = 0;
    int rows = 0;
    places_.assign(next, 0);
    for (const auto& kind : kinds) {
        const int nodes = int(kind.elasticity->masses().size());
        for (std::size_t u = 0; u < units_.size(); ++u) {
            if (units_[u].elasticity != kind.elasticity) continue;
            if (batches_.empty() || batches_.back().elasticity != kind.elasticity.get() ||
                batches_.back().units.size() == lanes) {
                batches_.push_back({kind.elasticity.get(), rows, {}});
                rows += 3 * nodes;
            }
            auto& batch = batches_.back();
            for (int n = 0; n < nodes; ++n)
                places_[units_[u].firstNode + n] = lanes * (batch.firstRow + 3 * n) + int(batch.units.size());
            units_[u].momentPlace = lanes * 3 * (int(batches_.size()) - 1) + int(batch.units.size());
            batch.units.push_back(int(u));
        }
    }
    for (auto* all : {&displacements_, &velocities_, &forces_, &lastForces_})
        all->assign(rows, Row{});
    moments_.assign(3 * batches_.size(), Row{});
    for (int node = 0; node < next; ++node) {
        put(displacements_, places_[node], displacements[node]);
        put(velocities_, places_[node], velocities[node]);
        put(lastForces_, places_[node], lastForces[node]);
    }
    return units_;
}

const MasonryZones::Unit* MasonryZones::unitOf(int body) {
    units();
    const bool mine = body >= 0 && std::size_t(body) < unitOfBody_.size() && unitOfBody_[body] >= 0;
    return mine ? &units_[unitOfBody_[body]] : nullptr;
}

py::tuple MasonryZones::nodesOf(int body) {
    const auto* unit = unitOf(body);
    if (!unit) throw std::invalid_argument("body " + std::to_string(body) + " is no deformable unit");
    return py::make_tuple(unit->firstNode, unit->firstNode + int(unit->elasticity->masses().size()));
}

Vector3r MasonryZones::referencePoint(int body, int node) {
    const auto* unit = unitOf(body);
    if (!unit || node < unit->firstNode || node - unit->firstNode >= int(unit->elasticity->masses().size()))
        throw std::invalid_argument("body " + std::to_string(body) + " has no node " + std::to_string(node));
    return reference(*unit, node);
}

void MasonryZones::setVelocity(int node, const Vector3r& velocity) {
    units();
    if (!velocity.allFinite()) throw std::invalid_argument("velocity of a node must be finite numbers [m/s]");
    if (node < 0 || std::size_t(node) >= places_.size())
        throw std::invalid_argument("there is no node " + std::to_string(node));
    put(velocities_, places_[node], velocity);
    ahead_ = true;
}

py::list MasonryZones::masses() {
    py::list all;
    for (const auto& unit : units())
        for (double mass : unit.elasticity->masses())
            all.append(mass);
    return all;
}

Vector3r MasonryZones::reference(const Unit& unit, int node) const {
    return unit.centre + unit.elasticity->mesh().nodes[node - unit.firstNode];
}

Attachment MasonryZones::attach(const Unit& unit, const Vector3r& point) const {
    const auto place = nearestOnSurface(unit.elasticity->mesh(), point - unit.centre);
    Attachment a;
    for (int i = 0; i < 3; ++i)
        a.nodes[i] = unit.firstNode + place.nodes[i], a.weights[i] = place.weights[i];
    return a;
}

std::vector<std::pair<int, double>> MasonryZones::nodesOn(const Unit& unit, const std::vector<Vector3r>& polygon,
                                                          const Vector3r& normal) const {
    const auto& mesh = unit.elasticity->mesh();
    const double size = (polygon[2] - polygon[0]).norm(), whole = area(polygon, normal);
    const auto inside = [&](const Vector3r& p) {
        if (std::abs((p - polygon[0]).dot(normal)) > 1e-3 * size) return false;
        for (std::size_t i = 0; i < polygon.size(); ++i)
            if ((polygon[(i + 1) % polygon.size()] - polygon[i]).cross(p - polygon[i]).dot(normal) <
                -1e-3 * size * size)
                return false;
        return true;
    };
    std::vector<std::pair<int, double>> found;
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        Vector3r c[3];
        bool on = true;
        for (int i = 0; i < 3; ++i)
            on &= inside(c[i] = unit.centre + mesh.nodes[t[i]]);
        if (!on) continue;
        const double part = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
        sum += part;
        for (int node : t) {
            const int number = unit.firstNode + node;
            auto at = std::find_if(found.begin(), found.end(), [&](const auto& f) { return f.first == number; });
            if (at == found.end()) at = found.insert(found.end(), {number, 0.0});
            at->second += part / 3;
        }
    }
    if (std::abs(sum - whole) > 1e-3 * whole) found.clear();
    return found;
}

void MasonryZones::dropGuests() { // guests have no velocities
    displacements_.resize(velocities_.size()), forces_.resize(velocities_.size());
    guests_ = 0;
}

namespace {

double total(const Row& row) {
    double sum = 0;
    for (double value : row.lane)
        sum += value;
    return sum;
}

} // namespace

// Forces of the joints that the functors of an InteractionLoop have brought up to date.
void MasonryZones::gatherFromFunctors() {
    const auto& interactions = scene->interactions->linIntrs;
    bool same = seen_.size() == scene->interactions->currSize;
    for (std::size_t i = 0; same && i < seen_.size(); ++i)
        same = seen_[i] == interactions[i]->geom;
    if (!same) {
        seen_.clear(), joints_.clear();
        for (std::size_t i = 0; i < scene->interactions->currSize; ++i) {
            seen_.push_back(interactions[i]->geom);
            const auto* geom = dynamic_cast<MasonryJointGeom*>(interactions[i]->geom.get());
            if (geom && geom->zones.get() == this) joints_.push_back(geom);
        }
    }
    std::fill(forces_.begin(), forces_.end(), Row{});
    std::fill(moments_.begin(), moments_.end(), Row{});
    const auto hang = [&](const Attachment& a, const Vector3r& force) {
        for (int i = 0; i < 3 && a.weights[i] != 0; ++i)
            for (int d = 0; d < 3; ++d)
                (forceRows() + places_[a.nodes[i]])[d * lanes] += a.weights[i] * force[d];
    };
    for (const auto* geom : joints_) {
        for (std::size_t i = 0; i < geom->points.size(); ++i) {
            if (!geom->attachments1.empty()) hang(geom->attachments1[i], geom->points[i].force);
            if (!geom->attachments2.empty()) hang(geom->attachments2[i], -geom->points[i].force);
        }
        for (int body : {geom->body1, geom->body2})
            if (const auto* unit = unitOf(body))
                for (int d = 0; d < 3; ++d)
                    (momentRows() + unit->momentPlace)[d * lanes] += geom->moment[d];
    }
}

void MasonryZones::action() {
    checkScene(*scene);
    units();
    if (!looped) gatherFromFunctors();
    const NodeMotion motion{scene->dt,
                            damping,
                            {gravity[0], gravity[1], gravity[2]},
                            dampingKind == "combined",
                            {holds(0), holds(1), holds(2)}};
    const int count = int(batches_.size());
    std::vector<NodeSums> sums(count);
    std::vector<Row> energies(count);
#pragma omp parallel for schedule(static)
    for (int b = 0; b < count; ++b) {
        thread_local std::vector<Row> scratch;
        const auto& batch = batches_[b];
        const auto matrix = batch.elasticity->matrix();
        const int row = batch.firstRow;
        Row present{}, turned[9];
        std::fill_n(present.lane, batch.units.size(), 1.0);
        scratch.resize(std::size_t(6) * matrix.nodeCount);
        addBlockForces(matrix, &displacements_[row], &moments_[3 * b], &forces_[row], turned, &energies[b],
                       scratch.data());
        moveBlocks(matrix, motion, present, &displacements_[row], &velocities_[row], &forces_[row], &lastForces_[row],
                   sums[b]);
        for (std::size_t lane = 0; lane < batch.units.size(); ++lane) {
            const auto& unit = units_[batch.units[lane]];
            auto& state = *scene->bodies->body[unit.body]->state;
            Matrix3 rotation;
            for (int i = 0; i < 9; ++i)
                rotation(i / 3, i % 3) = turned[i].lane[lane];
            for (int d = 0; d < 3; ++d)
                state.pos[d] = unit.centre[d] + sums[b].moved[d].lane[lane] / batch.elasticity->mass();
            state.ori = Quaternionr(rotation) * unit.orientation;
        }
    }
    dampingWork += pendingDamping;
    pendingDamping = kinetic = elastic = gravityWork = 0;
    for (const auto& energy : energies)
        elastic += total(energy);
    for (const auto& sum : sums) {
        kinetic += total(sum.kinetic), gravityWork += total(sum.gravityWork);
        dampingWork += total(sum.damping), pendingDamping += total(sum.pending);
    }
    ahead_ = true;
}

} // namespace masonry
