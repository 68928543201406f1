#pragma once

#include "meshing/quad_mesh.h"
#include "meshing/quad_smoothing.h"
#include "network/network.h"

namespace fcn {

struct QuadCurveOptions {
    double edge_length = 0;  ///< of the quads, > 0, mesh units
    double reach = 0.4;      ///< in edge lengths: farther vertices are not drawn to a curve
    /// Degrees that an edge may run away from a curve and still be drawn to it.
    double most_degrees = 30;
    double corner_degrees = 40;  ///< boundaries that turn by more have a corner there
};

/// What vertices of a quad mesh that was made without regard to the network may do: boundary
/// vertices stay on the boundary of `surface`, and its corners get a vertex each. Edges of the mesh
/// that run along an arc of the network are drawn to it, those nearest to its nodes to these; they
/// become the mesh's feature edges. Deterministic.
QuadConstraints draw_to_curves(QuadMesh& mesh, const Mesh& surface,
                               const FeatureCurveNetwork& network, const QuadCurveOptions& options);

}  // namespace fcn
