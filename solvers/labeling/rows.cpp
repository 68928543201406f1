#include "labeling/rows.h"

#include <algorithm>
#include <cstdlib>

namespace labeling {

RowSystem::RowSystem(const LabelingProblem& problem) {
    row_begin_.reserve(problem.rule_count() + 1);
    right_hand_sides_.reserve(problem.rule_count());
    min_activities_.reserve(problem.rule_count());
    max_coefficients_.reserve(problem.rule_count());
    for (const Rule& rule : problem.rules()) {
        if (rule.relation != Relation::GreaterEqual) add(rule, 1);
        if (rule.relation != Relation::LessEqual) add(rule, -1);
    }
    use_begin_.assign(static_cast<std::size_t>(problem.label_count()) + 1, 0);
    for (const Term& t : terms_) ++use_begin_[t.label + 1];
    for (std::size_t i = 1; i < use_begin_.size(); ++i) use_begin_[i] += use_begin_[i - 1];
    uses_.resize(terms_.size());
    std::vector<std::size_t> next(use_begin_.begin(), use_begin_.end() - 1);
    for (std::int32_t row = 0; row < row_count(); ++row) {
        for (const Term& t : terms(row)) uses_[next[t.label]++] = {row, t.coefficient};
    }
}

void RowSystem::add(const Rule& rule, int sign) {
    std::int64_t minimum = 0, largest = 0;
    for (const Term& t : rule.terms) {
        const std::int32_t coefficient = sign * t.coefficient;
        terms_.push_back({coefficient, t.label});
        minimum += std::min(coefficient, 0);
        largest = std::max<std::int64_t>(largest, std::abs(coefficient));
    }
    row_begin_.push_back(terms_.size());
    right_hand_sides_.push_back(sign * rule.right_hand_side);
    min_activities_.push_back(minimum);
    max_coefficients_.push_back(largest);
}

}  // namespace labeling
