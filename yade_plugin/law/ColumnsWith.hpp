// LawColumns with a law. A law gives, beside what Law.hpp asks for:
//
//   Equations                          its equations with the numbers of a kind of joint; `equations(k)` makes them
//   columnCount                        how many columns it has
//   worthSideBySide                    from how many subcontacts on the whole law costs less side by side than one by one
//   advance(equations, state, jump)    one step of one subcontact; returns what it dissipated
//
// and, for these equations, the functions
//
//   normalStress(e, columns, i, yielded)   [Pa] of the state in columns
//   consequences(e, state)                 what the columns that follow from the others hold
//   keep(consequences, columns, i)         writes that
//   neverYielded(e, state)                 whether a state is one of a subcontact that has always been elastic
//   write, read(e, columns, i, state)      the columns from Crushing on that are state
//   advanceElastic, stayElastic, advanceSideBySide, addEnergies   steps and energies of several subcontacts
#pragma once
#include "LawColumns.hpp"
#include <algorithm>

namespace masonry {

template <class LawType> class ColumnsWith : public LawColumns {
public:
    using Equations = typename LawType::Equations;

    ColumnsWith(std::shared_ptr<const LawType> law, const ElasticStiffness& k, int joints, int points)
        : LawColumns(LawType::columnCount, k, joints, points), law_(std::move(law)) {
        prepare();
    }

    const LawType& law() const override { return *law_; }
    bool setLaw(const std::shared_ptr<const Law>& law) override {
        auto same = std::dynamic_pointer_cast<const LawType>(law);
        if (!same) return false;
        law_ = std::move(same);
        prepare();
        for (int point = 0; point < points_; ++point)
            for (int joint = 0; joint < stride_; ++joint) {
                if (!hasYielded(point, joint) && !neverYielded(equations_, get(point, joint))) yieldFrom(point, joint);
                if (hasYielded(point, joint)) derive(point, joint);
            }
        return true;
    }

    JointState get(int point, int joint) const override {
        const std::size_t i = at(point, joint);
        const bool yielded = hasYielded(point, joint);
        JointState s;
        s.opening = columns_[Columns::Opening][i];
        s.shearStress = {columns_[Columns::ShearStressA][i], columns_[Columns::ShearStressB][i]};
        s.largestOpening = columns_[Columns::LargestOpening][i];
        s.largestClosure = columns_[Columns::LargestClosure][i];
        s.regime = regime_[i];
        if (yielded) read(equations_, columns_, i, s);
        s.normalStress = normalStress(equations_, columns_, i, yielded);
        return s;
    }
    void set(int point, int joint, const JointState& s) override {
        const std::size_t i = at(point, joint);
        columns_[Columns::Opening][i] = s.opening;
        columns_[Columns::ShearStressA][i] = s.shearStress.a;
        columns_[Columns::ShearStressB][i] = s.shearStress.b;
        columns_[Columns::LargestOpening][i] = s.largestOpening;
        columns_[Columns::LargestClosure][i] = s.largestClosure;
        regime_[i] = s.regime;
        if (!hasYielded(point, joint) && neverYielded(equations_, s)) return;
        write(equations_, columns_, i, s);
        yieldFrom(point, joint);
        keep(consequences(equations_, s), columns_, i);
    }
    void setDissipated(int point, int joint, const Energies& energies) override {
        if (energies.tension == 0 && energies.shear == 0 && energies.compression == 0 && !hasYielded(point, joint))
            return;
        yieldFrom(point, joint);
        const std::size_t i = at(point, joint);
        columns_[Columns::LostTension][i] = energies.tension;
        columns_[Columns::LostShear][i] = energies.shear;
        columns_[Columns::LostCompression][i] = energies.compression;
    }

    double advanceOne(int point, int joint, const Jump& jump) override {
        JointState s = get(point, joint);
        const Energies lost = law_->advance(equations_, s, jump);
        set(point, joint, s);
        if (hasYielded(point, joint)) {
            const std::size_t i = at(point, joint);
            columns_[Columns::LostTension][i] += lost.tension;
            columns_[Columns::LostShear][i] += lost.shear;
            columns_[Columns::LostCompression][i] += lost.compression;
        }
        return s.normalStress;
    }
    void advance(int point, int from, int count, const double* opening, const double* slideA, const double* slideB,
                 double* normalStress) override;
    Sums energies(const double* area, bool alike) const override;

private:
    void prepare() { // what follows from law and stiffness
        equations_ = law_->equations(k_);
        neverYielded_ = consequences(equations_, JointState{});
    }
    void derive(int point, int joint) { // finds what follows from a state
        const std::size_t i = at(point, joint);
        JointState s;
        s.largestOpening = columns_[Columns::LargestOpening][i];
        s.largestClosure = columns_[Columns::LargestClosure][i];
        read(equations_, columns_, i, s);
        keep(consequences(equations_, s), columns_, i);
    }
    void yieldFrom(int point, int joint) { // from now on the eight joints of this one use all columns
        auto& yielded = yielded_[group(point, joint)];
        if (yielded) return;
        yielded = 1;
        const int first = joint / lanes * lanes;
        for (int n = first; n < std::min(first + lanes, stride_); ++n)
            derive(point, n);
    }

    std::shared_ptr<const LawType> law_;
    Equations equations_;
    decltype(consequences(std::declval<Equations>(), JointState{})) neverYielded_; // of subcontacts that never yielded
};

template <class LawType>
void ColumnsWith<LawType>::advance(int point, int from, int count, const double* opening, const double* slideA,
                                   const double* slideB, double* normalStress) {
    constexpr double none[most] = {}; // no slides
    const std::size_t first = at(point, from);
    const Jumps jumps{opening, slideA, slideB ? slideB : none, slideB == nullptr};
    Regime* regime = &regime_[first];
    if (stride_ < lanes) { // a lone joint, whose columns hold no eight numbers
        *normalStress = advanceOne(point, from, {opening[0], {slideA[0], jumps.slideB[0]}});
        return;
    }
    if (equations_.elastic) {
        std::fill_n(regime, count, Regime::Elastic);
        advanceElastic(k_.normal, k_.shear, columns_, first, count, jumps, normalStress);
        return;
    }
    bool yielded = false;
    for (int n = 0; n < count; n += lanes)
        yielded |= hasYielded(point, from + n);
    Mask waits[most];
    if (yielded) {
        int busy = 0; // how many yielded in the last step
        for (int n = 0; n < count; ++n)
            busy += regime[n] != Regime::Elastic;
        for (int n = 0; n < count; n += lanes)
            yieldFrom(point, from + n);
        if (4 * busy > 3 * count) { // nearly all need the whole law again
            std::fill_n(waits, count, 1);
            advanceSideBySide(equations_, law_->tension(), law_->shear(), columns_.from(first), &rows_[first], regime,
                              jumps, waits, count, normalStress);
            return;
        }
    }
    std::fill_n(regime, count, Regime::Elastic);
    const Mask left =
        stayElastic(equations_, yielded ? nullptr : &neverYielded_, columns_, first, count, jumps, normalStress, waits);
    if (left == 0) return;

    int waiting[most]; // the subcontacts that need the whole law
    int many = 0;
    for (int n = 0; n < count; ++n)
        if (waits[n]) waiting[many++] = n;
    if (many < LawType::worthSideBySide) {
        for (int n = 0; n < many; ++n) {
            const int i = waiting[n];
            normalStress[i] = advanceOne(point, from + i, {opening[i], {slideA[i], jumps.slideB[i]}});
        }
        return;
    }
    for (int n = 0; n < count; n += lanes)
        yieldFrom(point, from + n);
    advanceSideBySide(equations_, law_->tension(), law_->shear(), columns_.from(first), &rows_[first], regime, jumps,
                      waits, count, normalStress);
}

template <class LawType> LawColumns::Sums ColumnsWith<LawType>::energies(const double* area, bool alike) const {
    LaneSums sums;
    for (int point = 0; point < points_; ++point)
        for (int from = 0; from < joints_; from += lanes) {
            const std::size_t first = at(point, from);
            const double* of = alike ? area + point * most + from % most : area + first;
            const int count = std::min(lanes, joints_ - from); // padding does not count
            addEnergies(equations_, columns_, first, count, hasYielded(point, from), of, sums);
        }
    const auto sum = [](const double(&lane)[lanes]) {
        double all = 0;
        for (double each : lane)
            all += each;
        return all;
    };
    return {{sum(sums.storedTension), sum(sums.storedShear), sum(sums.storedCompression)},
            {sum(sums.lostTension), sum(sums.lostShear), sum(sums.lostCompression)}};
}

} // namespace masonry
