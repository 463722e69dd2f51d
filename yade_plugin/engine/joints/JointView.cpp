// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointView.hpp"
#include "blocks/JointPoints.hpp"
#include "engine/units/Zones.hpp"
#include <algorithm>

namespace masonry {

void JointGeometry::define(const FaceContact& face, const Vector3r& along, int columns, int rows, int body1, int body2,
                           const yade::State& state1, const yade::State& state2) {
    JointReference r;
    r.normal = face.normal;
    r.tangent = along;
    r.corners = std::make_shared<Polygon>(face.polygon);
    r.sides[0] = {body1, state1.pos, state1.ori};
    r.sides[1] = {body2, state2.pos, state2.ori};
    const auto cells = subdivide(r.polygon(), r.normal, r.tangent, columns, rows);
    group.reset(new JointShapes(1, int(cells.size())));
    index = 0;
    for (std::size_t p = 0; p < cells.size(); ++p)
        group->setShape(int(p), 0, r.axes().transpose() * (cells[p].centre - r.sides[0].position), cells[p].area);
    group->joints[0] = r;
}

void JointGeometry::attach(const shared_ptr<Zones>& all) {
    auto& r = group->joints[index];
    const Zones::Unit* units[2] = {all->unitOf(r.sides[0].body), all->unitOf(r.sides[1].body)};
    if (!units[0] && !units[1]) return;
    r.attached = std::make_shared<JointReference::Attached>();
    r.attached->zones = all;
    std::optional<Zones::Covered> covers[2];
    for (int side = 0; side < 2; ++side)
        if (units[side]) covers[side] = all->cover(*units[side], r.polygon(), r.normal, r.tangent);
    const int lead = units[0] ? 0 : 1;
    bool matching = covers[lead].has_value();
    if (units[0] && units[1]) {
        const double close = 1e-3 * (r.polygon()[2] - r.polygon()[0]).norm();
        matching = matching && covers[1] && covers[0]->nodes.size() == covers[1]->nodes.size();
        for (std::size_t n = 0; matching && n < covers[0]->nodes.size(); ++n) {
            const Vector3r place = all->reference(*units[0], covers[0]->nodes[n]);
            matching = std::any_of(covers[1]->nodes.begin(), covers[1]->nodes.end(), [&](int other) {
                return (all->reference(*units[1], other) - place).norm() < close;
            });
        }
    }
    if (matching) {
        const auto& points = covers[lead]->points;
        const shared_ptr<JointShapes> moved(new JointShapes(1, int(points.size())));
        moved->joints[0] = r;
        for (std::size_t p = 0; p < points.size(); ++p)
            moved->setShape(int(p), 0, r.axes().transpose() * (points[p].centre - r.sides[0].position), points[p].area);
        group = moved;
        index = 0;
    }
    auto& attached = *group->joints[index].attached;
    for (int side = 0; side < 2; ++side)
        for (int p = 0; units[side] && p < group->points; ++p)
            attached.sides[side].push_back(all->attach(*units[side], centre(p)));
}

std::vector<Polygon> JointGeometry::cells() const {
    std::vector<Point> around;
    for (int p = 0; p < points(); ++p)
        around.push_back(centre(p));
    return nearestCells(reference().polygon(), around);
}

// The equations stand in motion/JointFrames.hpp. As forces act at the middle of the jump, and the axes turn with the
// mean rotation, the angular momentum is conserved, and the power of the forces is that of the tractions on the jumps.
void JointGeometry::follow(const yade::State& state1, const yade::State& state2) {
    if (!step) step = std::make_unique<Step>();
    step->increments.resize(points());
    step->arms.resize(points());
    const auto& r = reference();
    if (r.attached) return followDeformable(state1, state2);
    Quaternionr by2 = state2.ori * r.frame(1);
    const Quaternionr mean = meanOf(state1.ori * r.frame(0), by2);
    const Quaternionr half = mean.conjugate() * by2;
    step->axes = mean.toRotationMatrix();
    step->between = state2.pos - state1.pos;

    const Vector3r span = r.span();
    const Vector3r v = half.vec(), twist = 4 * half.w() * v, twice = 2 * v;
    const Vector3r turned = twice.cross(span); // for half d = d + w (2v × d) + v × (2v × d)
    // The part of the jump that is the same at all subcontacts.
    const Vector3r common = step->axes.transpose() * step->between - (span + half.w() * turned + v.cross(turned));
    const double shrink = 1 - 2 * v.squaredNorm();
    for (int p = 0; p < points(); ++p) {
        const Vector3r a = offset(p), now = common + twist.cross(a);
        step->increments[p] = now - jump(p);
        group->setJump(p, index, now);
        step->arms[p] = shrink * a + v.dot(a) * twice + 0.5 * common; // half^T a + jump / 2
    }
}

// As follow(), in the same frame. The jump is the difference of the displacements of both sides, which come from the
// nodes of a deformable side and from the body of a rigid one.
void JointGeometry::followDeformable(const yade::State& state1, const yade::State& state2) {
    const auto& r = reference();
    Quaternionr by2 = state2.ori * r.frame(1);
    step->axes = meanOf(state1.ori * r.frame(0), by2).toRotationMatrix();
    step->between = state2.pos - state1.pos;
    step->forces.resize(points());
    const yade::State* states[2] = {&state1, &state2};
    const auto displacement = [&](int side, int p, const Vector3r& place) {
        if (!r.rigid(side)) return r.attached->zones->displacementAt(r.attached->sides[side][p]);
        const auto& from = r.sides[side];
        const auto& s = *states[side];
        return Vector3r(s.pos + s.ori * (from.orientation.conjugate() * (place - from.position)) - place);
    };
    r.attached->zones->units();
    for (int p = 0; p < points(); ++p) {
        const Vector3r place = centre(p), u1 = displacement(0, p, place), u2 = displacement(1, p, place);
        const Vector3r gap = u2 - u1, now = step->axes.transpose() * gap;
        step->increments[p] = now - jump(p);
        group->setJump(p, index, now);
        // From the centre of the rigid body, if there is one.
        const Vector3r arm = r.rigid(0) ? Vector3r(place + u1 - state1.pos) : Vector3r(place + u2 - state2.pos);
        step->arms[p] = step->axes.transpose() * arm;
    }
}

} // namespace masonry
