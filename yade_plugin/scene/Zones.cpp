// SPDX-License-Identifier: GPL-2.0-or-later
#include "Zones.hpp"
#include "Blocks.hpp"
#include "Changes.hpp"
#include "UnitMaterial.hpp"
#include "common/Parallel.hpp"
#include <algorithm>

namespace masonry {

std::vector<std::string> Zones::problems() const {
    std::vector<std::string> wrong;
    if (divisions.size() != 3) wrong.push_back("divisions must be three whole numbers");
    for (int n : divisions)
        if (n < 1 || n > 100) wrong.push_back("divisions " + std::to_string(n) + " must be 1 to 100");
    if (dampingKind != "combined" && dampingKind != "local")
        wrong.push_back("dampingKind '" + dampingKind + "' must be 'combined' or 'local'");
    if (blocked.find_first_not_of("xyz") != std::string::npos)
        wrong.push_back("blocked '" + blocked + "' must be made of x, y and z");
    auto sorted = bodies;
    std::sort(sorted.begin(), sorted.end());
    if (!sorted.empty() && sorted[0] < 0) wrong.push_back("body " + std::to_string(sorted[0]) + " does not exist");
    if (const auto twin = std::adjacent_find(sorted.begin(), sorted.end()); twin != sorted.end())
        wrong.push_back("body " + std::to_string(*twin) + " stands twice in bodies");
    if (!laidOut.empty() && laidOut != layout())
        wrong.push_back("bodies, divisions and plane cannot change once joints or a run know their nodes");
    return wrong;
}

void Zones::divideAnew() {
    if (!units_.empty()) loaded_ = {displacements(), velocities(), lastForces()};
    units_.clear();
    batches_.clear();
    places_.clear();
    ++changes;
}

// ---- state of the nodes -----------------------------------------------------------------------------------------

void Zones::checkAlive() const {
    if (acted_ && scene_.expired())
        throw std::runtime_error("these MasonryZones are gone: the scene that they belonged to has ended");
}

std::vector<Vector3r> Zones::listed(const std::vector<Row>& rows, const std::vector<Vector3r>& loaded) const {
    checkAlive();
    if (units_.empty()) return loaded;
    std::vector<Vector3r> all;
    for (const int place : places_)
        all.push_back(at(rows, place));
    return all;
}

void Zones::take(const std::vector<Vector3r>& values, std::vector<Row>& rows, std::vector<Vector3r>& loaded) {
    if (units_.empty() || values.size() != places_.size()) {
        if (!units_.empty()) divideAnew(); // units() then refuses the state of another number of nodes
        loaded = values;
        return;
    }
    for (std::size_t node = 0; node < values.size(); ++node)
        put(rows, places_[node], values[node]);
}

int Zones::addDependentRows() {
    const int row = int(displacements_.size());
    displacements_.resize(row + 3, Row{});
    forces_.resize(row + 3, Row{});
    return lanes * row;
}

// Dependent points have rows of displacements and forces only, so the rows of velocities show where they begin.
void Zones::dropDependentRows() {
    displacements_.resize(velocities_.size());
    forces_.resize(velocities_.size());
}

void Zones::clearForces() {
    units();
    std::fill(forces_.begin(), forces_.end(), Row{});
    std::fill(moments_.begin(), moments_.end(), Row{});
}

// ---- units ------------------------------------------------------------------------------------------------------

const std::vector<Zones::Unit>& Zones::units() {
    if (units_.empty() && !(bodies.empty() && loaded_.displacements.empty())) {
        mesh();
        layOut();
    }
    return units_;
}

void Zones::mesh() {
    // Another scene may be the present one by now, whose bodies have the same ids.
    auto scene = boost::dynamic_pointer_cast<yade::Scene>(divided_.lock());
    if (!scene) scene = Singleton<yade::Omega>::instance().getScene();
    divided_ = scene;
    const auto& all = scene->bodies->body;
    struct Kind {
        std::vector<Vector3r> corners;
        const UnitMaterial* mat;
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
        const auto* mat = dynamic_cast<const UnitMaterial*>(all[id]->material.get());
        if (!isBlock(all[id]->shape.get()) || !mat) {
            fail("is no block of MasonryMat");
            continue;
        }
        const auto& state = *all[id]->state;
        ConvexBlock block = blockOf(*all[id]->shape, state.refPos, state.refOri);
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
                const std::array<int, 3> cells{divisions[0], divisions[1], divisions[2]};
                std::optional<BlockMesh> made;
                if (plane && held >= 0) made = divideInPlane(block, cells, held);
                if (!made) made = divide(block, cells);
                kinds.push_back({block.vertices, mat,
                                 std::make_shared<const BlockElasticity>(std::move(*made), mat->young, mat->poisson,
                                                                         all[id]->material->density, held)});
            } catch (const std::invalid_argument& e) {
                fail(std::string("cannot be divided: ") + e.what());
                continue;
            }
            kind = std::prev(kinds.end());
        }
        mat->usedIn(*scene);
        unitOfBody_[id] = int(units_.size());
        units_.push_back({id, next, 0, kind->elasticity, state.refPos, state.refOri});
        next += int(kind->elasticity->masses().size());
    }
    const auto known = loaded_.displacements.size();
    if (known != 0 && known != std::size_t(next))
        wrong.push_back("MasonryZones: bodies of " + std::to_string(next) + " nodes do not fit the state of " +
                        std::to_string(known) + " nodes");
    for (const auto* list : {&loaded_.velocities, &loaded_.lastForces})
        if (known != 0 && !list->empty() && list->size() != known)
            wrong.push_back("MasonryZones: the state has " + std::to_string(known) + " displacements of nodes and " +
                            std::to_string(list->size()) + " velocities or forces");
    if (!wrong.empty()) {
        units_.clear();
        throw std::invalid_argument(firstOf(wrong));
    }
    for (int id : bodies) {
        auto& state = *all[id]->state;
        state.blockedDOFs = 63; // all axes, so that integrators of rigid bodies do not move it
        state.vel = state.angVel = Vector3r::Zero();
    }
    if (known == 0) {
        laidOut = layout();
        loaded_.displacements.assign(next, Vector3r::Zero());
    }
    for (auto* list : {&loaded_.velocities, &loaded_.lastForces})
        list->resize(next, Vector3r::Zero());
}

