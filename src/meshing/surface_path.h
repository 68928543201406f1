#pragma once

#include <optional>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// A point of a surface by the simplex whose interior it lies in.
struct SimplexPoint {
    enum class Kind { Vertex, Edge, Face };
    Kind kind = Kind::Vertex;
    int index = -1;                   ///< of the vertex, edge or face
    double t = 0;                     ///< Edge: parameter from halfedge 0's origin, (0, 1)
    Vec3 barycentric = Vec3::Zero();  ///< Face: in the order of face_vertices()
};

Vec3 position(const Mesh& mesh, const SimplexPoint& point);

/// Faces whose closure holds the point, ascending.
std::vector<int> incident_faces(const Mesh& mesh, const SimplexPoint& point);

/// Whether some face's closure holds both; then the straight line between them is on the surface.
bool share_face(const Mesh& mesh, const SimplexPoint& a, const SimplexPoint& b);

/// The simplex a surface point lies on, where a point closer to a vertex or an edge than
/// `tolerance` (mesh units) and 5% of the face's size counts as lying on it.
SimplexPoint snap_to_simplex(const Mesh& mesh, const SurfacePoint& point, double tolerance);

/// Points strictly between `from` and `to` on a short path over the surface, so that consecutive
/// ones (ends included) share a face: the cut with the plane through both that stands on the
/// surface, or along mesh edges where that cut does not get there. nullopt: not connected.
std::optional<std::vector<SimplexPoint>> trace_path(const Mesh& mesh, const SimplexPoint& from,
                                                    const SimplexPoint& to);

}  // namespace fcn
