// Gomory's fractional cuts (1958) as Chvatal-Gomory cuts with exact arithmetic. The row of the
// basis inverse that belongs to a fractional basic column has, on our problems, almost always a
// small common denominator D: then multipliers p / D with integers p = D * fractional part are
// recovered exactly, and
//   sum_j floor(sum_r p_r a_rj / D) x_j <= floor(sum_r p_r b_r / D)
// holds for all nonnegative integer x, columns at their upper bound being complemented first. The
// tableau only suggests the multipliers; the cut is valid whatever they are. For each row the
// multiples k p mod D are tried as well (k-cuts, Cornuejols, Li & Vandenbussche 2003).
#include "labeling/gomory_cuts.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace labeling {
namespace {

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
    const std::int64_t q = a / b;
    return q * b > a ? q - 1 : q;
}

/// Smallest D with all D * inverse near integers, 0 if none.
int common_denominator(const std::vector<double>& inverse, int largest) {
    for (int d = 2; d <= largest; ++d) {
        const bool fits = std::all_of(inverse.begin(), inverse.end(), [d](double u) {
            const double scaled = u * d;
            return std::abs(scaled - std::round(scaled)) < 1e-5 * d;
        });
        if (fits) return d;
    }
    return 0;
}

class CutBuilder {
public:
    CutBuilder(const Relaxation& relaxation, const GomoryCutOptions& options)
        : relaxation_(relaxation),
          options_(options),
          x_(relaxation.x()),
          sums_(relaxation.column_count(), 0) {}

    /// The best cut of the multiples of one tableau row; empty when none is violated.
    Cut build(const std::vector<double>& inverse, int denominator) {
        std::vector<std::pair<std::int32_t, std::int64_t>> residues;
        for (std::size_t r = 0; r < inverse.size(); ++r) {
            const auto p = static_cast<std::int64_t>(std::llround(inverse[r] * denominator));
            const std::int64_t residue = p - denominator * floor_divide(p, denominator);
            if (residue != 0) residues.emplace_back(static_cast<std::int32_t>(r), residue);
        }
        Cut best;
        double best_score = 0;
        for (int k = 1; k < std::min(denominator, 8); ++k) {
            Cut cut = combine(residues, denominator, k);
            if (cut.entries.empty()) continue;
            double norm = 0;
            for (const Cut::Entry& e : cut.entries) {
                norm += static_cast<double>(e.coefficient) * e.coefficient;
            }
            const double violation = cut.activity(x_) - static_cast<double>(cut.right_hand_side);
            const double score = violation / std::sqrt(norm);
            if (violation < options_.min_violation || score <= best_score) continue;
            best_score = score;
            best = std::move(cut);
        }
        return best;
    }

    std::int64_t work = 0;

private:
    Cut combine(const std::vector<std::pair<std::int32_t, std::int64_t>>& residues,
                std::int64_t denominator, int multiple) {
        touched_.clear();
        std::int64_t side = 0;
        for (const auto& [r, residue] : residues) {
            const std::int64_t p = (residue * multiple) % denominator;
            if (p == 0) continue;
            const Cut& row = relaxation_.row(r);
            side += p * row.right_hand_side;
            for (const Cut::Entry& e : row.entries) {
                if (sums_[e.column] == 0) touched_.push_back(e.column);
                sums_[e.column] += p * e.coefficient;
            }
            work += static_cast<std::int64_t>(row.entries.size());
        }
        std::sort(touched_.begin(), touched_.end());
        touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
        Cut cut;
        std::int64_t complemented = 0;
        bool is_good = true;
        for (std::int32_t c : touched_) {
            const std::int64_t sum = sums_[c];
            sums_[c] = 0;
            if (relaxation_.at_zero(c)) continue;
            std::int64_t coefficient = 0;
            if (relaxation_.at_one(c) || x_[c] > 1 - 1e-6) {
                // In terms of 1 - x: coefficient -sum, rounded down.
                side -= sum;
                coefficient = -floor_divide(-sum, denominator);
                complemented += coefficient;
            } else {
                coefficient = floor_divide(sum, denominator);
            }
            if (coefficient == 0) continue;
            is_good = is_good && std::abs(coefficient) <= options_.max_coefficient;
            cut.entries.push_back({c, static_cast<std::int32_t>(coefficient)});
        }
        cut.right_hand_side = floor_divide(side, denominator) + complemented;
        if (!is_good || cut.entries.size() > options_.max_entries) cut.entries.clear();
        return cut;
    }

    const Relaxation& relaxation_;
    const GomoryCutOptions& options_;
    std::span<const double> x_;
    std::vector<std::int64_t> sums_;
    std::vector<std::int32_t> touched_;
};

}  // namespace

std::vector<Cut> gomory_cuts(Relaxation& relaxation, const GomoryCutOptions& options,
                             std::int64_t& work) {
    const auto x = relaxation.x();
    std::vector<std::pair<double, std::int32_t>> fractional;
    for (std::int32_t c = 0; c < relaxation.column_count(); ++c) {
        const double distance = std::abs(x[c] - 0.5);
        if (distance < 0.49) fractional.emplace_back(distance, c);
    }
    std::stable_sort(fractional.begin(), fractional.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    if (fractional.size() > options.max_rows) fractional.resize(options.max_rows);
    std::vector<std::int32_t> columns;
    for (const auto& [distance, c] : fractional) columns.push_back(c);
    const auto inverse = relaxation.engine().inverse_rows(columns);
    CutBuilder builder(relaxation, options);
    std::vector<std::pair<double, Cut>> found;
    for (const auto& row : inverse) {
        if (row.empty()) continue;
        builder.work += static_cast<std::int64_t>(row.size()) * 2;
        const int denominator = common_denominator(row, options.max_denominator);
        if (denominator == 0) continue;
        Cut cut = builder.build(row, denominator);
        if (cut.entries.empty()) continue;
        double norm = 0;
        for (const Cut::Entry& e : cut.entries) {
            norm += static_cast<double>(e.coefficient) * e.coefficient;
        }
        const double violation = cut.activity(x) - static_cast<double>(cut.right_hand_side);
        found.emplace_back(violation / std::sqrt(norm), std::move(cut));
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (found.size() > options.max_cuts) found.resize(options.max_cuts);
    std::vector<Cut> cuts;
    for (auto& [score, cut] : found) cuts.push_back(std::move(cut));
    work += builder.work;
    return cuts;
}

}  // namespace labeling
