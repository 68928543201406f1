#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// A scalar property of a PLY file's vertices, as the file has them.
struct VertexValues {
    std::vector<Vec3> points;
    std::vector<double> values;  ///< as many
};

/// `content` is that of a PLY file (decompressed), `source` its name in messages. Throws InputError
/// with file, line and value, also where the vertices have no such property.
VertexValues read_ply_values(std::string_view content, const std::string& source,
                             const std::string& property);

}  // namespace fcn