// Gives every node its place in the rows. Congruent units stand side by side, one in each lane.
void Zones::layOut() {
    batches_.clear();
    places_.assign(loaded_.displacements.size(), 0);
    std::vector<const BlockElasticity*> kinds; // in the order in which they were met
    for (const auto& unit : units_)
        if (std::find(kinds.begin(), kinds.end(), unit.elasticity.get()) == kinds.end())
            kinds.push_back(unit.elasticity.get());
    int rows = 0;
    for (const auto* kind : kinds) {
        const int nodes = int(kind->masses().size());
        for (std::size_t u = 0; u < units_.size(); ++u) {
            if (units_[u].elasticity.get() != kind) continue;
            if (batches_.empty() || batches_.back().elasticity != kind || batches_.back().units.size() == lanes) {
                batches_.push_back({kind, rows, {}});
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
    for (std::size_t node = 0; node < places_.size(); ++node) {
        put(displacements_, places_[node], loaded_.displacements[node]);
        put(velocities_, places_[node], loaded_.velocities[node]);
        put(lastForces_, places_[node], loaded_.lastForces[node]);
    }
    loaded_ = {};
    ++changes; // others have to look up the places again
}

const Zones::Unit* Zones::unitOf(int body) {
    units();
    const bool mine = body >= 0 && std::size_t(body) < unitOfBody_.size() && unitOfBody_[body] >= 0;
    return mine ? &units_[unitOfBody_[body]] : nullptr;
}

void Zones::setVelocity(int node, const Vector3r& velocity) {
    units();
    if (!velocity.allFinite()) throw std::invalid_argument("velocity of a node must be finite numbers [m/s]");
    if (node < 0 || std::size_t(node) >= places_.size())
        throw std::invalid_argument("there is no node " + std::to_string(node));
    put(velocities_, places_[node], velocity);
}

Vector3r Zones::reference(const Unit& unit, int node) const {
    return unit.centre + unit.elasticity->mesh().nodes[node - unit.firstNode];
}

Attachment Zones::attach(const Unit& unit, const Vector3r& point) const {
    auto place = nearestOnSurface(unit.elasticity->mesh(), point - unit.centre);
    // Round-off leaves a point on an edge or at a node a little weight on the other nodes. The largest weight comes
    // first.
    double sum = 0;
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return place.weights[i] > place.weights[j]; });
    for (double& weight : place.weights) {
        if (weight < 1e-9) weight = 0;
        sum += weight;
    }
    Attachment a;
    for (int i = 0; i < 3; ++i) {
        a.nodes[i] = unit.firstNode + place.nodes[order[i]];
        a.weights[i] = place.weights[order[i]] / sum;
    }
    return a;
}

std::optional<Zones::Covered> Zones::cover(const Unit& unit, const std::vector<Vector3r>& polygon,
                                           const Vector3r& normal, const Vector3r& along) const {
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
    const auto place = [&](int node) { return Vector3r(unit.centre + mesh.nodes[node]); };
    const Vector3r across = normal.cross(along);
    bool held = false; // whether the nodes are held in the direction across
    for (int d = 0; d < 3; ++d)
        held = held || (holds(d) && across.cross(Vector3r::Unit(d)).norm() < 1e-6);
    Covered found;
    double sum = 0;
    const auto add = [&](const Subcontact& point) {
        const auto at = std::find_if(found.points.begin(), found.points.end(), [&](const Subcontact& other) {
            return (other.centre - point.centre).norm() < 1e-6 * size;
        });
        if (at == found.points.end())
            found.points.push_back(point);
        else
            at->area += point.area;
    };
    const auto name = [&](int node) {
        const int number = unit.firstNode + node;
        if (std::find(found.nodes.begin(), found.nodes.end(), number) == found.nodes.end())
            found.nodes.push_back(number);
    };
    for (const auto& edge : mesh.rim) {
        const Vector3r a = place(edge[0]), b = place(edge[1]);
        if (!held || !inside(a) || !inside(b)) continue;
        const double part = (b - a).norm() * mesh.thickness;
        sum += part;
        name(edge[0]);
        name(edge[1]);
        add({a, part / 6});
        add({0.5 * (a + b), part / 1.5});
        add({b, part / 6});
    }
    for (std::size_t n = 0; n < mesh.triangles.size() && mesh.across < 0; ++n) {
        const auto& t = mesh.triangles[n];
        if (!std::all_of(t.begin(), t.end(), [&](int node) { return inside(place(node)); })) continue;
        const Vector3r a = place(t[0]), b = place(t[1]), c = place(t[2]);
        const double part = 0.5 * (b - a).cross(c - a).norm();
        sum += part;
        for (int node : t)
            name(node);
        if (held && !mesh.cellFaces.empty()) {
            if (n % 2 != 0) continue; // the first half of a face stands for both
            const auto& face = mesh.cellFaces[n / 2];
            const auto& half = mesh.triangles[n + 1];
            const double both = 2 * part;
            for (int node : t) // the ends of the diagonal
                if (std::find(half.begin(), half.end(), node) != half.end()) add({place(node), both / 6});
            const auto edge = [&](int i) { return Vector3r(place(face[(i + 1) % 4]) - place(face[i % 4])); };
            const int first = std::abs(edge(0).dot(along)) > std::abs(edge(1).dot(along)) ? 0 : 1;
            for (int i : {first, first + 2}) // the edges along the joint
                add({place(face[i % 4]) + 0.5 * edge(i), both / 3});
        } else {
            for (const auto& corner : {a, b, c})
                add({corner, part / 12});
            add({(a + b + c) / 3, 0.75 * part});
        }
    }
    if (std::abs(sum - whole) > 1e-3 * whole) return std::nullopt;
    return found;
}

// ---- a step -----------------------------------------------------------------------------------------------------

namespace {

double total(const Row& row) {
    double sum = 0;
    for (double value : row.lane)
        sum += value;
    return sum;
}

} // namespace

void Zones::followGravity(const Vector3r& ofIntegrator) {
    const auto asText = [](const Vector3r& g) {
        return "(" + text(g[0]) + ", " + text(g[1]) + ", " + text(g[2]) + ")";
    };
    if (falling && gravity != lastGravity && gravity != ofIntegrator)
        throw std::invalid_argument("MasonryZones.gravity " + asText(gravity) +
                                    " m/s² is not that of the integrator, " + asText(ofIntegrator) +
                                    " m/s²: set the gravity of the integrator alone, MasonryZones follows it");
    gravity = ofIntegrator;
}

void Zones::advance(yade::Scene& scene, BodyColumns& columns, const Vector3r& ofIntegrator, double massDamping) {
    followGravity(ofIntegrator);
    units();
    scene_ = scene.shared_from_this();
    acted_ = true;
    const NodeMotion motion{scene.dt,
                            damping,
                            {gravity[0], gravity[1], gravity[2]},
                            dampingKind == "combined",
                            {holds(0), holds(1), holds(2)},
                            massDamping};
    const int count = int(batches_.size());
    std::vector<NodeSums> sums(count);
    std::vector<Row> energies(count);
    std::size_t most = 0; // largest number of nodes of a unit
    for (const auto& batch : batches_)
        most = std::max(most, batch.elasticity->masses().size());
    Parallel::instance().overPieces(count, 1, [&](int first, int beyond) {
        thread_local std::vector<Row> scratch;
        if (scratch.size() < 6 * most) scratch.resize(6 * most);
        for (int b = first; b < beyond; ++b) {
            const auto& batch = batches_[b];
            const auto matrix = batch.elasticity->matrix();
            const int row = batch.firstRow;
            Row present{}, turned[9];
            std::fill_n(present.lane, batch.units.size(), 1.0);
            addBlockForces(matrix, &displacements_[row], &moments_[3 * b], &forces_[row], turned, &energies[b],
                           scratch.data());
            moveBlocks(matrix, motion, present, &displacements_[row], &velocities_[row], &forces_[row],
                       &lastForces_[row], sums[b]);
            for (std::size_t lane = 0; lane < batch.units.size(); ++lane) {
                const auto& unit = units_[batch.units[lane]];
                Matrix3 rotation;
                for (int i = 0; i < 9; ++i)
                    rotation(i / 3, i % 3) = turned[i].lane[lane];
                Vector3r place;
                for (int d = 0; d < 3; ++d)
                    place[d] = unit.centre[d] + sums[b].moved[d].lane[lane] / batch.elasticity->mass();
                columns.setPlace(unit.body, place, Quaternionr(rotation) * unit.orientation);
            }
        }
    });
    const double before = fallen;
    const Vector3r moment = moved; // the work is counted up to the beginning of this step
    beginStep();
    moved.setZero();
    for (int b = 0; b < count; ++b) {
        add({0, total(sums[b].damping), 0, total(sums[b].pending), total(sums[b].kinetic), total(sums[b].gravityWork),
             total(energies[b])});
        for (int d = 0; d < 3; ++d)
            moved[d] += total(sums[b].moved[d]);
    }
    fallen = workOfGravity(fallen, gravity, moment, before);
}

} // namespace masonry
