#include "SofteningTable.hpp"
#include "common/Text.hpp"
#include <cmath>

namespace masonry {

SofteningTable::SofteningTable(std::vector<TableRow> rows) : rows_(std::move(rows)) {
    for (std::size_t i = 0; i + 1 < rows_.size(); ++i)
        slopes_.push_back((rows_[i + 1].damage - rows_[i].damage) / (rows_[i + 1].ratio - rows_[i].ratio));
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

} // namespace masonry
