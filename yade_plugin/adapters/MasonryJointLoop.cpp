#include "MasonryJointLoop.hpp"
#include "SceneCheck.hpp"
#include "common/Vectorised.hpp"
#include "motion/JointFrames.hpp"
#include <algorithm>
#include <cmath>

BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointLoop)

namespace masonry {

namespace {

constexpr int block = JointFrames::most; // joints that a thread takes at a time
constexpr double flat = 1e-9;            // what counts as nothing out of the plane [rad, m, -]

// Whether numbers are the same but for round-off: stiffnesses, lengths and areas calculated in many places.
bool same(double a, double b, double scale) { return std::abs(a - b) <= 1e-12 * scale; }

// Whether y and the rotations about x and z are blocked.
bool heldInPlane(const yade::State& s) { return (s.blockedDOFs & 0b101010) == 0b101010; }

// A turn about y as cosine and sine of its half angle; whether the rotation is one.
bool aboutY(const Quaternionr& q, double& cosine, double& sine) {
    cosine = q.w(), sine = q.y();
    return std::abs(q.x()) + std::abs(q.z()) < flat;
}

// The turn of a joint's axes in a block from normal z and tangent x.
Quaternionr fromPlane(const yade::State& s, const Quaternionr& frame) {
    return s.refOri * frame * Quaternionr(0.5, 0.5, 0.5, 0.5); // e1 to x, e2 to y, e3 to z, and on by what is left
}

} // namespace

// ---- arrays ------------------------------------------------------------------------------------------------------

bool MasonryJointLoop::stale() const { return seen_ != changes || seenInteractions_ != scene->interactions->currSize; }

void MasonryJointLoop::store() {
    if (!ahead_) return;
    ahead_ = false;
    for (auto& g : groups_)
        for (std::size_t j = 0; j < g.geoms.size(); ++j) {
            auto& phys = *g.physics[j];
            phys.dissipated.setZero();
            for (int p = 0; p < g.points; ++p) {
                const std::size_t i = std::size_t(p) * g.stride + j;
                g.geoms[j]->points[p].jump = {g.jump[0][i], g.jump[1][i], g.jump[2][i]};
                phys.states[p] = g.columns.get(i);
                const auto lost = g.columns.dissipated(i);
                phys.losses[p] = {lost.tension, lost.shear, lost.compression};
                phys.dissipated += g.geoms[j]->points[p].area * phys.losses[p];
            }
        }
}

void MasonryJointLoop::release() {
    store();
    for (auto& g : groups_)
        for (std::size_t j = 0; j < g.geoms.size(); ++j)
            g.geoms[j]->keeper = nullptr, g.physics[j]->keeper = nullptr;
    groups_.clear();
    if (zones_) {
        zones_->looped = false;
        zones_->dropGuests();
    }
    zones_.reset();
    seen_ = -1;
}

int MasonryJointLoop::bodyNumber(int id, std::vector<int>& known) {
    if (known[id] < 0) {
        known[id] = int(bodies_.ids.size());
        bodies_.ids.push_back(id);
        bodies_.states.push_back(scene->bodies->body[id]->state);
        bodies_.reference.push_back(bodies_.states.back()->refOri.conjugate());
        const auto* unit = zones_ ? zones_->unitOf(id) : nullptr;
        bodies_.momentPlaces.push_back(unit ? unit->momentPlace : -1);
    }
    return known[id];
}

// Where all joints are alike, a block of them has the geometry of all, which then stays in the innermost cache.
void MasonryJointLoop::Group::share() {
    struct Column {
        std::vector<double>* values;
        int rows; // one, or one for each point
        double scale;
    };
    const double length = std::hypot(span[0][0], span[1][0], span[2][0]);
    std::vector<Column> all{{&area, points, area[0]}};
    for (int d = 0; d < 4; ++d)
        all.insert(all.end(), {{&frame1[d], 1, 1}, {&frame2[d], 1, 1}});
    for (int d = 0; d < 3; ++d)
        all.insert(all.end(), {{&span[d], 1, length}, {&offset[d], points, length}});
    alike = stride >= block;
    for (const auto& c : all)
        for (int i = 0; alike && i < stride * c.rows; ++i)
            alike = same((*c.values)[i], (*c.values)[i / stride * stride], c.scale);
    if (!alike) return;
    for (const auto& c : all) {
        for (int p = 0; p < c.rows; ++p)
            std::copy_n(c.values->begin() + p * stride, block, c.values->begin() + p * block);
        c.values->resize(c.rows * block);
        c.values->shrink_to_fit();
    }
}

void MasonryJointLoop::Gather::fill(const std::vector<std::vector<int>>& lists) {
    receivers.clear(), items.clear(), start.assign(1, 0);
    for (std::size_t r = 0; r < lists.size(); ++r) {
        if (lists[r].empty()) continue;
        receivers.push_back(int(r));
        items.insert(items.end(), lists[r].begin(), lists[r].end());
        start.push_back(int(items.size()));
    }
}

// Whether all joints lie across a plane y = constant, on blocks that can move and turn in it only, and have no stress
// or jump out of it beyond round-off.
bool MasonryJointLoop::inPlane() const {
    double cosine, sine;
    for (const auto& g : groups_)
        for (std::size_t j = 0; j < g.geoms.size(); ++j) {
            const auto& geom = *g.geoms[j];
            if ((geom.normal.cross(geom.tangent) - Vector3r::UnitY()).norm() > flat) return false;
            for (int side = 0; side < 2; ++side) {
                const int id = side ? g.body2[j] : g.body1[j];
                const auto& s = *scene->bodies->body[id]->state;
                const bool held = zones_ && zones_->unitOf(id) ? zones_->holds(1) : heldInPlane(s);
                if (!held || !(std::abs(s.pos.y() - s.refPos.y()) < flat) ||
                    !aboutY(fromPlane(s, side ? geom.frame2 : geom.frame1), cosine, sine) ||
                    !aboutY(s.ori * s.refOri.conjugate(), cosine, sine))
                    return false;
            }
            for (int p = 0; p < g.points; ++p) {
                const auto& phys = *g.physics[j];
                const double elastic = phys.states[p].shearStress.b / phys.shearStiffness;
                if (!(std::abs(elastic) + std::abs(geom.points[p].jump[2]) < flat)) return false;
            }
        }
    return true;
}

// Joints are grouped by what their subcontacts have in common; within a group they keep the order of YADE's container.
void MasonryJointLoop::build(bool mayBePlane) {
    release();
    bodies_ = {};
    guests_.clear();
    for (std::size_t n = 0; n < scene->interactions->currSize; ++n) {
        const auto& interaction = *scene->interactions->linIntrs[n];
        const auto geom = boost::dynamic_pointer_cast<MasonryJointGeom>(interaction.geom);
        const auto phys = boost::dynamic_pointer_cast<MasonryJointPhys>(interaction.phys);
        if (!geom || !phys) continue;
        if (geom->keeper) geom->keeper->release();
        const int points = int(geom->points.size());
        auto group = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) {
            return g.joint == phys->joint && g.points == points && g.nodal == bool(geom->zones) &&
                   same(g.physics[0]->normalStiffness, phys->normalStiffness, phys->normalStiffness) &&
                   same(g.physics[0]->shearStiffness, phys->shearStiffness, phys->shearStiffness);
        });
        if (group == groups_.end()) {
            group = groups_.insert(groups_.end(), Group());
            group->joint = phys->joint, group->points = points, group->nodal = bool(geom->zones);
        }
        if (geom->zones && zones_ && zones_ != geom->zones)
            throw std::invalid_argument("MasonryJointLoop: the joints of a scene can belong to one MasonryZones only");
        if (geom->zones) zones_ = geom->zones;
        group->geoms.push_back(geom), group->physics.push_back(phys);
        group->body1.push_back(interaction.id1), group->body2.push_back(interaction.id2);
    }
    if (zones_) zones_->units();
    plane_ = mayBePlane && inPlane();

    std::vector<int> known(scene->bodies->body.size(), -1);
    std::vector<std::vector<int>> atBodies, atPlaces;
    blocks_.clear();
    int joints = 0, points = 0;
    for (auto& g : groups_) {
        const int count = int(g.geoms.size());
        g.stride = (count + lanes - 1) / lanes * lanes;
        g.first = joints, g.firstPoint = points;
        joints += g.stride;
        if (g.nodal) points += g.stride * g.points;
        for (int from = 0; from < g.stride; from += block)
            blocks_.emplace_back(int(&g - groups_.data()), from);
        for (auto* columns : {g.frame1, g.frame2})
            for (int d = 0; d < 4; ++d)
                columns[d].resize(g.stride);
        for (auto& column : g.span)
            column.resize(g.stride);
        for (auto* column : {&g.area, &g.jump[0], &g.jump[1], &g.jump[2], &g.offset[0], &g.offset[1], &g.offset[2]})
            column->resize(std::size_t(g.stride) * g.points);
        g.columns = JointColumns(g.joint->law(), g.physics[0]->stiffness(), std::size_t(g.stride) * g.points);
        g.body1.resize(g.stride, g.body1.back()), g.body2.resize(g.stride, g.body2.back());
        for (int j = 0; j < g.stride; ++j) { // the last joint stands for the places up to whole lanes, too
            const bool real = j < count;
            auto& geom = *g.geoms[std::min(j, count - 1)];
            auto& phys = *g.physics[std::min(j, count - 1)];
            geom.keeper = phys.keeper = this;
            for (auto* body : {&g.body1[j], &g.body2[j]}) {
                *body = bodyNumber(*body, known);
                atBodies.resize(bodies_.ids.size());
                if (real) atBodies[*body].push_back(2 * (g.first + j) + (body == &g.body2[j]));
            }
            const auto put = [&](std::vector<double>* columns, const Quaternionr& q, int body) {
                if (plane_)
                    aboutY(fromPlane(*bodies_.states[body], q), columns[0][j], columns[1][j]);
                else
                    columns[0][j] = q.w(), columns[1][j] = q.x(), columns[2][j] = q.y(), columns[3][j] = q.z();
            };
            put(g.frame1, geom.frame1, g.body1[j]), put(g.frame2, geom.frame2, g.body2[j]);
            for (int d = 0; d < 3; ++d)
                g.span[d][j] = geom.centreToCentre[d];
            for (int p = 0; p < g.points; ++p) {
                const std::size_t i = std::size_t(p) * g.stride + j;
                g.area[i] = geom.points[p].area;
                for (int d = 0; d < 3; ++d)
                    g.jump[d][i] = geom.points[p].jump[d], g.offset[d][i] = geom.points[p].offset[d];
                g.columns.set(g.joint->law(), i, phys.states[p]);
                g.columns.setDissipated(i, {phys.losses[p][0], phys.losses[p][1], phys.losses[p][2]});
            }
        }
        g.share();
        if (g.nodal) buildPlaces(g, atPlaces);
    }
    for (auto& column : bodies_.position)
        column.resize(bodies_.ids.size());
    for (std::size_t b = 0; plane_ && b < bodies_.ids.size(); ++b)
        bodies_.position[2][b] = bodies_.states[b]->refPos.y();
    for (auto& column : bodies_.orientation)
        column.resize(bodies_.ids.size());
    onJoints_.assign(std::size_t(plane_ ? 4 : 9) * joints, 0);
    onPoints_.assign(std::size_t(plane_ ? 2 : 3) * points, 0);
    bodyGather_.fill(atBodies);
    nodeGather_.fill(atPlaces);
    if (zones_) zones_->looped = true;
    seen_ = changes, seenInteractions_ = scene->interactions->currSize;
}

