#pragma once

#include <vector>

#include "labeling/problem.h"
#include "labeling/run_control.h"

namespace labeling {

/// Cliques of the conflict graph that together contain every conflict: greedy, each grown from the
/// first conflict not covered yet by the common neighbour with most uncovered conflicts inside.
/// Members ascend; order follows the conflicts. O(sum over cliques of their members' degrees).
/// Incomplete when `control` (may be null) is over.
std::vector<std::vector<Label>> conflict_clique_cover(const LabelingProblem& problem,
                                                      RunControl* control = nullptr);

}  // namespace labeling
