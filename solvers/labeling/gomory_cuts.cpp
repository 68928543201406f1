// Gomory's mixed-integer cuts (1960) with exact arithmetic. A row of the tableau is a combination
// of the LP's rows; its multipliers, rounded to integers p over a common denominator D (a small one
// where that fits all of them, a large power of two otherwise), give the exact equation
//   sum_j a_j x_j + sum_r p_r s_r = b   (all over D; slacks s_r = b_r - a_r x are integers >= 0)
// and with R(a) = a mod D, R0 = R(b), G(a) = floor(a / D) (D - R0) + max(0, R(a) - R0) the valid
// inequality  sum_j G(a_j) x_j + sum_r G(p_r) s_r <= floor(b / D) (D - R0).  Columns at their upper
// bound are complemented first. Coefficients too large for a row are divided and rounded down,
// which keeps the cut valid because all variables are nonnegative. The tableau only suggests the
// multipliers: the cut holds whatever they are. Unlike with plain rounding, small errors of p
// change the cut little, so nothing depends on recovering the tableau exactly. Where large blocks
// of columns sit at one half, hundreds of tableau rows give one and the same cut: it counts once.
#include "labeling/gomory_cuts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace labeling {
namespace {

constexpr std::int64_t kCoarse = 60;
constexpr double kFine = 1 << 22;
constexpr std::int64_t kLargest = std::int64_t{1} << 18;

Int128 floor_divide(Int128 a, Int128 b) {
    const Int128 q = a / b;
    return q * b > a ? q - 1 : q;
}

/// Smallest D <= kCoarse with all D * inverse near integers, 0 if none.
std::int64_t common_denominator(const std::vector<double>& inverse) {
    for (std::int64_t d = 2; d <= kCoarse; ++d) {
        const auto scale = static_cast<double>(d);
        const bool fits = std::all_of(inverse.begin(), inverse.end(), [scale](double u) {
            return std::abs(u * scale - std::round(u * scale)) < 1e-6 * scale;
        });
        if (fits) return d;
    }
    return 0;
}

double efficacy(const Cut& cut, std::span<const double> x) {
    double norm = 0;
    for (const Cut::Entry& e : cut.entries) {
        norm += static_cast<double>(e.coefficient) * e.coefficient;
    }
    return (cut.activity(x) - static_cast<double>(cut.right_hand_side)) / std::sqrt(norm);
}

class CutBuilder {
public:
    CutBuilder(const Relaxation& relaxation, const GomoryCutOptions& options)
        : relaxation_(relaxation),
          options_(options),
          x_(relaxation.x()),
          sums_(relaxation.column_count(), 0),
          is_touched_(relaxation.column_count(), 0) {}

    /// The best cut of the multiples of one tableau row; empty when none is violated enough.
    Cut build(std::vector<double> inverse) {
        double coarsest = 1;
        for (std::size_t r = 0; r < inverse.size(); ++r) {
            const double scale = relaxation_.row_scale(static_cast<std::int32_t>(r));
            inverse[r] /= scale;
            if (inverse[r] != 0) coarsest = std::max(coarsest, scale);
        }
        std::int64_t denominator = coarsest > 1 ? 0 : common_denominator(inverse);
        if (denominator == 0) denominator = static_cast<std::int64_t>(kFine * coarsest);
        multipliers_.clear();
        for (std::size_t r = 0; r < inverse.size(); ++r) {
            const double scaled = inverse[r] * static_cast<double>(denominator);
            if (!(std::abs(scaled) < 1e15)) return {};
            const auto p = static_cast<std::int64_t>(std::llround(scaled));
            if (p != 0) multipliers_.push_back({static_cast<std::int32_t>(r), p});
        }
        Cut best;
        double best_efficacy = options_.min_efficacy;
        for (int k = 1; k <= options_.max_multiple; ++k) {
            Cut cut = combine(denominator, k);
            if (cut.entries.empty()) continue;
            const double e = efficacy(cut, x_);
            if (e <= best_efficacy) continue;
            best_efficacy = e;
            best = std::move(cut);
        }
        return best;
    }

    std::int64_t work = 0;

private:
    struct Multiplier {
        std::int32_t row;
        std::int64_t p;
    };

    bool is_complemented(std::int32_t c) const { return relaxation_.at_one(c) || x_[c] > 1 - 1e-7; }

    void add_row(const Cut& row, Int128 factor) {
        for (const Cut::Entry& e : row.entries) {
            if (is_touched_[e.column] == 0) {
                is_touched_[e.column] = 1;
                touched_.push_back(e.column);
            }
            sums_[e.column] += factor * e.coefficient;
        }
        work += static_cast<std::int64_t>(row.entries.size());
    }

