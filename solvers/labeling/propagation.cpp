#include "labeling/propagation.h"

#include <algorithm>

namespace labeling {

Propagator::Propagator(const LabelingProblem& problem, const RowSystem& rows)
    : problem_(problem), rows_(rows), values_(problem.label_count(), kFree) {
    min_activities_.reserve(rows.row_count());
    for (std::int32_t row = 0; row < rows.row_count(); ++row) {
        min_activities_.push_back(rows.min_activity(row));
    }
    trail_.reserve(problem.label_count());
}

bool Propagator::enqueue(Label i, bool value) {
    if (values_[i] != kFree) return values_[i] == static_cast<std::int8_t>(value);
    values_[i] = value ? 1 : 0;
    trail_.push_back(i);
    return true;
}

bool Propagator::propagate_all() {
    for (std::int32_t row = 0; row < rows_.row_count(); ++row) {
        if (!tighten(row)) return false;
    }
    return propagate();
}

bool Propagator::assign(Label i, bool value) { return enqueue(i, value) && propagate(); }

bool Propagator::propagate() {
    while (head_ < trail_.size()) {
        const Label i = trail_[head_++];
        const bool value = values_[i] == 1;
        // Activities first, for every queued label up to this one: undo() relies on applied_.
        const auto uses = rows_.uses(i);
        for (const auto& use : uses) {
            // The minimum assumed 1 for negative coefficients and 0 for positive ones.
            const std::int64_t c = use.coefficient;
            if (value ? c > 0 : c < 0) min_activities_[use.row] += c > 0 ? c : -c;
        }
        applied_ = head_;
        work_ += static_cast<std::int64_t>(uses.size()) + 1;
        if (value) {
            const auto neighbours = problem_.conflicts_of(i);
            work_ += static_cast<std::int64_t>(neighbours.size());
            for (Label j : neighbours) {
                if (!enqueue(j, false)) return false;
            }
        }
        for (const auto& use : uses) {
            if ((value ? use.coefficient > 0 : use.coefficient < 0) && !tighten(use.row)) {
                return false;
            }
        }
    }
    return true;
}

bool Propagator::tighten(std::int32_t row) {
    const std::int64_t slack = rows_.right_hand_side(row) - min_activities_[row];
    if (slack < 0) return false;
    if (slack >= rows_.max_coefficient(row)) return true;
    const auto terms = rows_.terms(row);
    work_ += static_cast<std::int64_t>(terms.size());
    for (const Term& t : terms) {
        if (values_[t.label] != kFree) continue;
        if (t.coefficient > slack && !enqueue(t.label, false)) return false;
        if (-static_cast<std::int64_t>(t.coefficient) > slack && !enqueue(t.label, true)) {
            return false;
        }
    }
    return true;
}

void Propagator::undo(std::size_t size) {
    while (trail_.size() > size) {
        const Label i = trail_.back();
        trail_.pop_back();
        if (trail_.size() < applied_) {
            const bool value = values_[i] == 1;
            for (const auto& use : rows_.uses(i)) {
                const std::int64_t c = use.coefficient;
                if (value ? c > 0 : c < 0) min_activities_[use.row] -= c > 0 ? c : -c;
            }
        }
        values_[i] = kFree;
    }
    head_ = std::min(head_, size);
    applied_ = std::min(applied_, size);
}

}  // namespace labeling
