// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryEnergy.hpp"
#include "engine/contacts/Contacts.hpp"
#include "engine/watch/EngineScope.hpp"

template class masonry::Adapter<masonry::MasonryEnergy, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryEnergy)

namespace masonry {

void MasonryEnergy::action() {
    const EngineScope scope(*scene, *this);
    audit(scope.store());
    scope.end();
}

void MasonryEnergy::given() {
    const BetweenSteps still;
    auto& store = SceneStore::present();
    store.update();
    countPresentMotion(store);
}

py::dict MasonryEnergy::balance() {
    const BetweenSteps still;
    auto& store = SceneStore::present();
    store.update(SceneStore::ScanScope::Joints); // a full look would take too long: every row of curve.csv calls this
    const auto [energies, stored, lost, error, size] = relativeBalance(store);
    const double impacts = store.loop ? store.loop->impactWork : 0;
    py::dict all;
    all["external"] = energies.work;
    all["gravity"] = energies.falls;
    all["refining"] = store.loop ? store.loop->refiningEnergy : 0;
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
    if (!store.allConnectors.empty()) {
        all["elastic_connectors"] = energies.inConnectors;
        all["dissipated_connectors"] = energies.lostInConnectors;
    }
    if (!store.allContacts.empty()) {
        double converted = 0;
        for (const auto* contacts : store.allContacts)
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
