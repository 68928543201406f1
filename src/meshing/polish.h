#pragma once

#include "geometry/surface_queries.h"
#include "meshing/marked_mesh.h"

namespace fcn {

struct PolishOptions {
    double edge_length = 0;                  ///< target L, > 0
    double good_angle = 0.5235987755982988;  ///< radians (30 degrees): triangles above it are left
    int max_rounds = 8;
};

/// Improves the triangles whose smallest angle is under `good_angle`: every change raises the
/// smallest angle around it. Marked edges, their vertices and all fixed vertices stay; moved
/// vertices lie on the reference surface. Deterministic.
MarkedMesh polish(const MarkedMesh& input, const SurfaceQueries& reference,
                  const PolishOptions& options);

}  // namespace fcn
