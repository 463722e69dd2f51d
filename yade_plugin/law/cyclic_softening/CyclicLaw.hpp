// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law on one subcontact: the strengths, tables and compression curve of the paper's law, with softening by
// rate, stiffness that degrades, dilatancy that turns back, and joints that close on a curve. README.md states it.
#pragma once
#include "CyclicEquations.hpp"
#include "CyclicState.hpp"
#include "law/piecewise_softening/PiecewiseLaw.hpp"

namespace masonry {

class CyclicLaw : public Law {
public:
    static constexpr const char* name = "cyclic";
    static constexpr const char* meaning = "the cyclic law, which is made for loads that come back";

    using State = CyclicState;
    using Column = CyclicColumn;
    using Equations = CyclicEquations;

    // Whether so many subcontacts that may yield are advanced faster one by one than several at a time (measured,
    // tests/law/benchmark_law.cpp).
    static constexpr bool fasterOneByOne(int many, int /*groups*/) { return many < 3; }

    // Throws std::invalid_argument with all problems of the properties at once.
    explicit CyclicLaw(const JointProperties& properties);

    // Whether the law ever reads a property of joints, and what is wrong with the properties of a joint.
    static bool reads(const std::string& property);
    static std::vector<Problem> problems(const JointProperties& properties);

    const SofteningTable& tension() const override { return paper_.tension(); }
    const SofteningTable& shear() const override { return paper_.shear(); }
    const CompressionCurve& compression() const override { return paper_.compression(); }
    double squaredCapStress(double normal, double squaredShear) const override {
        return paper_.squaredCapStress(normal, squaredShear);
    }

    // The equations for a joint that shows the stiffness k, its own or lumped with rigid units.
    CyclicEquations equations(const ElasticStiffness& k) const;

    // One step: takes the state on by the jump and returns the energy dissipated in the step.
    Energies advance(const ElasticStiffness& k, CyclicState& s, const Jump& jump) const {
        return advance(equations(k), s, jump);
    }
    Energies advance(const CyclicEquations& e, CyclicState& s, const Jump& jump) const;

    // Normal stress of a state [Pa].
    static double normalStress(const CyclicEquations& e, const CyclicState& s);

    // Elastic energy by mode [J/m²].
    Energies stored(const ElasticStiffness& k, const CyclicState& s) const;

    // Yield functions [Pa], [Pa], [Pa²], and each over the size of its terms [-], as those of the paper's law.
    Yield yield(const ElasticStiffness& k, const CyclicState& s) const;
    Yield yielding(const ElasticStiffness& k, const CyclicState& s) const { return paper_.relative(yield(k, s), k, s); }
    static void show(const CyclicEquations& e, const CyclicState& s, const ShowField& show) {
        PiecewiseLaw::show(e, s, show);
    }

    std::vector<std::string> snapsBack(const ElasticStiffness& k, double distance) const override;

    std::unique_ptr<LawColumns> columns(const ElasticStiffness& k, int joints, int points) const override;

private:
    PiecewiseLaw paper_; // whose strengths and tables these are
};

} // namespace masonry
