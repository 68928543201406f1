#pragma once

#include "labeling/problem.h"
#include "labeling/run_control.h"

namespace labeling {

/// Upper bound on the value of any labeling from a clique cover of the labels' conflicts, each
/// bonus shared by its two labels. Rules are ignored. Time O(labels log labels + conflicts); what
/// is left when `control` is over counts in full. Never above sum_of_gains().
Value quick_clique_bound(const LabelingProblem& problem, RunControl& control);

}  // namespace labeling
