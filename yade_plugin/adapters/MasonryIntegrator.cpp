// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryIntegrator.hpp"
#include "scene/EngineTurn.hpp"

template class masonry::Adapter<masonry::MasonryIntegrator, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryIntegrator)

namespace masonry {

void MasonryIntegrator::action() {
    const EngineTurn turn(*scene, *this);
    advance(turn.store());
    turn.end();
}

py::list MasonryIntegrator::sectionsOfBricks() {
    const BetweenSteps still;
    SceneStore::present().update();
    py::list all;
    for (const auto& section : bricks.sections())
        all.append(py::make_tuple(section.body1, section.body2, section.force, section.moment));
    return all;
}

} // namespace masonry
