// SPDX-License-Identifier: GPL-2.0-or-later
// One step of the cyclic law for several subcontacts side by side, as many as the vector units of a processor take. A
// file for each kind of vector units includes this header and compiles `advanceAs` for it (common/Pack.hpp); that file
// must not compile anything else, because the linker would take it for all processors.
#pragma once
#include "CyclicState.hpp"
#include "CyclicStep.hpp"
#include "law/common/Columns.hpp"
#include "law/common/SofteningTable.hpp"
#include <vector>

namespace masonry::cyclic {

struct Numbers { // of a kind of joint
    const CyclicEquations& equations;
    const SofteningTable &tension, &shear;
    double lastRatio; // [-] of the shear table, less 1
};

using Advance = void(const Numbers& numbers, const Columns& columns, TableRows* rows, Regime* regime,
                     const Jumps& jumps, const Mask* pending, int count, double* normalStress);
Advance advanceOnAny, advanceOnAvx2, advanceOnAvx512;

struct Processor {
    const char* name;
    Advance* advance;
};
std::vector<Processor> processors(); // that this processor has, the fastest one last

// What is looked up one by one. The numbers stand in memory, where each can be reached.
struct Asked {
    int many;
    alignas(64) double at[lanes], shift[lanes], found[lanes];
    alignas(64) Mask wanted[lanes];
};
void readTable(const SofteningTable& table, std::int32_t TableRows::*row, TableRows* rows, const int* places, Asked& a);
void readCurve(const CyclicEquations& e, Asked& a); // beyond ucm
void readDecay(const CyclicEquations& e, Asked& a);
void readEnergy(const CyclicEquations& e, Asked& a);

namespace {

// Subcontacts of a column, wherever they stand in it.
struct Places {
    int at[packed];
    bool together; // whether they stand side by side

    MASONRY_INLINED Pack get(const double* column) const {
        if (together) return load(column + at[0]);
        alignas(64) double x[packed];
        for (int i = 0; i < packed; ++i)
            x[i] = column[at[i]];
        return load(x);
    }
    MASONRY_INLINED void put(double* column, const Pack& x) const {
        if (together) return store(column + at[0], x);
        for (int i = 0; i < packed; ++i)
            column[at[i]] = x[i];
    }
    MASONRY_INLINED void add(double* column, const Pack& x) const { put(column, get(column) + x); }
};

struct Look { // see advance() in CyclicStep.hpp
    const Numbers& numbers;
    TableRows* rows;
    const int* places; // in `rows`

