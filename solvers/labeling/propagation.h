#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"
#include "labeling/rows.h"

namespace labeling {

/// Partial assignment of a problem, closed under its conflicts and under bounds consistency of its
/// rows, with a trail to go back. Work is proportional to the adjacency of the labels assigned.
class Propagator {
public:
    Propagator(const LabelingProblem& problem, const RowSystem& rows);

    static constexpr std::int8_t kFree = -1;
    std::int8_t value(Label i) const { return values_[i]; }
    bool is_free(Label i) const { return values_[i] == kFree; }
    std::span<const std::int8_t> values() const { return values_; }
    /// Labels assigned so far, in order.
    std::span<const Label> trail() const { return trail_; }
    Label free_count() const { return static_cast<Label>(values_.size() - trail_.size()); }

    /// Propagates the rows as they stand (to be called once at the start); false: infeasible.
    bool propagate_all();
    /// Assigns and propagates; false on a contradiction, after which only undo() may follow.
    bool assign(Label i, bool value);
    /// Takes back every assignment but the first `size`.
    void undo(std::size_t size);

    /// Adjacency entries touched so far.
    std::int64_t work() const { return work_; }
    std::int64_t activity_slack(std::int32_t row) const {
        return rows_.right_hand_side(row) - min_activities_[row];
    }

private:
    bool enqueue(Label i, bool value);
    bool propagate();
    bool tighten(std::int32_t row);

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    std::vector<std::int8_t> values_;
    std::vector<std::int64_t> min_activities_;
    std::vector<Label> trail_;
    std::size_t head_ = 0;     ///< trail entries before it are propagated
    std::size_t applied_ = 0;  ///< trail entries before it are in the activities
    std::int64_t work_ = 0;
};

}  // namespace labeling
