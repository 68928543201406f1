#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// Triangles without connectivity: what is drawn need not be manifold.
struct TriangleArrays {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
};

TriangleArrays triangle_arrays(const Mesh& mesh);

/// At most `face_limit` triangles that look the same from where all of the mesh is seen. O(faces).
/// Deterministic. Not for computing: sheets closer than a cell of the grid fall together.
TriangleArrays decimate_for_display(const TriangleArrays& mesh, std::size_t face_limit);

}  // namespace fcn
