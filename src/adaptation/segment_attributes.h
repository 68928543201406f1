#pragma once

#include <vector>

#include "adaptation/conflicts.h"
#include "adaptation/initial_state.h"
#include "adaptation/weights.h"
#include "adaptation/working_network.h"

namespace fcn {

/// What samples [first, last] of an arc say about a segment of length `chord` between them.
SegmentAttributes attributes_of_stretch(const WorkingArc& arc, int first, int last, double chord,
                                        const std::vector<OriginAttributes>& origins);

/// One entry per segment of the graph.
std::vector<SegmentAttributes> attributes_of(const NetworkGraph& graph,
                                             const WorkingNetwork& network,
                                             const std::vector<OriginAttributes>& origins);

/// Segments that share a label: members of symmetry orbits, or whole curves when curves are the
/// unit; best mode splits groups at their own conflicts. A group per segment, -1 = alone; empty
/// without groups.
std::vector<int> label_groups(const NetworkGraph& graph, const WorkingNetwork& network,
                              const std::vector<OriginAttributes>& origins,
                              const std::vector<Conflict>& conflicts,
                              const AdaptationOptions& options);

}  // namespace fcn
