#pragma once

#include "meshing/working_mesh.h"

namespace fcn {

/// Whether the smallest angle of a face lies between two marked edges.
bool is_between_curves(const WorkingMesh& mesh, int face);

/// Whether only the curves could change the smallest angle of a face: it lies between two marked
/// edges, or at a fixed vertex, the tip of a spike, with less than 90 degrees around it.
bool is_angle_forced(const WorkingMesh& mesh, int face);

}  // namespace fcn
