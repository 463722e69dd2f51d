#include "JointColumns.hpp"
#include "common/Vectorised.hpp"
#include <new>

namespace masonry {

namespace {

using J = JointColumns;
using Jumps = J::Jumps;
constexpr int most = J::most;
using Mask = std::int64_t; // a switch as wide as the numbers beside it, for the vector units

double squareOfCap(const Equations& e, double largestClosure) {
    const double fc = e.cap ? e.curve.strength(largestClosure, e.stretch) : HUGE_VAL;
    return fc * fc;
}

constexpr double none[most] = {}; // no slides

// ---- joints without strength ---------------------------------------------------------------------------------------

MASONRY_VECTORISED
void advanceElastic(double kn, double ks, const J::Columns& columns, std::size_t at, int count, const Jumps& jumps,
                    double* normalStress) {
    double* opening = columns[J::Opening] + at;
    double* shearStressA = columns[J::ShearStressA] + at;
    double* shearStressB = columns[J::ShearStressB] + at;
    const double* irreversible = columns[J::Irreversible] + at;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        opening[i] += jumps.opening[i];
        normalStress[i] = kn * (opening[i] + irreversible[i]);
        shearStressA[i] += ks * jumps.slideA[i];
    }
    if (jumps.plane) return;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i)
        shearStressB[i] += ks * jumps.slideB[i];
}

// ---- subcontacts that stay elastic ---------------------------------------------------------------------------------

// The law where no strength is passed: eqs. (6), (7), the secant of eq. (11), and the three conditions of eq. (8).
// Tells which subcontacts need more, which then are as before, and how many they are.
template <bool spatial, bool yielded>
MASONRY_INLINED Mask stayElastic(const Equations& given, const J::Consequences& ofAll, const J::Columns& columns,
                                 std::size_t at, int count, const Jumps& jumps, double* normalStress, Mask* waits) {
    const Equations e = given;
    const J::Consequences same = ofAll;
    const double limit = e.curve.limit(e.stretch);
    const double closing = e.cap ? -1 : 0; // how closure counts
    double* opening = columns[J::Opening] + at;
    double* shearStressA = columns[J::ShearStressA] + at;
    double* shearStressB = columns[J::ShearStressB] + at;
    double* largestOpening = columns[J::LargestOpening] + at;
    double* largestClosure = columns[J::LargestClosure] + at;
    const double* irreversible = columns[J::Irreversible] + at;
    const double* intact = columns[J::Intact] + at;
    const double* secant = columns[J::Secant] + at;
    const double* reach = columns[J::Reach] + at;
    const double* capSquared = columns[J::CapSquared] + at;
    Mask waiting = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double bond = yielded ? intact[i] : same.intact;
        const double weak = yielded ? secant[i] : same.secant;
        const double within = yielded ? reach[i] : same.reach;
        const double capable = yielded ? capSquared[i] : same.capSquared;
        const double plastic = yielded ? irreversible[i] : same.irreversible;
        const double oldOpening = opening[i];
        const double oldA = shearStressA[i];
        const double oldB = spatial ? shearStressB[i] : 0;
        const double farthest = largestOpening[i];
        const double closest = largestClosure[i];
        const auto moved = e.open(oldOpening, plastic, farthest, jumps.opening[i]);
        const double sigma = e.stiffness(moved.elastic, weak) * moved.elastic;
        const double a = oldA + e.ks * jumps.slideA[i];
        const double b = spatial ? oldB + e.ks * jumps.slideB[i] : 0;
        const double tauSquared = a * a + b * b;
        const double strength = e.slipStrength(bond, sigma);
        const double crushing = sigma < 0 ? e.capStress(sigma, tauSquared) : 0;
        const double closure = sigma < 0 ? closing * moved.total : 0;
        const double hardens = closest > limit ? closest : limit;
        // a subcontact that opens with one stiffness and closes with another loses energy
        const bool keeps = !yielded | ((e.kn - weak) * moved.before * moved.elastic >= 0);
        const bool elastic = (moved.elastic <= within) & (tauSquared <= strength * strength) & (crushing <= capable) &
                             (closure <= hardens) & keeps;
        normalStress[i] = sigma;
        opening[i] = elastic ? moved.total : oldOpening;
        shearStressA[i] = elastic ? a : oldA;
        if (spatial) shearStressB[i] = elastic ? b : oldB;
        largestOpening[i] = elastic ? moved.farthest : farthest;
        largestClosure[i] = elastic & (closure > closest) ? closure : closest;
        waits[i] = elastic ? 0 : 1;
        waiting += elastic ? 0 : 1;
    }
    return waiting;
}

