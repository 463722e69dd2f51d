// SPDX-License-Identifier: GPL-2.0-or-later
#include "SofteningTable.hpp"
#include "common/Text.hpp"
#include <cmath>
#include <limits>

namespace masonry {

SofteningTable::SofteningTable(std::vector<TableRow> rows) : rows_(std::move(rows)) {
    constexpr double roundOff = 8 * std::numeric_limits<double>::epsilon(); // of a position, over ratio + shift
    double largest = HUGE_VAL;
    for (std::size_t i = 0; i + 1 < rows_.size(); ++i) {
        const double apart = rows_[i + 1].ratio - rows_[i].ratio;
        const double lost = rows_[i + 1].damage - rows_[i].damage;
        slopes_.push_back(lost / apart);
        largest = std::min(largest, (apart * (1 - 1e-9) - roundOff * rows_[i + 1].ratio) / (lost + roundOff));
    }
    largestShift_ = std::max(largest, 0.0); // without a shift the rows rise as they are given
}

double SofteningTable::damageAfterDrops(double ratio, double shift) const {
    std::size_t row = 0;
    while (row + 1 < rows_.size() && !(ratio < position(row + 1, shift)))
        ++row;
    if (row + 1 == rows_.size()) return rows_.back().damage;
    const double from = position(row, shift);
    const double share = (ratio - from) / (position(row + 1, shift) - from);
    const double damage = rows_[row].damage + share * (rows_[row + 1].damage - rows_[row].damage);
    return std::min(damage, rows_[row + 1].damage);
}

double SofteningTable::steepest() const {
    double steepest = 0;
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
        const bool drops =
            rows_[i + 1].ratio - rows_[i].ratio <= 1e-3 * (1 + 1e-9) && rows_[i + 1].damage - rows_[i].damage >= 0.1;
        if (!drops) steepest = std::max(steepest, slopes_[i]);
    }
    return steepest;
}

std::vector<std::string> SofteningTable::problems(const std::vector<TableRow>& rows) {
    std::vector<std::string> found;
    const auto at = [](std::size_t i) { return "row " + std::to_string(i + 1) + ": "; };
    if (rows.size() < 2) found.push_back("needs at least two rows, has " + std::to_string(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& [ratio, damage] = rows[i];
        if (!std::isfinite(ratio) || !std::isfinite(damage)) {
            found.push_back(at(i) + "ratio and damage must be finite numbers");
            continue;
        }
        if (i == 0 && (ratio != 1 || damage != 0))
            found.push_back(at(i) + "must be ratio 1, damage 0 (the peak), is " + text(ratio) + ", " + text(damage));
        if (damage < 0 || damage > 1) found.push_back(at(i) + "damage " + text(damage) + " is outside 0 to 1");
        if (i == 0) continue;
        if (!(ratio > rows[i - 1].ratio))
            found.push_back(at(i) + "ratio " + text(ratio) + " must be above " + text(rows[i - 1].ratio) +
                            " of the row before");
        if (damage < rows[i - 1].damage)
            found.push_back(at(i) + "damage " + text(damage) + " falls below " + text(rows[i - 1].damage) +
                            " of the row before");
    }
    return found;
}

std::vector<TableRow> SofteningTable::exponential(double decay, int segments) {
    // A chord over exp(-x) errs by h^3 exp(-x) / 12: steps that grow as exp(x/3) share that error evenly and keep
    // the area within 1e-4. The curve is left at 1e-5 of the strength, where the last row takes the rest.
    const double end = std::log(1e5);
    std::vector<TableRow> rows;
    for (int i = 0; i <= segments; ++i) {
        const double x = -3 * std::log(1 - (1 - std::exp(-end / 3)) * i / segments);
        rows.push_back({1 + x / decay, i == segments ? 1 : 1 - std::exp(-x)});
    }
    return rows;
}

// Areas are over strength times displacement at the peak. The triangle before the peak has 1/2; where it would take
// more than half of all, softening has the other half.
std::vector<TableRow> SofteningTable::exponentialOf(double strength, double stiffness, double fractureEnergy) {
    if (strength == 0) return brittle();
    const double whole = stiffness * fractureEnergy / (strength * strength);
    return exponential(1 / (whole >= 1 ? whole - 0.5 : 0.5 * whole));
}

double SofteningTable::fractureEnergyOf(double strength, double stiffness, double fractureEnergy, double gentler) {
    const double unit = strength * strength / stiffness;
    const double whole = fractureEnergy / unit;
    const double softening = gentler * (whole >= 1 ? whole - 0.5 : 0.5 * whole);
    return unit * (softening >= 0.5 ? softening + 0.5 : 2 * softening);
}

} // namespace masonry
