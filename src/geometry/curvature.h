#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// Per vertex: |kappa_max| >= |kappa_min|, unit directions tangent to the surface.
struct PrincipalCurvatures {
    std::vector<double> kappa_max;  ///< curvature of largest magnitude, 1/length, > 0 convex
    std::vector<double> kappa_min;
    std::vector<Vec3> direction_max;
    std::vector<Vec3> direction_min;
};

struct CurvatureOptions {
    /// Radius of the averaging ball in mesh units; 0 = each vertex's one-ring.
    double radius = 0.0;
    int threads = 1;
};

/// Principal curvatures from the shape operator averaged over a ball around each vertex
/// (Alliez, Cohen-Steiner, Devillers, Levy, Desbrun 2003: sum over edges of
/// beta(e) |e in B| e e^T / |B|, where kappa across an edge belongs to the other eigenvector).
/// The ball holds what is connected to the vertex inside it. Time O(V * faces per ball) while that
/// is at most 1000 on average; above, O(F + V) with the ball's border blurred by radius / 16. The
/// same bytes on any number of threads (<= 0: all there are).
PrincipalCurvatures principal_curvatures(const Mesh& mesh, const CurvatureOptions& options = {});

}  // namespace fcn
