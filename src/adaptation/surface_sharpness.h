#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
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
/// thread-safe. Memory: about 90 bytes an edge, and 7 more for each thread.
class SurfaceSharpness {
public:
    explicit SurfaceSharpness(const Mesh& mesh);

    /// Visits the faces connected to `at.face` inside the ball: O(faces in the ball).
    PointSharpness measure(const SurfacePoint& at, const Vec3& position, const Vec3& tangent,
                           double radius) const;

private:
    struct Edge {
        Vec3 from, unit;
        double length = 0, dihedral = 0;
    };
    /// What a walk has seen, without clearing anything between walks.
    struct Visit {
        std::vector<int> queue;
        std::vector<std::uint32_t> face_round;
        std::vector<std::uint32_t> edge_mark;  ///< twice the round, and 1 if it may be crossed
        std::uint32_t round = 0;

        void begin(std::size_t face_count, std::size_t edge_count);
        void add_face(int face);
        void add_edge(int edge, bool is_crossed) {
            edge_mark[static_cast<std::size_t>(edge)] = 2 * round + (is_crossed ? 1 : 0);
        }
        bool has_edge(int edge) const {
            return edge_mark[static_cast<std::size_t>(edge)] / 2 == round;
        }
        bool is_passable(int edge) const {
            return edge_mark[static_cast<std::size_t>(edge)] % 2 == 1;
        }
    };
    std::vector<Edge> edges_;
    std::vector<std::array<int, 3>> face_edges_;
    std::vector<std::array<int, 3>> face_neighbours_;  ///< across face_edges_; -1 at boundaries
    double mean_edge_length_ = 0;
    mutable tbb::enumerable_thread_specific<Visit> visits_;
};

}  // namespace fcn
