// SPDX-License-Identifier: GPL-2.0-or-later
#include "LawColumns.hpp"
#include <cstring>
#include <memory>
#include <new>
#include <utility>

namespace masonry {

LawColumns::LawColumns(int count, int (*of)(Role), const ElasticStiffness& k, int joints, int points)
    : of_(of),
      k_(k),
      joints_(joints),
      points_(points),
      stride_(joints == 1 ? 1 : (joints + lanes - 1) / lanes * lanes) {
    const std::size_t size = std::size_t(stride_) * points_;
    columns_.pitch = size % 512 == 0 ? size + lanes : size; // columns whole pages apart would compete for the cache
    const std::size_t numbers = columns_.pitch * count + lanes;
    memory_.reset(std::calloc(numbers, sizeof(double)));
    if (!memory_ && size > 0) throw std::bad_alloc();
    void* aligned = memory_.get();
    std::size_t available = numbers * sizeof(double);
    columns_.first = static_cast<double*>(std::align(alignof(Row), sizeof(double), aligned, available));
    regime_.assign(size, Regime::Elastic);
}

bool LawColumns::isBonded() const {
    return law().properties().tensileStrength > 0 && of_(Role::BondDamage) != SharedColumn::none;
}

Energies LawColumns::dissipated(int point, int joint) const {
    const std::size_t i = at(point, joint);
    return {columns_[SharedColumn::LostTension][i], columns_[SharedColumn::LostShear][i],
            columns_[SharedColumn::LostCompression][i]};
}

void LawColumns::visitState(int point, int joint, StateNumbers& n) {
    Energies lost = dissipated(point, joint);
    n(lost.tension, lost.shear, lost.compression);
    if (!n.back) return read(point, joint, [&](const char*, double number) { n(number); });
    write(point, joint, [&](const char*, double& number) { n(number); });
    setDissipated(point, joint, lost);
}

double LawColumns::shown(int point, int joint, const JointField& field) const {
    double found = 0;
    show(point, joint, [&](const JointField& each, double value) {
        if (&each == &field) found = value;
    });
    return found;
}

void LawColumns::take(int point, int joint, const LawColumns& from, int otherPoint, int other) {
    std::vector<std::pair<const char*, double>> numbers;
    from.read(otherPoint, other, [&](const char* name, double value) { numbers.emplace_back(name, value); });
    write(point, joint, [&](const char* name, double& value) {
        for (const auto& [each, number] : numbers)
            if (std::strcmp(each, name) == 0) value = number;
    });
    setDissipated(point, joint, from.dissipated(otherPoint, other));
}

LawColumns::Sums LawColumns::energies(const double* area, bool alike) const {
    LaneSums sums;
    for (int point = 0; point < points_; ++point)
        for (int from = 0; from < joints_; from += lanes) {
            const double* of = alike ? area + point * most + from % most : area + at(point, from);
            const int count = joints_ - from < lanes ? joints_ - from : lanes; // padding does not count
            sumEnergies(point, from, count, of, sums);
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
