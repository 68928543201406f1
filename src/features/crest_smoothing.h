#pragma once

#include "features/crest_lines.h"

namespace fcn {

/// Takes the zigzag out of lines that is shorter than about twice the radius of the fits: crossings
/// slide along their mesh edges towards a smoothing spline. Ends, forks and bridges stay.
void smooth_lines(const MeshArrays& arrays, CrestGraph& graph);

/// Puts crossings closer to a vertex than `share` of their edge on it; points of one vertex become
/// one, and pieces without length go.
void snap_to_vertices(const MeshArrays& arrays, double share, CrestGraph& graph);

/// Where an edge is crossed: `t` along it from its first vertex.
void place_on_edge(const MeshArrays& arrays, int edge, double t, CrestPoint& point);

}  // namespace fcn
