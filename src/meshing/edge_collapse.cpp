// The second step of incremental remeshing (Botsch, Kobbelt 2004, section 3) and its feature rules:
// fixed vertices stay, vertices of a curve move along the curve only. A collapse is refused if it
// makes an edge too long, a needle, or a face that turns by more than a limit; the normal of a
// needle says nothing, so there the face across its far edge is asked.
//
// The chains of small edges that a network's segments were embedded as must end as single edges.
// With growing thresholds the faces beside a bent chain grow before the chain cuts its corners;
// what is left is collapsed at the end whatever the lengths around it. Where the link condition is
// in the way, some edge beside the chain joins already what the collapse would join: it is halved.
#include <algorithm>
#include <limits>
#include <utility>

#include "meshing/crossing_guard.h"
#include "meshing/remeshing_steps.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kMaxTurnFree = 0.5;   ///< cosine between a face's normal before and after
constexpr double kMaxTurnChain = 0.1;  ///< the same where a chain cuts a corner
constexpr double kNeedle = 1e-3;       ///< altitude over longest side below which normals are noise

struct Limits {
    double longest = 0;   ///< new edges may be this long, or as long as the longest old one
    double max_turn = 0;  ///< cosine
    double least_quality = 0;
};

/// Normal that a face at h, out of its vanishing corner, stands for.
Vec3 normal_before(const WorkingMesh& mesh, int h) {
    const auto shape = [&](int side) {
        const Vec3 &a = mesh.point(mesh.from(side)), &b = mesh.point(mesh.to(side)),
                   &c = mesh.point(mesh.apex(side));
        return std::pair(flatness_quality(a, b, c), triangle_normal(a, b, c));
    };
    const auto [quality, normal] = shape(h);
    if (quality > kNeedle) return normal;
    const int far = mesh.twin(WorkingMesh::next(h));
    if (far < 0) return normal;
    const auto [other_quality, other_normal] = shape(far);
    return other_quality > quality ? other_normal : normal;
}

bool keeps_faces(const WorkingMesh& mesh, int vanishing, int staying, const Limits& limits) {
    const Vec3 &here = mesh.point(vanishing), &there = mesh.point(staying);
    double longest = limits.longest * limits.longest;
    mesh.visit_neighbors(vanishing, [&](int v) {
        longest = std::max(longest, (mesh.point(v) - here).squaredNorm());
        return true;
    });
    const bool is_short_enough = mesh.visit_neighbors(
        vanishing, [&](int v) { return (mesh.point(v) - there).squaredNorm() <= longest; });
    if (!is_short_enough) return false;
    return mesh.visit_star(vanishing, [&](int h) {
        const int b = mesh.to(h), c = mesh.apex(h);
        if (b == staying || c == staying) return true;
        const Vec3 &pb = mesh.point(b), &pc = mesh.point(c);
        const double quality = flatness_quality(there, pb, pc);
        if (quality < limits.least_quality && quality < flatness_quality(here, pb, pc))
            return false;
        if (!(quality > 0)) return false;
        return triangle_normal(there, pb, pc).dot(normal_before(mesh, h)) >= limits.max_turn;
    });
}

bool try_collapse(WorkingMesh& mesh, CrossingGuard& guard, int h, int vanishing,
                  const Limits& limits) {
    const int staying = mesh.from(h) == vanishing ? mesh.to(h) : mesh.from(h);
    if (!mesh.can_collapse(h, vanishing) || !keeps_faces(mesh, vanishing, staying, limits) ||
        !guard.allows_collapse(h, vanishing))
        return false;
    mesh.collapse(h, vanishing);
    guard.update_star(staying);
    return true;
}

double squared_length(const WorkingMesh& mesh, int h) {
    return (mesh.point(mesh.to(h)) - mesh.point(mesh.from(h))).squaredNorm();
}

/// Free edges from `staying` to neighbours of `vanishing` that are not across edge h.
void collect_blocking(const WorkingMesh& mesh, int h, int vanishing, std::vector<int>& blocking) {
    if (mesh.is_fixed(vanishing)) return;
    const int staying = mesh.from(h) == vanishing ? mesh.to(h) : mesh.from(h);
    const int left = mesh.apex(h), right = mesh.twin(h) < 0 ? -1 : mesh.apex(mesh.twin(h));
    mesh.visit_neighbors(vanishing, [&](int v) {
        if (v == staying || v == left || v == right) return true;
        const int there = mesh.find_edge(staying, v);
        if (there >= 0 && !mesh.is_marked(there))
            blocking.push_back(std::max(there, mesh.twin(there)));
        return true;
    });
}

}  // namespace

std::size_t collapse_short_edges(WorkingMesh& mesh, const EdgeTarget& target, double share) {
    std::vector<std::pair<float, int>> queue;
    const auto is_short = [&](int h) {
        const double limit = share * target.of_edge(mesh, h);
        return squared_length(mesh, h) < limit * limit;
    };
    for (int h = 0; h < mesh.halfedge_end(); ++h)
        if (mesh.is_first(h) && !mesh.is_edge_resting(h) && is_short(h))
            queue.emplace_back(static_cast<float>(squared_length(mesh, h)), h);
    if (queue.empty()) return 0;
    std::sort(queue.begin(), queue.end());
    CrossingGuard guard(mesh, std::max(share, 0.5) * target.length);
    std::size_t count = 0;
    for (const auto& [square, h] : queue) {
        if (!mesh.is_halfedge_alive(h) || !is_short(h)) continue;
        const double longest = kLongestEdge * target.of_edge(mesh, h);
        const Limits limits{longest, mesh.is_marked(h) ? kMaxTurnChain : kMaxTurnFree, 0.02};
        if (try_collapse(mesh, guard, h, mesh.from(h), limits) ||
            try_collapse(mesh, guard, h, mesh.to(h), limits))
            ++count;
    }
    return count;
}

std::size_t straighten_chains(WorkingMesh& mesh, const EdgeTarget& target) {
    std::vector<std::pair<double, int>> queue;
    for (int h = 0; h < mesh.halfedge_end(); ++h)
        if (mesh.is_first(h) && mesh.role(h) == EdgeRole::Feature &&
            !(mesh.is_fixed(mesh.from(h)) && mesh.is_fixed(mesh.to(h))))
            queue.emplace_back(squared_length(mesh, h), h);
    if (queue.empty()) return 0;
    std::sort(queue.begin(), queue.end());
    const Limits limits{std::numeric_limits<double>::infinity(), kMaxTurnChain, 1e-4};
    CrossingGuard guard(mesh, target.length);
    std::size_t count = 0;
    for (const auto& [square, h] : queue)
        if (mesh.is_halfedge_alive(h) && (try_collapse(mesh, guard, h, mesh.from(h), limits) ||
                                          try_collapse(mesh, guard, h, mesh.to(h), limits)))
            ++count;
    if (count > 0) return count;
    std::vector<int> blocking;
    for (const auto& [square, h] : queue)
        for (const int end : {mesh.from(h), mesh.to(h)}) collect_blocking(mesh, h, end, blocking);
    std::sort(blocking.begin(), blocking.end());
    blocking.erase(std::unique(blocking.begin(), blocking.end()), blocking.end());
    for (const int h : blocking)
        mesh.split(h, 0.5 * (mesh.point(mesh.from(h)) + mesh.point(mesh.to(h))));
    return blocking.size();
}

}  // namespace fcn