    Cut combine(std::int64_t denominator, int multiple) {
        for (std::int32_t c : touched_) {
            sums_[c] = 0;
            is_touched_[c] = 0;
        }
        touched_.clear();
        Int128 side = 0;
        for (const Multiplier& m : multipliers_) {
            const Cut& row = relaxation_.row(m.row);
            side += Int128{m.p * multiple} * row.right_hand_side;
            add_row(row, m.p * multiple);
        }
        for (std::int32_t c : touched_) {
            if (!is_complemented(c)) continue;
            side -= sums_[c];
            sums_[c] = -sums_[c];
        }
        const Int128 whole = floor_divide(side, denominator);
        const auto rest = static_cast<std::int64_t>(side - whole * denominator);
        const double fraction = static_cast<double>(rest) / static_cast<double>(denominator);
        if (fraction < 0.02 || fraction > 0.98) return {};
        const std::int64_t complement = denominator - rest;
        auto rounded = [&](Int128 a) -> Int128 {
            const Int128 floor = floor_divide(a, denominator);
            const auto remainder = static_cast<std::int64_t>(a - floor * denominator);
            return floor * complement + std::max<std::int64_t>(0, remainder - rest);
        };
        for (std::int32_t c : touched_) sums_[c] = rounded(sums_[c]);
        Int128 cut_side = whole * complement;
        substitute_slacks(rounded, multiple, cut_side);
        return finished(cut_side);
    }

    /// Adds G(p) s with s = b_r - a_r x in terms of the columns, complemented ones included.
    template <typename Rounded>
    void substitute_slacks(const Rounded& rounded, int multiple, Int128& side) {
        for (const Multiplier& m : multipliers_) {
            const Int128 g = rounded(Int128{m.p * multiple});
            if (g == 0) continue;
            const Cut& row = relaxation_.row(m.row);
            side -= g * row.right_hand_side;
            for (const Cut::Entry& e : row.entries) {
                if (is_complemented(e.column)) {
                    sums_[e.column] += g * e.coefficient;
                    side += g * e.coefficient;
                } else {
                    sums_[e.column] -= g * e.coefficient;
                }
            }
            work += static_cast<std::int64_t>(row.entries.size());
        }
    }

    /// Makes the numbers small, undoes the complements; empty when the cut is too dense.
    Cut finished(Int128 side) {
        Int128 largest = 0;
        std::size_t entries = 0;
        for (std::int32_t c : touched_) {
            if (relaxation_.at_zero(c) || relaxation_.at_one(c)) sums_[c] = 0;
            largest = std::max(largest, sums_[c] < 0 ? -sums_[c] : sums_[c]);
            entries += sums_[c] != 0 ? 1 : 0;
        }
        if (largest == 0) return {};
        if (largest > kLargest) {
            const Int128 divisor = largest / kLargest + 1;
            side = floor_divide(side, divisor);
            entries = 0;
            for (std::int32_t c : touched_) {
                sums_[c] = floor_divide(sums_[c], divisor);
                entries += sums_[c] != 0 ? 1 : 0;
            }
        }
        if (entries > options_.max_entries || entries == 0) return {};
        std::sort(touched_.begin(), touched_.end());
        Cut cut;
        for (std::int32_t c : touched_) {
            auto coefficient = static_cast<std::int64_t>(sums_[c]);
            if (coefficient == 0) continue;
            if (is_complemented(c)) {
                side -= coefficient;
                coefficient = -coefficient;
            }
            cut.entries.push_back({c, static_cast<std::int32_t>(coefficient)});
        }
        cut.right_hand_side = static_cast<std::int64_t>(side);
        std::int64_t divisor = 0;
        for (const Cut::Entry& e : cut.entries) {
            divisor = std::gcd(divisor, std::int64_t{e.coefficient});
        }
        for (Cut::Entry& e : cut.entries) e.coefficient /= static_cast<std::int32_t>(divisor);
        cut.right_hand_side = static_cast<std::int64_t>(floor_divide(cut.right_hand_side, divisor));
        return cut;
    }

    const Relaxation& relaxation_;
    const GomoryCutOptions& options_;
    std::span<const double> x_;
    std::vector<Int128> sums_;
    std::vector<std::uint8_t> is_touched_;
    std::vector<std::int32_t> touched_;
    std::vector<Multiplier> multipliers_;
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
    CutBuilder builder(relaxation, options);
    std::vector<std::pair<double, Cut>> found;
    std::set<std::uint64_t> seen;
    for (const auto& row : relaxation.engine().inverse_rows(columns)) {
        builder.work += static_cast<std::int64_t>(row.size()) * 2;
        Cut cut = builder.build(row);
        if (cut.entries.empty() || !seen.insert(hash_of(cut)).second) continue;
        found.emplace_back(efficacy(cut, x), std::move(cut));
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
