#pragma once

#include "adaptation/initial_state.h"
#include "adaptation/working_network.h"
#include "geometry/surface_queries.h"
#include "network/network.h"

namespace fcn {

/// The adapted network: nodes are the ends of segments, arcs keep their dense samples and the
/// initial arcs they came from, attributes (kind, pin, source, patches, dihedral) are those of the
/// origin with the largest share. `weights`, per graph segment, become segment weights.
FeatureCurveNetwork make_adapted_network(const FeatureCurveNetwork& initial,
                                         const WorkingNetwork& network, const NetworkGraph& graph,
                                         const std::vector<double>& weights,
                                         const SurfaceQueries& queries);

/// The initial arc with the largest share of the dense samples [first, last] of an arc.
int majority_origin(const WorkingArc& arc, int first, int last);

}  // namespace fcn
