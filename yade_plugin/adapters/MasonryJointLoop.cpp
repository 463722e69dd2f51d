#include "MasonryJointLoop.hpp"
#include "SceneCheck.hpp"
#include "Vectorised.hpp"
#include <algorithm>

BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointLoop)

namespace masonry {

namespace {
constexpr int block = 32; // joints that a thread takes at a time
}

// ---- arrays ------------------------------------------------------------------------------------------------------

bool MasonryJointLoop::stale() const { return seen_ != changes || seenInteractions_ != scene->interactions->currSize; }

void MasonryJointLoop::store() {
    if (!ahead_) return;
    ahead_ = false;
    for (auto& g : groups_)
        for (std::size_t j = 0; j < g.geoms.size(); ++j)
            for (int p = 0; p < g.points; ++p) {
                const std::size_t i = std::size_t(p) * g.stride + j;
                g.geoms[j]->points[p].jump = {g.jump[0][i], g.jump[1][i], g.jump[2][i]};
                g.physics[j]->states[p] = g.columns.get(i);
                const auto lost = g.columns.takeDissipated(i);
                g.physics[j]->dissipated += g.area[i] * Vector3r(lost.tension, lost.shear, lost.compression);
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
        const auto* unit = zones_ ? zones_->unitOf(id) : nullptr;
        bodies_.momentPlaces.push_back(unit ? unit->momentPlace : -1);
    }
    return known[id];
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

// Joints are grouped by what their subcontacts have in common; within a group they keep the order of YADE's container.
void MasonryJointLoop::build() {
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
                   g.physics[0]->normalStiffness == phys->normalStiffness &&
                   g.physics[0]->shearStiffness == phys->shearStiffness;
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
        for (auto* column : {&g.frame1[0], &g.frame2[0]}) // no turn, where a column ends before whole lanes do
            column->assign(g.stride, 1);
        for (int d = 1; d < 4; ++d)
            for (auto* column : {&g.frame1[d], &g.frame2[d], &g.span[d - 1]})
                column->assign(g.stride, 0);
        for (auto* column : {&g.area, &g.jump[0], &g.jump[1], &g.jump[2], &g.offset[0], &g.offset[1], &g.offset[2]})
            column->assign(std::size_t(g.stride) * g.points, 0);
        g.columns = JointColumns(g.joint->law(), g.physics[0]->stiffness(), std::size_t(g.stride) * g.points);
        for (int j = 0; j < count; ++j) {
            auto& geom = *g.geoms[j];
            auto& phys = *g.physics[j];
            geom.keeper = phys.keeper = this;
            for (auto* body : {&g.body1[j], &g.body2[j]}) {
                *body = bodyNumber(*body, known);
                atBodies.resize(bodies_.ids.size());
                atBodies[*body].push_back(2 * (g.first + j) + (body == &g.body2[j]));
            }
            const auto put = [j](std::vector<double>* columns, const Quaternionr& q) {
                columns[0][j] = q.w(), columns[1][j] = q.x(), columns[2][j] = q.y(), columns[3][j] = q.z();
            };
            put(g.frame1, geom.frame1), put(g.frame2, geom.frame2);
            for (int d = 0; d < 3; ++d)
                g.span[d][j] = geom.centreToCentre[d];
            for (int p = 0; p < g.points; ++p) {
                const std::size_t i = std::size_t(p) * g.stride + j;
                g.area[i] = geom.points[p].area;
                for (int d = 0; d < 3; ++d)
                    g.jump[d][i] = geom.points[p].jump[d], g.offset[d][i] = geom.points[p].offset[d];
                g.columns.set(g.joint->law(), i, phys.states[p]);
            }
        }
        g.body1.resize(g.stride, 0), g.body2.resize(g.stride, 0);
        if (g.nodal) buildPlaces(g, atPlaces);
    }
    for (auto& column : bodies_.position)
        column.resize(bodies_.ids.size());
    for (auto& column : bodies_.orientation)
        column.resize(bodies_.ids.size());
    onBodies_.assign(2 * bodies_.ids.size(), Vector3r::Zero());
    onJoints_.assign(std::size_t(9) * joints, 0);
    onPoints_.assign(std::size_t(3) * points, 0);
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

namespace {

struct Frames { // of a block of joints: scratch in the innermost cache
    double axes[9][block], v[3][block], w[block], between[3][block], common[3][block];
    double step[3][block], arm[3][block], force[3][block], torque[3][block];
};

// The equations of MasonryJointGeom::update, for many joints at a time. Columns of a block never overlap.

[[gnu::always_inline]] inline void align(int n, const int* body1, const int* body2, const double* const* q,
                                         const double* const* f1, const double* const* f2, Frames& __restrict out) {
    const double *qw = q[0], *qx = q[1], *qy = q[2], *qz = q[3];
    const double *aw = f1[0], *ax = f1[1], *ay = f1[2], *az = f1[3];
    const double *bw = f2[0], *bx = f2[1], *by = f2[2], *bz = f2[3];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const int one = body1[i], two = body2[i];
        const double w1 = qw[one] * aw[i] - qx[one] * ax[i] - qy[one] * ay[i] - qz[one] * az[i];
        const double x1 = qw[one] * ax[i] + qx[one] * aw[i] + qy[one] * az[i] - qz[one] * ay[i];
        const double y1 = qw[one] * ay[i] + qy[one] * aw[i] + qz[one] * ax[i] - qx[one] * az[i];
        const double z1 = qw[one] * az[i] + qz[one] * aw[i] + qx[one] * ay[i] - qy[one] * ax[i];
        double w2 = qw[two] * bw[i] - qx[two] * bx[i] - qy[two] * by[i] - qz[two] * bz[i];
        double x2 = qw[two] * bx[i] + qx[two] * bw[i] + qy[two] * bz[i] - qz[two] * by[i];
        double y2 = qw[two] * by[i] + qy[two] * bw[i] + qz[two] * bx[i] - qx[two] * bz[i];
        double z2 = qw[two] * bz[i] + qz[two] * bw[i] + qx[two] * by[i] - qy[two] * bx[i];
        const double same = w1 * w2 + x1 * x2 + y1 * y2 + z1 * z2 < 0 ? -1.0 : 1.0;
        w2 *= same, x2 *= same, y2 *= same, z2 *= same;
        double w = w1 + w2, x = x1 + x2, y = y1 + y2, z = z1 + z2;
        const double size = 1 / std::sqrt(w * w + x * x + y * y + z * z);
        w *= size, x *= size, y *= size, z *= size;
        out.w[i] = w * w2 + x * x2 + y * y2 + z * z2; // the half turn from the mean to side 2
        out.v[0][i] = w * x2 - x * w2 - (y * z2 - z * y2);
        out.v[1][i] = w * y2 - y * w2 - (z * x2 - x * z2);
        out.v[2][i] = w * z2 - z * w2 - (x * y2 - y * x2);
        out.axes[0][i] = 1 - 2 * (y * y + z * z);
        out.axes[1][i] = 2 * (x * y - w * z);
        out.axes[2][i] = 2 * (x * z + w * y);
        out.axes[3][i] = 2 * (x * y + w * z);
        out.axes[4][i] = 1 - 2 * (x * x + z * z);
        out.axes[5][i] = 2 * (y * z - w * x);
        out.axes[6][i] = 2 * (x * z - w * y);
        out.axes[7][i] = 2 * (y * z + w * x);
        out.axes[8][i] = 1 - 2 * (x * x + y * y);
    }
}

MASONRY_VECTORISED void alignRigid(int n, const int* body1, const int* body2, const double* const* position,
                                   const double* const* q, const double* const* f1, const double* const* f2,
                                   const double* const* span, Frames& __restrict out) {
    align(n, body1, body2, q, f1, f2, out);
    const double *px = position[0], *py = position[1], *pz = position[2];
    const double *sx = span[0], *sy = span[1], *sz = span[2];
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = px[body2[i]] - px[body1[i]], y = py[body2[i]] - py[body1[i]], z = pz[body2[i]] - pz[body1[i]];
        out.between[0][i] = x, out.between[1][i] = y, out.between[2][i] = z;
        const double v0 = out.v[0][i], v1 = out.v[1][i], v2 = out.v[2][i], w = out.w[i];
        const double t0 = 2 * (v1 * sz[i] - v2 * sy[i]), t1 = 2 * (v2 * sx[i] - v0 * sz[i]),
                     t2 = 2 * (v0 * sy[i] - v1 * sx[i]); // half d = d + w (2v × d) + v × (2v × d)
        out.common[0][i] =
            out.axes[0][i] * x + out.axes[3][i] * y + out.axes[6][i] * z - (sx[i] + w * t0 + (v1 * t2 - v2 * t1));
        out.common[1][i] =
            out.axes[1][i] * x + out.axes[4][i] * y + out.axes[7][i] * z - (sy[i] + w * t1 + (v2 * t0 - v0 * t2));
        out.common[2][i] =
            out.axes[2][i] * x + out.axes[5][i] * y + out.axes[8][i] * z - (sz[i] + w * t2 + (v0 * t1 - v1 * t0));
        for (int d = 0; d < 3; ++d)
            out.force[d][i] = out.torque[d][i] = 0;
    }
}

MASONRY_VECTORISED void alignNodal(int n, const int* body1, const int* body2, const double* const* q,
                                   const double* const* f1, const double* const* f2, Frames& __restrict out) {
    align(n, body1, body2, q, f1, f2, out);
    for (auto& component : out.torque)
        for (int i = 0; i < n; ++i)
            component[i] = 0;
}

MASONRY_VECTORISED void jumpRigid(int n, const double* __restrict ax, const double* __restrict ay,
                                  const double* __restrict az, double* __restrict jx, double* __restrict jy,
                                  double* __restrict jz, Frames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double v0 = out.v[0][i], v1 = out.v[1][i], v2 = out.v[2][i], turn = 4 * out.w[i];
        const double a0 = ax[i], a1 = ay[i], a2 = az[i];
        const double c0 = out.common[0][i], c1 = out.common[1][i], c2 = out.common[2][i];
        const double j0 = c0 + turn * (v1 * a2 - v2 * a1), j1 = c1 + turn * (v2 * a0 - v0 * a2),
                     j2 = c2 + turn * (v0 * a1 - v1 * a0);
        out.step[0][i] = j0 - jx[i], out.step[1][i] = j1 - jy[i], out.step[2][i] = j2 - jz[i];
        jx[i] = j0, jy[i] = j1, jz[i] = j2;
        const double shrink = 1 - 2 * (v0 * v0 + v1 * v1 + v2 * v2), along = 2 * (v0 * a0 + v1 * a1 + v2 * a2);
        out.arm[0][i] = shrink * a0 + along * v0 + 0.5 * c0; // half^T a + jump / 2
        out.arm[1][i] = shrink * a1 + along * v1 + 0.5 * c1;
        out.arm[2][i] = shrink * a2 + along * v2 + 0.5 * c2;
    }
}

