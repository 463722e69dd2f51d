#include "JointColumns.hpp"
#include "common/Vectorised.hpp"
#include <new>

namespace masonry {

namespace {

using J = JointColumns;
using Mask = std::int64_t; // a switch as wide as the numbers beside it, for the vector units

struct Jumps {
    const double *opening, *slideA, *slideB;
};


double squareOfCap(const Equations& e, double largestClosure) {
    const double fc = e.cap ? e.curve.strength(largestClosure, e.stretch) : HUGE_VAL;
    return fc * fc;
}

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
    if (!jumps.slideB) return;
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
    if (jumps.slideB)
        return yielded ? stayElastic<true, true>(e, ofAll, columns, at, count, jumps, normalStress, waits)
                       : stayElastic<true, false>(e, ofAll, columns, at, count, jumps, normalStress, waits);
    return yielded ? stayElastic<false, true>(e, ofAll, columns, at, count, jumps, normalStress, waits)
                   : stayElastic<false, false>(e, ofAll, columns, at, count, jumps, normalStress, waits);
}

// ---- subcontacts that may yield ------------------------------------------------------------------------------------

struct Scratch { // subcontacts side by side
    alignas(64) double column[J::columnCount][J::most];
    double jump[J::most], slideA[J::most], slideB[J::most];
    double total[J::most], before[J::most], elastic[J::most], farthest[J::most], oldStiffness[J::most];
    double trialA[J::most], trialB[J::most], size[J::most]; // trial shear stress
    double ratio[J::most], tensionDamage[J::most], shearDamage[J::most], dilatancy[J::most];
    double intact[J::most], secant[J::most], sigma[J::most], share[J::most], slip[J::most], dilation[J::most];
    double closest[J::most], fc[J::most], crushed[J::most], closure[J::most], crushingSlip[J::most];
    Mask open[J::most], asks[J::most], regime[J::most];
    Mask waits[J::most]; // 0 of subcontacts that only fill the lanes
    std::int32_t tensionRow[J::most], shearRow[J::most];
};

// One step of `count` subcontacts, a multiple of the lanes: what JointLaw::advance does for one. Tables and
// exponentials are looked up one by one, for those that need them.
MASONRY_VECTORISED
void advanceSideBySide(const Equations& given, const SofteningTable& tension, const SofteningTable& shear, Scratch& s,
                       int count) {
    const Equations e = given;
    auto& was = s.column;

    // 1, opening
    Mask any = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const auto moved = e.open(was[J::Opening][i], was[J::Irreversible][i], was[J::LargestOpening][i], s.jump[i]);
        s.total[i] = moved.total;
        s.before[i] = moved.before;
        s.elastic[i] = moved.elastic;
        s.farthest[i] = moved.farthest;
        s.open[i] = moved.open;
        s.asks[i] = moved.tears ? s.waits[i] : 0;
        s.regime[i] = Mask(Regime::Elastic);
        s.oldStiffness[i] = e.stiffness(moved.before, was[J::Secant][i]);
        s.trialA[i] = was[J::ShearStressA][i] + e.ks * s.slideA[i]; // eq. (7)
        s.trialB[i] = was[J::ShearStressB][i] + e.ks * s.slideB[i];
        s.size[i] = std::sqrt(s.trialA[i] * s.trialA[i] + s.trialB[i] * s.trialB[i]);
        s.tensionDamage[i] = was[J::TensionDamage][i];
        s.shearDamage[i] = was[J::ShearDamage][i];
        s.intact[i] = was[J::Intact][i];
        s.secant[i] = was[J::Secant][i];
        any |= s.asks[i];
    }
    if (any) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i)
            s.ratio[i] = e.tensionRatio(s.elastic[i]);
        for (int i = 0; i < count; ++i) {
            if (!s.asks[i]) continue;
            const double damage = tension.damage(s.ratio[i], s.tensionRow[i]);
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
    any = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        s.sigma[i] = e.stiffness(s.elastic[i], s.secant[i]) * s.elastic[i];
        s.asks[i] = s.size[i] > e.slipStrength(s.intact[i], s.sigma[i]) ? s.waits[i] : 0;
        s.share[i] = 1;
        s.slip[i] = 0;
        s.dilation[i] = 0;
        any |= s.asks[i];
    }
    if (any) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            s.ratio[i] = e.shearRatio(s.size[i], s.sigma[i], was[J::Slip][i]);
            s.dilatancy[i] = s.open[i] ? 0 : e.tanPsi;
        }
        for (int i = 0; i < count; ++i) {
            if (!s.asks[i]) continue;
            if (s.shearDamage[i] < 1) {
                const double damage = shear.damage(s.ratio[i], s.shearRow[i]);
                if (damage > s.shearDamage[i]) s.shearDamage[i] = damage;
            }
            if (e.tanPsi > 0 && !s.open[i]) s.dilatancy[i] = e.dilatancy(was[J::Slip][i]);
        }
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const bool weaker = s.shearDamage[i] > was[J::ShearDamage][i];
            s.intact[i] = Equations::intact(s.tensionDamage[i], s.shearDamage[i]);
            s.secant[i] = e.secant(s.intact[i], s.farthest[i]);
            const auto slid = e.slide(s.size[i], s.sigma[i], s.intact[i], s.dilatancy[i]);
            s.sigma[i] = (s.open[i] != 0) & weaker ? s.secant[i] * s.elastic[i] : slid.sigma;
            s.share[i] = slid.share;
            s.slip[i] = slid.slip;
            s.dilation[i] = slid.dilation;
            s.regime[i] = slid.slides ? Mask(Regime::Slipping) : s.regime[i];
        }
    }

    // 3, cap
    any = 0;
    const double limit = e.curve.limit(e.stretch);
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double a = s.share[i] * s.trialA[i];
        const double b = s.share[i] * s.trialB[i];
        const double closest = was[J::LargestClosure][i];
        const bool squeezed = e.cap & (s.sigma[i] < 0);
        s.closest[i] = squeezed & (-s.total[i] > closest) ? -s.total[i] : closest;
        s.crushed[i] = 1;
        s.closure[i] = 0;
        s.crushingSlip[i] = 0;
        const bool passes = e.capStress(s.sigma[i], a * a + b * b) > e.smallestFcSquared;
        any |= squeezed & (passes | (s.closest[i] > limit)) ? s.waits[i] : 0;
    }
    if (any) {
        Mask anyBeyond = 0;
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            s.fc[i] = e.curve.upToMiddle(s.closest[i], e.stretch);
            s.asks[i] = e.curve.isBeyondMiddle(s.closest[i], e.stretch) ? s.waits[i] : 0;
            anyBeyond |= s.asks[i];
        }
        for (int i = 0; anyBeyond && i < count; ++i)
            if (s.asks[i]) s.fc[i] = e.curve.beyondMiddle(s.closest[i], e.stretch);
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const double a = s.share[i] * s.trialA[i];
            const double b = s.share[i] * s.trialB[i];
            const auto crushed = e.crush(s.sigma[i], a * a + b * b, s.fc[i]);
            s.sigma[i] *= crushed.share;
            s.crushed[i] = crushed.share;
            s.closure[i] = crushed.closure;
            s.crushingSlip[i] = crushed.slip;
            s.regime[i] = crushed.crushes ? Mask(Regime::Crushing) : s.regime[i];
            was[J::CapSquared][i] = s.fc[i] * s.fc[i];
        }
    }

    // the new state and what was lost
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double a = s.crushed[i] * (s.share[i] * s.trialA[i]);
        const double b = s.crushed[i] * (s.share[i] * s.trialB[i]);
        const double crushing = was[J::Crushing][i] + s.closure[i];
        const double dilation = was[J::Dilation][i] + s.dilation[i];
        const double irreversible = crushing - dilation;
        const double oldNormal = s.oldStiffness[i] * s.before[i];
        const double newStiffness = e.stiffness(s.elastic[i], s.secant[i]);
        const double meanNormal = 0.5 * (oldNormal + s.sigma[i]);
        const double meanShear = Equations::meanShear(was[J::ShearStressA][i], was[J::ShearStressB][i], a, b,
                                                      s.trialA[i], s.trialB[i], s.size[i]);
        const bool slips = s.slip[i] + s.crushingSlip[i] > 0;
        const double inShear = meanShear * s.slip[i] + meanNormal * (dilation - was[J::Dilation][i]);
        const double inCrushing = meanShear * s.crushingSlip[i];
        was[J::LostTension][i] += Equations::lostInTension(s.oldStiffness[i], newStiffness, oldNormal, s.sigma[i],
                                                           s.before[i], s.total[i] + irreversible);
        was[J::LostShear][i] += slips ? inShear : 0;
        was[J::LostCompression][i] += (slips ? inCrushing : 0) - meanNormal * (crushing - was[J::Crushing][i]);
        was[J::Opening][i] = s.total[i];
        was[J::ShearStressA][i] = a;
        was[J::ShearStressB][i] = b;
        was[J::LargestOpening][i] = s.farthest[i];
        was[J::LargestClosure][i] = s.closest[i];
        was[J::Crushing][i] = crushing;
        was[J::Dilation][i] = dilation;
        was[J::Slip][i] = was[J::Slip][i] + s.slip[i] + s.crushingSlip[i];
        was[J::TensionDamage][i] = s.tensionDamage[i];
        was[J::ShearDamage][i] = s.shearDamage[i];
        was[J::Irreversible][i] = irreversible;
        was[J::Intact][i] = s.intact[i];
        was[J::Secant][i] = s.secant[i];
        was[J::Reach][i] = e.reach(s.intact[i], s.farthest[i]);
    }
}

