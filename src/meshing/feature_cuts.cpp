// Cuts of feature edges, which remeshing leaves alone otherwise: where a source asks for much
// shorter ones. A new vertex lies on the curve that the edge stands for, not on the edge, unless a
// face would turn over.
#include <algorithm>
#include <vector>

#include "meshing/crossing_guard.h"
#include "meshing/remeshing_steps.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kCutShare = 0.7;  ///< an edge is cut if its source asks for less than this of it
constexpr double kLeastShare = 0.25;  ///< of the edge's length, to either end
constexpr double kMaxTurn = 0.3;      ///< cosine between a face's normal before and after

/// Where edge h is cut: near the middle, on the curve.
Vec3 point_of_cut(const WorkingMesh& mesh, int h, const ReferenceSurface& curves) {
    const Vec3 &a = mesh.point(mesh.from(h)), &b = mesh.point(mesh.to(h));
    const Vec3 middle = 0.5 * (a + b);
    const double length = (b - a).norm();
    const ReferencePoint near = curves.closest(middle, Vec3::Zero(), 0.5 * length, -1);
    if (near.face < 0) return middle;
    const Vec3& p = near.position;
    if (std::min((p - a).norm(), (p - b).norm()) < kLeastShare * length) return middle;
    for (const int side : {h, mesh.twin(h)}) {
        if (side < 0) continue;
        const Vec3 &from = mesh.point(mesh.from(side)), &to = mesh.point(mesh.to(side)),
                   &apex = mesh.point(mesh.apex(side));
        const Vec3 normal = triangle_normal(from, to, apex);
        if (triangle_normal(from, p, apex).dot(normal) < kMaxTurn ||
            triangle_normal(p, to, apex).dot(normal) < kMaxTurn)
            return middle;
    }
    return p;
}

}  // namespace

std::size_t cut_features(WorkingMesh& mesh, const ReferenceSurface& curves,
                         const EdgeTarget& target) {
    std::vector<int> queue;
    for (int h = 0; h < mesh.halfedge_end(); ++h)
        if (mesh.is_first(h) && mesh.role(h) == EdgeRole::Feature) queue.push_back(h);
    CrossingGuard guard(mesh, target.length);
    std::size_t count = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const int h = queue[i];
        const Vec3 &a = mesh.point(mesh.from(h)), &b = mesh.point(mesh.to(h));
        if (target.curve_sources.limit(0.5 * (a + b)) > kCutShare * (b - a).norm()) continue;
        const int place = mesh.place(mesh.from(h));
        const Vec3 middle = 0.5 * (a + b), there = point_of_cut(mesh, h, curves);
        const int v = mesh.split(h, middle);
        guard.update_star(v);
        if (guard.allows_move(v, there)) mesh.set_point(v, there);
        guard.update_star(v);
        mesh.set_place(v, place);
        mesh.fix_cut(v);
        ++count;
    }
    mesh.compact();
    return count;
}

}  // namespace fcn
