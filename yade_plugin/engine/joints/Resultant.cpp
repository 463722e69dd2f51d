// SPDX-License-Identifier: GPL-2.0-or-later
#include "Resultant.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/bodies/StepLock.hpp"
#include "engine/units/Zones.hpp"

namespace masonry {

namespace py = boost::python;

// The forces on both sides act apart by the jump. With the moments that each body then gets, half of jump × force (see
// advanceJoint), they have the moment of forces that meet in the middle of the jump.
Resultant resultantOf(const yade::Scene& scene, const yade::Interaction& interaction, const Vector3r& about) {
    const auto* geom = dynamic_cast<const JointGeometry*>(interaction.geom.get());
    const auto* phys = dynamic_cast<const JointPhysics*>(interaction.phys.get());
    if (!geom || !phys || !geom->made() || !phys->made())
        throw std::invalid_argument("interaction " + std::to_string(interaction.id1) + "+" +
                                    std::to_string(interaction.id2) + " is no joint: connect() makes joints");
    geom->group->check();
    const auto& r = geom->reference();
    const yade::State* states[2] = {bodyAt(scene, interaction.id1, "a joint holds body").state.get(),
                                    bodyAt(scene, interaction.id2, "a joint holds body").state.get()};
    Quaternionr by2 = states[1]->ori * r.frame(1);
    const yade::Matrix3r axes = meanOf(states[0]->ori * r.frame(0), by2).toRotationMatrix();
    if (r.attached) r.attached->zones->units(); // they may still have to be divided
    const auto present = [&](int side, int p, const Vector3r& place) {
        if (!r.rigid(side)) return Vector3r(place + r.attached->zones->displacementAt(r.attached->sides[side][p]));
        const auto& from = r.sides[side];
        return Vector3r(states[side]->pos +
                        states[side]->ori * (from.orientation.conjugate() * (place - from.position)));
    };
    Resultant sum;
    for (int p = 0; p < geom->points(); ++p) {
        const auto s = phys->state(p);
        const Vector3r stress =
            Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b) + geom->group->stressBesideLaw(p, geom->index);
        const Vector3r force = axes * (geom->area(p) * stress), place = geom->centre(p);
        sum.force += force;
        sum.moment += (0.5 * (present(0, p, place) + present(1, p, place)) - about).cross(force);
    }
    return sum;
}

py::tuple resultant(const py::list& interactions, const py::list& signs, const Vector3r& about) {
    const BetweenSteps still;
    const auto& scene = *Singleton<yade::Omega>::instance().getScene();
    Resultant sum;
    for (py::ssize_t i = 0; i < py::len(interactions); ++i) {
        const yade::Interaction& interaction = py::extract<const yade::Interaction&>(interactions[i]);
        const double sign = py::extract<double>(signs[i]);
        const auto one = resultantOf(scene, interaction, about);
        sum.force += sign * one.force;
        sum.moment += sign * one.moment;
    }
    return py::make_tuple(sum.force, sum.moment);
}

} // namespace masonry
