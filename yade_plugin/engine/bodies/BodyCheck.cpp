// SPDX-License-Identifier: GPL-2.0-or-later
#include "BodyCheck.hpp"
#include "Blocks.hpp"
#include "UnitMaterial.hpp"

namespace masonry {

const yade::Body& bodyAt(const yade::Scene& scene, int id, const char* what, ClassRole role) {
    const auto& all = scene.bodies->body;
    const bool exists = id >= 0 && std::size_t(id) < all.size() && all[id];
    if (!exists || !all[id]->state)
        throw std::invalid_argument(nameOf(role) + what + " " + std::to_string(id) +
                                    (exists ? " has no State" : " does not exist"));
    return *all[id];
}

std::vector<std::string> problemsOf(const yade::Body& body) {
    std::vector<std::string> wrong;
    const auto fail = [&](const std::string& what) { wrong.push_back("body " + std::to_string(body.id) + " " + what); };
    const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
    if (!dynamic_cast<const UnitMaterial*>(body.material.get()))
        fail("has " + (body.material ? body.material->getClassName() : "no material") + ", must have a " +
             nameOf(ClassRole::Material));
    if (!body.state) {
        fail("has no State");
        return wrong;
    }
    if (body.clumpId >= 0)
        fail("belongs to clump " + std::to_string(body.clumpId) +
             ", which would not move as one: join blocks by stiff "
             "joints instead");
    const auto& s = *body.state;
    if (const auto* corners = cornersOf(body.shape.get()); corners && corners->empty())
        fail("has a " + body.shape->getClassName() + " without corners");
    if (!positive(s.mass)) fail("has a mass of " + text(s.mass) + " kg, must be a finite number above 0");
    for (double inertia : {s.inertia[0], s.inertia[1], s.inertia[2]})
        if (!positive(inertia)) {
            fail("has an inertia of " + text(inertia) + " kg m², must be a finite number above 0");
            break;
        }
    if (!s.pos.allFinite() || !s.ori.coeffs().allFinite() || !s.vel.allFinite() || !s.angVel.allFinite())
        fail("has a place or velocity that is no finite number");
    return wrong;
}

} // namespace masonry
