#include "labeling/search_state.h"

namespace labeling {

SearchState::SearchState(const LabelingProblem& problem, const RowSystem& rows,
                         std::span<const std::uint8_t> start)
    : problem_(problem),
      rows_(rows),
      labels_(problem.label_count(), 0),
      gains_(problem.weights().begin(), problem.weights().end()),
      blocker_counts_(problem.label_count(), 0) {
    for (std::int32_t row = 0; row < rows.row_count(); ++row) {
        excesses_.push_back(-rows.right_hand_side(row));
    }
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (start[i] != 0) apply(i);
    }
    suspects_.clear();
}

void SearchState::apply(Label i) {
    const auto neighbours = problem_.conflicts_of(i);
    const auto partners = problem_.bonuses_of(i);
    const auto uses = rows_.uses(i);
    work_ += static_cast<std::int64_t>(neighbours.size() + partners.size() + uses.size()) + 1;
    if (labels_[i] != 0) {
        labels_[i] = 0;
        value_ -= gains_[i];
        for (Label j : neighbours) --blocker_counts_[j];
        for (const auto& b : partners) gains_[b.label] -= b.value;
        for (const auto& use : uses) {
            excesses_[use.row] -= use.coefficient;
            if (use.coefficient < 0 && excesses_[use.row] > 0) suspects_.push_back(use.row);
        }
    } else {
        labels_[i] = 1;
        value_ += gains_[i];
        for (Label j : neighbours) ++blocker_counts_[j];
        for (const auto& b : partners) gains_[b.label] += b.value;
        for (const auto& use : uses) {
            excesses_[use.row] += use.coefficient;
            if (use.coefficient > 0 && excesses_[use.row] > 0) suspects_.push_back(use.row);
        }
    }
}

void SearchState::flip(Label i) {
    apply(i);
    log_.push_back(i);
}

void SearchState::commit() {
    log_.clear();
    suspects_.clear();
}

void SearchState::roll_back() {
    while (!log_.empty()) {
        apply(log_.back());
        log_.pop_back();
    }
    suspects_.clear();
}

}  // namespace labeling
