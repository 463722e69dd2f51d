#pragma once
#include "MasonryJoint.hpp"
#include "MasonryMat.hpp"

namespace masonry {

class MasonryJointPhys : public Adapter<MasonryJointPhys, yade::IPhys> {
    MASONRY_DISPATCHED(MasonryJointPhys, yade::IPhys)
    static constexpr const char* className = "MasonryJointPhys";
    static constexpr const char* baseName = "IPhys";
    static constexpr const char* doc =
        "State of a joint: the property set that it shares with others of its kind, the stiffness that it shows, and "
        "what every subcontact remembers. Opening and tension are positive.";

    shared_ptr<MasonryJoint> joint;
    double normalStiffness = 0, shearStiffness = 0;
    std::vector<JointState> states;
    std::vector<Vector3r> losses; // per subcontact: energy dissipated so far by mode [J/m²]
    Vector3r dissipated = Vector3r::Zero();

    template <class Visit> static void attributes(Visit&& visit) {
        using P = MasonryJointPhys;
        visit("joint", &P::joint, "The MasonryJoint of this joint.", ReadOnly);
        visit("normalStiffness", &P::normalStiffness,
              "Normal stiffness shown [Pa/m]: the joint's, in series with rigid units (law.md §7).", ReadOnly);
        visit("shearStiffness", &P::shearStiffness,
              "Shear stiffness shown [Pa/m]: the joint's, in series with rigid units (law.md §7).", ReadOnly);
        visit("dissipated", &P::dissipated, "Energy dissipated so far in tension, shear and compression [J].",
              ReadOnly);
        visit("states", &P::states, "", Hidden);
        visit("losses", &P::losses, "", Hidden);
    }

    Keeper* keeper = nullptr; // the engine that has the states in its arrays, if one has

    MasonryJointPhys() {
        createIndex();
        ++changes;
    }
    void refresh() {
        if (keeper) keeper->store();
    }

    const JointLaw& law() const { return joint->law(); }
    ElasticStiffness stiffness() const { return {normalStiffness, shearStiffness}; }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.add_property("stress", &MasonryJointPhys::stress,
                         "Per subcontact: normal stress and shear stress along and across the tangent [Pa].")
            .add_property("opening", &MasonryJointPhys::opening, "Per subcontact: total opening [m], negative closed.")
            .add_property("slip", &MasonryJointPhys::slip, "Per subcontact: accumulated plastic slip [m].")
            .add_property("damage", &MasonryJointPhys::damage,
                          "Per subcontact: damage in tension, shear and compression [-], 0 to 1.")
            .add_property("largest", &MasonryJointPhys::largest,
                          "Per subcontact: largest opening, measured from the crushed and dilated place, and largest "
                          "closure so far [m].")
            .add_property(
                "yielding", &MasonryJointPhys::yielding,
                "Per subcontact: F1, F2 and F3 of the paper's eqs. (8) and (9), each over the sum of the sizes "
                "of its terms and of the elastic stress of all jumps so far, whose round-off they carry [-]: at "
                "most that above zero, -1 where it does not act.")
            .add_property(
                "regime", &MasonryJointPhys::regime,
                "Per subcontact: what acted in the last step: 'elastic', 'opening', 'slipping' or 'crushing'.");
    }

private:
    template <class F> py::list perSubcontact(F&& value) {
        refresh();
        py::list all;
        for (const auto& s : states)
            all.append(value(s));
        return all;
    }
    py::list stress() {
        return perSubcontact(
            [](const JointState& s) { return Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b); });
    }
    py::list opening() {
        return perSubcontact([](const JointState& s) { return s.opening; });
    }
    py::list slip() {
        return perSubcontact([](const JointState& s) { return s.slip; });
    }
    py::list damage() {
        return perSubcontact([&](const JointState& s) {
            return Vector3r(s.tensionDamage, s.shearDamage, law().compressionDamage(stiffness(), s));
        });
    }
    py::list largest() {
        return perSubcontact([](const JointState& s) { return py::make_tuple(s.largestOpening, s.largestClosure); });
    }
    py::list yielding() {
        const auto& p = law().properties();
        return perSubcontact([&](const JointState& s) {
            const auto f = law().yield(stiffness(), s);
            const double sigma = std::abs(s.normalStress), tau = std::hypot(s.shearStress.a, s.shearStress.b);
            const double elastic = normalStiffness * (s.largestOpening + s.largestClosure) + shearStiffness * s.slip;
            const double quadratic =
                p.capNormal * sigma * (sigma + elastic) + p.capShear * tau * (tau + elastic) + std::abs(f.cap);
            const auto share = [](double value, double size) { return value == -1 ? -1 : size > 0 ? value / size : 0; };
            return Vector3r(share(f.tension, sigma + p.tensileStrength + elastic),
                            share(f.slip, tau + sigma * p.friction + p.cohesion + elastic),
                            share(f.cap, quadratic + std::abs(p.capLinear) * sigma));
        });
    }
    py::list regime() {
        static const char* const names[] = {"elastic", "opening", "slipping", "crushing"};
        return perSubcontact([](const JointState& s) { return py::str(names[int(s.regime)]); });
    }
};

