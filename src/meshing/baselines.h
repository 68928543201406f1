#pragma once

#include <cstddef>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// The arcs of a network whose surface turns by `threshold` (radians, length-weighted mean of the
/// dihedral angle) and more; pinned arcs stay. Selection by curvature alone (figure 9).
FeatureCurveNetwork above_curvature(const FeatureCurveNetwork& network, double threshold);

/// Quadric error decimation to `vertex_count` vertices, or as near as topology lets it.
LoadedMesh decimate_by_quadrics(const LoadedMesh& mesh, std::size_t vertex_count);

/// The surface with detail below `length` filtered out by one implicit step of the heat flow of
/// its points; boundary vertices stay. Throws LogicError if the linear system cannot be solved.
LoadedMesh filter_detail(const LoadedMesh& mesh, double length);

}  // namespace fcn
