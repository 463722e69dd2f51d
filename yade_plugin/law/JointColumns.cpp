#include "JointColumns.hpp"
#include "common/Vectorised.hpp"

namespace masonry {

namespace {

constexpr std::size_t most = 32; // subcontacts that are taken at a time

// What subcontacts did in a step, as wide as the numbers beside it, for the vector units.
constexpr std::int64_t did(Regime regime) { return std::int64_t(regime); }
constexpr std::int64_t waiting = -1; // for the full law

} // namespace

JointColumns::JointColumns(const JointLaw& law, const ElasticStiffness& k, std::size_t size) : k_(k) {
    for (auto* column : {&opening_, &crushing_, &dilation_, &slip_, &largestOpening_, &largestClosure_, &tensionDamage_,
                         &shearDamage_, &shearStressA_, &shearStressB_, &flow_, &intact_, &secant_, &reach_,
                         &capStrength2_, &lostTension_, &lostShear_, &lostCompression_})
        column->assign(size, 0);
    regime_.assign(size, Regime::Elastic), row_.assign(size, 0);
    const auto& p = law.properties();
    const bool cap = p.cap && !p.elastic;
    limits_ = {k.normal,           k.shear,
               p.tensileStrength,  p.tensileStrength / k.normal,
               p.residualCohesion, p.cohesion - p.residualCohesion,
               p.residualFriction, p.friction - p.residualFriction,
               p.capNormal,        p.capShear,
               p.capLinear,        cap ? law.limitClosure(k) : HUGE_VAL,
               p.shearStiffness,   cap};
    slides_ = !p.elastic && p.dilatancy == 0;
    if (p.elastic) { // no strength is ever reached
        limits_.tensileStrength = limits_.onset = limits_.residualCohesion = HUGE_VAL;
        limits_.cohesionLoss = limits_.residualFriction = limits_.frictionLoss = 0;
    }
    for (std::size_t i = 0; i < size; ++i)
        set(law, i, JointState{});
}

JointState JointColumns::get(std::size_t i) const {
    const double elastic = opening_[i] + flow_[i], normalStress = (elastic > 0 ? secant_[i] : k_.normal) * elastic;
    return {opening_[i],        crushing_[i],      dilation_[i],    slip_[i],     largestOpening_[i],
            largestClosure_[i], tensionDamage_[i], shearDamage_[i], normalStress, {shearStressA_[i], shearStressB_[i]},
            regime_[i]};
}

void JointColumns::set(const JointLaw& law, std::size_t i, const JointState& s) {
    opening_[i] = s.opening, crushing_[i] = s.crushing, dilation_[i] = s.dilation, slip_[i] = s.slip;
    largestOpening_[i] = s.largestOpening, largestClosure_[i] = s.largestClosure;
    tensionDamage_[i] = s.tensionDamage, shearDamage_[i] = s.shearDamage;
    shearStressA_[i] = s.shearStress.a, shearStressB_[i] = s.shearStress.b;
    regime_[i] = s.regime;
    flow_[i] = s.crushing - s.dilation;
    intact_[i] = 1 - JointLaw::coupled(s);
    const double weakened = limits_.tensileStrength * intact_[i] / s.largestOpening; // eq. (11)
    secant_[i] = weakened < k_.normal ? weakened : k_.normal;
    reach_[i] = intact_[i] == 1 ? limits_.onset : s.largestOpening;
    const double strength = limits_.cap ? law.compressiveStrength(k_, s.largestClosure) : HUGE_VAL;
    capStrength2_[i] = strength * strength;
}

// law.md §5 where no strength is passed: eqs. (6), (7), the secant of eq. (11), and the three conditions of eq. (8).
// Returns how many subcontacts need more.
MASONRY_VECTORISED
std::int64_t JointColumns::advanceIntact(const Limits& m, std::size_t count, const double* __restrict jumpN,
                                         const double* __restrict jumpA, const double* __restrict jumpB,
                                         const double* __restrict flow, const double* __restrict intact,
                                         const double* __restrict secant, const double* __restrict reach,
                                         const double* __restrict capStrength2, double* __restrict opening,
                                         double* __restrict largestOpening, double* __restrict largestClosure,
                                         double* __restrict shearStressA, double* __restrict shearStressB,
                                         double* __restrict normalStress, std::int64_t* __restrict now) {
    const double kn = m.normalStiffness, ks = m.shearStiffness;
    const double cr = m.residualCohesion, dc = m.cohesionLoss, fr = m.residualFriction, df = m.frictionLoss;
    const double cnn = m.capNormal, css = m.capShear, cn = m.capLinear, limit = m.limitClosure;
    const bool cap = m.cap;
    std::int64_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double total = opening[i] + jumpN[i], before = opening[i] + flow[i], elastic = total + flow[i];
        const double whole = intact[i], farthest = largestOpening[i], closest = largestClosure[i], weak = secant[i];
        const double sigma = (elastic > 0 ? weak : kn) * elastic;
        const double a = shearStressA[i] + ks * jumpA[i], b = shearStressB[i] + ks * jumpB[i], tau2 = a * a + b * b;
        const double strength = cr + dc * whole - sigma * (fr + df * whole), slips = strength > 0 ? strength : 0;
        const double hardens = closest > limit ? closest : limit;
        const double crush = sigma < 0 ? cnn * sigma * sigma + css * tau2 + cn * sigma : 0;
        const double closure = sigma < 0 && cap ? -total : 0;
        // a joint that opens on one stiffness and closes on another loses energy
        const bool quick = (elastic <= reach[i]) & (tau2 <= slips * slips) & (crush <= capStrength2[i]) &
                           (closure <= hardens) & ((kn - weak) * before * elastic >= 0);
        opening[i] = quick ? total : opening[i];
        normalStress[i] = sigma;
        shearStressA[i] = quick ? a : shearStressA[i];
        shearStressB[i] = quick ? b : shearStressB[i];
        largestOpening[i] = quick & (elastic > farthest) ? elastic : farthest;
        largestClosure[i] = quick & (closure > closest) ? closure : closest;
        now[i] = quick ? did(Regime::Elastic) : waiting;
        left += quick ? 0 : 1;
    }
    return left;
}

