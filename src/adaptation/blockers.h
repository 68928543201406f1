#pragma once

#include <functional>
#include <vector>

#include "adaptation/conflicts.h"
#include "adaptation/labeling_bridge.h"
#include "labeling/problem.h"
#include "network/network.h"

namespace fcn {

/// What blockers, labels of `problem`, are to the dropped `segment`: weights, arcs of the initial
/// network, and the conflict with it. `origin_of` gives a segment's arc of the initial network.
std::vector<Blocker> describe_blockers(const std::vector<int>& labels, int segment,
                                       const LabelingBridge& bridge,
                                       const ConflictResult& conflicts,
                                       const labeling::LabelingProblem& problem,
                                       const std::function<int(int)>& origin_of);

}  // namespace fcn
