// Damage as a piecewise linear function of the displacement ratio, paper eqs. (12)-(17); law/README.md,
// Softening.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace masonry {

struct TableRow {
    double ratio;  // [-] displacement over the displacement at peak strength, >= 1
    double damage; // [-] 0 at the peak, at most 1
};

class SofteningTable {
public:
    SofteningTable() = default; // no rows: never any damage
    explicit SofteningTable(std::vector<TableRow> rows);

    // What is wrong with these rows, in words that name the row; empty if nothing is.
    static std::vector<std::string> problems(const std::vector<TableRow>& rows);

    // exp(-decay (ratio - 1)) of the strength is left; 200 segments as in the paper §4.1, the last row at damage 1.
    static std::vector<TableRow> exponential(double decay, int segments = 200);

    // Strength is lost at the first yield: the usual Coulomb slip law.
    static std::vector<TableRow> brittle() { return {{1, 0}, {1 + 1e-6, 1}}; }

    // Linear between rows; past the last one its damage stays [decided].
    double damage(double ratio) const {
        if (rows_.empty() || !(ratio > 1)) return 0;
        if (ratio >= rows_.back().ratio) return rows_.back().damage;
        return within(rowOf(ratio), ratio);
    }

    // The same for a ratio near the last one: `row` is where that was found, and is brought up to date.
    double damage(double ratio, std::int32_t& row) const {
        if (ratio > 1 && isWithin(std::size_t(row), ratio)) return within(std::size_t(row), ratio);
        if (rows_.empty() || !(ratio > 1)) return 0;
        if (ratio >= rows_.back().ratio) return rows_.back().damage;
        const std::size_t next = std::size_t(row) + 1;
        row = std::int32_t(isWithin(next, ratio) ? next : rowOf(ratio));
        return within(std::size_t(row), ratio);
    }

    const std::vector<TableRow>& rows() const { return rows_; }

private:
    std::size_t rowOf(double ratio) const { // the row at or before a ratio between 1 and the last row
        std::size_t low = 0;
        std::size_t span = rows_.size() - 1; // rows_[low].ratio <= ratio < rows_[low + span].ratio
        while (span > 1) {
            const std::size_t half = span / 2;
            if (rows_[low + half].ratio <= ratio) {
                low += half;
                span -= half;
            } else
                span = half;
        }
        return low;
    }
    bool isWithin(std::size_t row, double ratio) const {
        return row < slopes_.size() && rows_[row].ratio <= ratio && ratio < rows_[row + 1].ratio;
    }
    double within(std::size_t row, double ratio) const { // never rounded up beyond the next row
        return std::min(rows_[row].damage + slopes_[row] * (ratio - rows_[row].ratio), rows_[row + 1].damage);
    }

    std::vector<TableRow> rows_;
    std::vector<double> slopes_;
};

} // namespace masonry
