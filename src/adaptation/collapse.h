#pragma once

#include <vector>

#include "adaptation/conflicts.h"
#include "adaptation/working_network.h"
#include "geometry/surface_queries.h"

namespace fcn {

/// Collapses the given short arcs, shortest first and only while their ends are closer than rmin,
/// each to its sharper end (paper section 5.3.3); the others are removed. Ends of arcs that move
/// are dragged smoothly and projected back to the surface, and lose their chains. Nodes of pinned
/// arcs do not move. Returns the number of collapses.
int collapse_short_arcs(WorkingNetwork& network, std::vector<int> arcs, const ScaleInterval& scale,
                        const SurfaceQueries& queries);

/// Short arcs that may collapse before the labeling: connected clusters of diameter < rmin, no
/// short segment of which is in conflict with a segment from outside, of which at most one node is
/// pinned, and whose arms, drawn from the merged node, enclose feasible angles.
std::vector<int> find_collapsible_clusters(const WorkingNetwork& network, const NetworkGraph& graph,
                                           const std::vector<Conflict>& conflicts,
                                           const ScaleInterval& scale);

}  // namespace fcn
