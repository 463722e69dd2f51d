#include "JointColumns.hpp"
#include <algorithm>
#include <new>

namespace masonry {

namespace {

constexpr int most = JointColumns::most;
constexpr double none[most] = {}; // no slides

double squareOfCap(const Equations& e, double largestClosure) {
    const double fc = e.cap ? e.curve.strength(largestClosure, e.stretch) : HUGE_VAL;
    return fc * fc;
}

double sum(const double (&lane)[lanes]) {
    double all = 0;
    for (double each : lane)
        all += each;
    return all;
}

} // namespace

// ---- states --------------------------------------------------------------------------------------------------------

JointColumns::JointColumns(std::shared_ptr<const JointLaw> law, const ElasticStiffness& k, int joints, int points)
    : law_(std::move(law)),
      k_(k),
      joints_(joints),
      points_(points),
      stride_(joints == 1 ? 1 : (joints + lanes - 1) / lanes * lanes),
      groups_((stride_ + lanes - 1) / lanes) {
    prepare();
    const std::size_t size = std::size_t(stride_) * points_;
    columns_.pitch = size % 512 == 0 ? size + lanes : size; // columns whole pages apart would compete for the cache
    const std::size_t numbers = columns_.pitch * Columns::count + lanes;
    memory_.reset(std::calloc(numbers, sizeof(double)));
    if (!memory_ && size > 0) throw std::bad_alloc();
    void* aligned = memory_.get();
    std::size_t room = numbers * sizeof(double);
    columns_.first = static_cast<double*>(std::align(alignof(Row), sizeof(double), aligned, room));
    rows_.assign(size, TableRows{0, 0});
    regime_.assign(size, Regime::Elastic);
    yielded_.assign(std::size_t(groups_) * points_, 0);
}

void JointColumns::prepare() {
    equations_ = law_->equations(k_);
    neverYielded_ = {0, 1, equations_.kn, equations_.reach(1, 0), squareOfCap(equations_, 0)};
}

bool JointColumns::neverYielded(const JointState& s) const {
    const bool whole = s.crushing == 0 && s.dilation == 0 && s.slip == 0 && s.tensionDamage == 0 && s.shearDamage == 0;
    const double limit = equations_.cap ? equations_.curve.limit(equations_.stretch) : HUGE_VAL;
    return whole && s.largestOpening <= equations_.reach(1, 0) && s.largestClosure <= limit;
}

void JointColumns::derive(std::size_t i) {
    const double largestOpening = columns_[Columns::LargestOpening][i];
    const double intact = Equations::intact(columns_[Columns::TensionDamage][i], columns_[Columns::ShearDamage][i]);
    columns_[Columns::Irreversible][i] = columns_[Columns::Crushing][i] - columns_[Columns::Dilation][i];
    columns_[Columns::Intact][i] = intact;
    columns_[Columns::Secant][i] = equations_.secant(intact, largestOpening);
    columns_[Columns::Reach][i] = equations_.reach(intact, largestOpening);
    columns_[Columns::CapSquared][i] = squareOfCap(equations_, columns_[Columns::LargestClosure][i]);
}

void JointColumns::yieldFrom(int point, int joint) {
    auto& yielded = yielded_[group(point, joint)];
    if (yielded) return;
    yielded = 1;
    const int first = joint / lanes * lanes;
    for (int n = first; n < std::min(first + lanes, stride_); ++n)
        derive(at(point, n));
}

void JointColumns::setLaw(std::shared_ptr<const JointLaw> law) {
    law_ = std::move(law);
    prepare();
    for (int point = 0; point < points_; ++point)
        for (int joint = 0; joint < stride_; ++joint) {
            if (!yielded_[group(point, joint)] && !neverYielded(get(point, joint))) yieldFrom(point, joint);
            if (yielded_[group(point, joint)]) derive(at(point, joint));
        }
}

JointState JointColumns::get(int point, int joint) const {
    const std::size_t i = at(point, joint);
    JointState s;
    s.opening = columns_[Columns::Opening][i];
    s.shearStress = {columns_[Columns::ShearStressA][i], columns_[Columns::ShearStressB][i]};
    s.largestOpening = columns_[Columns::LargestOpening][i];
    s.largestClosure = columns_[Columns::LargestClosure][i];
    s.regime = regime_[i];
    if (!yielded_[group(point, joint)]) {
        s.normalStress = equations_.kn * s.opening;
        return s;
    }
    s.crushing = columns_[Columns::Crushing][i];
    s.dilation = columns_[Columns::Dilation][i];
    s.slip = columns_[Columns::Slip][i];
    s.tensionDamage = columns_[Columns::TensionDamage][i];
    s.shearDamage = columns_[Columns::ShearDamage][i];
    const double elastic = s.opening + columns_[Columns::Irreversible][i];
    s.normalStress = equations_.stiffness(elastic, columns_[Columns::Secant][i]) * elastic;
    return s;
}

void JointColumns::set(int point, int joint, const JointState& s) {
    const std::size_t i = at(point, joint);
    columns_[Columns::Opening][i] = s.opening;
    columns_[Columns::ShearStressA][i] = s.shearStress.a;
    columns_[Columns::ShearStressB][i] = s.shearStress.b;
    columns_[Columns::LargestOpening][i] = s.largestOpening;
    columns_[Columns::LargestClosure][i] = s.largestClosure;
    regime_[i] = s.regime;
    if (!yielded_[group(point, joint)] && neverYielded(s)) return;
    columns_[Columns::Crushing][i] = s.crushing;
    columns_[Columns::Dilation][i] = s.dilation;
    columns_[Columns::Slip][i] = s.slip;
    columns_[Columns::TensionDamage][i] = s.tensionDamage;
    columns_[Columns::ShearDamage][i] = s.shearDamage;
    yieldFrom(point, joint);
    derive(i);
}

Energies JointColumns::dissipated(int point, int joint) const {
    const std::size_t i = at(point, joint);
    if (!yielded_[group(point, joint)]) return {};
    return {columns_[Columns::LostTension][i], columns_[Columns::LostShear][i], columns_[Columns::LostCompression][i]};
}

void JointColumns::setDissipated(int point, int joint, const Energies& energies) {
    if (energies.tension == 0 && energies.shear == 0 && energies.compression == 0 && !yielded_[group(point, joint)])
        return;
    yieldFrom(point, joint);
    const std::size_t i = at(point, joint);
    columns_[Columns::LostTension][i] = energies.tension;
    columns_[Columns::LostShear][i] = energies.shear;
    columns_[Columns::LostCompression][i] = energies.compression;
}

JointColumns::Sums JointColumns::energies(const double* area, bool alike) const {
    LaneSums sums;
    for (int point = 0; point < points_; ++point)
        addEnergies(equations_.kn, equations_.ks, columns_, &yielded_[group(point, 0)], joints_, stride_, area, alike,
                    point, sums);
    return {{sum(sums.storedTension), sum(sums.storedShear), sum(sums.storedCompression)},
            {sum(sums.lostTension), sum(sums.lostShear), sum(sums.lostCompression)}};
}

// ---- steps ---------------------------------------------------------------------------------------------------------

double JointColumns::advanceOne(int point, int joint, const Jump& jump) {
    JointState s = get(point, joint);
    const Energies lost = law_->advance(equations_, s, jump);
    set(point, joint, s);
    if (yielded_[group(point, joint)]) {
        const std::size_t i = at(point, joint);
        columns_[Columns::LostTension][i] += lost.tension;
        columns_[Columns::LostShear][i] += lost.shear;
        columns_[Columns::LostCompression][i] += lost.compression;
    }
    return s.normalStress;
}

void JointColumns::advance(int point, int from, int count, const double* opening, const double* slideA,
                           const double* slideB, double* normalStress) {
    const std::size_t first = at(point, from);
    const Jumps jumps{opening, slideA, slideB ? slideB : none, slideB == nullptr};
    Regime* regime = &regime_[first];
    if (equations_.elastic) {
        std::fill_n(regime, count, Regime::Elastic);
        advanceElastic(k_.normal, k_.shear, columns_, first, count, jumps, normalStress);
        return;
    }
    bool yielded = false;
    for (int n = 0; n < count; n += lanes)
        yielded |= yielded_[group(point, from + n)] != 0;
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
    if (many < 5) { // side by side, the others would be calculated for nothing
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

} // namespace masonry
