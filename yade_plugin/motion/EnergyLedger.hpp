// What bodies or nodes take and give in a run, one ledger for rigid and for deformable units.
#pragma once

namespace masonry {

// Half of a step's work is done with the velocity before it, half with the velocity after it. The second half is
// pending until the next step, so that all entries belong to the same instant.
struct EnergyLedger {           // [J]
    double external = 0;        // work of prescribed motions so far
    double damped = 0;          // taken by damping so far
    double pendingExternal = 0; // of the last step, for the next
    double pendingDamped = 0;
    double kinetic = 0; // now
    double fallen = 0;  // work of gravity since the reference state
    double elastic = 0; // stored in deformable units now

    // Books what was pending, and forgets what belongs to the last instant.
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
