#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_io.h"

namespace fcn::app {

/// A value per vertex of the mesh: a property of a PLY file's vertices, whose positions are looked
/// up, so that the order may be another; or a text of one number a line in the mesh's order, or of
/// four (x y z value), looked up too; from # on a line is comment. Throws InputError.
std::vector<double> read_importance(const std::string& path, const std::string& property,
                                    const LoadedMesh& mesh);

}  // namespace fcn::app
