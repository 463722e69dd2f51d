#include "CyclicLaw.hpp"
#include "CyclicColumns.hpp"
#include "common/Text.hpp"

namespace masonry {

namespace {

struct Look { // for one subcontact
    const CyclicEquations& e;
    const SofteningTable &tensionTable, &shearTable;

    double tension(double damage, double ratio, double shift, bool asks) const {
        return asks ? larger(damage, tensionTable.damage(ratio, shift)) : damage;
    }
    double shear(double damage, double ratio, double shift, bool asks) const {
        return asks ? larger(damage, shearTable.damage(ratio, shift)) : damage;
    }
    double lastRatio() const { return shearTable.lastRatio() - 1; }
    double strength(double fc, double kappa, bool asks) const { return asks ? e.curve.strength(kappa, e.stretch) : fc; }
    double decay(double slip, bool asks) const { return asks ? e.dilatancy(slip) : 0; }
    double normalEnergy(double sigma, double w) const { return e.storedNormal(sigma, w); }
};

} // namespace

CyclicEquations CyclicLaw::equations(const ElasticStiffness& k) const {
    const auto& p = properties();
    CyclicEquations e;
    static_cast<masonry::Equations&>(e) = paper_.equations(k);
    e.omegaM = p.shearStiffnessLoss;
    e.chi = p.bondLossByCrushing;
    e.shearStretch = 1 / k.shear - 1 / p.shearStiffness;
    if (e.cap) {
        e.rho = p.compressionStiffnessLoss;
        e.shearWeight = e.Css / e.Cnn;
        e.peakClosure = e.curve.peakClosure + e.curve.peak * e.stretch;
    }
    if (p.initialClosingStiffness > 0) {
        e.curved = true;
        e.kn0 = p.initialClosingStiffness;
        e.cm = p.closureLimit;
        const double ends = e.cm * (1 - std::sqrt(e.kn0 / e.ownKn)); // where the tangent is kn
        e.bendPressure = e.cm * (std::sqrt(e.kn0 * e.ownKn) - e.kn0);
        e.bend = ends + e.bendPressure * e.stretch;
    }
    return e;
}

Energies CyclicLaw::advance(const CyclicEquations& e, JointState& s, const Jump& jump) const {
    const auto follows = consequences(e, s);
    CyclicPoint<double> p{s.opening,         s.crushing,
                          s.dilation,        s.slip,
                          s.largestOpening,  s.largestClosure,
                          s.tensionDamage,   s.shearDamage,
                          s.shearStress.a,   s.shearStress.b,
                          s.plasticSlip.a,   s.plasticSlip.b,
                          s.shearSoftening,  s.shearStiffnessLoss,
                          s.capDisplacement, s.normalStress,
                          follows.strength,  follows.closing,
                          follows.shearing,  follows.intact,
                          follows.secant,    follows.squaredHardening};
    const auto out =
        masonry::advance<double>(e, Look{e, tension(), shear()}, p, jump.opening, jump.slide.a, jump.slide.b);
    s = {p.opening,
         p.crushing,
         p.dilation,
         p.slip,
         p.largestOpening,
         p.largestClosure,
         p.tensionDamage,
         p.shearDamage,
         p.normalStress,
         {p.shearA, p.shearB},
         Regime(int(out.regime)),
         {p.plasticA, p.plasticB},
         p.shearSoftening,
         p.shearStiffnessLoss,
         p.capDisplacement};
    return {out.lostTension, out.lostShear, out.lostCompression};
}

Energies CyclicLaw::stored(const ElasticStiffness& k, const JointState& s) const {
    const auto e = equations(k);
    const double tauSquared = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
    const double shear = masonry::Equations::storedShear(tauSquared, e.shearStiffness(s.shearStiffnessLoss));
    const double w = s.opening + (s.crushing - s.dilation);
    const double normal = e.storedNormal(s.normalStress, w);
    return w > 0 ? Energies{normal, shear, 0} : Energies{0, shear, normal};
}

Yield CyclicLaw::yield(const ElasticStiffness& k, const JointState& s) const {
    const auto e = equations(k);
    const auto follows = consequences(e, s);
    const double w = s.opening + (s.crushing - s.dilation);
    const double tauSquared = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
    Yield f{s.normalStress - e.ft * follows.intact,
            std::sqrt(tauSquared) - e.slipStrength(follows.intact, s.normalStress, w), -1};
    if (e.cap) f.cap = e.capStress(std::fmin(s.normalStress, 0), tauSquared) - follows.strength * follows.strength;
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
    return std::make_unique<CyclicColumns>(std::static_pointer_cast<const CyclicLaw>(shared_from_this()), k, joints,
                                           points);
}

} // namespace masonry
