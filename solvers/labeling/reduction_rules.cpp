// Rules that say nothing, or nothing but conflicts. The labelings of a short row are enumerated
// under the conflicts: a row that none of them violates goes, a label that all feasible ones agree
// on is fixed, and a row that is violated only by pairs becomes conflicts of those pairs, which
// bounds and cliques can use. Two rows i <= k and k <= i make one label of two. A row goes too if
// another one with a common label is never satisfied without it: if the positive differences of the
// coefficients fit into the difference of the right-hand sides.
#include <algorithm>
#include <array>
#include <cstdint>

#include "labeling/reduction_state.h"

namespace labeling {
namespace {

constexpr std::size_t kLongestRow = 8;
constexpr std::size_t kMostUses = 200;

class RowReduction {
public:
    RowReduction(ReductionState& state, std::int32_t r)
        : state_(state), r_(r), row_(state.row(r)) {}

    bool reduce() { return (is_short() && reduce_short()) || drop_dominated(); }

private:
    using Set = std::uint32_t;
    static constexpr Set bit(std::size_t k) { return Set{1} << k; }

    bool is_short() const { return !row_.terms.empty() && row_.terms.size() <= kLongestRow; }

    bool reduce_short() {
        const std::size_t n = row_.terms.size();
        for (std::size_t k = 0; k < n; ++k) {
            for (std::size_t l = 0; l < k; ++l) {
                if (!state_.in_conflict(row_.terms[k].label, row_.terms[l].label)) continue;
                enemies_[k] |= bit(l);
                enemies_[l] |= bit(k);
            }
        }
        state_.work += static_cast<std::int64_t>(n * n + bit(n) / 4);
        enumerate(n);
        if (bad_count_ == 0) {
            state_.drop_row(r_);
            return true;
        }
        return fix_agreed(n) || make_conflicts(n) || merge_equal(n);
    }

    void enumerate(std::size_t n) {
        for (Set set = 0; set < bit(n); ++set) {
            std::int64_t activity = 0;
            bool is_allowed = true;
            for (std::size_t k = 0; k < n && is_allowed; ++k) {
                if ((set & bit(k)) == 0) continue;
                is_allowed = (enemies_[k] & set) == 0;
                activity += row_.terms[k].coefficient;
            }
            if (!is_allowed) continue;
            if (activity > row_.right_hand_side) {
                bad_[bad_count_++] = set;
                continue;
            }
            some_on_ |= set;
            some_off_ |= ~set;
            for (std::size_t k = 0; k < n; ++k) {
                if ((set & bit(k)) != 0) together_[k] |= set;
            }
        }
    }

    bool fix_agreed(std::size_t n) {
        bool is_fixed = false;
        const auto terms = row_.terms;
        for (std::size_t k = 0; k < n; ++k) {
            if ((some_on_ & bit(k)) == 0) {
                state_.fix(terms[k].label, false);
            } else if ((some_off_ & bit(k)) == 0) {
                state_.fix(terms[k].label, true);
            } else {
                continue;
            }
            is_fixed = true;
        }
        return is_fixed;
    }

    /// Every violating set holds a pair that no feasible set holds.
    bool make_conflicts(std::size_t n) {
        for (std::size_t b = 0; b < bad_count_; ++b) {
            bool has_pair = false;
            for (std::size_t k = 0; k < n; ++k) {
                const bool is_on = (bad_[b] & bit(k)) != 0;
                has_pair = has_pair || (is_on && (bad_[b] & ~together_[k]) != 0);
            }
            if (!has_pair) return false;
        }
        const auto terms = row_.terms;
        state_.drop_row(r_);
        for (std::size_t k = 0; k < n; ++k) {
            for (std::size_t l = 0; l < k; ++l) {
                const bool are_apart = (together_[k] & bit(l)) == 0 && (enemies_[k] & bit(l)) == 0;
                if (are_apart) state_.add_conflict(terms[l].label, terms[k].label);
            }
        }
        return true;
    }

    /// Index of the term that is on in the one set a row of two terms forbids; -1: another shape.
    static int leader(const ReductionState::Row& row) {
        if (row.terms.size() != 2) return -1;
        const std::int64_t a = row.terms[0].coefficient, b = row.terms[1].coefficient;
        const std::int64_t side = row.right_hand_side;
        if (side < 0 || a + b > side) return -1;
        return a > side ? 0 : b > side ? 1 : -1;
    }

    bool merge_equal(std::size_t n) {
        const int mine = leader(row_);
        if (n != 2 || mine < 0) return false;
        const Label first = row_.terms[0].label, second = row_.terms[1].label;
        for (const auto& use : state_.uses(first)) {
            const auto& other = state_.row(use.row);
            if (use.row == r_ || other.terms.size() != 2) continue;
            if (other.terms[0].label != first || other.terms[1].label != second) continue;
            if (leader(other) != 1 - mine) continue;
            state_.merge(first, second);
            return true;
        }
        return false;
    }

    bool drop_dominated() {
        if (row_.terms.empty()) return false;
        const Label rarest =
            std::min_element(row_.terms.begin(), row_.terms.end(),
                             [&](const Term& a, const Term& b) {
                                 return state_.uses(a.label).size() < state_.uses(b.label).size();
                             })
                ->label;
        const auto uses = state_.uses(rarest);
        if (uses.size() > kMostUses) return false;
        for (const auto& use : uses) {
            if (use.row == r_ || !implies(state_.row(use.row))) continue;
            state_.drop_row(r_);
            return true;
        }
        return false;
    }

    bool implies(const ReductionState::Row& other) {
        std::int64_t slack = row_.right_hand_side - other.right_hand_side;
        std::size_t k = 0;
        for (const Term& t : other.terms) {
            while (k < row_.terms.size() && row_.terms[k].label < t.label) {
                slack -= std::max(0, row_.terms[k++].coefficient);
            }
            std::int64_t difference = -static_cast<std::int64_t>(t.coefficient);
            if (k < row_.terms.size() && row_.terms[k].label == t.label) {
                difference += row_.terms[k++].coefficient;
            }
            slack -= std::max<std::int64_t>(0, difference);
        }
        for (; k < row_.terms.size(); ++k) slack -= std::max(0, row_.terms[k].coefficient);
        state_.work += static_cast<std::int64_t>(row_.terms.size() + other.terms.size());
        return slack >= 0;
    }

    ReductionState& state_;
    const std::int32_t r_;
    const ReductionState::Row& row_;
    std::array<Set, kLongestRow> enemies_{}, together_{};
    std::array<Set, std::size_t{1} << kLongestRow> bad_;
    std::size_t bad_count_ = 0;
    Set some_on_ = 0, some_off_ = 0;
};

}  // namespace

bool reduce_rule(ReductionState& state, std::int32_t row) {
    return RowReduction(state, row).reduce();
}

}  // namespace labeling