// Where the two sides of nodal joints stand in the rows of MasonryZones.
void MasonryJointLoop::buildPlaces(Group& g, std::vector<std::vector<int>>& atPlaces) {
    g.place1.assign(std::size_t(g.stride) * g.points, 0);
    g.place2 = g.place1;
    for (std::size_t j = 0; j < g.geoms.size(); ++j) {
        const auto& geom = *g.geoms[j];
        for (int p = 0; p < g.points; ++p)
            for (int side = 0; side < 2; ++side) {
                const auto& attachments = side ? geom.attachments2 : geom.attachments1;
                int place;
                if (!attachments.empty() && attachments[p].weights[0] == 1)
                    place = zones_->placeOf(attachments[p].nodes[0]);
                else {
                    Guest guest{zones_->addGuest(), -1, geom.centre(geom.points[p]), Vector3r::Zero(), {}};
                    if (attachments.empty()) {
                        guest.body = side ? g.body2[j] : g.body1[j];
                        guest.local = (side ? geom.orientation2 : geom.orientation1).conjugate() *
                                      (guest.reference - (side ? geom.position2 : geom.position1));
                    } else
                        guest.attachment = attachments[p];
                    guests_.push_back(guest);
                    place = guest.place;
                }
                const int i = p * g.stride + int(j);
                (side ? g.place2 : g.place1)[i] = place;
                if (int(atPlaces.size()) <= place) atPlaces.resize(place + 1);
                atPlaces[place].push_back(2 * (g.firstPoint + i) + side);
            }
    }
}