MASONRY_VECTORISED
Mask stayElasticOfMany(const Equations& e, const J::Consequences& ofAll, bool yielded, const J::Columns& columns,
                       std::size_t at, int count, const Jumps& jumps, double* normalStress, Mask* waits) {
    if (jumps.plane)
        return yielded ? stayElastic<false, true>(e, ofAll, columns, at, count, jumps, normalStress, waits)
                       : stayElastic<false, false>(e, ofAll, columns, at, count, jumps, normalStress, waits);
    return yielded ? stayElastic<true, true>(e, ofAll, columns, at, count, jumps, normalStress, waits)
                   : stayElastic<true, false>(e, ofAll, columns, at, count, jumps, normalStress, waits);
}

// ---- subcontacts that may yield ------------------------------------------------------------------------------------

struct Scratch { // of subcontacts side by side, for one step
    alignas(64) double total[most];
    double before[most], elastic[most], farthest[most]; // [m] see Equations::Opened
    double oldStiffness[most], newStiffness[most];      // [Pa/m] of the elastic opening
    double trialA[most], trialB[most], size[most];      // [Pa] trial shear stress
    double ratio[most], tensionDamage[most], shearDamage[most], intact[most], secant[most], dilatancy[most];
    double sigma[most];                                   // [Pa]
    double share[most], slip[most], dilation[most];       // see Equations::Slid
    double closest[most], fc[most];                       // [m], [Pa]
    double left[most], closure[most], crushingSlip[most]; // see Equations::Crushed
    double torn[most];                                    // [J/m²] lost in tension
    Mask open[most], asks[most], regime[most];
};

