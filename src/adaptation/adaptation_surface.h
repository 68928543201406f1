#pragma once

#include "adaptation/surface_sharpness.h"
#include "geometry/surface_queries.h"

namespace fcn {

/// What adaptation asks of a mesh at every scale: made once where there are several. Keeps a
/// reference to the mesh. Queries are const and thread-safe.
struct AdaptationSurface {
    explicit AdaptationSurface(const Mesh& mesh) : queries(mesh), sharpness(mesh) {}

    SurfaceQueries queries;
    SurfaceSharpness sharpness;
};

}  // namespace fcn