// ---- a step ------------------------------------------------------------------------------------------------------

// ---- a step ------------------------------------------------------------------------------------------------------

// Whether the bodies are where the arrays can follow them: in the plane, if those are for the plane.
bool MasonryJointLoop::readBodies() {
    const int count = int(bodies_.ids.size());
    bool fits = true;
#pragma omp parallel for schedule(static) reduction(&& : fits)
    for (int b = 0; b < count; ++b) {
        if (b + 8 < count) __builtin_prefetch(&bodies_.states[b + 8]->ori);
        const auto& s = *bodies_.states[b];
        if (plane_) {
            bodies_.position[0][b] = s.pos[2], bodies_.position[1][b] = s.pos[0];
            fits = fits && aboutY(s.ori * bodies_.reference[b], bodies_.orientation[0][b], bodies_.orientation[1][b]);
            fits = fits && std::abs(s.pos[1] - bodies_.position[2][b]) < flat;
            fits = fits && (bodies_.momentPlaces[b] >= 0 || heldInPlane(s));
        } else {
            for (int d = 0; d < 3; ++d)
                bodies_.position[d][b] = s.pos[d], bodies_.orientation[d + 1][b] = s.ori.coeffs()[d];
            bodies_.orientation[0][b] = s.ori.w();
        }
    }
    return fits;
}

