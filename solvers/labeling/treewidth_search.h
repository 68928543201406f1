#pragma once

#include <cstdint>
#include <optional>

#include "labeling/elimination_order.h"
#include "labeling/problem.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/tree_search.h"

namespace labeling {

struct TreewidthOptions {
    /// Estimated ticks above which the problem is called too wide.
    std::int64_t most_ticks = 0;
    /// Memory for tables; above, the problem is called too wide.
    std::size_t most_bytes = std::size_t{1} << 28;
};

struct TreewidthStatistics {
    std::int64_t solved = 0;   ///< problems
    std::int64_t entries = 0;  ///< of tables
    std::int64_t width = 0;    ///< largest number of labels that one depends on
};

/// Solves a problem of small width by dynamic programming over an elimination order, exactly and in
/// integers: bound == value, or bound == kNoValue when there is no solution. nullopt: too wide, or
/// `control` stopped it. Deterministic.
std::optional<TreeResult> treewidth_search(const LabelingProblem& problem, RunControl& control,
                                           const TreewidthOptions& options,
                                           TreewidthStatistics* statistics = nullptr);

/// The same by an order that is given, as elimination_order makes them.
std::optional<TreeResult> treewidth_search(const LabelingProblem& problem, const RowSystem& rows,
                                           const EliminationOrder& order, RunControl& control,
                                           const TreewidthOptions& options);

}  // namespace labeling
