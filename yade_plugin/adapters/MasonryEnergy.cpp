// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryEnergy.hpp"
#include "engine/bodies/Load.hpp"
#include "engine/contacts/Contacts.hpp"
#include <algorithm>

MASONRY_DEFINE(MasonryEnergy)

namespace masonry {

void MasonryEnergy::step(SceneStore& store) { audit(store); }

void MasonryEnergy::given() { countPresentMotion(*StillScene()); }

py::dict MasonryEnergy::balance() {
    const StillScene scene(SceneStore::ScanScope::Joints); // every row of curve.csv calls this: a full look is too slow
    const auto [energies, stored, lost, error, size] = relativeBalance(*scene);
    const double impacts = scene->loop ? scene->loop->impactWork : 0;
    py::dict all;
    all["external"] = energies.work;
    all["gravity"] = energies.falls;
    all["refining"] = scene->loop ? scene->loop->refiningEnergy : 0;
    all["kinetic"] = energies.moving;
    all["damping"] = energies.drag - impacts;
    all["impacts"] = impacts;
    all["elastic_units"] = energies.inUnits;
    all["elastic_tension"] = stored[0];
    all["elastic_shear"] = stored[1];
    all["elastic_compression"] = stored[2];
    all["dissipated_tension"] = lost[0];
    all["dissipated_shear"] = lost[1];
    all["dissipated_compression"] = lost[2];
    const auto hasMachine = [](const Load* load) { return !load->machineStiffness().isZero(0); };
    if (!scene->allConnectors.empty() || std::any_of(scene->allLoads.begin(), scene->allLoads.end(), hasMachine)) {
        all["elastic_connectors"] = energies.inConnectors;
        all["dissipated_connectors"] = energies.lostInConnectors;
    }
    if (!scene->allContacts.empty()) {
        double converted = 0;
        for (const auto* contacts : scene->allContacts)
            converted += contacts->conversionEnergy;
        all["handing"] = converted;
        all["elastic_contacts"] = energies.contacts[0];
        all["friction_contacts"] = energies.contacts[1];
        all["damping_contacts"] = energies.contacts[2];
    }
    all["error"] = error;
    return all;
}

} // namespace masonry