// One step of the subcontacts that wait: what JointLaw::advance does for one. What has happened to none is not
// calculated. Tables and exponentials are looked up one by one, for those that need them.
MASONRY_VECTORISED
void advanceSideBySide(const Equations& given, const SofteningTable& tension, const SofteningTable& shear,
                       const J::Columns& columns, J::Rows* rows, Regime* regime, const Jumps& jumps, const Mask* waits,
                       int count, double* normalStress) {
    const Equations e = given;
    Scratch s;
    double* opening = columns[J::Opening];
    double* shearStressA = columns[J::ShearStressA];
    double* shearStressB = columns[J::ShearStressB];
    double* largestOpening = columns[J::LargestOpening];
    double* largestClosure = columns[J::LargestClosure];
    double* irreversible = columns[J::Irreversible];
    double* tensionDamage = columns[J::TensionDamage];
    double* shearDamage = columns[J::ShearDamage];
    double* slip = columns[J::Slip];
    double* intact = columns[J::Intact];
    double* secant = columns[J::Secant];

    // 1, opening
    Mask tears = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const auto moved = e.open(opening[i], irreversible[i], largestOpening[i], jumps.opening[i]);
        const double a = shearStressA[i] + e.ks * jumps.slideA[i]; // eq. (7)
        const double b = shearStressB[i] + e.ks * jumps.slideB[i];
        s.total[i] = moved.total;
        s.before[i] = moved.before;
        s.elastic[i] = moved.elastic;
        s.farthest[i] = moved.farthest;
        s.open[i] = moved.open;
        s.asks[i] = moved.tears ? waits[i] : 0;
        s.regime[i] = Mask(Regime::Elastic);
        s.oldStiffness[i] = e.stiffness(moved.before, secant[i]);
        s.trialA[i] = a;
        s.trialB[i] = b;
        s.size[i] = std::sqrt(a * a + b * b);
        s.intact[i] = intact[i];
        s.secant[i] = secant[i];
        s.tensionDamage[i] = tensionDamage[i];
        s.shearDamage[i] = shearDamage[i];
        tears |= s.asks[i];
    }
    if (tears) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i)
            s.ratio[i] = e.tensionRatio(s.elastic[i]);
        for (int i = 0; i < count; ++i) {
            if (!s.asks[i]) continue;
            const double damage = tension.damage(s.ratio[i], rows[i].tension);
            if (!(damage > s.tensionDamage[i])) continue;
            s.tensionDamage[i] = damage;
            s.regime[i] = Mask(Regime::Opening);
        }
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            s.intact[i] = Equations::intact(s.tensionDamage[i], s.shearDamage[i]);
            s.secant[i] = e.secant(s.intact[i], s.farthest[i]);
        }
    }

    // 2, Coulomb slip
    Mask slides = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        s.newStiffness[i] = e.stiffness(s.elastic[i], s.secant[i]);
        s.sigma[i] = s.newStiffness[i] * s.elastic[i];
        s.asks[i] = s.size[i] > e.slipStrength(s.intact[i], s.sigma[i]) ? waits[i] : 0;
        s.share[i] = 1;
        s.slip[i] = 0;
        s.dilation[i] = 0;
        slides |= s.asks[i];
    }
    if (slides) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            s.ratio[i] = e.shearRatio(s.size[i], s.sigma[i], slip[i]);
            s.dilatancy[i] = s.open[i] ? 0 : e.tanPsi;
        }
        for (int i = 0; i < count; ++i) {
            if (!s.asks[i] || !(s.shearDamage[i] < 1)) continue;
            const double damage = shear.damage(s.ratio[i], rows[i].shear);
            if (damage > s.shearDamage[i]) s.shearDamage[i] = damage;
        }
        for (int i = 0; e.tanPsi > 0 && e.delta > 0 && i < count; ++i)
            if (s.asks[i] && !s.open[i]) s.dilatancy[i] = e.dilatancy(slip[i]);
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const bool weaker = s.shearDamage[i] > shearDamage[i];
            s.intact[i] = Equations::intact(s.tensionDamage[i], s.shearDamage[i]);
            s.secant[i] = e.secant(s.intact[i], s.farthest[i]);
            s.newStiffness[i] = e.stiffness(s.elastic[i], s.secant[i]);
            const auto slid = e.slide(s.size[i], s.sigma[i], s.intact[i], s.dilatancy[i]);
            s.sigma[i] = (s.open[i] != 0) & weaker ? s.newStiffness[i] * s.elastic[i] : slid.sigma;
            s.share[i] = slid.share;
            s.slip[i] = slid.slip;
            s.dilation[i] = slid.dilation;
            s.regime[i] = slid.slides ? Mask(Regime::Slipping) : s.regime[i];
        }
    }

    // 3, cap
    Mask crushes = 0;
    const double limit = e.curve.limit(e.stretch);
    const double closing = e.cap ? -1 : 0; // how closure counts
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double a = s.share[i] * s.trialA[i];
        const double b = s.share[i] * s.trialB[i];
        const double closest = largestClosure[i];
        const double closure = s.sigma[i] < 0 ? closing * s.total[i] : 0;
        const bool passes = (s.sigma[i] < 0) & (e.capStress(s.sigma[i], a * a + b * b) > e.smallestFcSquared);
        s.closest[i] = closure > closest ? closure : closest;
        s.left[i] = 1;
        s.closure[i] = 0;
        s.crushingSlip[i] = 0;
        crushes |= passes | ((closure > closest) & (closure > limit)) ? waits[i] : 0;
    }
    if (crushes && e.cap) {
        double* capSquared = columns[J::CapSquared];
        Mask beyond = 0;
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            s.fc[i] = e.curve.upToMiddle(s.closest[i], e.stretch);
            s.asks[i] = e.curve.isBeyondMiddle(s.closest[i], e.stretch) ? waits[i] : 0;
            beyond |= s.asks[i];
        }
        for (int i = 0; beyond && i < count; ++i)
            if (s.asks[i]) s.fc[i] = e.curve.beyondMiddle(s.closest[i], e.stretch);
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const double a = s.share[i] * s.trialA[i];
            const double b = s.share[i] * s.trialB[i];
            const double old = capSquared[i];
            const auto crushed = e.crush(s.sigma[i], a * a + b * b, s.fc[i]);
            s.sigma[i] *= crushed.share;
            s.left[i] = crushed.share;
            s.closure[i] = crushed.closure;
            s.crushingSlip[i] = crushed.slip;
            s.regime[i] = crushed.crushes ? Mask(Regime::Crushing) : s.regime[i];
            capSquared[i] = waits[i] ? s.fc[i] * s.fc[i] : old;
        }
    } else
        crushes = 0;

    // the new state and what was lost; s.closure and s.dilation become what the state has grown by
    if (crushes || (slides && e.tanPsi > 0)) {
        double* crushing = columns[J::Crushing];
        double* dilation = columns[J::Dilation];
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const double oldCrushing = crushing[i];
            const double oldDilation = dilation[i];
            const double old = irreversible[i];
            const double newCrushing = oldCrushing + s.closure[i];
            const double newDilation = oldDilation + s.dilation[i];
            const double now = newCrushing - newDilation;
            s.closure[i] = newCrushing - oldCrushing;
            s.dilation[i] = newDilation - oldDilation;
            s.elastic[i] = s.total[i] + now;
            crushing[i] = waits[i] ? newCrushing : oldCrushing;
            dilation[i] = waits[i] ? newDilation : oldDilation;
            irreversible[i] = waits[i] ? now : old;
        }
    }
    if (crushes || slides) {
        double* lostShear = columns[J::LostShear];
        double* lostCompression = columns[J::LostCompression];
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const double a = s.left[i] * (s.share[i] * s.trialA[i]);
            const double b = s.left[i] * (s.share[i] * s.trialB[i]);
            const double meanNormal = 0.5 * (s.oldStiffness[i] * s.before[i] + s.sigma[i]);
            const double meanShear =
                Equations::meanShear(shearStressA[i], shearStressB[i], a, b, s.trialA[i], s.trialB[i], s.size[i]);
            const bool slips = s.slip[i] + s.crushingSlip[i] > 0;
            const double inShear = meanShear * s.slip[i] + meanNormal * s.dilation[i];
            const double inCrushing = meanShear * s.crushingSlip[i];
            const double oldSlip = slip[i];
            const double oldShear = lostShear[i];
            const double oldCompression = lostCompression[i];
            const double newSlip = oldSlip + s.slip[i] + s.crushingSlip[i];
            const double newShear = oldShear + (slips ? inShear : 0);
            const double newCompression = oldCompression + ((slips ? inCrushing : 0) - meanNormal * s.closure[i]);
            slip[i] = waits[i] ? newSlip : oldSlip;
            lostShear[i] = waits[i] ? newShear : oldShear;
            lostCompression[i] = waits[i] ? newCompression : oldCompression;
        }
    }
    Mask tore = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double oldOpening = opening[i];
        const double oldA = shearStressA[i];
        const double oldB = shearStressB[i];
        const double oldFarthest = largestOpening[i];
        const double oldClosest = largestClosure[i];
        const double oldStress = normalStress[i];
        const double a = s.left[i] * (s.share[i] * s.trialA[i]);
        const double b = s.left[i] * (s.share[i] * s.trialB[i]);
        s.torn[i] = Equations::lostInTension(s.oldStiffness[i], s.newStiffness[i], s.oldStiffness[i] * s.before[i],
                                             s.sigma[i], s.before[i], s.elastic[i]);
        tore |= s.oldStiffness[i] != s.newStiffness[i] ? waits[i] : 0;
        opening[i] = waits[i] ? s.total[i] : oldOpening;
        shearStressA[i] = waits[i] ? a : oldA;
        shearStressB[i] = waits[i] ? b : oldB;
        largestOpening[i] = waits[i] ? s.farthest[i] : oldFarthest;
        largestClosure[i] = waits[i] ? s.closest[i] : oldClosest;
        normalStress[i] = waits[i] ? s.sigma[i] : oldStress;
    }
    if (tore) {
        double* lostTension = columns[J::LostTension];
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i)
            lostTension[i] += waits[i] ? s.torn[i] : 0;
    }
    if (tears || slides) {
        double* reach = columns[J::Reach];
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const double oldTension = tensionDamage[i];
            const double oldShear = shearDamage[i];
            const double oldIntact = intact[i];
            const double oldSecant = secant[i];
            const double oldReach = reach[i];
            tensionDamage[i] = waits[i] ? s.tensionDamage[i] : oldTension;
            shearDamage[i] = waits[i] ? s.shearDamage[i] : oldShear;
            intact[i] = waits[i] ? s.intact[i] : oldIntact;
            secant[i] = waits[i] ? s.secant[i] : oldSecant;
            reach[i] = waits[i] ? e.reach(s.intact[i], s.farthest[i]) : oldReach;
        }
    }
    for (int i = 0; i < count; ++i) {
        const Regime old = regime[i];
        regime[i] = waits[i] ? Regime(s.regime[i]) : old;
    }
}

