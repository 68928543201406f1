#pragma once

#include <vector>

#include "geometry/surface_queries.h"
#include "meshing/quad_mesh.h"
#include "network/network.h"
#include "report/picture.h"

namespace fcn {

using Polyline = std::vector<Vec3>;

/// Held by the input or by the user: drawn in a colour of its own.
bool is_pinned(const NetworkArc& arc);

Polyline polyline_of(const NetworkArc& arc);

/// A chord in `pieces` >= 1 pieces as it lies on the surface; where the surface is far away, the
/// chord itself.
Polyline chord_on_surface(const Vec3& from, const Vec3& to, const SurfaceQueries& surface,
                          int pieces);

/// The edges of quads as thin lines.
PictureLayer quad_edges(const QuadMesh& mesh);

/// A polyline as it lies on the surface, in pieces of at most `finest`.
Polyline laid_on_surface(const Polyline& points, const SurfaceQueries& surface, double finest);

/// The polyline without points that lie within `tolerance` of what is left; ends stay.
Polyline simplified(const Polyline& points, double tolerance);

}  // namespace fcn
