#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/narrow_order.h"
#include "labeling/problem.h"
#include "labeling/random.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"

namespace labeling {

struct MergeStatistics {
    std::int64_t merges = 0;    ///< calls
    std::int64_t parts = 0;     ///< solved
    std::int64_t improved = 0;  ///< parts
    std::int64_t given_up = 0;  ///< labels that kept their value, or a part would be too wide
};

/// Searches the labelings that take the value of one of several labelings at every label, by
/// dynamic programming. Where the labels in question are joined too widely, some keep their
/// present value, others each time. Deterministic per seed. Memory: some 20 bytes per label.
class SolutionMerger {
public:
    using Labels = std::vector<std::uint8_t>;

    /// All must outlive the merger.
    SolutionMerger(const LabelingProblem& problem, const RowSystem& rows, RunControl& control,
                   std::uint64_t seed);

    /// Never makes `best`, which must be feasible, worse. The others need not be feasible.
    void merge(Solution& best, std::span<const Labels> others);

    MergeStatistics statistics;

private:
    void merge_freed(Solution& best, std::vector<Label> free);
    void drop_blocked(const Solution& best, std::vector<Label>& free);
    std::vector<std::vector<Label>> parts(const Solution& best, std::span<const Label> free);
    bool solve(Solution& best, std::span<const Label> members, std::size_t most_neighbours);
    LabelGraph graph(const Solution& best, std::span<const Label> members);
    LabelingProblem extract(const Solution& best, std::span<const Label> members);
    /// Some values of the free labels would violate it.
    bool is_open(std::int32_t row, const Solution& best) const;
    void release(Label i);
    bool is_free(Label i) const { return local_[i] >= 0; }
    Label find(Label i);
    void join(Label i, Label j);
    bool charge();

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    RunControl& control_;
    Random random_;
    std::vector<Label> parent_, local_, part_of_;
    std::int64_t work_ = 0;
};

}  // namespace labeling