// ---- energies ------------------------------------------------------------------------------------------------------

struct LaneSums { // of lanes, so that the order of adding is the same with any vector unit
    double storedTension[lanes] = {}, storedShear[lanes] = {}, storedCompression[lanes] = {};
    double lostTension[lanes] = {}, lostShear[lanes] = {}, lostCompression[lanes] = {};
};

double sum(const double (&lane)[lanes]) {
    double all = 0;
    for (double each : lane)
        all += each;
    return all;
}

template <bool yielded>
MASONRY_INLINED void addEnergies(double kn, double ks, const J::Columns& columns, std::size_t at, int count,
                                 const double* area, LaneSums& sums) {
    const double* opening = columns[J::Opening] + at;
    const double* shearStressA = columns[J::ShearStressA] + at;
    const double* shearStressB = columns[J::ShearStressB] + at;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double elastic = yielded ? opening[i] + columns[J::Irreversible][at + i] : opening[i];
        const double stiffness = yielded && elastic > 0 ? columns[J::Secant][at + i] : kn;
        const double tauSquared = shearStressA[i] * shearStressA[i] + shearStressB[i] * shearStressB[i];
        const double normal = area[i] * Equations::storedNormal(stiffness * elastic, elastic);
        sums.storedTension[i] += elastic > 0 ? normal : 0;
        sums.storedCompression[i] += elastic > 0 ? 0 : normal;
        sums.storedShear[i] += area[i] * Equations::storedShear(tauSquared, ks);
        if (!yielded) continue;
        sums.lostTension[i] += area[i] * columns[J::LostTension][at + i];
        sums.lostShear[i] += area[i] * columns[J::LostShear][at + i];
        sums.lostCompression[i] += area[i] * columns[J::LostCompression][at + i];
    }
}

