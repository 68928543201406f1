#pragma once

#include <vector>

#include "meshing/quad_mesh.h"

namespace fcn {

/// Takes out a quad near each of the places, so that there is a hole again where a short boundary
/// loop was closed (hole_filling.h). Quads at boundaries stay. Returns the number of holes that
/// could be made. O(quads) a hole. Deterministic.
int open_holes(QuadMesh& mesh, const std::vector<Vec3>& places);

}  // namespace fcn
