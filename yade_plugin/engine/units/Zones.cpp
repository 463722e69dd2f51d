// SPDX-License-Identifier: GPL-2.0-or-later
#include "Zones.hpp"
#include "common/Parallel.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/bodies/Changes.hpp"
#include "engine/bodies/ClassRole.hpp"
#include "engine/bodies/UnitMaterial.hpp"
#include <algorithm>
#include <map>

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
        wrong.push_back("bodies and divisions cannot change once joints or a run know their nodes");
    return wrong;
}

void Zones::divideAnew() {
    if (!units_.empty()) loaded_ = {displacements(), velocities(), lastForces()};
    units_.clear();
    batches_.clear();
    groups_.clear();
    places_.clear();
    ++changes;
}

// ---- state of the nodes -----------------------------------------------------------------------------------------

void Zones::checkAlive() const {
    if (acted_ && scene_.expired())
        throw std::runtime_error("these " + nameOf(ClassRole::Units) +
                                 " are gone: the scene that they belonged to has ended");
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
            wrong.push_back(nameOf(ClassRole::Units) + ": body " + std::to_string(id) + " " + what);
        };
        if (id < 0 || std::size_t(id) >= all.size() || !all[id]) {
            fail("does not exist");
            continue;
        }
        const auto* mat = dynamic_cast<const UnitMaterial*>(all[id]->material.get());
        if (!isBlock(all[id]->shape.get()) || !mat) {
            fail("is no block of " + nameOf(ClassRole::Material));
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
                if (held >= 0) made = divideInPlane(block, cells, held);
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
        wrong.push_back(nameOf(ClassRole::Units) + ": bodies of " + std::to_string(next) +
                        " nodes do not fit the state of " + std::to_string(known) + " nodes");
    for (const auto* list : {&loaded_.velocities, &loaded_.lastForces})
        if (known != 0 && !list->empty() && list->size() != known)
            wrong.push_back(nameOf(ClassRole::Units) + ": the state has " + std::to_string(known) +
                            " displacements of nodes and " + std::to_string(list->size()) + " velocities or forces");
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

// Puts a unit into the next lane of a batch.
void Zones::addUnit(int number, int n) {
    auto& batch = batches_[n];
    auto& unit = units_[number];
    const int nodes = int(unit.elasticity->masses().size()), lane = int(batch.units.size());
    for (int node = 0; node < nodes; ++node)
        places_[unit.firstNode + node] = lanes * (batch.firstRow + 3 * node) + lane;
    unit.momentPlace = lanes * 3 * n + lane;
    batch.units.push_back(number);
}

// Whether both bodies of a brick are deformable, and both in the plane or both in space.
bool Zones::isPair(const Brick& brick) {
    const auto *one = unitOf(brick.body1), *two = unitOf(brick.body2);
    return one && two && one->elasticity->mesh().across == two->elasticity->mesh().across;
}

// Gives both units of every brick the same lane in two batches that are moved together.
void Zones::pairUp() {
    std::map<std::pair<const BlockElasticity*, const BlockElasticity*>, int> open; // the last group of two kinds
    for (std::size_t b = 0; b < bricks_.size(); ++b) {
        if (!isPair(bricks_[b])) continue;
        const auto *one = unitOf(bricks_[b].body1), *two = unitOf(bricks_[b].body2);
        const auto [at, fresh] = open.emplace(std::pair(one->elasticity.get(), two->elasticity.get()), -1);
        if (fresh || groups_[at->second].bricks.size() == lanes) {
            at->second = int(groups_.size());
            groups_.push_back({int(batches_.size()), int(batches_.size()) + 1, {}});
            for (const auto* unit : {one, two}) {
                batches_.push_back({unit->elasticity.get(), rows_, {}});
                rows_ += 3 * int(unit->elasticity->masses().size());
            }
        }
        auto& group = groups_[at->second];
        group.bricks.push_back(int(b));
        addUnit(unitOfBody_[bricks_[b].body1], group.first);
        addUnit(unitOfBody_[bricks_[b].body2], group.second);
    }
}

// Gives every node its place in the rows. Congruent units stand side by side, one in each lane.
void Zones::layOut() {
    batches_.clear();
    groups_.clear();
    rows_ = 0;
    places_.assign(loaded_.displacements.size(), -1);
    if (massScaling > 0) pairUp();
    const std::size_t paired = batches_.size();
    std::vector<const BlockElasticity*> kinds; // in the order in which they were met
    for (const auto& unit : units_)
        if (std::find(kinds.begin(), kinds.end(), unit.elasticity.get()) == kinds.end())
            kinds.push_back(unit.elasticity.get());
    for (const auto* kind : kinds) {
        const int nodes = int(kind->masses().size());
        for (std::size_t u = 0; u < units_.size(); ++u) {
            if (units_[u].elasticity.get() != kind || places_[units_[u].firstNode] >= 0) continue;
            if (batches_.size() == paired || batches_.back().elasticity != kind ||
                batches_.back().units.size() == lanes) {
                groups_.push_back({int(batches_.size()), -1, {}});
                batches_.push_back({kind, rows_, {}});
                rows_ += 3 * nodes;
            }
            addUnit(int(u), int(batches_.size()) - 1);
        }
    }
    const int rows = rows_;
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
        throw std::invalid_argument(nameOf(ClassRole::Units) + ".gravity " + asText(gravity) +
                                    " m/s² is not that of the integrator, " + asText(ofIntegrator) +
                                    " m/s²: set the gravity of the integrator alone, " + nameOf(ClassRole::Units) +
                                    " follows it");
    gravity = ofIntegrator;
}

// Forces and motion of one batch, or of the two of a group.
void Zones::advanceGroup(const LaneGroup& group, const NodeMotion& motion, BodyColumns& columns,
                         std::vector<NodeSums>& sums, std::vector<Row>& energies) {
    thread_local std::vector<Row> scratch;
    const int members[2] = {group.first, group.second}, count = group.second < 0 ? 1 : 2;
    std::size_t nodes = 0;
    for (int k = 0; k < count; ++k)
        nodes += batches_[members[k]].elasticity->masses().size();
    if (scratch.size() < 9 * nodes) scratch.resize(9 * nodes);
    LaneUnits scaled[2];
    Row turned[2][9];
    for (int k = 0; k < count; ++k) {
        const int b = members[k];
        const auto& batch = batches_[b];
        const int row = batch.firstRow;
        auto& s = scaled[k];
        s = {batch.elasticity->matrix(),
             {},
             &displacements_[row],
             &velocities_[row],
             &forces_[row],
             &lastForces_[row],
             {},
             {}};
        std::fill_n(s.present.lane, batch.units.size(), 1.0);
        addBlockForces(s.matrix, s.displacements, &moments_[3 * b], s.forces, turned[k], &energies[b], scratch.data());
        if (massScaling == 0) moveBlocks(motion, s);
    }
    if (massScaling > 0) {
        Row whole{};
        for (std::size_t lane = 0; lane < group.bricks.size(); ++lane) {
            whole.lane[lane] = bricks_[group.bricks[lane]].split ? 0 : 1;
            const auto &one = units_[batches_[group.first].units[lane]],
                       &two = units_[batches_[group.second].units[lane]];
            for (int d = 0; d < 3; ++d)
                scaled[1].offset[d].lane[lane] = two.centre[d] - one.centre[d];
        }
        moveScaled(motion, massScaling, scaled, count, whole, scratch.data());
    }
    for (int k = 0; k < count; ++k) {
        sums[members[k]] = scaled[k].sums;
        const auto& batch = batches_[members[k]];
        for (std::size_t lane = 0; lane < batch.units.size(); ++lane) {
            const auto& unit = units_[batch.units[lane]];
            Matrix3 rotation;
            for (int i = 0; i < 9; ++i)
                rotation(i / 3, i % 3) = turned[k][i].lane[lane];
            Vector3r place;
            for (int d = 0; d < 3; ++d)
                place[d] = unit.centre[d] + sums[members[k]].moved[d].lane[lane] / batch.elasticity->mass();
            columns.setPlace(unit.body, place, Quaternionr(rotation) * unit.orientation);
        }
    }
}

// ---- masses that are scaled -------------------------------------------------------------------------------------

void Zones::takeBricks(std::vector<Brick> bricks) {
    const bool same =
        std::equal(bricks.begin(), bricks.end(), bricks_.begin(), bricks_.end(),
                   [](const Brick& a, const Brick& b) { return a.body1 == b.body1 && a.body2 == b.body2; });
    bricks_ = std::move(bricks);
    int most = -1;
    for (const auto& brick : bricks_)
        most = std::max(most, brick.body1);
    brickOfBody_.assign(most + 1, -1);
    for (std::size_t b = 0; b < bricks_.size(); ++b)
        brickOfBody_[bricks_[b].body1] = int(b);
    for (int body : splitBricks)
        if (body < int(brickOfBody_.size()) && body >= 0 && brickOfBody_[body] >= 0)
            bricks_[brickOfBody_[body]].split = true;
    if (!same && massScaling > 0) divideAnew();
}

void Zones::followMasses(const std::vector<int>& cracked) {
    if (cracked.empty() && massScaling == scaledBy) return;
    const double before = kineticEnergy(scaledBy);
    for (int body : cracked) {
        bricks_[brickOfBody_[body]].split = true;
        splitBricks.push_back(body);
    }
    if (falling) damped += before - kineticEnergy(massScaling);
    scaledBy = massScaling;
}

// They do not depend on how the units are laid out, which may have changed since the last step.
std::vector<Zones::Block> Zones::blocks() {
    std::vector<Block> all;
    std::vector<bool> taken(units().size(), false);
    for (const auto& brick : bricks_) {
        if (!isPair(brick)) continue;
        all.push_back({{unitOf(brick.body1), unitOf(brick.body2)}, brick.split});
        taken[unitOfBody_[brick.body1]] = taken[unitOfBody_[brick.body2]] = true;
    }
    for (std::size_t u = 0; u < units_.size(); ++u)
        if (!taken[u]) all.push_back({{&units_[u]}, false});
    return all;
}

Eigen::MatrixXd Zones::motionsOfParts(const Block& block) const {
    Eigen::MatrixXd all;
    for (const auto* unit : block.units) {
        const auto own = rigidMotions({unit});
        const Eigen::Index rows = all.rows(), columns = all.cols();
        all.conservativeResizeLike(Eigen::MatrixXd::Zero(rows + own.rows(), columns + own.cols()));
        all.bottomRightCorner(own.rows(), own.cols()) = own;
    }
    return all;
}

Eigen::MatrixXd Zones::rigidMotions(const std::vector<const Unit*>& group) const {
    std::vector<Vector3r> places;
    std::vector<double> masses;
    Vector3r centre = Vector3r::Zero();
    double mass = 0;
    for (const auto* unit : group)
        for (std::size_t n = 0; n < unit->elasticity->masses().size(); ++n) {
            const int node = unit->firstNode + int(n);
            places.push_back(reference(*unit, node) + displacementOf(node));
            masses.push_back(unit->elasticity->masses()[n]);
            centre += masses.back() * places.back();
            mass += masses.back();
        }
    centre /= mass;
    const int count = int(places.size());
    std::vector<Eigen::VectorXd> found;
    const auto product = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
        double sum = 0;
        for (int i = 0; i < 3 * count; ++i)
            sum += masses[i / 3] * a[i] * b[i];
        return sum;
    };
    for (int motion = 0; motion < 6; ++motion) {
        const int d = motion % 3;
        if (motion < 3 ? holds(d) : holds((d + 1) % 3) || holds((d + 2) % 3)) continue;
        Eigen::VectorXd column(3 * count);
        for (int n = 0; n < count; ++n)
            column.segment<3>(3 * n) =
                motion < 3 ? Vector3r(Vector3r::Unit(d)) : Vector3r(Vector3r::Unit(d).cross(places[n] - centre));
        for (int twice = 0; twice < 2; ++twice)
            for (const auto& other : found)
                column -= product(other, column) * other;
        found.push_back(column / std::sqrt(product(column, column)));
    }
    Eigen::MatrixXd all(3 * count, found.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        all.col(i) = found[i];
    return all;
}

double Zones::kineticEnergy(double scaling) {
    units();
    double twice = 0;
    for (const auto& block : blocks()) {
        std::vector<double> momenta;
        double own = 0;
        for (const auto* unit : block.units)
            for (std::size_t n = 0; n < unit->elasticity->masses().size(); ++n) {
                const Vector3r velocity = velocityOf(unit->firstNode + int(n));
                const double mass = unit->elasticity->masses()[n];
                for (int d = 0; d < 3; ++d) {
                    momenta.push_back(holds(d) ? 0 : mass * velocity[d]);
                    own += momenta.back() * velocity[d];
                }
            }
        twice += own;
        if (scaling == 0) continue;
        const Eigen::Map<const Eigen::VectorXd> p(momenta.data(), Eigen::Index(momenta.size()));
        const double whole = (rigidMotions(block.units).transpose() * p).squaredNorm();
        if (block.split) {
            const double parts = (motionsOfParts(block).transpose() * p).squaredNorm();
            twice += scaling * (own - parts + sharedScaling * (parts - whole));
        } else
            twice += scaling * (own - whole);
    }
    return 0.5 * twice;
}

// ---- a step of all units ----------------------------------------------------------------------------------------

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
    Parallel::instance().overPieces(int(groups_.size()), 1, [&](int first, int beyond) {
        for (int t = first; t < beyond; ++t)
            advanceGroup(groups_[t], motion, columns, sums, energies);
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
