// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryIntegrator.hpp"

MASONRY_DEFINE(MasonryIntegrator)

namespace masonry {

void MasonryIntegrator::shake(const std::vector<double>& samples, const std::vector<Vector3r>& axes, double interval,
                              double factor) {
    const BetweenSteps still;
    if (!shaking.samples.empty() && gravity == shaking.last) gravity = shaking.beside;
    if (!samples.empty() && (axes.empty() || samples.size() % axes.size() != 0 || !(interval > 0)))
        throw std::invalid_argument(nameOf(ClassRole::Integrator) +
                                    ".shake: needs axes, as many samples along each, and an interval above 0");
    shaking = {samples, axes, interval, factor, gravity, gravity};
}

void MasonryIntegrator::step(SceneStore& store) { advance(*scene, store.bodies, store.loads, store.foreignForces); }

} // namespace masonry
