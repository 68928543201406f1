#pragma once

#include <memory>
#include <vector>

#include "features/mesh_arrays.h"
#include "geometry/surface_queries.h"
#include "network/network.h"

namespace fcn {

/// Points and normals along polylines on a mesh, whether they run on edges or across faces. Keeps
/// references. For one thread: a closest-point tree is built when it is first needed.
class SurfaceLines {
public:
    SurfaceLines(const Mesh& mesh, const MeshArrays& arrays);

    /// The point at t in [0, 1] between two samples: on the straight line where both lie on one
    /// face, else projected to the surface.
    ArcSample between(const ArcSample& a, const ArcSample& b, double t) const;
    /// The closest surface point.
    ArcSample project(const Vec3& point) const;
    /// Faces that the point touches: one, two on an edge, a fan at a vertex; none if unknown.
    std::vector<int> faces_at(const SurfacePoint& point) const;
    /// Mean of the normals of the faces that it touches (not of unit length); zero if unknown.
    Vec3 normal(const SurfacePoint& point) const;

private:
    /// Coordinates of the point in another face that it touches.
    SurfacePoint moved_to(const SurfacePoint& point, int face) const;

    const Mesh& mesh_;
    const MeshArrays& arrays_;
    IndexRows faces_;
    mutable std::unique_ptr<SurfaceQueries> queries_;
};

}  // namespace fcn
