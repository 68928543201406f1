#include "geometry/mesh.h"

#include <cmath>

namespace fcn {

namespace {

/// Twice the area vector of a face.
Vec3 doubled_area_vector(const Mesh& mesh, FaceHandle face) {
    const auto [a, b, c] = face_vertices(mesh, face);
    const Vec3& origin = mesh.point(a);
    return (mesh.point(b) - origin).cross(mesh.point(c) - origin);
}

}  // namespace

std::array<VertexHandle, 3> face_vertices(const Mesh& mesh, FaceHandle face) {
    const HalfedgeHandle first = mesh.halfedge_handle(face);
    const HalfedgeHandle second = mesh.next_halfedge_handle(first);
    return {mesh.from_vertex_handle(first), mesh.to_vertex_handle(first),
            mesh.to_vertex_handle(second)};
}

Vec3 position(const Mesh& mesh, const SurfacePoint& point) {
    const auto [a, b, c] = face_vertices(mesh, FaceHandle(point.face));
    return point.barycentric[0] * mesh.point(a) + point.barycentric[1] * mesh.point(b) +
           point.barycentric[2] * mesh.point(c);
}

Vec3 face_normal(const Mesh& mesh, FaceHandle face) {
    const Vec3 area_vector = doubled_area_vector(mesh, face);
    const double length = area_vector.norm();
    return length > 0 ? Vec3(area_vector / length) : Vec3(Vec3::Zero());
}

double face_area(const Mesh& mesh, FaceHandle face) {
    return 0.5 * doubled_area_vector(mesh, face).norm();
}

BoundingBox bounding_box(const Mesh& mesh) {
    BoundingBox box;
    if (mesh.n_vertices() == 0) return box;
    box.min = box.max = mesh.point(VertexHandle(0));
    for (const auto vertex : mesh.vertices()) {
        box.min = box.min.cwiseMin(mesh.point(vertex));
        box.max = box.max.cwiseMax(mesh.point(vertex));
    }
    return box;
}

double dihedral_angle(const Mesh& mesh, EdgeHandle edge) {
    if (mesh.is_boundary(edge)) return 0.0;
    const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
    const HalfedgeHandle opposite = mesh.halfedge_handle(edge, 1);
    const Vec3 left = doubled_area_vector(mesh, mesh.face_handle(halfedge));
    const Vec3 right = doubled_area_vector(mesh, mesh.face_handle(opposite));
    const Vec3 direction =
        mesh.point(mesh.to_vertex_handle(halfedge)) - mesh.point(mesh.from_vertex_handle(halfedge));
    const double length = direction.norm();
    if (length == 0) return 0.0;
    // Seen along the edge the left face's normal turns counter-clockwise to the right one's where
    // convex.
    return std::atan2(left.cross(right).dot(direction) / length, left.dot(right));
}

}  // namespace fcn
