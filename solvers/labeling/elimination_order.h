#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "labeling/problem.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"

namespace labeling {

/// Order in which labels can be eliminated one after the other, and for each the later labels that
/// it is then joined with, by a conflict, a bonus, a rule or an eliminated label, in ascending
/// order: at most kMostNeighbours.
struct EliminationOrder {
    static constexpr std::size_t kMostNeighbours = 40;

    std::vector<Label> order;
    std::vector<std::vector<Label>> neighbours;  ///< per label
};

enum class EliminationRule {
    Degree,  ///< fewest neighbours first; near-linear
    Fill,    ///< fewest pairs of neighbours to join first; better and slower
};

/// nullopt when a label has too many neighbours or `control` stops. Deterministic.
std::optional<EliminationOrder> elimination_order(const LabelingProblem& problem,
                                                  const RowSystem& rows, RunControl& control,
                                                  EliminationRule rule);

}  // namespace labeling
