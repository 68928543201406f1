#pragma once

#include <vector>

#include "meshing/quad_mesh.h"
#include "meshing/reference_surface.h"

namespace fcn {

/// Where a quad mesh and the surface are far from each other.
struct QuadDistance {
    double largest = 0;        ///< of all samples
    std::vector<Vec3> places;  ///< on either, farther than asked for, farthest first, spread out
};

/// Samples: vertices and centres of the quads; vertices of `input`, and points of its edges
/// `spacing` apart. Places are those over `tolerance`, `spacing` from each other at least.
QuadDistance find_far_places(const QuadMesh& mesh, const Mesh& input,
                             const ReferenceSurface& reference, double tolerance, double spacing);

/// Vertices of a mesh and points of its edges `spacing` apart.
std::vector<Vec3> sample_points(const Mesh& mesh, double spacing);

/// A place where quads and surface are far from each other: on the surface, and the quad there.
struct FarPoint {
    double distance = 0;
    Vec3 position = Vec3::Zero();
    int quad = -1;
};

/// Both ways, from `points` of the surface to the quads and from points of the quads to the
/// surface: what is farther than `least`, the farthest first.
std::vector<FarPoint> far_points(const QuadMesh& mesh, const std::vector<Vec3>& points,
                                 const ReferenceSurface& reference, double least);

}  // namespace fcn
