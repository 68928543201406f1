#pragma once

#include <vector>

#include "features/features.h"
#include "features/mesh_arrays.h"

namespace fcn {

/// Signed dihedral angle of each edge as far as it stands out from noise: the plain dihedral
/// where the surroundings are clean, the smaller of it and the angle between the mean normals of
/// the areas left and right of the edge where they are noisy; 0 where the two disagree in sign.
/// Edges whose plain dihedral stays below `low_angle` (radians) get their plain value.
/// Deterministic on any number of threads.
std::vector<double> robust_dihedrals(const MeshArrays& arrays, double low_angle, int threads = 1);

/// Is there no edge of comparable angle beside this one that runs along it? True of a crease, not
/// of the facets of a coarsely meshed curved surface.
bool is_isolated(const MeshArrays& arrays, const std::vector<double>& angles, int edge);

/// Hysteresis on `angles`: edges above the high angle and chains of edges above the low one that
/// continue them, convex and concave ones apart, not shorter than options.min_length and
/// `min_edge_count`, without crumbs of a few edges that end inside the surface.
std::vector<bool> sharp_edges(const MeshArrays& arrays, const std::vector<double>& angles,
                              const SharpOptions& options, int min_edge_count = 1);

}  // namespace fcn