// The one place where stress meets area, and tension meets the host's forces: an open joint pulls body 1 on.
MASONRY_VECTORISED void pullRigid(int n, const double* area, const double* normal, const double* shearA,
                                  const double* shearB, Frames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = area[i] * normal[i], y = area[i] * shearA[i], z = area[i] * shearB[i];
        out.force[0][i] += x, out.force[1][i] += y, out.force[2][i] += z;
        out.torque[0][i] += out.arm[1][i] * z - out.arm[2][i] * y;
        out.torque[1][i] += out.arm[2][i] * x - out.arm[0][i] * z;
        out.torque[2][i] += out.arm[0][i] * y - out.arm[1][i] * x;
    }
}

MASONRY_VECTORISED void finishRigid(int n, const Frames& f, double* __restrict onJoints) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        double* out = onJoints + 9 * i;
        const auto turned = [&](const double(&c)[3][block], int d) {
            return f.axes[3 * d][i] * c[0][i] + f.axes[3 * d + 1][i] * c[1][i] + f.axes[3 * d + 2][i] * c[2][i];
        };
        const double fx = turned(f.force, 0), fy = turned(f.force, 1), fz = turned(f.force, 2);
        const double tx = turned(f.torque, 0), ty = turned(f.torque, 1), tz = turned(f.torque, 2);
        const double bx = f.between[0][i], by = f.between[1][i], bz = f.between[2][i];
        out[0] = fx, out[1] = fy, out[2] = fz, out[3] = tx, out[4] = ty, out[5] = tz;
        out[6] = by * fz - bz * fy - tx; // the arms of body 2 are shorter by `between`
        out[7] = bz * fx - bx * fz - ty;
        out[8] = bx * fy - by * fx - tz;
    }
}

