// SPDX-License-Identifier: GPL-2.0-or-later
// ColumnsOf with a law that also takes several subcontacts at a time, and has columns which are used only where
// subcontacts have yielded. Beside what ColumnsOf.hpp asks for, the law gives:
//
//   Column::Crushing             the first of these columns; all that come after it are used likewise
//   fasterOneByOne(many, groups) whether the whole law costs less one by one than side by side, for so many subcontacts
//                                that stand in so many groups of eight
//
// and, for its equations, the functions
//
//   normalStress(e, columns, i, yielded)   [Pa] of the state in columns
//   derive(e, state)                 what the columns that follow from the others hold
//   keep(derived, columns, i)         writes that
//   neverYielded(e, state)                 whether a state is one of a subcontact that has always been elastic
//   stayElastic, slideOpen, advanceSideBySide, addEnergies   steps and energies of several subcontacts
//   isLinear(e), hasConvexDomain(e)        whether stresses are the stiffness times the jumps before anything yields,
//                                          and whether the elastic domain is convex
//   markYielding, rememberElastic          what LawColumns asks of intact joints
#pragma once
#include "ColumnsOf.hpp"
#include <algorithm>
#include <vector>

namespace masonry {

template <class LawType> class ColumnsSideBySide final : public ColumnsOf<LawType> {
    using Base = ColumnsOf<LawType>;
    friend Base; // stepOf()
    using Base::at, Base::columns_, Base::elastic_, Base::equations_, Base::joints_, Base::k_, Base::law_,
        Base::regime_, Base::stride_;

public:
    using State = typename LawType::State;
    using Column = typename LawType::Column;
    using Base::most;

    ColumnsSideBySide(std::shared_ptr<const LawType> law, const ElasticStiffness& k, int joints, int points)
        : Base(std::move(law), k, joints, points),
          neverYielded_(derive(equations_, State{})),
          groups_((stride_ + lanes - 1) / lanes),
          yielded_(std::size_t(groups_) * points, 0),
          rows_(std::size_t(stride_) * points, TableRows{0, 0}) {}

    State get(int point, int joint) const override {
        const std::size_t i = at(point, joint);
        const bool yielded = hasYielded(point, joint);
        State s;
        State::visitNumbers(s, [&](const char*, double& number, int column) {
            if (yielded || column < Column::Crushing) number = columns_[column][i];
        });
        s.regime = regime_[i];
        s.normalStress = normalStress(equations_, columns_, i, yielded);
        return s;
    }
    void set(int point, int joint, const State& s) override {
        const std::size_t i = at(point, joint);
        const bool elastic = !hasYielded(point, joint) && neverYielded(equations_, s);
        State::visitNumbers(s, [&](const char*, double number, int column) {
            if (!elastic || column < Column::Crushing) columns_[column][i] = number;
        });
        regime_[i] = s.regime;
        if (elastic) return;
        yieldFrom(point, joint);
        keep(derive(equations_, s), columns_, i);
    }
    void setDissipated(int point, int joint, const Energies& lost) override {
        if (lost.tension == 0 && lost.shear == 0 && lost.compression == 0 && !hasYielded(point, joint)) return;
        yieldFrom(point, joint);
        Base::setDissipated(point, joint, lost);
    }

    double advanceOne(int point, int joint, const Jump& jump) override {
        return Base::stepOf(*this, point, joint, jump);
    }
    void advance(int point, int from, int count, const double* opening, const double* slideA, const double* slideB,
                 double* normalStress) override;

    bool knowsIntact() const override { return elastic_ || isLinear(equations_); }
    bool isIntact(int point, int joint) const override {
        if (elastic_) return true;
        const State s = get(point, joint);
        const Energies lost = Base::dissipated(point, joint);
        return s.regime == Regime::Elastic && neverYielded(equations_, s) && lost.tension == 0 && lost.shear == 0 &&
               lost.compression == 0;
    }
    bool isConvex() const override { return elastic_ || hasConvexDomain(equations_); }
    void findYielding(int count, const double* opening, const double* slideA, const double* slideB,
                      Mask* yielding) const override {
        if (!elastic_) markYielding(equations_, neverYielded_, count, opening, slideA, slideB, yielding);
    }
    void remember(int point, int from, int count, const double* opening) override {
        if (!elastic_) rememberElastic(equations_, columns_.from(at(point, from)), count, opening);
    }

protected:
    void sumEnergies(int point, int from, int count, const double* area, LaneSums& sums) const override {
        addEnergies(equations_, columns_.from(at(point, from)), count, hasYielded(point, from), area, sums);
    }

private:
    std::size_t group(int point, int joint) const { return std::size_t(point) * groups_ + joint / lanes; }
    bool hasYielded(int point, int joint) const { return yielded_[group(point, joint)] != 0; }

    void yieldFrom(int point, int joint) { // from now on the eight joints of this one use all columns
        auto& yielded = yielded_[group(point, joint)];
        if (yielded) return;
        yielded = 1;
        const int first = joint / lanes * lanes;
        for (int n = first; n < std::min(first + lanes, stride_); ++n) {
            const std::size_t i = at(point, n);
            State s;
            State::visitNumbers(s, [&](const char*, double& number, int column) { number = columns_[column][i]; });
            keep(derive(equations_, s), columns_, i);
        }
    }

    using Derived = decltype(derive(std::declval<typename LawType::Equations>(), State{}));
    Derived neverYielded_;              // of subcontacts that never yielded
    int groups_;                        // of eight joints
    std::vector<std::uint8_t> yielded_; // of these groups at a point, whether one of the joints has yielded
    std::vector<TableRows> rows_;
};

template <class LawType>
void ColumnsSideBySide<LawType>::advance(int point, int from, int count, const double* opening, const double* slideA,
                                         const double* slideB, double* normalStress) {
    static constexpr double none[most] = {}; // no slides
    const std::size_t first = at(point, from);
    const Jumps jumps{opening, slideA, slideB ? slideB : none, slideB == nullptr};
    Regime* regime = &regime_[first];
    if (stride_ < lanes) { // a lone joint, whose columns hold no eight numbers
        *normalStress = advanceOne(point, from, {opening[0], {slideA[0], jumps.slideB[0]}});
        return;
    }
    if (elastic_) {
        std::fill_n(regime, count, Regime::Elastic);
        advanceElastic(k_.normal, k_.shear, columns_.from(first), count, jumps, normalStress);
        return;
    }
    bool yielded = false;
    for (int n = 0; n < count; n += lanes)
        yielded |= hasYielded(point, from + n);
    Mask pending[most];
    for (int n = 0; yielded && n < count; n += lanes)
        yieldFrom(point, from + n);
    std::fill_n(regime, count, Regime::Elastic);
    const SideBySide all{columns_.from(first), jumps, regime, pending, count, normalStress};
    const auto rest = stayElastic(equations_, yielded ? nullptr : &neverYielded_, all);
    Mask left = rest.all;
    int begin = 0, end = count; // the groups of eight from the first to the last that are pending
    const auto narrow = [&] {
        while (!pending[begin])
            ++begin;
        while (!pending[end - 1])
            --end;
        begin = begin / lanes * lanes;
        end = std::min((end - 1) / lanes * lanes + lanes, count);
    };
    if (left != 0 && rest.open != 0) {
        narrow();
        left -= slideOpen(equations_, law_->tension(), law_->shear(), all.part(begin, end));
    }
    if (left == 0) return;
    narrow();
    if (LawType::fasterOneByOne(int(left), (end - begin + lanes - 1) / lanes)) {
        for (int i = begin; i < end; ++i)
            if (pending[i]) normalStress[i] = advanceOne(point, from + i, {opening[i], {slideA[i], jumps.slideB[i]}});
        return;
    }
    for (int n = begin; n < end; n += lanes)
        yieldFrom(point, from + n);
    advanceSideBySide(equations_, law_->tension(), law_->shear(), &rows_[first + begin], all.part(begin, end));
}

} // namespace masonry
