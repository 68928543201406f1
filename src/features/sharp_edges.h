#pragma once

#include <vector>

#include "features/edge_chains.h"
#include "features/features.h"
#include "features/mesh_arrays.h"

namespace fcn {

/// Signed dihedral angles of the edges as far as they stand out from noise.
struct RobustDihedrals {
    std::vector<double> angles;       ///< radians, per edge
    std::vector<bool> is_noisy_edge;  ///< the angle is that of filtered normals
    std::vector<Vec3> normals;        ///< of faces, filtered where it is noisy; empty if nowhere
    double displacement = 0;          ///< of vertices by noise, mesh units; see FilteredNormals
    double residual = 0;              ///< of the filter, see FilteredNormals
};

/// The plain dihedrals where the surroundings are clean, those of filtered normals where they are
/// noisy. Only edges above `low_angle` (radians) tell noise. Near-linear; deterministic on any
/// number of threads.
RobustDihedrals robust_dihedrals(const MeshArrays& arrays, double low_angle, int threads = 1);

/// Do most of some thirty faces around `face` disagree with their neighbours as noise makes them?
/// `share` scales the thresholds. Never true of parts of fewer faces.
bool is_noisy_place(const MeshArrays& arrays, int face, double share = 1);

/// Number of lines of edges of comparable angle beside this one that run along it, counted up to
/// `most`.
int lines_beside(const MeshArrays& arrays, const std::vector<double>& angles, int edge, int most);

/// Is there no edge of comparable angle beside this one that runs along it? True of a crease, not
/// of the facets of a coarsely meshed curved surface.
bool is_isolated(const MeshArrays& arrays, const std::vector<double>& angles, int edge);

/// Hysteresis on the angles: edges above the high angle and chains of edges above the low one that
/// continue them, convex and concave ones apart, not shorter than options.min_length and
/// `min_edge_count`, without crumbs of a few edges that end inside the surface. Where there is
/// noise, what noise does to chains is undone (mend_chains()).
std::vector<bool> sharp_edges(const MeshArrays& arrays, const RobustDihedrals& dihedrals,
                              const SharpOptions& options, int min_edge_count = 1);

/// Takes the zigzag of noise out of arcs along mesh edges: their samples leave noisy edges by less
/// than an edge length. Nodes, sharp turns and arcs in clean places stay.
FeatureCurveNetwork straighten_noisy(const MeshArrays& arrays, const RobustDihedrals& dihedrals,
                                     const EdgeNetwork& edges);

}  // namespace fcn
