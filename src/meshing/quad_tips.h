#pragma once

#include "meshing/quad_fitting.h"

namespace fcn {

/// Moves free vertices to samples of the surface that are far from the quads, one after the other,
/// and smooths around them; what makes quads bad is taken back. Returns the number of vertices that
/// were moved. Deterministic.
int reach_tips(QuadMesh& mesh, const QuadConstraints& constraints, const std::vector<Vec3>& samples,
               const ReferenceSurface& reference, const QuadFitOptions& options);

}  // namespace fcn