struct JointColumns::Slide {
    double total[most], elastic[most], sigma[most], a[most], b[most], size[most], farthest[most], ratio[most],
        damage[most];
    std::int64_t slides[most];
};

// law.md §5, 1 and 2, for subcontacts that do not open beyond what they have seen and have no dilatancy: up to the
// displacement ratio of eq. (13), which the table of eq. (14) is read at,
MASONRY_VECTORISED
void JointColumns::trySlide(const Limits& m, std::size_t count, const double* __restrict jumpN,
                            const double* __restrict jumpA, const double* __restrict jumpB,
                            const double* __restrict flow, const double* __restrict intact,
                            const double* __restrict secant, const double* __restrict reach,
                            const double* __restrict slip, const double* __restrict opening,
                            const double* __restrict largestOpening, const double* __restrict shearStressA,
                            const double* __restrict shearStressB, const std::int64_t* __restrict now,
                            Slide& __restrict s) {
    const double kn = m.normalStiffness, ks = m.shearStiffness, own = m.ownShearStiffness;
    const double cr = m.residualCohesion, dc = m.cohesionLoss, fr = m.residualFriction, df = m.frictionLoss;
    for (std::size_t i = 0; i < count; ++i) {
        const double total = opening[i] + jumpN[i], elastic = total + flow[i], whole = intact[i];
        const double sigma = (elastic > 0 ? secant[i] : kn) * elastic;
        const double a = shearStressA[i] + ks * jumpA[i], b = shearStressB[i] + ks * jumpB[i];
        const double size = std::sqrt(a * a + b * b), strength = cr + dc * whole - sigma * (fr + df * whole);
        const double peak = cr + dc - sigma * (fr + df); // eq. (15)
        s.ratio[i] = peak > 0 ? 1 + (slip[i] + (size - peak) / ks) * own / peak : HUGE_VAL;
        s.slides[i] = (now[i] == waiting) & (size > (strength > 0 ? strength : 0)) & (elastic <= reach[i]);
        s.total[i] = total, s.elastic[i] = elastic, s.sigma[i] = sigma, s.a[i] = a, s.b[i] = b, s.size[i] = size;
        s.farthest[i] = elastic > largestOpening[i] ? elastic : largestOpening[i];
    }
}

