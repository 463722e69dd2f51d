// SPDX-License-Identifier: GPL-2.0-or-later
// LawColumns with a law that takes one subcontact after the other. Beside what Law.hpp asks for, such a law gives:
//
//   State                        what it remembers of a subcontact: JointState and more, with visitNumbers()
//   Column                       its columns: those of SharedColumn, and one for each further number of its state
//   Equations                    its equations with the numbers of a kind of joint; `equations(k)` makes them
//   advance(e, state, jump)      one step of one subcontact; returns what it dissipated [J/m²]
//   normalStress(e, state)       [Pa] of a state of which the other numbers are known
//   stored(k, state)             elastic energy [J/m²] by mode
//   yielding(k, state)           its yield functions, see JointState.hpp
//   show(e, state, show)         calls show(field, value) for what files show, see JointField.hpp
//
// Joints without strength (property `elastic`) are advanced here: the law is not asked.
#pragma once
#include "LawColumns.hpp"
#include <typeinfo>

namespace masonry {

// The regime that a number in a file stands for. Throws std::invalid_argument if it stands for none.
inline Regime regimeOf(double number) {
    if (number >= 0 && number <= double(Regime::Crushing)) return Regime(int(number));
    throw std::invalid_argument("saved file is damaged at the regime of a joint");
}

template <class LawType> class ColumnsOf : public LawColumns {
public:
    using State = typename LawType::State;
    using Equations = typename LawType::Equations;
    using Column = typename LawType::Column;

    ColumnsOf(std::shared_ptr<const LawType> law, const ElasticStiffness& k, int joints, int points)
        : LawColumns(Column::count, &Column::of, k, joints, points),
          law_(std::move(law)),
          equations_(law_->equations(k)),
          elastic_(law_->properties().elastic) {}

    const LawType& law() const override { return *law_; }

    virtual State get(int point, int joint) const {
        const std::size_t i = at(point, joint);
        State s;
        State::visitNumbers(s, [&](const char*, double& number, int column) { number = columns_[column][i]; });
        s.regime = regime_[i];
        s.normalStress = elastic_ ? k_.normal * (s.opening + columns_[Column::Irreversible][i])
                                  : LawType::normalStress(equations_, s);
        return s;
    }
    virtual void set(int point, int joint, const State& s) {
        const std::size_t i = at(point, joint);
        State::visitNumbers(s, [&](const char*, double number, int column) { columns_[column][i] = number; });
        regime_[i] = s.regime;
    }

    JointState state(int point, int joint) const override { return get(point, joint); }
    void setDissipated(int point, int joint, const Energies& energies) override {
        const std::size_t i = at(point, joint);
        columns_[Column::LostTension][i] = energies.tension;
        columns_[Column::LostShear][i] = energies.shear;
        columns_[Column::LostCompression][i] = energies.compression;
    }

    void read(int point, int joint, const std::function<void(const char*, double)>& reader) const override {
        const State s = get(point, joint);
        State::visitNumbers(s, [&](const char* name, double number, int) { reader(name, number); });
        reader("regime", double(s.regime));
    }
    void write(int point, int joint, const std::function<void(const char*, double&)>& writer) override {
        State s = get(point, joint);
        State::visitNumbers(s, [&](const char* name, double& number, int) { writer(name, number); });
        double regime = double(s.regime);
        writer("regime", regime);
        s.regime = regimeOf(regime);
        set(point, joint, s);
    }
    void release(int point, int joint) override {
        State s = get(point, joint);
        s.shearStress = {};
        s.opening = std::max(s.opening, -columns_[Column::Irreversible][at(point, joint)]);
        set(point, joint, s);
    }
    void take(int point, int joint, const LawColumns& from, int otherPoint, int other) override {
        if (typeid(from) != typeid(*this)) return LawColumns::take(point, joint, from, otherPoint, other);
        const auto& same = static_cast<const ColumnsOf&>(from);
        set(point, joint, same.get(otherPoint, other)); // the same law: no names need to be compared
        setDissipated(point, joint, from.dissipated(otherPoint, other));
    }
    void show(int point, int joint, const ShowField& shown) const override {
        LawType::show(equations_, get(point, joint), shown);
    }
    Yield yielding(int point, int joint) const override {
        return elastic_ ? Yield{} : law_->yielding(k_, get(point, joint));
    }

    Yield yieldingUnder(double normalStress, const Shear& shearStress) const override {
        if (elastic_) return {};
        State s;
        s.opening = normalStress / k_.normal;
        s.normalStress = normalStress;
        s.shearStress = shearStress;
        return law_->yielding(k_, s);
    }

    double advanceOne(int point, int joint, const Jump& jump) override { return stepOf(*this, point, joint, jump); }
    void advance(int point, int from, int count, const double* opening, const double* slideA, const double* slideB,
                 double* normalStress) override {
        for (int n = 0; n < count; ++n)
            normalStress[n] = advanceOne(point, from + n, {opening[n], {slideA[n], slideB ? slideB[n] : 0}});
    }

    // A joint without strength is always intact, whatever its law.
    bool knowsIntact() const override { return elastic_; }
    bool isIntact(int, int) const override { return elastic_; }
    bool isConvex() const override { return elastic_; }

protected:
    // advanceOne() of columns whose class is known, so that the compiler sees which get() and set() it calls.
    template <class Self> static double stepOf(Self& self, int point, int joint, const Jump& jump) {
        const std::size_t i = self.at(point, joint);
        const Columns& columns = self.columns_;
        if (self.elastic_) {
            double normalStress;
            const Jumps one{&jump.opening, &jump.slide.a, &jump.slide.b, false};
            advanceElastic(self.k_.normal, self.k_.shear, columns.from(i), 1, one, &normalStress);
            self.regime_[i] = Regime::Elastic;
            return normalStress;
        }
        State s = self.get(point, joint);
        const Energies lost = self.law_->advance(self.equations_, s, jump);
        self.set(point, joint, s);
        if (lost.tension != 0) columns[Column::LostTension][i] += lost.tension; // a zero would use memory for nothing
        if (lost.shear != 0) columns[Column::LostShear][i] += lost.shear;
        if (lost.compression != 0) columns[Column::LostCompression][i] += lost.compression;
        return s.normalStress;
    }

    void sumEnergies(int point, int from, int count, const double* area, LaneSums& sums) const override {
        for (int n = 0; n < count; ++n) {
            const Energies stored = law_->stored(k_, get(point, from + n));
            const Energies lost = dissipated(point, from + n);
            sums.storedTension[n] += area[n] * stored.tension;
            sums.storedShear[n] += area[n] * stored.shear;
            sums.storedCompression[n] += area[n] * stored.compression;
            sums.lostTension[n] += area[n] * lost.tension;
            sums.lostShear[n] += area[n] * lost.shear;
            sums.lostCompression[n] += area[n] * lost.compression;
        }
    }

    std::shared_ptr<const LawType> law_;
    Equations equations_;
    bool elastic_; // whether no strength is ever reached
};

} // namespace masonry