void MasonryJointLoop::advanceBlock(Group& g, int from, int n) {
    JointFrames frames;
    const int own = g.alike ? 0 : from;
    const double *position[3], *orientation[4], *frame1[4], *frame2[4], *span[3];
    for (int d = 0; d < 4; ++d)
        orientation[d] = bodies_.orientation[d].data(), frame1[d] = &g.frame1[d][own], frame2[d] = &g.frame2[d][own];
    for (int d = 0; d < 3; ++d)
        position[d] = bodies_.position[d].data(), span[d] = &g.span[d][own];
    const int *body1 = &g.body1[from], *body2 = &g.body2[from];
    if (g.nodal)
        (plane_ ? alignNodalInPlane : alignNodal)(n, body1, body2, orientation, frame1, frame2, frames);
    else
        (plane_ ? alignRigidInPlane : alignRigid)(n, body1, body2, position, orientation, frame1, frame2, span, frames);
    const auto& law = g.joint->law();
    for (int p = 0; p < g.points; ++p) {
        const std::size_t i = std::size_t(p) * g.stride + from;
        const std::size_t at = g.alike ? p * block : i;
        const double *area = &g.area[at], *a0 = &g.offset[0][at], *a1 = &g.offset[1][at], *a2 = &g.offset[2][at];
        double *j0 = &g.jump[0][i], *j1 = &g.jump[1][i], *j2 = &g.jump[2][i];
        if (g.nodal) {
            const int *place1 = &g.place1[i], *place2 = &g.place2[i];
            const double* u = zones_->displacementRows();
            plane_ ? jumpNodalInPlane(n, place1, place2, u, j0, j1, frames)
                   : jumpNodal(n, place1, place2, u, j0, j1, j2, frames);
        } else
            plane_ ? jumpRigidInPlane(n, a0, a1, j0, j1, frames) : jumpRigid(n, a0, a1, a2, j0, j1, j2, frames);
        g.columns.advance(law, i, n, frames.step[0], frames.step[1], plane_ ? nullptr : frames.step[2],
                          frames.normalStress);
        const double *normal = frames.normalStress, *a = g.columns.shearStressA() + i,
                     *b = g.columns.shearStressB() + i;
        if (g.nodal)
            plane_ ? pullNodalInPlane(n, area, normal, a, j0, j1, frames, &onPoints_[2 * (g.firstPoint + i)])
                   : pullNodal(n, area, normal, a, b, j0, j1, j2, frames, &onPoints_[3 * (g.firstPoint + i)]);
        else
            plane_ ? pullRigidInPlane(n, area, normal, a, a0, a1, frames) : pullRigid(n, area, normal, a, b, frames);
    }
    double* onJoints = &onJoints_[std::size_t(plane_ ? 4 : 9) * (g.first + from)];
    if (g.nodal)
        (plane_ ? finishNodalInPlane : finishNodal)(n, frames, onJoints);
    else
        (plane_ ? finishRigidInPlane : finishRigid)(n, frames, onJoints);
}