MASONRY_VECTORISED
void addEnergiesOfMany(double kn, double ks, const J::Columns& columns, const std::uint8_t* yielded, int joints,
                       int stride, const double* area, bool alike, int point, LaneSums& sums) {
    for (int from = 0; from < joints; from += lanes) {
        const std::size_t at = std::size_t(point) * stride + from;
        const double* of = alike ? area + point * J::most + from % J::most : area + at;
        const int count = joints - from < lanes ? joints - from : lanes; // padding does not count
        if (yielded[from / lanes])
            count == lanes ? addEnergies<true>(kn, ks, columns, at, lanes, of, sums)
                           : addEnergies<true>(kn, ks, columns, at, count, of, sums);
        else
            count == lanes ? addEnergies<false>(kn, ks, columns, at, lanes, of, sums)
                           : addEnergies<false>(kn, ks, columns, at, count, of, sums);
    }
}

} // namespace

// ---- states --------------------------------------------------------------------------------------------------------

JointColumns::JointColumns(std::shared_ptr<const JointLaw> law, const ElasticStiffness& k, int joints, int points)
    : law_(std::move(law)),
      k_(k),
      joints_(joints),
      points_(points),
      stride_(joints == 1 ? 1 : (joints + lanes - 1) / lanes * lanes),
      groups_((stride_ + lanes - 1) / lanes) {
    find();
    const std::size_t size = std::size_t(stride_) * points_;
    columns_.pitch = size % 512 == 0 ? size + lanes : size; // columns whole pages apart would compete for the cache
    const std::size_t numbers = columns_.pitch * columnCount + lanes;
    memory_.reset(std::calloc(numbers, sizeof(double)));
    if (!memory_ && size > 0) throw std::bad_alloc();
    void* aligned = memory_.get();
    std::size_t room = numbers * sizeof(double);
    columns_.first = static_cast<double*>(std::align(alignof(Row), sizeof(double), aligned, room));
    rows_.assign(size, Rows{0, 0});
    regime_.assign(size, Regime::Elastic);
    yielded_.assign(std::size_t(groups_) * points_, 0);
}

void JointColumns::find() {
    equations_ = law_->equations(k_);
    neverYielded_ = {0, 1, equations_.kn, equations_.reach(1, 0), squareOfCap(equations_, 0)};
}

bool JointColumns::neverYielded(const JointState& s) const {
    const bool whole = s.crushing == 0 && s.dilation == 0 && s.slip == 0 && s.tensionDamage == 0 && s.shearDamage == 0;
    const double limit = equations_.cap ? equations_.curve.limit(equations_.stretch) : HUGE_VAL;
    return whole && s.largestOpening <= equations_.reach(1, 0) && s.largestClosure <= limit;
}

