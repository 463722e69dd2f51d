// SPDX-License-Identifier: GPL-2.0-or-later
#include "CyclicLaw.hpp"
#include "CyclicColumns.hpp"
#include "CyclicStep.hpp"
#include "common/Text.hpp"
#include "law/common/ColumnsSideBySide.hpp"
#include <set>

namespace masonry {

namespace {

struct Look { // for one subcontact
    const CyclicEquations& e;
    const SofteningTable &tensionTable, &shearTable;

    double tension(double damage, double ratio, double shift, bool wanted) const {
        return wanted ? larger(damage, tensionTable.damage(ratio, shift)) : damage;
    }
    double shear(double damage, double ratio, double shift, bool wanted) const {
        return wanted ? larger(damage, shearTable.damage(ratio, shift)) : damage;
    }
    double lastRatio() const { return shearTable.lastRatio() - 1; }
    double strength(double fc, double kappa, bool wanted) const {
        return wanted ? e.curve.strength(kappa, e.stretch) : fc;
    }
    double decay(double slip, bool wanted) const { return wanted ? e.dilatancy(slip) : 0; }
    double normalEnergy(double sigma, double w) const { return e.storedNormal(sigma, w); }
};

} // namespace

bool CyclicLaw::reads(const std::string& property) {
    static const std::set<std::string> own{"shearStiffnessLoss", "compressionStiffnessLoss", "bondLossByCrushing",
                                           "initialClosingStiffness", "closureLimit"};
    return own.count(property) > 0 || PiecewiseLaw::reads(property);
}

std::vector<Problem> CyclicLaw::problems(const JointProperties& p) {
    auto found = PiecewiseLaw::problems(p, reads);
    if (p.elastic) return found;
    // From here on a joint that slides back would fall by itself: it loses pressure, and with it strength, faster than
    // its shear stress falls.
    const double steepest = (1 - p.shearStiffnessLoss) * p.shearStiffness / (p.friction * p.normalStiffness);
    if (p.dilatancy > 0 && p.friction > 0 && !(p.dilatancy < steepest))
        found.push_back(about("dilatancy", text(p.dilatancy) +
                                               " must be below (1 - shear stiffness loss)·ks/(friction·kn) = " +
                                               text(steepest) + " in the cyclic law"));
    if (p.cap && p.capLinear < 0)
        found.push_back(about("capLinear", text(p.capLinear) + " Pa must be at least 0 in the cyclic law"));
    if (p.cap && p.compressionStiffnessLoss > 0 && (p.capNormal != 1 || p.capLinear != 0))
        found.push_back(
            about("capNormal", text(p.capNormal) + " and cap linear " + text(p.capLinear) +
                                   " Pa must be 1 and 0 in the cyclic law, or compression stiffness loss " +
                                   text(p.compressionStiffnessLoss) +
                                   " must be 0: how much of a closure is irreversible is only known "
                                   "for a cap whose strength under pure closure is that of the compression curve"));
    if (p.initialClosingStiffness > 0) {
        if (p.initialClosingStiffness >= p.normalStiffness)
            found.push_back(about("initialClosingStiffness",
                                  text(p.initialClosingStiffness) + " Pa/m must be below the normal stiffness " +
                                      text(p.normalStiffness) + " Pa/m, that of the closed joint"));
        if (p.tensileStrength > 0)
            found.push_back(
                about("tensileStrength",
                      text(p.tensileStrength) + " Pa must be 0 for a joint that closes on a curve: it is a dry joint"));
        if (!(p.closureLimit > 0))
            found.push_back(
                about("closureLimit",
                      text(p.closureLimit) + " m must be above 0 where there is an initial closing stiffness"));
        if (p.cap && p.compressionStiffnessLoss > 0)
            found.push_back(about("compressionStiffnessLoss",
                                  text(p.compressionStiffnessLoss) + " must be 0 for a joint that closes on a curve"));
    } else if (p.closureLimit > 0)
        found.push_back(about("closureLimit", text(p.closureLimit) + " m needs an initial closing stiffness above 0"));
    return found;
}

CyclicLaw::CyclicLaw(const JointProperties& properties)
    : Law(properties, problems(properties)), paper_(properties, std::vector<Problem>{}) {}

CyclicEquations CyclicLaw::equations(const ElasticStiffness& k) const {
    const auto& p = properties();
    CyclicEquations e;
    static_cast<PiecewiseEquations&>(e) = paper_.equations(k);
    e.omegaM = p.shearStiffnessLoss;
    e.chi = p.bondLossByCrushing;
    e.shearStretch = 1 / k.shear - 1 / p.shearStiffness;
    if (e.cap) {
        e.rho = p.compressionStiffnessLoss;
        e.shearWeight = e.Css / e.Cnn;
        e.peakClosure = e.curve.peakClosure + e.curve.peak * e.stretch;
    }
    if (p.initialClosingStiffness > 0 && !p.elastic) {
        e.curved = true;
        e.kn0 = p.initialClosingStiffness;
        e.cm = p.closureLimit;
        const double ends = e.cm * (1 - std::sqrt(e.kn0 / e.ownKn)); // where the tangent is kn
        e.bendPressure = e.cm * (std::sqrt(e.kn0 * e.ownKn) - e.kn0);
        e.bend = ends + e.bendPressure * e.stretch;
    }
    return e;
}

Energies CyclicLaw::advance(const CyclicEquations& e, CyclicState& s, const Jump& jump) const {
    const auto derived = derive(e, s);
    CyclicPoint<double> p{s.opening,         s.crushing,
                          s.dilation,        s.slip,
                          s.largestOpening,  s.largestClosure,
                          s.tensionDamage,   s.shearDamage,
                          s.shearStress.a,   s.shearStress.b,
                          s.plasticSlip.a,   s.plasticSlip.b,
                          s.shearSoftening,  s.shearStiffnessLoss,
                          s.capDisplacement, s.normalStress,
                          derived.strength,  derived.closing,
                          derived.shearing,  derived.intact,
                          derived.secant,    derived.squaredHardening};
    const auto out =
        masonry::advance<double>(e, Look{e, tension(), shear()}, p, jump.opening, jump.slide.a, jump.slide.b);
    s.opening = p.opening;
    s.crushing = p.crushing;
    s.dilation = p.dilation;
    s.slip = p.slip;
    s.largestOpening = p.largestOpening;
    s.largestClosure = p.largestClosure;
    s.tensionDamage = p.tensionDamage;
    s.shearDamage = p.shearDamage;
    s.normalStress = p.normalStress;
    s.shearStress = {p.shearA, p.shearB};
    s.regime = Regime(int(out.regime));
    s.plasticSlip = {p.plasticA, p.plasticB};
    s.shearSoftening = p.shearSoftening;
    s.shearStiffnessLoss = p.shearStiffnessLoss;
    s.capDisplacement = p.capDisplacement;
    return {out.lostTension, out.lostShear, out.lostCompression};
}

double CyclicLaw::normalStress(const CyclicEquations& e, const CyclicState& s) {
    const auto derived = derive(e, s);
    return e.normal(s.opening + (s.crushing - s.dilation), derived.secant, derived.closing);
}

Energies CyclicLaw::stored(const ElasticStiffness& k, const CyclicState& s) const {
    const auto e = equations(k);
    const double tauSquared = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
    const double shear = PiecewiseEquations::storedShear(tauSquared, e.shearStiffness(s.shearStiffnessLoss));
    const double w = s.opening + (s.crushing - s.dilation);
    const double normal = e.storedNormal(s.normalStress, w);
    return w > 0 ? Energies{normal, shear, 0} : Energies{0, shear, normal};
}

Yield CyclicLaw::yield(const ElasticStiffness& k, const CyclicState& s) const {
    const auto e = equations(k);
    const auto derived = derive(e, s);
    const double w = s.opening + (s.crushing - s.dilation);
    const double tauSquared = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
    Yield f{s.normalStress - e.ft * derived.intact,
            std::sqrt(tauSquared) - e.slipStrength(derived.intact, s.normalStress, w), -1};
    if (e.cap) f.cap = e.capStress(std::fmin(s.normalStress, 0), tauSquared) - derived.strength * derived.strength;
    return f;
}

std::vector<std::string> CyclicLaw::snapsBack(const ElasticStiffness& k, double distance) const {
    auto found = paper_.snapsBack(k, distance);
    const auto e = equations(k);
    const double steepest = e.shearStiffness(e.omegaM) / (e.tanPhiP * e.kn);
    if (e.tanPsi > 0 && !(e.tanPsi < steepest))
        found.push_back("dilatancy " + text(e.tanPsi) + " must be below " + text(steepest) +
                        ", shear stiffness over friction times normal stiffness, both with those of the rigid units in "
                        "series: a joint that slides back would fall by itself");
    return found;
}

std::unique_ptr<LawColumns> CyclicLaw::columns(const ElasticStiffness& k, int joints, int points) const {
    return std::make_unique<ColumnsSideBySide<CyclicLaw>>(std::static_pointer_cast<const CyclicLaw>(shared_from_this()),
                                                          k, joints, points);
}

} // namespace masonry
