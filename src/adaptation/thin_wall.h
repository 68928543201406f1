#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/surface_queries.h"

namespace fcn {

/// Says whether a thin wall parts two points that are close in space: surface normals with dot
/// product <= -0.5 (those of any two faces within `touch` of the one point and the other, so that
/// no crease is mistaken for a wall, whichever normal one takes there), a surface distance of at
/// least `surface_distance`, and a wall thick enough to tell its sides apart (20 touch radii). The
/// distance is never overestimated: a path of that length stays inside a ball around the midpoint,
/// so the points are parted exactly when the faces in that ball do not connect them. Const and
/// thread-safe.
class ThinWallTest {
public:
    ThinWallTest(const Mesh& mesh, const SurfaceQueries& queries, double surface_distance,
                 double touch);
    bool operator()(const Vec3& a, const Vec3& b) const;

private:
    /// Faces within touch; empty on a boundary, where another sheet may begin (repair cuts surfaces
    /// that have no two sides, for one) and the closest face is chance.
    std::vector<int> faces_at(const ClosestPoint& point) const;
    bool is_connected_inside(int from, int to, const Vec3& center, double radius) const;

    const Mesh& mesh_;
    const SurfaceQueries& queries_;
    double surface_distance_;
    double touch_;
};

}  // namespace fcn
