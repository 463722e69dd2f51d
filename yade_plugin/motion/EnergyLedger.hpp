// SPDX-License-Identifier: GPL-2.0-or-later
// The energies of bodies or nodes in a run, for rigid or for deformable units.
#pragma once

namespace masonry {

// All entries are in J. Half of the work in a step is done with the velocity before it, half with the velocity after
// it. The second half is pending until the next step, so that all other entries belong to the same instant.
struct EnergyLedger {
    double external = 0;        // work of prescribed motions and foreign forces so far
    double damped = 0;          // taken by damping so far
    double pendingExternal = 0; // second half of the last step's work, which the next step adds to `external`
    double pendingDamped = 0;   // second half of what damping took in the last step
    double kinetic = 0;         // present kinetic energy
    double fallen = 0;          // work of gravity since the first step
    double elastic = 0;         // present elastic energy of deformable units

    // Adds what was pending, and sets the present energies to zero.
    void beginStep() {
        external += pendingExternal;
        damped += pendingDamped;
        pendingExternal = pendingDamped = kinetic = fallen = elastic = 0;
    }
    void add(const EnergyLedger& other) {
        external += other.external;
        damped += other.damped;
        pendingExternal += other.pendingExternal;
        pendingDamped += other.pendingDamped;
        kinetic += other.kinetic;
        fallen += other.fallen;
        elastic += other.elastic;
    }
};

} // namespace masonry