MASONRY_VECTORISED void jumpNodal(int n, const int* place1, const int* place2, const double* u, double* __restrict jx,
                                  double* __restrict jy, double* __restrict jz, Frames& __restrict out) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const int one = place1[i], two = place2[i];
        const double x = u[two] - u[one], y = u[two + lanes] - u[one + lanes],
                     z = u[two + 2 * lanes] - u[one + 2 * lanes];
        const double j0 = out.axes[0][i] * x + out.axes[3][i] * y + out.axes[6][i] * z;
        const double j1 = out.axes[1][i] * x + out.axes[4][i] * y + out.axes[7][i] * z;
        const double j2 = out.axes[2][i] * x + out.axes[5][i] * y + out.axes[8][i] * z;
        out.step[0][i] = j0 - jx[i], out.step[1][i] = j1 - jy[i], out.step[2][i] = j2 - jz[i];
        jx[i] = j0, jy[i] = j1, jz[i] = j2;
    }
}

MASONRY_VECTORISED void pullNodal(int n, const double* area, const double* normal, const double* shearA,
                                  const double* shearB, const double* jx, const double* jy, const double* jz,
                                  Frames& __restrict f, double* __restrict onPoints) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
        const double x = area[i] * normal[i], y = area[i] * shearA[i], z = area[i] * shearB[i];
        onPoints[3 * i] = f.axes[0][i] * x + f.axes[1][i] * y + f.axes[2][i] * z;
        onPoints[3 * i + 1] = f.axes[3][i] * x + f.axes[4][i] * y + f.axes[5][i] * z;
        onPoints[3 * i + 2] = f.axes[6][i] * x + f.axes[7][i] * y + f.axes[8][i] * z;
        f.torque[0][i] += jy[i] * z - jz[i] * y;
        f.torque[1][i] += jz[i] * x - jx[i] * z;
        f.torque[2][i] += jx[i] * y - jy[i] * x;
    }
}

