#pragma once

#include <nlohmann/json.hpp>

#include "meshing/measure.h"
#include "meshing/quad_mesh.h"
#include "meshing/quad_quality.h"
#include "report/viewer_block.h"

namespace fcn {

/// Adds a mesh to a block; one with more than `face_limit` faces is decimated. The header entry has
/// its points and triangles, "name", "faces" (before decimation), "shown", and, unless `quality` is
/// null, the measures that a person compares.
nlohmann::json add_mesh(BlockWriter& block, const Mesh& mesh, const std::string& name,
                        const PointGrid& grid, std::size_t face_limit,
                        const TriangleQuality* quality);

/// The same for quads: four corners a face, "sides" 4; the better diagonal joins the first and the
/// third. With more than half of `face_limit` faces they are shown as decimated triangles.
nlohmann::json add_quads(BlockWriter& block, const QuadMesh& mesh, const std::string& name,
                         const PointGrid& grid, std::size_t face_limit, const QuadQuality& quality);

}  // namespace fcn
