// SPDX-License-Identifier: GPL-2.0-or-later
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

    template <class Visit> void visitState(Visit&& visit) { visit(ratio, damage); }
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

    // The exponential table that takes the fracture energy [J/m²], the elastic energy at the peak included, of a joint
    // with this strength [Pa] and own stiffness [Pa/m]; law/README.md, Softening. Zero strength has nothing to soften.
    static std::vector<TableRow> exponentialOf(double strength, double stiffness, double fractureEnergy);
    // The fracture energy [J/m²] with which that table falls `gentler` times as slowly.
    static double fractureEnergyOf(double strength, double stiffness, double fractureEnergy, double gentler);

    // In what follows `shift` [-], at least 0, is what lumped units add to the ratio at the peak: a row stands at ratio
    // + shift (1 - damage), because it moves by the elastic part at its own strength (law/README.md, Rigid units).
    // Where a row then stands before an earlier one, the softening snaps back; the damage rises at once to where the
    // table goes on.

    // Linear between rows; past the last one its damage stays [decided].
    double damage(double ratio, double shift = 0) const {
        std::int32_t row = 0;
        return damage(ratio, shift, row);
    }
    // The same for a ratio near the last one: `row` is where that was found, and is brought up to date.
    double damage(double ratio, double shift, std::int32_t& row) const {
        if (rows_.empty() || !(ratio > 1 + shift)) return 0;
        if (!rises(shift)) return damageAfterDrops(ratio, shift);
        if (isWithin(row, ratio, shift)) return within(row, ratio, shift);
        if (ratio >= position(rows_.size() - 1, shift)) return rows_.back().damage;
        const std::size_t next = row + 1;
        row = std::int32_t(isWithin(next, ratio, shift) ? next : rowOf(ratio, shift));
        return within(row, ratio, shift);
    }

    // Steepest rise of damage with the ratio but for brittle drops, that is rows at most 1e-3 apart between which a
    // tenth of the strength or more is lost. Softening snaps back where this times the shift reaches 1.
    double steepest() const;

    const std::vector<TableRow>& rows() const { return rows_; }
    double mostDamage() const { return rows_.empty() ? 0 : rows_.back().damage; }
    double lastRatio() const { return rows_.empty() ? 1 : rows_.back().ratio; } // beyond which damage stays

private:
    double position(std::size_t row, double shift) const { return rows_[row].ratio + shift * (1 - rows_[row].damage); }
    // Whether every row stands beyond the one before, also in numbers with round-off.
    bool rises(double shift) const { return shift <= largestShift_; }
    double damageAfterDrops(double ratio, double shift) const;

    // The row at or before a ratio between the positions of the first and the last row.
    std::size_t rowOf(double ratio, double shift) const {
        std::size_t low = 0;
        std::size_t span = rows_.size() - 1; // position(low) <= ratio < position(low + span)
        while (span > 1) {
            const std::size_t half = span / 2;
            if (position(low + half, shift) <= ratio) {
                low += half;
                span -= half;
            } else
                span = half;
        }
        return low;
    }
    bool isWithin(std::size_t row, double ratio, double shift) const {
        return row < slopes_.size() && position(row, shift) <= ratio && ratio < position(row + 1, shift);
    }
    double within(std::size_t row, double ratio, double shift) const { // never rounded up beyond the next row
        const double slope = shift == 0 ? slopes_[row] : slopes_[row] / (1 - shift * slopes_[row]);
        return std::min(rows_[row].damage + slope * (ratio - position(row, shift)), rows_[row + 1].damage);
    }

    std::vector<TableRow> rows_;
    std::vector<double> slopes_;
    double largestShift_ = 0; // up to which rises() holds
};

} // namespace masonry