// and from the damage to the returned stress, where it stays within the cap.
MASONRY_VECTORISED
void JointColumns::finishSlide(const Limits& m, std::size_t count, const double* __restrict flow,
                               const double* __restrict capStrength2, const double* __restrict tensionDamage,
                               double* __restrict shearDamage, double* __restrict intact, double* __restrict secant,
                               double* __restrict reach, double* __restrict slip, double* __restrict opening,
                               double* __restrict largestOpening, double* __restrict largestClosure,
                               double* __restrict shearStressA, double* __restrict shearStressB,
                               double* __restrict lostTension, double* __restrict lostShear,
                               double* __restrict normalStress, std::int64_t* __restrict now,
                               const Slide& __restrict s) {
    const double kn = m.normalStiffness, ks = m.shearStiffness, ft = m.tensileStrength, onset = m.onset;
    const double cr = m.residualCohesion, dc = m.cohesionLoss, fr = m.residualFriction, df = m.frictionLoss;
    const double cnn = m.capNormal, css = m.capShear, cn = m.capLinear, limit = m.limitClosure;
    const bool cap = m.cap;
    for (std::size_t i = 0; i < count; ++i) {
        const double damage = s.damage[i], elastic = s.elastic[i], size = s.size[i];
        const bool open = elastic > 0, weaker = damage > shearDamage[i];
        const double whole = 1 - (tensionDamage[i] + damage - tensionDamage[i] * damage); // eq. (10)
        const double friction = fr + df * whole, left = cr + dc * whole - s.sigma[i] * friction;
        const double strength = left > 0 ? left : 0;
        const double flowed = size > strength ? (size - strength) / ks : 0;
        const double rest = 1 - ks * flowed / size, share = rest > 0 ? rest : 0;
        const double a = s.a[i] * share, b = s.b[i] * share;
        const double weakened = ft * whole / s.farthest[i], weak = weakened < kn ? weakened : kn;
        const double sigma = open & weaker ? weak * elastic : s.sigma[i];
        const double crush = sigma < 0 ? cnn * sigma * sigma + css * (a * a + b * b) + cn * sigma : 0;
        const double closure = sigma < 0 && cap ? -s.total[i] : 0, closest = largestClosure[i];
        const double hardens = closest > limit ? closest : limit;
        const bool takes = (s.slides[i] != 0) & (crush <= capStrength2[i]) & (closure <= hardens);
        const double before = opening[i] + flow[i], sigmaBefore = (before > 0 ? secant[i] : kn) * before;
        const double meanShear = 0.5 * ((shearStressA[i] + a) * s.a[i] + (shearStressB[i] + b) * s.b[i]) / size;
        const double torn = open | (before > 0) ? 0.5 * (sigmaBefore * elastic - sigma * before) : 0;
        lostTension[i] += takes ? torn : 0;
        lostShear[i] += takes ? meanShear * flowed : 0;
        slip[i] += takes ? flowed : 0;
        opening[i] = takes ? s.total[i] : opening[i];
        normalStress[i] = takes ? sigma : normalStress[i];
        shearStressA[i] = takes ? a : shearStressA[i];
        shearStressB[i] = takes ? b : shearStressB[i];
        shearDamage[i] = takes ? damage : shearDamage[i];
        intact[i] = takes ? whole : intact[i];
        secant[i] = takes ? weak : secant[i];
        reach[i] = takes ? (whole == 1 ? onset : s.farthest[i]) : reach[i];
        largestOpening[i] = takes ? s.farthest[i] : largestOpening[i];
        largestClosure[i] = takes & (closure > closest) ? closure : closest;
        now[i] = takes ? (flowed > 0 ? did(Regime::Slipping) : did(Regime::Elastic)) : now[i];
    }
}

void JointColumns::slide(const JointLaw& law, std::size_t i, std::size_t count, const double* jumpN,
                         const double* jumpA, const double* jumpB, double* shearStressB, double* normalStress,
                         std::int64_t* now) {
    Slide s;
    trySlide(limits_, count, jumpN, jumpA, jumpB, &flow_[i], &intact_[i], &secant_[i], &reach_[i], &slip_[i],
             &opening_[i], &largestOpening_[i], &shearStressA_[i], shearStressB, now, s);
    std::int64_t any = 0;
    for (std::size_t n = 0; n < count; ++n)
        any |= s.slides[n];
    if (!any) return;
    for (std::size_t n = 0; n < count; ++n) {
        s.damage[n] = shearDamage_[i + n];
        if (s.slides[n] && s.damage[n] < 1)
            s.damage[n] = std::max(s.damage[n], law.shear().damage(s.ratio[n], row_[i + n]));
    }
    finishSlide(limits_, count, &flow_[i], &capStrength2_[i], &tensionDamage_[i], &shearDamage_[i], &intact_[i],
                &secant_[i], &reach_[i], &slip_[i], &opening_[i], &largestOpening_[i], &largestClosure_[i],
                &shearStressA_[i], shearStressB, &lostTension_[i], &lostShear_[i], normalStress, now, s);
}

void JointColumns::advance(const JointLaw& law, std::size_t first, std::size_t count, const double* jumpN,
                           const double* jumpA, const double* jumpB, double* normalStress) {
    for (; count > most; first += most, count -= most, normalStress += most) {
        advance(law, first, most, jumpN, jumpA, jumpB, normalStress);
        jumpN += most, jumpA += most, jumpB += jumpB ? most : 0;
    }
    double none[most] = {}, noStress[most] = {}; // in the innermost cache, where nothing happens along b
    const double* slideB = jumpB ? jumpB : none;
    double* shearStressB = jumpB ? &shearStressB_[first] : noStress;
    std::int64_t now[most];
    const auto left =
        advanceIntact(limits_, count, jumpN, jumpA, slideB, &flow_[first], &intact_[first], &secant_[first],
                      &reach_[first], &capStrength2_[first], &opening_[first], &largestOpening_[first],
                      &largestClosure_[first], &shearStressA_[first], shearStressB, normalStress, now);
    if (left > 2 && slides_) slide(law, first, count, jumpN, jumpA, slideB, shearStressB, normalStress, now);
    for (std::size_t n = 0; n < count; ++n)
        regime_[first + n] = Regime(now[n]);
    for (std::size_t n = 0; left && n < count; ++n) {
        if (now[n] != waiting) continue;
        const std::size_t i = first + n;
        JointState s = get(i);
        const auto lost = law.advance(k_, s, {jumpN[n], {jumpA[n], slideB[n]}});
        set(law, i, s);
        normalStress[n] = s.normalStress;
        lostTension_[i] += lost.tension, lostShear_[i] += lost.shear, lostCompression_[i] += lost.compression;
    }
}

} // namespace masonry
