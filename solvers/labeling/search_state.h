#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"
#include "labeling/rows.h"

namespace labeling {

/// A 0/1 labeling with incremental gains, conflict counts and row activities, and a log that takes
/// flips back. Conflicts and rows may be violated between the flips of one transaction.
class SearchState {
public:
    SearchState(const LabelingProblem& problem, const RowSystem& rows,
                std::span<const std::uint8_t> start);

    bool is_on(Label i) const { return labels_[i] != 0; }
    std::span<const std::uint8_t> labels() const { return labels_; }
    Value value() const { return value_; }
    /// Weight of i plus its bonuses to labels that are on (i itself may be on or off).
    Value gain(Label i) const { return gains_[i]; }
    /// How many conflict partners of i are on.
    std::int32_t blocker_count(Label i) const { return blocker_counts_[i]; }
    std::int64_t excess(std::int32_t row) const { return excesses_[row]; }

    void flip(Label i);

    /// Flips since the last commit(), in order.
    std::span<const Label> log() const { return log_; }
    void commit();
    void roll_back();

    /// Rows that a flip since the last commit() pushed over their right-hand side; entries may have
    /// been mended since. The caller pops.
    std::vector<std::int32_t>& suspects() { return suspects_; }

    /// Adjacency entries touched so far.
    std::int64_t work() const { return work_; }

private:
    void apply(Label i);

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    std::vector<std::uint8_t> labels_;
    std::vector<Value> gains_;
    std::vector<std::int32_t> blocker_counts_;
    std::vector<std::int64_t> excesses_;  ///< activity - right-hand side; violated when > 0
    std::vector<Label> log_;
    std::vector<std::int32_t> suspects_;
    Value value_ = 0;
    std::int64_t work_ = 0;
};

}  // namespace labeling
