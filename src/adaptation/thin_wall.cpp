#include "adaptation/thin_wall.h"

#include <algorithm>
#include <unordered_set>

namespace fcn {

namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 d = b - a;
    const double squared = d.squaredNorm();
    const double t = squared > 0 ? std::clamp((p - a).dot(d) / squared, 0.0, 1.0) : 0.0;
    return (p - a - t * d).norm();
}

}  // namespace

ThinWallTest::ThinWallTest(const Mesh& mesh, const SurfaceQueries& queries, double surface_distance)
    : mesh_(mesh), queries_(queries), surface_distance_(surface_distance) {}

Vec3 ThinWallTest::normal_at(const SurfacePoint& point) const {
    // On an edge or vertex the mean of the faces there: a crease must not take one side's word.
    constexpr double kOnEdge = 1e-3;
    const FaceHandle face(point.face);
    const auto vertices = face_vertices(mesh_, face);
    Vec3 normal = face_normal(mesh_, face);
    for (int k = 0; k < 3; ++k) {
        if (point.barycentric[k] > 1 - kOnEdge) {
            normal.setZero();
            for (const FaceHandle other : mesh_.vf_range(vertices[k])) {
                normal += face_normal(mesh_, other);
            }
            return normal.normalized();
        }
    }
    for (const HalfedgeHandle halfedge : mesh_.fh_range(face)) {
        const VertexHandle opposite = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(halfedge));
        for (int k = 0; k < 3; ++k) {
            if (vertices[k] != opposite || point.barycentric[k] >= kOnEdge) continue;
            const FaceHandle other = mesh_.face_handle(mesh_.opposite_halfedge_handle(halfedge));
            if (other.is_valid()) normal += face_normal(mesh_, other);
        }
    }
    return normal.normalized();
}

bool ThinWallTest::is_connected_inside(int from, int to, const Vec3& center, double radius) const {
    std::vector<int> queue{from};
    std::unordered_set<int> seen{from};
    for (std::size_t head = 0; head < queue.size(); ++head) {
        if (queue[head] == to) return true;
        for (const HalfedgeHandle halfedge : mesh_.fh_range(FaceHandle(queue[head]))) {
            const Vec3& a = mesh_.point(mesh_.from_vertex_handle(halfedge));
            const Vec3& b = mesh_.point(mesh_.to_vertex_handle(halfedge));
            if (distance_to_segment(center, a, b) > radius) continue;
            const FaceHandle next = mesh_.face_handle(mesh_.opposite_halfedge_handle(halfedge));
            if (next.is_valid() && seen.insert(next.idx()).second) queue.push_back(next.idx());
        }
    }
    return false;
}

bool ThinWallTest::operator()(const Vec3& a, const Vec3& b) const {
    const ClosestPoint p = queries_.closest(a);
    const ClosestPoint q = queries_.closest(b);
    if (p.surface.face < 0 || q.surface.face < 0) return false;
    if (normal_at(p.surface).dot(normal_at(q.surface)) > -0.5) return false;
    const Vec3 center = (p.position + q.position) / 2;
    return !is_connected_inside(p.surface.face, q.surface.face, center, surface_distance_ / 2);
}

}  // namespace fcn