// The moment on the rotation of each of the two blocks, as in the Law2 functor.
MASONRY_VECTORISED void finishNodal(int n, const Frames& f, double* __restrict onJoints) {
#pragma GCC ivdep
    for (int i = 0; i < n; ++i)
        for (int d = 0; d < 3; ++d)
            onJoints[9 * i + 3 + d] = onJoints[9 * i + 6 + d] =
                0.5 * (f.axes[3 * d][i] * f.torque[0][i] + f.axes[3 * d + 1][i] * f.torque[1][i] +
                       f.axes[3 * d + 2][i] * f.torque[2][i]);
}

} // namespace

void MasonryJointLoop::advanceBlock(Group& g, int from, int n) {
    Frames frames;
    const double *position[3], *orientation[4], *frame1[4], *frame2[4], *span[3];
    for (int d = 0; d < 4; ++d)
        orientation[d] = bodies_.orientation[d].data(), frame1[d] = &g.frame1[d][from], frame2[d] = &g.frame2[d][from];
    for (int d = 0; d < 3; ++d)
        position[d] = bodies_.position[d].data(), span[d] = &g.span[d][from];
    if (g.nodal)
        alignNodal(n, &g.body1[from], &g.body2[from], orientation, frame1, frame2, frames);
    else
        alignRigid(n, &g.body1[from], &g.body2[from], position, orientation, frame1, frame2, span, frames);
    const auto& law = g.joint->law();
    for (int p = 0; p < g.points; ++p) {
        const std::size_t i = std::size_t(p) * g.stride + from;
        double *jx = &g.jump[0][i], *jy = &g.jump[1][i], *jz = &g.jump[2][i];
        if (g.nodal)
            jumpNodal(n, &g.place1[i], &g.place2[i], zones_->displacementRows(), jx, jy, jz, frames);
        else
            jumpRigid(n, &g.offset[0][i], &g.offset[1][i], &g.offset[2][i], jx, jy, jz, frames);
        g.columns.advance(law, i, n, frames.step[0], frames.step[1], frames.step[2]);
        const double *normal = g.columns.normalStress() + i, *a = g.columns.shearStressA() + i,
                     *b = g.columns.shearStressB() + i;
        if (g.nodal)
            pullNodal(n, &g.area[i], normal, a, b, jx, jy, jz, frames, &onPoints_[3 * (g.firstPoint + i)]);
        else
            pullRigid(n, &g.area[i], normal, a, b, frames);
    }
    double* onJoints = &onJoints_[std::size_t(9) * (g.first + from)];
    if (g.nodal)
        finishNodal(n, frames, onJoints);
    else
        finishRigid(n, frames, onJoints);
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
            const int item = bodyGather_.items[n];
            const double* on = &onJoints_[9 * (item / 2)];
            if (item % 2)
                force -= Vector3r(on[0], on[1], on[2]), torque += Vector3r(on[6], on[7], on[8]);
            else
                force += Vector3r(on[0], on[1], on[2]), torque += Vector3r(on[3], on[4], on[5]);
        }
        const int body = bodyGather_.receivers[r];
        if (bodies_.momentPlaces[body] >= 0) {
            for (int d = 0; d < 3; ++d)
                (zones_->momentRows() + bodies_.momentPlaces[body])[d * lanes] = torque[d];
        } else
            onBodies_[2 * body] = force, onBodies_[2 * body + 1] = torque;
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
            const double *on = &onPoints_[3 * (item / 2)], sign = item % 2 ? -1 : 1;
            x += sign * on[0], y += sign * on[1], z += sign * on[2];
        }
        double* at = forces + nodeGather_.receivers[r];
        at[0] = x, at[lanes] = y, at[2 * lanes] = z;
    }
    for (const auto& guest : guests_) {
        const double* on = forces + guest.place;
        const Vector3r force(on[0], on[lanes], on[2 * lanes]);
        if (guest.body >= 0) {
            onBodies_[2 * guest.body] += force;
            onBodies_[2 * guest.body + 1] += (bodies_.states[guest.body]->ori * guest.local).cross(force);
        } else
            for (int i = 0; i < 3; ++i)
                for (int d = 0; d < 3; ++d)
                    forces[zones_->placeOf(guest.attachment.nodes[i]) + d * lanes] +=
                        guest.attachment.weights[i] * force[d];
    }
}

void MasonryJointLoop::action() {
    checkScene(*scene);
    if (stale()) build();
    const int bodyCount = int(bodies_.ids.size());
    for (int b = 0; b < bodyCount; ++b) {
        if (b + 8 < bodyCount) __builtin_prefetch(&bodies_.states[b + 8]->ori);
        const auto& s = *bodies_.states[b];
        for (int d = 0; d < 3; ++d)
            bodies_.position[d][b] = s.pos[d], bodies_.orientation[d + 1][b] = s.ori.coeffs()[d];
        bodies_.orientation[0][b] = s.ori.w();
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
    std::fill(onBodies_.begin(), onBodies_.end(), Vector3r::Zero());
    toBodies();
    if (zones_) toNodes();
    auto& forces = scene->forces();
    for (int b = 0; b < bodyCount; ++b) {
        if (onBodies_[2 * b].isZero(0) && onBodies_[2 * b + 1].isZero(0)) continue;
        forces.addForce(bodies_.ids[b], onBodies_[2 * b]);
        forces.addTorque(bodies_.ids[b], onBodies_[2 * b + 1]);
    }
}

} // namespace masonry
