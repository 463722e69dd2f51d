#pragma once
#include "Adapter.hpp"
#include "law/JointLaw.hpp"
#include <memory>

namespace masonry {

class MasonryJoint : public Adapter<MasonryJoint, yade::Serializable>, public JointProperties {
public:
    static constexpr const char* className = "MasonryJoint";
    static constexpr const char* baseName = "Serializable";
    static constexpr const char* doc =
        "Properties of one kind of joint (bed, head, crack, support, or any name), shared by all joints of that kind. "
        "Defaults: bed joint of the calcium-silicate walls (paper table 2); values that the paper does not give say "
        "[decided]. Wrong values are refused with ValueError, all problems at once.";

    std::string jointSet;
    Vector3r direction = Vector3r::Zero();

    template <class Visit> static void attributes(Visit&& visit) {
        using J = MasonryJoint;
        visit("name", &J::name, "Name of this kind of joint, as files and messages show it.");
        visit("jointSet", &J::jointSet, "Applies to pairs with a unit of this MasonryMat.jointSet; empty: to any.");
        visit("direction", &J::direction,
              "Applies to joints whose normal lies within 30° of this direction, either sense; zero: any.");
        visit("elastic", &J::elastic, "Linear elastic: no strength is ever reached (supports and loads, paper §4.1).");
        visit("normalStiffness", &J::normalStiffness, "kn [Pa/m], > 0 (paper eq. (26)).");
        visit("shearStiffness", &J::shearStiffness, "ks [Pa/m], > 0 (paper eq. (26)).");
        visit("tensileStrength", &J::tensileStrength, "ft [Pa], 0 to cohesion/friction (paper table 2).");
        visit("modeIFractureEnergy", &J::modeIFractureEnergy,
              "GfI [J/m²], > 0 [decided]; builds the exponential tension table.");
        visit("tensionTable", &J::tensionTable,
              "Rows (displacement ratio, damage) from (1, 0) on, in place of the exponential (paper eq. (12)). "
              "Default: none.");
        visit("cohesion", &J::cohesion, "cp [Pa], >= 0 (paper table 2).");
        visit("residualCohesion", &J::residualCohesion, "cr [Pa], 0 to cohesion [decided].");
        visit("friction", &J::friction, "Peak friction coefficient tan(phi) [-], >= 0 (paper table 2).");
        visit("residualFriction", &J::residualFriction, "Residual friction coefficient [-], 0 to friction [decided].");
        visit("dilatancy", &J::dilatancy, "tan(psi) [-], 0 to residual friction [decided] (paper eq. (9)).");
        visit("dilatancyDecay", &J::dilatancyDecay,
              "delta [1/m] in tan(psi)·exp(-delta·slip), >= 0; 0: constant dilatancy.");
        visit("modeIIFractureEnergy", &J::modeIIFractureEnergy,
              "GfII without normal stress [J/m²], > 0 [decided]; builds the exponential shear table.");
        visit("shearTable", &J::shearTable,
              "Rows (displacement ratio, damage) from (1, 0) on, in place of the exponential (paper eq. (13)). "
              "Default: none.");
        visit("cap", &J::cap, "Whether the joint can crush (paper eq. (8c)).");
        visit("compressiveStrength", &J::compressiveStrength, "fcp [Pa], > 0 (paper table 2).");
        visit("elasticLimitRatio", &J::elasticLimitRatio,
              "Elastic limit over compressive strength [-], 0 to 1 (paper eq. (18)).");
        visit("residualStrengthRatio", &J::residualStrengthRatio,
              "Residual over peak compressive strength [-], 0 to 1 [decided].");
        visit("peakRatio", &J::peakRatio, "n [-], >= 1: closure at the peak is n·fcp/kn (paper eq. (19)).");
        visit("compressiveFractureEnergy", &J::compressiveFractureEnergy,
              "Gc [J/m²]; too small for n is refused (paper eq. (24)).");
        visit("capNormal", &J::capNormal, "Cnn [-], > 0 [decided] (paper eq. (8c)).");
        visit("capShear", &J::capShear, "Css [-], >= 0 [decided] (paper eq. (8c)).");
        visit("capLinear", &J::capLinear, "Cn [Pa] [decided] (paper eq. (8c)).");
    }

    MasonryJoint() { postLoad(); }
    void postLoad() {
        if (!direction.allFinite())
            throw std::invalid_argument("joint \"" + name + "\": direction must be finite numbers");
        law_ = std::make_shared<const JointLaw>(*this);
        ++changes;
    }

    const JointLaw& law() const { return *law_; }

    bool appliesTo(const std::string& set1, const std::string& set2, const Vector3r& normal) const {
        if (!jointSet.empty() && jointSet != set1 && jointSet != set2) return false;
        return direction.isZero() || std::abs(direction.normalized().dot(normal)) >= 0.8660254; // cos 30°
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("compressionCurve", &MasonryJoint::compressionCurve, py::args("closures"),
                "Compressive strength [Pa] at each largest closure [m] of a list (law.md §4).")
            .def("softening", &MasonryJoint::softening,
                 "The rows (displacement ratio, damage) in use: {'tension': [...], 'shear': [...]}.")
            .def("brittleCoulomb", &MasonryJoint::brittle,
                 "The same joint as a brittle Coulomb slip joint: tension to zero and cohesion to its residual at the "
                 "first yield, no cap (law.md §9). Returns a new object.");
    }

private:
    py::list compressionCurve(const std::vector<double>& closures) const {
        py::list strengths;
        for (double u : closures) {
            if (!std::isfinite(u)) throw std::invalid_argument("closure " + text(u) + " m must be a finite number");
            strengths.append(law_->compression().strength(u));
        }
        return strengths;
    }
    py::dict softening() const {
        const auto rows = [](const SofteningTable& table) {
            py::list all;
            for (const auto& row : table.rows())
                all.append(py::make_tuple(row.ratio, row.damage));
            return all;
        };
        py::dict both;
        both["tension"] = rows(law_->tension()), both["shear"] = rows(law_->shear());
        return both;
    }
    shared_ptr<MasonryJoint> brittle() const {
        shared_ptr<MasonryJoint> made(new MasonryJoint);
        static_cast<JointProperties&>(*made) = brittleCoulomb(*this);
        made->jointSet = jointSet, made->direction = direction;
        made->postLoad();
        return made;
    }

    std::shared_ptr<const JointLaw> law_;
};

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryJoint)