void JointColumns::derive(std::size_t i) {
    const double largestOpening = columns_[LargestOpening][i];
    const double intact = Equations::intact(columns_[TensionDamage][i], columns_[ShearDamage][i]);
    columns_[Irreversible][i] = columns_[Crushing][i] - columns_[Dilation][i];
    columns_[Intact][i] = intact;
    columns_[Secant][i] = equations_.secant(intact, largestOpening);
    columns_[Reach][i] = equations_.reach(intact, largestOpening);
    columns_[CapSquared][i] = squareOfCap(equations_, columns_[LargestClosure][i]);
}

void JointColumns::yieldFrom(int point, int joint) {
    auto& yielded = yielded_[group(point, joint)];
    if (yielded) return;
    yielded = 1;
    const int first = joint / lanes * lanes;
    for (int n = first; n < std::min(first + lanes, stride_); ++n)
        derive(at(point, n));
}

void JointColumns::setLaw(std::shared_ptr<const JointLaw> law) {
    law_ = std::move(law);
    find();
    for (int point = 0; point < points_; ++point)
        for (int joint = 0; joint < stride_; ++joint) {
            if (!yielded_[group(point, joint)] && !neverYielded(get(point, joint))) yieldFrom(point, joint);
            if (yielded_[group(point, joint)]) derive(at(point, joint));
        }
}

JointState JointColumns::get(int point, int joint) const {
    const std::size_t i = at(point, joint);
    JointState s;
    s.opening = columns_[Opening][i];
    s.shearStress = {columns_[ShearStressA][i], columns_[ShearStressB][i]};
    s.largestOpening = columns_[LargestOpening][i];
    s.largestClosure = columns_[LargestClosure][i];
    s.regime = regime_[i];
    if (!yielded_[group(point, joint)]) {
        s.normalStress = equations_.kn * s.opening;
        return s;
    }
    s.crushing = columns_[Crushing][i];
    s.dilation = columns_[Dilation][i];
    s.slip = columns_[Slip][i];
    s.tensionDamage = columns_[TensionDamage][i];
    s.shearDamage = columns_[ShearDamage][i];
    const double elastic = s.opening + columns_[Irreversible][i];
    s.normalStress = equations_.stiffness(elastic, columns_[Secant][i]) * elastic;
    return s;
}

void JointColumns::set(int point, int joint, const JointState& s) {
    const std::size_t i = at(point, joint);
    columns_[Opening][i] = s.opening;
    columns_[ShearStressA][i] = s.shearStress.a;
    columns_[ShearStressB][i] = s.shearStress.b;
    columns_[LargestOpening][i] = s.largestOpening;
    columns_[LargestClosure][i] = s.largestClosure;
    regime_[i] = s.regime;
    if (!yielded_[group(point, joint)] && neverYielded(s)) return;
    columns_[Crushing][i] = s.crushing;
    columns_[Dilation][i] = s.dilation;
    columns_[Slip][i] = s.slip;
    columns_[TensionDamage][i] = s.tensionDamage;
    columns_[ShearDamage][i] = s.shearDamage;
    yieldFrom(point, joint);
    derive(i);
}

Energies JointColumns::dissipated(int point, int joint) const {
    const std::size_t i = at(point, joint);
    if (!yielded_[group(point, joint)]) return {};
    return {columns_[LostTension][i], columns_[LostShear][i], columns_[LostCompression][i]};
}

void JointColumns::setDissipated(int point, int joint, const Energies& energies) {
    if (energies.tension == 0 && energies.shear == 0 && energies.compression == 0 && !yielded_[group(point, joint)])
        return;
    yieldFrom(point, joint);
    const std::size_t i = at(point, joint);
    columns_[LostTension][i] = energies.tension;
    columns_[LostShear][i] = energies.shear;
    columns_[LostCompression][i] = energies.compression;
}

JointColumns::Sums JointColumns::energies(const double* area, bool alike) const {
    LaneSums sums;
    for (int point = 0; point < points_; ++point)
        addEnergiesOfMany(equations_.kn, equations_.ks, columns_, &yielded_[group(point, 0)], joints_, stride_, area,
                          alike, point, sums);
    return {{sum(sums.storedTension), sum(sums.storedShear), sum(sums.storedCompression)},
            {sum(sums.lostTension), sum(sums.lostShear), sum(sums.lostCompression)}};
}

