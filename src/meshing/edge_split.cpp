// The first step of incremental remeshing (Botsch, Kobbelt 2004, section 3): no edge longer than
// 4/3 of the target. Longest first, so that the halves of a long edge come before shorter edges
// beside it, whose split would leave needles; for the same reason edges beside a longer feature are
// left, and those whose middle is a corner. Beside edges that are left the same points could be
// made for ever, by edges that get no shorter; so new edges may not be much longer than what they
// come of, and splits of what splits made have an end.
#include <algorithm>
#include <cstdint>
#include <queue>
#include <vector>

#include "meshing/remeshing_steps.h"

namespace fcn {
namespace {

constexpr double kTaken = 0.02;       ///< in targets: a middle this near a vertex
constexpr double kLonger = 1.5;       ///< share of an edge's length that new edges stay below
constexpr int kMostGenerations = 60;  ///< a factor of 2^30 in lengths, at two each

struct LongEdge {
    double square;  ///< length over target, squared
    int halfedge;
    bool operator<(const LongEdge& other) const {
        return square != other.square ? square < other.square : halfedge > other.halfedge;
    }
};

}  // namespace

std::size_t split_long_edges(WorkingMesh& mesh, const EdgeTarget& target) {
    std::priority_queue<LongEdge> queue;
    const auto square = [&](int h) {
        const double wanted = target.of_edge(mesh, h);
        return (mesh.point(mesh.to(h)) - mesh.point(mesh.from(h))).squaredNorm() /
               (wanted * wanted);
    };
    const auto is_beside_longer_feature = [&](int h) {
        for (const int side : {h, mesh.twin(h)})
            if (side >= 0)
                for (const int other : {WorkingMesh::next(side), WorkingMesh::prev(side)})
                    if (mesh.role(other) == EdgeRole::Feature && square(other) > square(h))
                        return true;
        return false;
    };
    // Beside long features flat triangles would breed others, each with its middle on an old
    // vertex.
    const auto is_splittable = [&](int h, const Vec3& middle) {
        const double least = kTaken * target.of_edge(mesh, h);
        const double most = kLonger * (mesh.point(mesh.to(h)) - mesh.point(mesh.from(h))).norm();
        for (const int side : {h, mesh.twin(h)}) {
            if (side < 0) continue;
            const double length = (mesh.point(mesh.apex(side)) - middle).norm();
            if (length < least || length > most) return false;
        }
        return true;
    };
    const auto consider = [&](int h) {
        if (mesh.role(h) == EdgeRole::Feature || mesh.is_edge_resting(h)) return;
        const double ratio = square(h);
        if (ratio > kLongestEdge * kLongestEdge * (1 + 1e-9)) queue.push({ratio, h});
    };
    for (int h = 0; h < mesh.halfedge_end(); ++h)
        if (mesh.is_first(h)) consider(h);
    std::size_t count = 0;
    std::vector<std::uint8_t> generation(static_cast<std::size_t>(mesh.vertex_end()), 0);
    const auto generation_after = [&](int h) {
        return 1 + std::max(generation[static_cast<std::size_t>(mesh.from(h))],
                            generation[static_cast<std::size_t>(mesh.to(h))]);
    };
    while (!queue.empty()) {
        const LongEdge edge = queue.top();
        queue.pop();
        // What is stale: edges that have been halved, and numbers that mean other edges now.
        if (square(edge.halfedge) != edge.square || is_beside_longer_feature(edge.halfedge))
            continue;
        const int h = edge.halfedge;
        const Vec3 point = 0.5 * (mesh.point(mesh.from(h)) + mesh.point(mesh.to(h)));
        const int after = generation_after(h);
        if (after > kMostGenerations || !is_splittable(h, point)) continue;
        const int middle = mesh.split(h, point);
        generation.push_back(static_cast<std::uint8_t>(after));
        ++count;
        mesh.visit_star(middle, [&](int out) {
            consider(out);
            consider(WorkingMesh::next(out));  // its number may be new
            const int last = WorkingMesh::prev(out);
            if (mesh.twin(last) < 0) consider(last);
            return true;
        });
    }
    return count;
}

}  // namespace fcn
