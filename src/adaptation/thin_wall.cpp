#include "adaptation/thin_wall.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "adaptation/point_distance.h"

namespace fcn {

namespace {

/// Points closer than this, in touch radii, are never taken for the two sides of a wall: which side
/// a projection finds would be chance.
constexpr double kUnclear = 20;

}  // namespace

ThinWallTest::ThinWallTest(const Mesh& mesh, const SurfaceQueries& queries, double surface_distance,
                           double touch)
    : mesh_(mesh), queries_(queries), surface_distance_(surface_distance), touch_(touch) {}

std::vector<int> ThinWallTest::faces_at(const ClosestPoint& point) const {
    const FaceHandle face(point.surface.face);
    for (const VertexHandle vertex : face_vertices(mesh_, face)) {
        if ((mesh_.point(vertex) - point.position).norm() > touch_) continue;
        if (mesh_.is_boundary(vertex)) return {};
        std::vector<int> faces;
        for (const FaceHandle other : mesh_.vf_range(vertex)) faces.push_back(other.idx());
        return faces;
    }
    std::vector<int> faces{face.idx()};
    for (const HalfedgeHandle halfedge : mesh_.fh_range(face)) {
        const Vec3& a = mesh_.point(mesh_.from_vertex_handle(halfedge));
        const Vec3& b = mesh_.point(mesh_.to_vertex_handle(halfedge));
        if (distance_to_segment(point.position, a, b) > touch_) continue;
        const FaceHandle other = mesh_.face_handle(mesh_.opposite_halfedge_handle(halfedge));
        if (!other.is_valid()) return {};
        faces.push_back(other.idx());
    }
    return faces;
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
    if ((a - b).norm() < kUnclear * touch_) return false;
    constexpr double kOpposite = -0.5;
    const std::vector<int> faces_at_p = faces_at(p), faces_at_q = faces_at(q);
    if (faces_at_p.empty() || faces_at_q.empty()) return false;
    for (int f : faces_at_p) {
        const Vec3 normal = face_normal(mesh_, FaceHandle(f));
        for (int g : faces_at_q) {
            if (normal.dot(face_normal(mesh_, FaceHandle(g))) > kOpposite) return false;
        }
    }
    const Vec3 center = (p.position + q.position) / 2;
    return !is_connected_inside(p.surface.face, q.surface.face, center, surface_distance_ / 2);
}

}  // namespace fcn