    MASONRY_INLINED Asked asked(const Pack& found, const Pack& at, const Pack& shift, const PackMask& wanted) const {
        Asked a;
        a.many = packed;
        store(a.at, at);
        store(a.shift, shift);
        store(a.found, found);
        std::memcpy(a.wanted, &wanted, sizeof wanted);
        return a;
    }
    MASONRY_INLINED Pack tension(const Pack& damage, const Pack& ratio, const Pack& shift,
                                 const PackMask& wanted) const {
        Asked a = asked(damage, ratio, shift, wanted);
        readTable(numbers.tension, &TableRows::tension, rows, places, a);
        return load(a.found);
    }
    MASONRY_INLINED Pack shear(const Pack& damage, const Pack& ratio, const Pack& shift, const PackMask& wanted) const {
        Asked a = asked(damage, ratio, shift, wanted);
        readTable(numbers.shear, &TableRows::shear, rows, places, a);
        return load(a.found);
    }
    MASONRY_INLINED double lastRatio() const { return numbers.lastRatio; }
    MASONRY_INLINED Pack strength(const Pack& fc, const Pack& kappa, const PackMask& wanted) const {
        const CyclicEquations& e = numbers.equations;
        const Pack found = choose(wanted, e.curve.upToMiddle(kappa, e.stretch), fc);
        const PackMask beyond = wanted & e.curve.isBeyondMiddle(kappa, e.stretch);
        if (!any(beyond)) return found;
        Asked a = asked(found, kappa, kappa, beyond);
        readCurve(e, a);
        return load(a.found);
    }
    MASONRY_INLINED Pack decay(const Pack& slip, const PackMask& wanted) const {
        Asked a = asked(Pack{}, slip, slip, wanted);
        readDecay(numbers.equations, a);
        return load(a.found);
    }
    MASONRY_INLINED Pack normalEnergy(const Pack& sigma, const Pack& w) const {
        Asked a = asked(Pack{}, sigma, w, sigma == sigma);
        readEnergy(numbers.equations, a);
        return load(a.found);
    }
};

MASONRY_INLINED void advanceAs(const Numbers& numbers, const Columns& columns, TableRows* rows, Regime* regime,
                               const Jumps& jumps, const Mask* pending, int count, double* normalStress) {
    const CyclicEquations e = numbers.equations;
    Places some;
    for (int from = 0;;) {
        int many = 0; // number of pending subcontacts in this pack; others may lie between them
        for (; from < count && many < packed; ++from)
            if (pending[from]) some.at[many++] = from;
        if (many == 0) return;
        // A pack that is not full repeats its last subcontact: the same numbers are then written several times.
        for (int i = many; i < packed; ++i)
            some.at[i] = some.at[many - 1];
        some.together = many == packed && some.at[packed - 1] - some.at[0] == packed - 1;
        const Columns& c = columns;
        const Pack opening = some.get(jumps.opening), slideA = some.get(jumps.slideA), slideB = some.get(jumps.slideB);
        CyclicPoint<Pack> p;
        p.opening = some.get(c[CyclicColumn::Opening]);
        p.crushing = some.get(c[CyclicColumn::Crushing]);
        p.dilation = some.get(c[CyclicColumn::Dilation]);
        p.slip = some.get(c[CyclicColumn::Slip]);
        p.largestOpening = some.get(c[CyclicColumn::LargestOpening]);
        p.largestClosure = some.get(c[CyclicColumn::LargestClosure]);
        p.tensionDamage = some.get(c[CyclicColumn::TensionDamage]);
        p.shearDamage = some.get(c[CyclicColumn::ShearDamage]);
        p.shearA = some.get(c[CyclicColumn::ShearStressA]);
        p.shearB = some.get(c[CyclicColumn::ShearStressB]);
        p.plasticA = some.get(c[CyclicColumn::PlasticSlipA]);
        p.plasticB = some.get(c[CyclicColumn::PlasticSlipB]);
        p.shearSoftening = some.get(c[CyclicColumn::ShearSoftening]);
        p.shearStiffnessLoss = some.get(c[CyclicColumn::ShearStiffnessLoss]);
        p.capDisplacement = some.get(c[CyclicColumn::CapDisplacement]);
        p.strength = root(some.get(c[CyclicColumn::CapSquared]));
        p.closing = some.get(c[CyclicColumn::ClosingStiffness]);
        p.shearing = some.get(c[CyclicColumn::ShearStiffness]);
        p.left = some.get(c[CyclicColumn::Intact]);
        p.secant = some.get(c[CyclicColumn::Secant]);
        p.hardening = some.get(c[CyclicColumn::SquaredHardening]);
        p.normalStress = e.normal<Pack>(p.opening + some.get(c[CyclicColumn::Irreversible]), p.secant, p.closing);
        const auto out = masonry::advance<Pack>(e, Look{numbers, rows, some.at}, p, opening, slideA, slideB);
        // what did not happen to one of them changes no column
        some.put(c[CyclicColumn::Opening], p.opening);
        some.put(c[CyclicColumn::ShearStressA], p.shearA);
        some.put(c[CyclicColumn::ShearStressB], p.shearB);
        if (out.tore | out.dilated) {
            some.put(c[CyclicColumn::LargestOpening], p.largestOpening);
            some.put(c[CyclicColumn::TensionDamage], p.tensionDamage);
            some.put(c[CyclicColumn::ShearDamage], p.shearDamage);
            some.put(c[CyclicColumn::Intact], p.left);
            some.put(c[CyclicColumn::Secant], p.secant);
            some.put(c[CyclicColumn::Reach], e.reach<Pack>(p.left, p.largestOpening));
        }
        if (out.slid) {
            some.put(c[CyclicColumn::Slip], p.slip);
            some.put(c[CyclicColumn::PlasticSlipA], p.plasticA);
            some.put(c[CyclicColumn::PlasticSlipB], p.plasticB);
            some.put(c[CyclicColumn::ShearSoftening], p.shearSoftening);
            some.add(c[CyclicColumn::LostShear], out.lostShear);
            if (e.omegaM > 0) {
                some.put(c[CyclicColumn::ShearStiffnessLoss], p.shearStiffnessLoss);
                some.put(c[CyclicColumn::ShearStiffness], p.shearing);
            }
        }
        if (out.crushed) {
            some.put(c[CyclicColumn::LargestClosure], p.largestClosure);
            some.put(c[CyclicColumn::CapDisplacement], p.capDisplacement);
            some.put(c[CyclicColumn::CapSquared], p.strength * p.strength);
            some.put(c[CyclicColumn::ClosingStiffness], p.closing);
            some.put(c[CyclicColumn::SquaredHardening], p.hardening);
        }
        if (out.crushed | out.dilated) {
            some.put(c[CyclicColumn::Crushing], p.crushing);
            some.put(c[CyclicColumn::Dilation], p.dilation);
            some.put(c[CyclicColumn::Irreversible], p.crushing - p.dilation);
        }
        some.add(c[CyclicColumn::LostTension], out.lostTension);
        some.add(c[CyclicColumn::LostCompression], out.lostCompression);
        some.put(normalStress, p.normalStress);
        for (int i = 0; i < packed; ++i)
            regime[some.at[i]] = Regime(int(out.regime[i]));
    }
}

} // namespace

} // namespace masonry::cyclic