void MasonryJointLoop::moveGuests() {
    double* rows = zones_->displacementRows();
    for (const auto& guest : guests_) {
        Vector3r moved;
        if (guest.body >= 0) {
            const auto& s = *bodies_.states[guest.body];
            moved = s.pos + s.ori * guest.local - guest.reference;
        } else
            moved = zones_->displacementAt(guest.attachment);
        for (int d = 0; d < 3; ++d)
            rows[guest.place + d * lanes] = moved[d];
    }
}

void MasonryJointLoop::toBodies() {
    const int count = int(bodyGather_.receivers.size());
#pragma omp parallel for schedule(static)
    for (int r = 0; r < count; ++r) {
        Vector3r force = Vector3r::Zero(), torque = Vector3r::Zero();
        for (int n = bodyGather_.start[r]; n < bodyGather_.start[r + 1]; ++n) {
            const int item = bodyGather_.items[n], second = item % 2;
            const double sign = second ? -1 : 1;
            if (plane_) {
                const double* on = &onJoints_[4 * (item / 2)];
                force[0] += sign * on[0], force[2] += sign * on[1], torque[1] += on[2 + second];
            } else {
                const double* on = &onJoints_[9 * (item / 2)];
                for (int d = 0; d < 3; ++d)
                    force[d] += sign * on[d], torque[d] += on[3 + 3 * second + d];
            }
        }
        const int body = bodyGather_.receivers[r];
        if (bodies_.momentPlaces[body] >= 0) {
            for (int d = 0; d < 3; ++d)
                (zones_->momentRows() + bodies_.momentPlaces[body])[d * lanes] = torque[d];
        } else
            forces_[bodies_.ids[body]] += force, torques_[bodies_.ids[body]] += torque;
    }
}

void MasonryJointLoop::toNodes() {
    double* forces = zones_->forceRows();
    const int count = int(nodeGather_.receivers.size());
#pragma omp parallel for schedule(static)
    for (int r = 0; r < count; ++r) {
        double x = 0, y = 0, z = 0;
        for (int n = nodeGather_.start[r]; n < nodeGather_.start[r + 1]; ++n) {
            const int item = nodeGather_.items[n];
            const double sign = item % 2 ? -1 : 1;
            if (plane_) {
                const double* on = &onPoints_[2 * (item / 2)];
                x += sign * on[0], z += sign * on[1];
            } else {
                const double* on = &onPoints_[3 * (item / 2)];
                x += sign * on[0], y += sign * on[1], z += sign * on[2];
            }
        }
        double* at = forces + nodeGather_.receivers[r];
        at[0] = x, at[lanes] = y, at[2 * lanes] = z;
    }
    for (const auto& guest : guests_) {
        const double* on = forces + guest.place;
        const Vector3r force(on[0], on[lanes], on[2 * lanes]);
        if (guest.body >= 0) {
            forces_[bodies_.ids[guest.body]] += force;
            torques_[bodies_.ids[guest.body]] += (bodies_.states[guest.body]->ori * guest.local).cross(force);
        } else
            for (int i = 0; i < 3; ++i)
                for (int d = 0; d < 3; ++d)
                    forces[zones_->placeOf(guest.attachment.nodes[i]) + d * lanes] +=
                        guest.attachment.weights[i] * force[d];
    }
}

void MasonryJointLoop::action() {
    checkScene(*scene);
    if (stale()) build(true);
    if (!readBodies()) {
        build(false);
        readBodies();
    }
    if (zones_) moveGuests();
    const int count = int(blocks_.size());
#pragma omp parallel for schedule(static)
    for (int n = 0; n < count; ++n) {
        auto& g = groups_[blocks_[n].first];
        const int from = blocks_[n].second;
        advanceBlock(g, from, std::min(block, g.stride - from));
    }
    ahead_ = true;
    forces_ = scene->forces().forces(int(scene->bodies->body.size()));
    torques_ = scene->forces().torques(int(scene->bodies->body.size()));
    toBodies();
    if (zones_) toNodes();
}

} // namespace masonry
