// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointImpact.hpp"
#include "engine/bodies/BodyStep.hpp"

namespace masonry {

namespace {

using yade::Matrix3r;

// The impulse on body 1 [N s], in the joint's axes, that ends the motion `speed` of side 2 against side 1 [m/s] at a
// point, for this part of the corners. It does not pull. Where friction cannot stop the slip it ends the motion along
// the normal alone.
Vector3r impulseAgainst(const Vector3r& speed, const JointImpacts& by, const JointShapes& shapes, int point, int joint,
                        double part) {
    const auto& r = shapes.joints[joint];
    Matrix3r changes = Matrix3r::Zero(); // of the speed by an impulse, in global axes [1/kg]
    Quaternionr axes[2];                 // the joint's axes as both bodies have carried them along
    for (int side = 0; side < 2; ++side) {
        const int body = r.sides[side].body;
        const auto& s = by.bodies.state(body);
        axes[side] = s.ori * r.frame(side);
        const Vector3r offset = shapes.offsetAt(point, joint);
        const Vector3r arm = axes[side] * (side ? Vector3r(offset - r.span()) : offset);
        Matrix3r cross; // the cross product with the arm
        cross << 0, -arm[2], arm[1], arm[2], 0, -arm[0], -arm[1], arm[0], 0;
        Matrix3r own = -cross * inverseInertia(s) * cross;
        for (int d = 0; d < 3; ++d)
            if (!by.bodies.isBlocked(body, d)) own(d, d) += 1 / s.mass;
        changes +=
            own * (by.jointedArea[body] / (by.bodies.inertiaFactor(body) * part * shapes.faceArea[shapes.face(joint)]));
    }
    for (int d = 0; d < 3; ++d)
        if (changes(d, d) == 0) changes(d, d) = 1; // nothing moves along this axis
    const Matrix3r turn = meanOf(axes[0], axes[1]).toRotationMatrix();
    const Vector3r impulse = turn.transpose() * changes.inverse() * (turn * speed);
    const double along = std::hypot(impulse[1], impulse[2]);
    const double friction = shapes.law->law().properties().friction;
    if (along <= -friction * impulse[0]) return impulse;
    const Vector3r slips(-1, friction * impulse[1] / along, friction * impulse[2] / along);
    const double ended = -turn.col(0).dot(changes * (turn * slips)); // of the speed along the normal, by slips
    return std::max(ended > 0 ? -speed[0] / ended : -impulse[0], 0.0) * slips;
}

} // namespace

double addImpacts(const JointImpacts& by, JointShapes& shapes, int corner, int from, int count, const double* area,
                  const double* const* change, double* normal, double* shearA, double* shearB) {
    const auto& properties = shapes.law->law().properties();
    const double* damage = shapes.law->isBonded() ? shapes.law->column(Role::BondDamage, corner, from) : nullptr;
    double taken = 0;
    for (int i = 0; i < count; ++i) {
        const std::size_t at = shapes.at(corner, from + i);
        double& closing = shapes.closing[at];
        const Vector3r step(change[0][i], change[1][i], change[2][i]);
        const double speed = -step[0] / by.dt;
        Vector3r now = Vector3r::Zero();
        if (normal[i] >= 0 && !properties.elastic && !(damage && damage[i] < bondGone))
            closing = 0;
        else if (closing >= 0 && speed < 0)
            closing = JointShapes::notAnImpact;
        else if (closing >= 0) {
            const double beyond = properties.restitution * std::max(closing, speed);
            if (by.act && speed > beyond) {
                int meeting = 0; // a corner that was open before counts all that may meet with it in this step
                for (int other : shapes.rim) {
                    const double theirs = shapes.closing[shapes.at(other, from + i)];
                    meeting += closing > 0 ? theirs > 0 : theirs >= 0;
                }
                const Vector3r ends(step[0] / by.dt + beyond, step[1] / by.dt, step[2] / by.dt);
                now = impulseAgainst(ends, by, shapes, corner, from + i, 1.0 / meeting) / (by.dt * area[i]);
            }
            closing = std::max(closing, speed);
        }
        for (int d = 0; d < 3; ++d) {
            taken += 0.5 * area[i] * (now[d] + shapes.impact[d][at]) * step[d];
            shapes.impact[d][at] = now[d];
        }
        normal[i] += now[0];
        shearA[i] += now[1];
        shearB[i] += now[2];
    }
    return taken;
}

} // namespace masonry
