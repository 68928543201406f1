#pragma once

#include "features/crest_lines.h"
#include "network/network.h"

namespace fcn {

/// Adds the lines of a graph as arcs. `node_of_vertex` names the nodes that stand on mesh vertices
/// already (-1: none): points on them become those. Samples between nodes are at least `spacing`
/// radii of the fits apart. Lines get patch ids from `first_line` on; returns the next free one.
int add_crest_arcs(const CrestGraph& graph, const std::vector<int>& node_of_vertex,
                   const std::string& source, int first_line, double spacing,
                   FeatureCurveNetwork& network);

}  // namespace fcn
