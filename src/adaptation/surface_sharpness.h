#pragma once

#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/surface_queries.h"

namespace fcn {

/// What the surface does around a point of a feature curve.
struct PointSharpness {
    /// Turning of the surface within `radius`, radians, >= 0: the dihedral angle of a crease;
    /// kappa pi radius / 2 on a smooth surface.
    double turning = 0;
    /// Largest |dihedral angle| (radians) of a mesh edge through the point along the tangent.
    double crease = 0;
};

/// Measures the turning of a surface at a scale. Built once per mesh; queries are const and
/// thread-safe. Memory: about 60 bytes an edge.
class SurfaceSharpness {
public:
    explicit SurfaceSharpness(const Mesh& mesh);

    /// Visits the faces connected to `at.face` inside the ball: O(faces in the ball).
    PointSharpness measure(const SurfacePoint& at, const Vec3& position, const Vec3& tangent,
                           double radius) const;

private:
    struct Edge {
        Vec3 from, to;
        double dihedral = 0;
    };
    std::vector<Edge> edges_;
    std::vector<std::array<int, 3>> face_edges_;
    std::vector<std::array<int, 3>> face_neighbours_;  ///< across face_edges_; -1 at boundaries
    double mean_edge_length_ = 0;
};

}  // namespace fcn
