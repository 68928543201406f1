// Two samples of a polyline rarely name the same face, even where both lie on its border. What
// they touch is compared instead, so that points between them stay exactly on the line.

#include "features/surface_lines.h"

#include <algorithm>

namespace fcn {
namespace {

constexpr double kOnEdge = 1e-9;  ///< barycentric coordinate that is nothing but rounding

}  // namespace

SurfaceLines::SurfaceLines(const Mesh& mesh, const MeshArrays& arrays)
    : mesh_(mesh), arrays_(arrays), faces_(faces_of_vertices(arrays)) {}

std::vector<int> SurfaceLines::faces_at(const SurfacePoint& point) const {
    if (point.face < 0 || point.face >= arrays_.face_count()) return {};
    const Vec3& b = point.barycentric;
    for (int i = 0; i < 3; ++i) {
        if (b[i] < 1 - kOnEdge) continue;
        const int v = arrays_.face_vertices[point.face][i];
        return {faces_.begin(v), faces_.end(v)};
    }
    for (int i = 0; i < 3; ++i) {
        if (b[(i + 2) % 3] > kOnEdge) continue;
        const int other = arrays_.face_neighbors[point.face][i];
        if (other < 0) return {point.face};
        return {std::min(point.face, other), std::max(point.face, other)};
    }
    return {point.face};
}

SurfacePoint SurfaceLines::moved_to(const SurfacePoint& point, int face) const {
    SurfacePoint result;
    result.face = face;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            if (arrays_.face_vertices[face][k] == arrays_.face_vertices[point.face][i]) {
                result.barycentric[k] = point.barycentric[i];
            }
        }
    }
    result.barycentric /= result.barycentric.sum();
    return result;
}

ArcSample SurfaceLines::between(const ArcSample& a, const ArcSample& b, double t) const {
    if (t <= 0) return a;
    if (t >= 1) return b;
    ArcSample result;
    result.position = (1 - t) * a.position + t * b.position;
    const std::vector<int> other = faces_at(b.surface);
    for (int face : faces_at(a.surface)) {
        if (!std::ranges::binary_search(other, face)) continue;
        const Vec3 one = moved_to(a.surface, face).barycentric;
        result.surface = {face, (1 - t) * one + t * moved_to(b.surface, face).barycentric};
        return result;
    }
    return project(result.position);
}

ArcSample SurfaceLines::project(const Vec3& point) const {
    if (!queries_) queries_ = std::make_unique<SurfaceQueries>(mesh_);
    const ClosestPoint closest = queries_->closest(point);
    return {closest.position, closest.surface};
}

Vec3 SurfaceLines::normal(const SurfacePoint& point) const {
    Vec3 sum = Vec3::Zero();
    const std::vector<int> faces = faces_at(point);
    for (int face : faces) sum += arrays_.normals[face];
    return faces.empty() ? sum : Vec3(sum / static_cast<double>(faces.size()));
}

}  // namespace fcn
