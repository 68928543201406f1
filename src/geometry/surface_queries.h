#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

struct ClosestPoint {
    SurfacePoint surface;
    Vec3 position = Vec3::Zero();
    double distance = 0;
};

struct RayHit {
    SurfacePoint surface;
    Vec3 position = Vec3::Zero();
    double distance = 0;  ///< along the ray or segment from its origin
};

/// Closest-point, segment and ray queries on a mesh (AABB tree). Keeps a reference to the mesh,
/// which must outlive it unchanged. Queries are const and thread-safe.
class SurfaceQueries {
public:
    explicit SurfaceQueries(const Mesh& mesh);
    ~SurfaceQueries();
    SurfaceQueries(SurfaceQueries&&) noexcept;
    SurfaceQueries& operator=(SurfaceQueries&&) noexcept;

    ClosestPoint closest(const Vec3& point) const;
    /// The same if it is at most `reach` away, which is found out much faster where it is not.
    std::optional<ClosestPoint> closest_within(const Vec3& point, double reach) const;
    /// All faces that the closed segment meets, sorted by distance from `from`.
    std::vector<RayHit> intersect_segment(const Vec3& from, const Vec3& to) const;
    /// First hit at distance > min_distance; direction need not be unit, distance is in mesh units.
    std::optional<RayHit> first_hit(const Vec3& origin, const Vec3& direction,
                                    double min_distance = 0) const;
    const Mesh& mesh() const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace fcn
