// SPDX-License-Identifier: GPL-2.0-or-later
// One step of the cyclic law for as many subcontacts side by side as the vector units of a processor take. A file for
// each kind of vector units compiles `advanceAs` for it (common/Pack.hpp), and nothing else, because the linker would
// take that for all processors.
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

using Advance = void(const Numbers& numbers, TableRows* rows, const SideBySide& all);
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

// Subcontacts of the columns, wherever they stand in them.
struct Places : CyclicColumn {
    Columns columns;
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
    MASONRY_INLINED Pack get(int column) const { return get(columns[column]); }
    MASONRY_INLINED void put(int column, const Pack& x) const { put(columns[column], x); }
    MASONRY_INLINED void add(int column, const Pack& x) const { put(column, get(column) + x); }

    MASONRY_INLINED CyclicPoint<Pack> read(const CyclicEquations& e) const {
        CyclicPoint<Pack> p;
        p.opening = get(Opening);
        p.crushing = get(Crushing);
        p.dilation = get(Dilation);
        p.slip = get(Slip);
        p.largestOpening = get(LargestOpening);
        p.largestClosure = get(LargestClosure);
        p.tensionDamage = get(TensionDamage);
        p.shearDamage = get(ShearDamage);
        p.shearA = get(ShearStressA);
        p.shearB = get(ShearStressB);
        p.plasticA = get(PlasticSlipA);
        p.plasticB = get(PlasticSlipB);
        p.shearSoftening = get(ShearSoftening);
        p.shearStiffnessLoss = get(ShearStiffnessLoss);
        p.capDisplacement = get(CapDisplacement);
        p.strength = root(get(CapSquared));
        p.closing = get(ClosingStiffness);
        p.shearing = get(ShearStiffness);
        p.left = get(Intact);
        p.secant = get(Secant);
        p.hardening = get(SquaredHardening);
        p.normalStress = e.normal<Pack>(p.opening + get(Irreversible), p.secant, p.closing);
        return p;
    }
    // What did not happen to one of them changes no column.
    MASONRY_INLINED void write(const CyclicEquations& e, const CyclicPoint<Pack>& p,
                               const CyclicOutcome<Pack>& out) const {
        put(Opening, p.opening);
        put(ShearStressA, p.shearA);
        put(ShearStressB, p.shearB);
        if (out.tore | out.dilated) {
            put(LargestOpening, p.largestOpening);
            put(TensionDamage, p.tensionDamage);
            put(ShearDamage, p.shearDamage);
            put(Intact, p.left);
            put(Secant, p.secant);
            put(Reach, e.reach<Pack>(p.left, p.largestOpening));
        }
        if (out.slid) {
            put(Slip, p.slip);
            put(PlasticSlipA, p.plasticA);
            put(PlasticSlipB, p.plasticB);
            put(ShearSoftening, p.shearSoftening);
            add(LostShear, out.lostShear);
            if (e.omegaM > 0) {
                put(ShearStiffnessLoss, p.shearStiffnessLoss);
                put(ShearStiffness, p.shearing);
            }
        }
        if (out.crushed) {
            put(LargestClosure, p.largestClosure);
            put(CapDisplacement, p.capDisplacement);
            put(CapSquared, p.strength * p.strength);
            put(ClosingStiffness, p.closing);
            put(SquaredHardening, p.hardening);
        }
        if (out.crushed | out.dilated) {
            put(Crushing, p.crushing);
            put(Dilation, p.dilation);
            put(Irreversible, p.crushing - p.dilation);
        }
        add(LostTension, out.lostTension);
        add(LostCompression, out.lostCompression);
    }
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

MASONRY_INLINED void advanceAs(const Numbers& numbers, TableRows* rows, const SideBySide& subcontacts) {
    const CyclicEquations e = numbers.equations;
    const SideBySide all = subcontacts;
    Places some;
    some.columns = all.columns;
    for (int from = 0;;) {
        int many = 0; // number of pending subcontacts in this pack; others may lie between them
        for (; from < all.count && many < packed; ++from)
            if (all.pending[from]) some.at[many++] = from;
        if (many == 0) return;
        // A pack that is not full repeats its last subcontact: the same numbers are then written several times.
        for (int i = many; i < packed; ++i)
            some.at[i] = some.at[many - 1];
        some.together = many == packed && some.at[packed - 1] - some.at[0] == packed - 1;
        auto p = some.read(e);
        const auto out = masonry::advance<Pack>(e, Look{numbers, rows, some.at}, p, some.get(all.jumps.opening),
                                                some.get(all.jumps.slideA), some.get(all.jumps.slideB));
        some.write(e, p, out);
        some.put(all.normalStress, p.normalStress);
        for (int i = 0; i < packed; ++i)
            all.regime[some.at[i]] = Regime(int(out.regime[i]));
    }
}

} // namespace

} // namespace masonry::cyclic