class Ip2_MasonryMat_MasonryMat_MasonryJointPhys
    : public Adapter<Ip2_MasonryMat_MasonryMat_MasonryJointPhys, yade::IPhysFunctor> {
public:
    static constexpr const char* className = "Ip2_MasonryMat_MasonryMat_MasonryJointPhys";
    static constexpr const char* baseName = "IPhysFunctor";
    static constexpr const char* doc = "Gives every joint its property set: the first of `joints` whose jointSet and "
                                       "direction fit. Another rule is the "
                                       "user's: assign(interaction, joint).";

    std::vector<shared_ptr<MasonryJoint>> joints;

    template <class Visit> static void attributes(Visit&& visit) {
        using F = Ip2_MasonryMat_MasonryMat_MasonryJointPhys;
        visit("joints", &F::joints, "MasonryJoint objects; the first that fits a pair is taken.");
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("assign", &Ip2_MasonryMat_MasonryMat_MasonryJointPhys::assignTo, py::args("interaction", "joint"),
                "Give an interaction this MasonryJoint, before the first step, whatever `joints` says.");
    }

    std::string get2DFunctorType1() const override { return "MasonryMat"; }
    std::string get2DFunctorType2() const override { return "MasonryMat"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryMat", "MasonryMat"}; }
    std::string checkOrder() const override { return "MasonryMat MasonryMat"; }
    void go(const shared_ptr<yade::Material>&, const shared_ptr<yade::Material>&,
            const shared_ptr<yade::Interaction>&) override;
    using FunctorCalls::go;

private:
    void assign(const MasonryMat&, const MasonryMat&, yade::Interaction&, const shared_ptr<MasonryJoint>&) const;
    void assignTo(const shared_ptr<yade::Interaction>&, const shared_ptr<MasonryJoint>&) const;
};

class Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening
    : public Adapter<Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening, yade::LawFunctor> {
public:
    static constexpr const char* className = "Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening";
    static constexpr const char* baseName = "LawFunctor";
    static constexpr const char* doc =
        "The joint law of the paper at every subcontact: tension cut-off, Coulomb slip and elliptical cap with "
        "piecewise "
        "linear softening (paper §3). Its parameters are those of the MasonryJoint objects.";

    template <class Visit> static void attributes(Visit&&) {}

    std::string get2DFunctorType1() const override { return "MasonryJointGeom"; }
    std::string get2DFunctorType2() const override { return "MasonryJointPhys"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryJointGeom", "MasonryJointPhys"}; }
    std::string checkOrder() const override { return "MasonryJointGeom MasonryJointPhys"; }
    bool go(shared_ptr<yade::IGeom>&, shared_ptr<yade::IPhys>&, yade::Interaction*) override;
    using FunctorCalls::go;
};

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryJointPhys)
BOOST_CLASS_EXPORT_KEY(masonry::Ip2_MasonryMat_MasonryMat_MasonryJointPhys)
BOOST_CLASS_EXPORT_KEY(masonry::Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening)
