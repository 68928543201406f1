#pragma once

#include "meshing/quad_smoothing.h"

namespace fcn {

struct QuadTipOptions {
    QuadSmoothingOptions smoothing;
    double far = 0.35;            ///< in h: what is farther from the quads is reached for
    double least_jacobian = 0.2;  ///< of quads at the vertices that reach
    int rounds = 4;
};

/// Per vertex whether a quad at it has a scaled Jacobian below the least.
std::vector<bool> vertices_of_bad_quads(const QuadMesh& mesh, double least_jacobian);

/// Moves free vertices to vertices of the surface that are far from the quads, tips of horns that
/// smoothing slides down from, and smooths the others. Where quads get bad by it the vertex stays.
/// Returns the number of vertices that were moved. Deterministic.
int reach_tips(QuadMesh& mesh, const QuadConstraints& constraints, const Mesh& surface,
               const ReferenceSurface& reference, const QuadTipOptions& options);

}  // namespace fcn
