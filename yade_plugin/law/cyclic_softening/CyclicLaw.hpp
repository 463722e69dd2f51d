// The cyclic law on one subcontact: the strengths, tables and compression curve of the paper's law, with softening by
// rate, stiffness that degrades, dilatancy that turns back, and joints that close on a curve. README.md states it.
#pragma once
#include "CyclicStep.hpp"
#include "law/piecewise_softening/JointLaw.hpp"

namespace masonry {

class CyclicLaw : public Law {
public:
    using Equations = CyclicEquations;
    static constexpr int columnCount = Columns::count;
    static constexpr int worthSideBySide = 3; // see law/ColumnsWith.hpp; they are gathered from among others

    // Throws std::invalid_argument with all problems of the properties at once.
    explicit CyclicLaw(const JointProperties& properties) : paper_(properties) {}

    const JointProperties& properties() const override { return paper_.properties(); }
    const SofteningTable& tension() const override { return paper_.tension(); }
    const SofteningTable& shear() const override { return paper_.shear(); }
    const CompressionCurve& compression() const override { return paper_.compression(); }

    // The equations for a joint that shows the stiffness k, its own or lumped with rigid units.
    CyclicEquations equations(const ElasticStiffness& k) const;

    // One step: takes the state on by the jump and returns the energy dissipated in the step.
    Energies advance(const ElasticStiffness& k, JointState& s, const Jump& jump) const {
        return advance(equations(k), s, jump);
    }
    Energies advance(const CyclicEquations& e, JointState& s, const Jump& jump) const;

    // Elastic energy by mode [J/m²].
    Energies stored(const ElasticStiffness& k, const JointState& s) const;

    Yield yield(const ElasticStiffness& k, const JointState& s) const override;
    double compressionDamage(const ElasticStiffness& k, const JointState& s) const override {
        return paper_.compressionDamage(k, s);
    }

    std::vector<std::string> snapsBack(const ElasticStiffness& k, double distance) const override;

    std::unique_ptr<LawColumns> columns(const ElasticStiffness& k, int joints, int points) const override;

private:
    JointLaw paper_; // whose strengths and tables these are
};

} // namespace masonry
