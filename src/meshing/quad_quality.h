#pragma once

#include <vector>

#include "meshing/quad_mesh.h"
#include "network/network.h"

namespace fcn {

/// Quality of quads. The scaled Jacobian of a corner is the sine of its angle about the direction
/// of the quad's area vector (half the cross product of its diagonals), that of a quad the least
/// of its corners'; a corner of 0 or less is inverted.
struct QuadQuality {
    std::size_t vertices = 0, faces = 0;
    double min_scaled_jacobian = 0, mean_scaled_jacobian = 0;
    std::size_t inverted_corners = 0;
    std::size_t inner_vertices = 0;
    double share_irregular = 0;  ///< of inner vertices that have other than four quads, [0, 1]
    /// Pairs of irregular inner vertices closer than the edge length asked for; 0 without one.
    std::size_t close_singularities = 0;
    double min_edge = 0, mean_edge = 0, max_edge = 0;  ///< mesh units
};

/// For meshes whose check_topology has no fault. `edge_length` h > 0, or 0: not known.
QuadQuality measure_quads(const QuadMesh& mesh, double edge_length = 0);

/// Inner vertices with other than four quads, ascending.
struct IrregularVertex {
    int vertex = -1;
    int valence = 0;  ///< quads around it; the index in quarters is 4 - valence
};
std::vector<IrregularVertex> irregular_vertices(const QuadMesh& mesh);

/// Angles between a network's curves and the nearest of the two directions of the quads under
/// them, degrees, over the length of the curves: a quad's directions at a point are those of its
/// parameter lines.
struct QuadAlignment {
    double mean_degrees = 0, max_degrees = 0;
    double share_over_10 = 0;  ///< of the curves' length, [0, 1]
    std::size_t samples = 0;
};

/// Every `sample_spacing` > 0 along segments, or dense arcs without segments. Throws InputError on
/// a mesh without faces or a bad spacing.
QuadAlignment measure_alignment(const QuadMesh& mesh, const FeatureCurveNetwork& network,
                                double sample_spacing);

}  // namespace fcn
