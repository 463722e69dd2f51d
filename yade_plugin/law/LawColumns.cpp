#include "LawColumns.hpp"
#include <memory>
#include <new>

namespace masonry {

LawColumns::LawColumns(int count, const ElasticStiffness& k, int joints, int points)
    : k_(k),
      joints_(joints),
      points_(points),
      stride_(joints == 1 ? 1 : (joints + lanes - 1) / lanes * lanes),
      groups_((stride_ + lanes - 1) / lanes) {
    const std::size_t size = std::size_t(stride_) * points_;
    columns_.pitch = size % 512 == 0 ? size + lanes : size; // columns whole pages apart would compete for the cache
    const std::size_t numbers = columns_.pitch * count + lanes;
    memory_.reset(std::calloc(numbers, sizeof(double)));
    if (!memory_ && size > 0) throw std::bad_alloc();
    void* aligned = memory_.get();
    std::size_t room = numbers * sizeof(double);
    columns_.first = static_cast<double*>(std::align(alignof(Row), sizeof(double), aligned, room));
    rows_.assign(size, TableRows{0, 0});
    regime_.assign(size, Regime::Elastic);
    yielded_.assign(std::size_t(groups_) * points_, 0);
}

Energies LawColumns::dissipated(int point, int joint) const {
    const std::size_t i = at(point, joint);
    if (!hasYielded(point, joint)) return {};
    return {columns_[Columns::LostTension][i], columns_[Columns::LostShear][i], columns_[Columns::LostCompression][i]};
}

} // namespace masonry
