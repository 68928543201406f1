#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"

namespace labeling {

/// The rules of a problem as rows  sum of terms <= right_hand_side  in CSR: >= is negated, = gives
/// two rows. Row order follows rule order.
class RowSystem {
public:
    struct Use {
        std::int32_t row = 0;
        std::int32_t coefficient = 0;
    };

    explicit RowSystem(const LabelingProblem& problem);

    std::int32_t row_count() const { return static_cast<std::int32_t>(right_hand_sides_.size()); }
    std::int64_t right_hand_side(std::int32_t row) const { return right_hand_sides_[row]; }
    std::span<const Term> terms(std::int32_t row) const {
        return {terms_.data() + row_begin_[row], row_begin_[row + 1] - row_begin_[row]};
    }
    /// Rows that contain the label, ascending.
    std::span<const Use> uses(Label i) const {
        return {uses_.data() + use_begin_[i], use_begin_[i + 1] - use_begin_[i]};
    }
    /// Sum of the negative coefficients: the smallest activity the row can have.
    std::int64_t min_activity(std::int32_t row) const { return min_activities_[row]; }
    /// Largest absolute coefficient.
    std::int64_t max_coefficient(std::int32_t row) const { return max_coefficients_[row]; }

private:
    void add(const Rule& rule, int sign);

    std::vector<std::size_t> row_begin_{0}, use_begin_;
    std::vector<Term> terms_;
    std::vector<Use> uses_;
    std::vector<std::int64_t> right_hand_sides_, min_activities_, max_coefficients_;
};

}  // namespace labeling