// All subcontacts of a range into the scratch, in their places, and back those that waited.
MASONRY_VECTORISED
void take(const J::Columns& columns, std::size_t at, int count, const Jumps& jumps, const Mask* waits, Scratch& s) {
    for (int c = 0; c < J::columnCount; ++c) {
        const double* column = columns[c] + at;
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i)
            s.column[c][i] = column[i];
    }
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        s.jump[i] = jumps.opening[i];
        s.slideA[i] = jumps.slideA[i];
        s.slideB[i] = 0;
        s.waits[i] = waits[i];
    }
    if (!jumps.slideB) return;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i)
        s.slideB[i] = jumps.slideB[i];
}

MASONRY_VECTORISED
void giveBack(const J::Columns& columns, std::size_t at, int count, double* normalStress, const Scratch& s) {
    for (int c = 0; c < J::columnCount; ++c) {
        double* column = columns[c] + at;
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const double old = column[i];
            const double now = s.column[c][i];
            column[i] = s.waits[i] ? now : old;
        }
    }
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double old = normalStress[i];
        const double now = s.sigma[i];
        normalStress[i] = s.waits[i] ? now : old;
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
    const Jumps jumps{opening, slideA, slideB};
    std::fill_n(&regime_[first], count, Regime::Elastic);
    if (equations_.elastic) {
        advanceElastic(k_.normal, k_.shear, columns_, first, count, jumps, normalStress);
        return;
    }
    bool yielded = false;
    for (int n = 0; n < count; n += lanes)
        yielded |= yielded_[group(point, from + n)] != 0;
    if (yielded)
        for (int n = 0; n < count; n += lanes)
            yieldFrom(point, from + n);
    Mask waits[most];
    const Mask left = stayElasticOfMany(equations_, neverYielded_, yielded, columns_, first, count, jumps,
                                        normalStress, waits);
    if (left == 0) return;

    int waiting[most]; // the subcontacts that need the whole law
    int many = 0;
    for (int n = 0; n < count; ++n)
        if (waits[n]) waiting[many++] = n;
    if (many < 3) {
        for (int n = 0; n < many; ++n) {
            const int i = waiting[n];
            normalStress[i] = advanceOne(point, from + i, {opening[i], {slideA[i], slideB ? slideB[i] : 0}});
        }
        return;
    }

    for (int n = 0; n < count; n += lanes)
        yieldFrom(point, from + n);
    Scratch s;
    if (2 * many >= count && count % lanes == 0) { // all, in their places
        take(columns_, first, count, jumps, waits, s);
        for (int n = 0; n < count; ++n) {
            s.tensionRow[n] = rows_[first + n].tension;
            s.shearRow[n] = rows_[first + n].shear;
        }
        advanceSideBySide(equations_, law_->tension(), law_->shear(), s, count);
        giveBack(columns_, first, count, normalStress, s);
        for (int n = 0; n < many; ++n) {
            const int i = waiting[n];
            rows_[first + i] = {s.tensionRow[i], s.shearRow[i]};
            regime_[first + i] = Regime(s.regime[i]);
        }
        return;
    }

    const int padded = (many + lanes - 1) / lanes * lanes; // the last one fills the lanes
    for (int n = 0; n < padded; ++n) {
        const int i = waiting[std::min(n, many - 1)];
        for (int c = 0; c < columnCount; ++c)
            s.column[c][n] = columns_[c][first + i];
        s.jump[n] = opening[i];
        s.slideA[n] = slideA[i];
        s.slideB[n] = slideB ? slideB[i] : 0;
        s.waits[n] = n < many;
        s.tensionRow[n] = rows_[first + i].tension;
        s.shearRow[n] = rows_[first + i].shear;
    }
    advanceSideBySide(equations_, law_->tension(), law_->shear(), s, padded);
    for (int n = 0; n < many; ++n) {
        const int i = waiting[n];
        for (int c = 0; c < columnCount; ++c)
            columns_[c][first + i] = s.column[c][n];
        rows_[first + i] = {s.tensionRow[n], s.shearRow[n]};
        regime_[first + i] = Regime(s.regime[n]);
        normalStress[i] = s.sigma[n];
    }
}

} // namespace masonry
