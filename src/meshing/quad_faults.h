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

}  // namespace fcn
