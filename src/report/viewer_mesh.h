#pragma once

#include <nlohmann/json.hpp>

#include "meshing/measure.h"
#include "report/viewer_block.h"

namespace fcn {

/// Adds a mesh to a block; one with more than `face_limit` faces is decimated. The header entry has
/// its points and triangles, "name", "faces" (before decimation), "shown", and, unless `quality` is
/// null, the measures that a person compares.
nlohmann::json add_mesh(BlockWriter& block, const Mesh& mesh, const std::string& name,
                        const PointGrid& grid, std::size_t face_limit,
                        const TriangleQuality* quality);

}  // namespace fcn
