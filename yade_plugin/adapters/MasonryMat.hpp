#pragma once
#include "Adapter.hpp"
#include "common/Text.hpp"

namespace masonry {

class MasonryMat : public Adapter<MasonryMat, yade::Material> {
    MASONRY_DISPATCHED(MasonryMat, yade::Material)
    static constexpr const char* className = "MasonryMat";
    static constexpr const char* baseName = "Material";
    static constexpr const char* doc =
        "Material of a masonry unit: what deforms between the joints. Its density is Material's [kg/m³]. Joints are "
        "MasonryJoint objects, chosen per pair of units by Ip2_MasonryMat_MasonryMat_MasonryJointPhys.";

    double young = 4.8e9;
    double poisson = 0.16;
    std::string jointSet = "brick";

    template <class Visit> static void attributes(Visit&& visit) {
        visit("young", &MasonryMat::young, "Young's modulus of the unit [Pa], > 0 (paper table 2).");
        visit("poisson", &MasonryMat::poisson,
              "Poisson's ratio of the unit [-], above -1 and below 0.5 (paper table 2).");
        visit("jointSet", &MasonryMat::jointSet, "Name by which MasonryJoint.jointSet picks the joints of this unit.");
    }

    template <class PyClass> static void extras(PyClass& cls) { // over the host's, which would not be checked
        cls.add_property(
            "density", +[](const MasonryMat& mat) { return mat.density; },
            +[](MasonryMat& mat, const py::object& value) { mat.set("density", value); },
            "Density [kg/m³], > 0. Default: 1000.");
    }

    MasonryMat() { createIndex(); }

    void postLoad() {
        std::vector<std::string> wrong;
        if (!(young > 0) || !std::isfinite(young))
            wrong.push_back("young " + text(young) + " Pa must be a finite number above 0");
        if (!(poisson > -1 && poisson < 0.5))
            wrong.push_back("poisson " + text(poisson) + " must be above -1 and below 0.5");
        if (!(density > 0) || !std::isfinite(density))
            wrong.push_back("density " + text(density) + " kg/m³ must be a finite number above 0");
        if (!wrong.empty()) throw std::invalid_argument("MasonryMat \"" + label + "\": " + joined(wrong, "; "));
    }

    double shearModulus() const { return young / (2 * (1 + poisson)); }
};

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryMat)
