// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactEnds.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

namespace {

constexpr double noticed = 0.05; // change of a contact area in a step, over the area, from which on energy is looked at

} // namespace

double shareThatTakes(const AddedForce& force, double energy) {
    if (energy == 0 || !(force.response > 0)) return 0;
    // With the share x the force gives x slope + x² response / 2.
    const double slope = force.work + 0.5 * force.others;
    const double under = slope * slope - 2 * force.response * energy;
    const double share =
        under > 0 ? -2 * energy / (slope + std::copysign(std::sqrt(under), slope)) : -slope / force.response;
    return std::clamp(share, -1.0, 1.0);
}

void countLastPush(const NearBlocks& blocks, double dt, ElasticAccount& account) {
    account.given -= 0.5 * dt * powerOf(blocks, account.push);
}

// Where the area grows, the force itself is scaled. Where it shrinks, that of the last step is added in part, because
// that acted on what has gone as if it stayed to the end of the step.
Wrench keepEnergy(const NearBlocks& blocks, double normalStiffness, double dt, const ContactChange& change,
                  const Wrench& elastic, const Wrench& dashpot, OverlapFinder& finder, ElasticAccount& account) {
    const auto potential = [&] {
        return normalStiffness * finder.potential(blocks.oneBlock, blocks.otherBlock, blocks.pose);
    };
    const Wrench last = account.push;
    account.push = elastic;
    const double work = dt * powerOf(blocks, elastic);
    const bool unknown = !change.begins && last.force.isZero(0);
    if (!change.begins && !unknown && std::abs(change.area) <= noticed) {
        account.given -= 0.5 * work;
        if (account.kept) account.excess = account.given - potential();
        account.kept = false;
        return elastic;
    }
    const double stored = potential();
    const double missing = stored + 0.5 * work - account.given;
    if (unknown || (change.begins && missing >= 0)) { // they were in each other before they came under this law
        account.given = stored;
        account.excess = 0;
        account.kept = false;
        return elastic;
    }
    const auto added = change.begins || change.area > 0 ? elastic : standing(blocks, last);
    auto sum = elastic;
    sum.add(1, dashpot);
    const double share = shareThatTakes({dt * powerOf(blocks, added), dt * dt * responseOf(blocks, added, added),
                                         dt * dt * responseOf(blocks, added, sum)},
                                        missing);
    auto all = elastic;
    all.add(share, added);
    account.push = all;
    account.given -= 0.5 * dt * powerOf(blocks, all);
    account.excess = share != 0 ? account.given - stored : 0;
    account.kept = share != 0;
    return all;
}

bool endOn(const NearBlocks& blocks, const Eigen::Vector3d& normal, double dt, ElasticAccount& account,
           Wrench& wrench) {
    const auto last = standing(blocks, account.push);
    const double work = dt * powerOf(blocks, last);
    if (!(work * last.force.dot(blocks.one.turn * normal) > 0)) return false; // they do not part along the force
    const double share = shareThatTakes({work, dt * dt * responseOf(blocks, last, last), 0}, -account.given);
    if (share == 0) return false;
    wrench = Wrench();
    wrench.add(share, last);
    account.excess = account.given - 0.5 * share * work;
    return true;
}

} // namespace masonry
