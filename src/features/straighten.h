#pragma once

#include <vector>

#include "features/edge_chains.h"

namespace fcn {

struct StraightenOptions {
    double smoothing = 300;   ///< weight of squared second differences against displacements
    double max_shift = 1.25;  ///< of a sample, in local edge lengths
    double max_neighbor_share = 0.4;  ///< of the distance to the next arc
};

/// Smooths arcs that run along mesh edges, on the surface: samples leave their vertices by at most
/// about an edge. Nodes (but those of closed arcs alone at their node), samples on `is_crease_edge`
/// intervals and on the mesh boundary stay; nodes, arcs, kinds, patches and dihedrals are kept.
FeatureCurveNetwork straighten(const MeshArrays& arrays, const EdgeNetwork& edges,
                               const std::vector<bool>& is_crease_edge,
                               const StraightenOptions& options = {});

}  // namespace fcn
