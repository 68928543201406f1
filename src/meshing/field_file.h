#pragma once

#include <string>
#include <vector>

#include "meshing/cross_field.h"
#include "meshing/singularity_merging.h"

namespace fcn {

/// Unit vector of one arm of a face, in space; of all faces.
Vec3 arm_direction(const Mesh& mesh, const CrossField& field, FaceHandle face);
std::vector<Vec3> arm_directions(const Mesh& mesh, const CrossField& field);

/// A field as .rosy: the number of faces, the symmetry (4), one arm a face as x y z.
std::string rosy_text(const std::vector<Vec3>& arms);

/// A line a singularity: its vertex in the mesh (from 0), its index in quarters, x y z.
std::string singularity_text(const Mesh& mesh, const std::vector<Singularity>& singularities);

}  // namespace fcn
