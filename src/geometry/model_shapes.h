#pragma once

#include "geometry/model_parts.h"
#include "geometry/models.h"

namespace fcn {

ModelSurface make_box(const ModelOptions& options);
ModelSurface make_skyscraper(const ModelOptions& options);
ModelSurface make_ribs(const ModelOptions& options);
ModelSurface make_holes(const ModelOptions& options);
ModelSurface make_step(const ModelOptions& options);
ModelSurface make_steps(const ModelOptions& options);
ModelSurface make_thin_wall(const ModelOptions& options);

ModelSurface make_cylinder(const ModelOptions& options);
ModelSurface make_sphere(const ModelOptions& options);
ModelSurface make_torus(const ModelOptions& options);
ModelSurface make_superellipse_torus(const ModelOptions& options);
ModelSurface make_gear(const ModelOptions& options);
ModelSurface make_octaflower(const ModelOptions& options);
ModelSurface make_noisy_plane(const ModelOptions& options);

}  // namespace fcn