// ---- steps ---------------------------------------------------------------------------------------------------------

double JointColumns::advanceOne(int point, int joint, const Jump& jump) {
    JointState s = get(point, joint);
    const Energies lost = law_->advance(equations_, s, jump);
    set(point, joint, s);
    if (yielded_[group(point, joint)]) {
        const std::size_t i = at(point, joint);
        columns_[LostTension][i] += lost.tension;
        columns_[LostShear][i] += lost.shear;
        columns_[LostCompression][i] += lost.compression;
    }
    return s.normalStress;
}

void JointColumns::advance(int point, int from, int count, const double* opening, const double* slideA,
                           const double* slideB, double* normalStress) {
    const std::size_t first = at(point, from);
    const Jumps jumps{opening, slideA, slideB ? slideB : none, slideB == nullptr};
    Regime* regime = &regime_[first];
    if (equations_.elastic) {
        std::fill_n(regime, count, Regime::Elastic);
        advanceElastic(k_.normal, k_.shear, columns_, first, count, jumps, normalStress);
        return;
    }
    bool yielded = false;
    for (int n = 0; n < count; n += lanes)
        yielded |= yielded_[group(point, from + n)] != 0;
    Mask waits[most];
    if (yielded) {
        int busy = 0; // how many yielded in the last step
        for (int n = 0; n < count; ++n)
            busy += regime[n] != Regime::Elastic;
        for (int n = 0; n < count; n += lanes)
            yieldFrom(point, from + n);
        if (4 * busy > 3 * count) { // nearly all need the whole law again
            std::fill_n(waits, count, 1);
            advanceSideBySide(equations_, law_->tension(), law_->shear(), columns_.from(first), &rows_[first], regime,
                              jumps, waits, count, normalStress);
            return;
        }
    }
    std::fill_n(regime, count, Regime::Elastic);
    const Mask left =
        stayElasticOfMany(equations_, neverYielded_, yielded, columns_, first, count, jumps, normalStress, waits);
    if (left == 0) return;

    int waiting[most]; // the subcontacts that need the whole law
    int many = 0;
    for (int n = 0; n < count; ++n)
        if (waits[n]) waiting[many++] = n;
    if (many < 3) {
        for (int n = 0; n < many; ++n) {
            const int i = waiting[n];
            normalStress[i] = advanceOne(point, from + i, {opening[i], {slideA[i], jumps.slideB[i]}});
        }
        return;
    }
    for (int n = 0; n < count; n += lanes)
        yieldFrom(point, from + n);
    if (3 * many >= count)
        advanceSideBySide(equations_, law_->tension(), law_->shear(), columns_.from(first), &rows_[first], regime,
                          jumps, waits, count, normalStress);
    else
        advanceGathered(first, waiting, many, jumps, normalStress);
}

// Few subcontacts are brought together for a step, so that all lanes have something to do.
void JointColumns::advanceGathered(std::size_t first, const int* waiting, int many, const Jumps& jumps,
                                   double* normalStress) {
    constexpr int room = most / 2;
    alignas(64) double column[columnCount][room];
    double opening[room], slideA[room], slideB[room], stress[room];
    Mask waits[room];
    Rows rows[room];
    Regime regime[room];
    const int padded = (many + lanes - 1) / lanes * lanes;
    for (int n = 0; n < padded; ++n) {
        const int i = waiting[std::min(n, many - 1)]; // the last one fills the lanes
        for (int c = 0; c < columnCount; ++c)
            column[c][n] = columns_[c][first + i];
        opening[n] = jumps.opening[i];
        slideA[n] = jumps.slideA[i];
        slideB[n] = jumps.slideB[i];
        waits[n] = n < many;
        rows[n] = rows_[first + i];
        regime[n] = Regime::Elastic;
        stress[n] = 0;
    }
    advanceSideBySide(equations_, law_->tension(), law_->shear(), Columns{column[0], room}, rows, regime,
                      {opening, slideA, slideB, false}, waits, padded, stress);
    for (int n = 0; n < many; ++n) {
        const int i = waiting[n];
        for (int c = 0; c < columnCount; ++c)
            columns_[c][first + i] = column[c][n];
        rows_[first + i] = rows[n];
        regime_[first + i] = regime[n];
        normalStress[i] = stress[n];
    }
}

} // namespace masonry
