#pragma once

#include "adaptation/adaptation.h"
#include "adaptation/conflicts.h"
#include "adaptation/labeling_bridge.h"
#include "adaptation/working_network.h"

namespace fcn {

/// Writes down what an iteration saw: segments, nodes, conflicts.
void record_counts(IterationReport& iteration, const NetworkGraph& graph,
                   const ConflictResult& conflicts);

/// Writes down a problem's size and how it was solved.
void record_solve(IterationReport& iteration, const labeling::LabelingProblem& problem,
                  const labeling::SolveResult& result, const labeling::Solution& solution,
                  int labels);

}  // namespace fcn
