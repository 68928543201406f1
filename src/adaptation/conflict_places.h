#pragma once

#include <functional>
#include <vector>

#include "adaptation/adaptation.h"
#include "adaptation/conflicts.h"
#include "adaptation/segment_graph.h"

namespace fcn {

/// Conflicts with the places of their segments, for pictures: all of them or, if there are more
/// than `most`, an even selection. `weights` and `is_kept` go by segment; `origin_of` gives a
/// segment's arc of the initial network.
std::vector<ConflictPlace> conflict_places(const std::vector<Conflict>& conflicts,
                                           const SegmentGraph& graph,
                                           const std::vector<double>& weights,
                                           const std::vector<bool>& is_kept,
                                           const std::function<int(int)>& origin_of,
                                           std::size_t most);

}  // namespace fcn
