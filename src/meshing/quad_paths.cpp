// Lines of edges for curves. A map that follows a curve softly has lines of its grid beside it, one
// of them within half a quad. The path is the shortest one (Dijkstra 1959) over directed edges that
// go forward along the curve, where being away from the curve and pointing away from it cost extra.
// Two edges of one quad in a row are no step: the quad would be a triangle once both lie on the
// curve. So paths are straight at regular vertices, and a curve that crosses lines has none.
#include "meshing/quad_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

namespace fcn {
namespace {

constexpr double kAwayCost = 6;       ///< of an edge at the reach, in its length
constexpr double kLeastCosine = 0.8;  ///< of an edge and the curve beside it
constexpr double kLongestStep = 3;    ///< along the curve, in lengths of the edge
constexpr double kMissedCost = 3;     ///< of the curve beyond the path's ends, in its length
constexpr double kEndShare = 1.2;     ///< of the reach: a path may begin this far from the end

}  // namespace

QuadPaths::QuadPaths(const QuadMesh& mesh, double reach)
    : mesh_(mesh),
      reach_(reach),
      opposite_(opposite_halfedges(mesh)),
      out_(mesh.points.size()),
      is_boundary_(mesh.points.size(), false),
      is_taken_(mesh.points.size(), false) {
    for (int h = 0; h < static_cast<int>(opposite_.size()); ++h) {
        out_[at(from(h))].push_back(h);
        if (opposite_[at(h)] < 0) is_boundary_[at(from(h))] = is_boundary_[at(to(h))] = true;
    }
    for (int v = 0; v < static_cast<int>(mesh.points.size()); ++v)
        cells_[cell(mesh.points[at(v)])].push_back(v);
}

std::array<long, 3> QuadPaths::cell(const Vec3& p) const {
    return {std::lround(p[0] / reach_), std::lround(p[1] / reach_), std::lround(p[2] / reach_)};
}

template <class Visit>
void QuadPaths::visit_near(const Vec3& point, Visit&& visit) const {
    const auto [x, y, z] = cell(point);
    for (long i = x - 1; i <= x + 1; ++i)
        for (long j = y - 1; j <= y + 1; ++j)
            for (long k = z - 1; k <= z + 1; ++k) {
                const auto found = cells_.find({i, j, k});
                if (found == cells_.end()) continue;
                for (const int v : found->second) {
                    const double distance = (mesh_.points[at(v)] - point).norm();
                    if (distance <= reach_) visit(v, distance);
                }
            }
}

int QuadPaths::nearest(const Vec3& point) const {
    int best = -1;
    double least = 0;
    visit_near(point, [&](int v, double distance) {
        if (is_taken_[at(v)] || (best >= 0 && distance >= least)) return;
        best = v;
        least = distance;
    });
    return best;
}

QuadPaths::Sights QuadPaths::look_from(const SampledCurve& curve, int from, int to) const {
    Sights sights;
    const int count = curve.is_closed ? curve.last() : curve.last() + 1;
    for (int i = 0; i < count; ++i) {
        visit_near(curve.points[at(i)], [&](int v, double distance) {
            if (v == from || v == to || is_taken_[at(v)] || is_boundary_[at(v)]) return;
            const auto [it, is_new] = sights.try_emplace(v, Sight{distance, i});
            if (!is_new && distance < it->second.distance) it->second = {distance, i};
        });
    }
    const auto add_end = [&](int v, int parameter) {
        if (v >= 0)
            sights[v] = {(mesh_.points[at(v)] - curve.points[at(parameter)]).norm(), parameter};
    };
    add_end(from, 0);
    add_end(to, curve.last());
    return sights;
}

double QuadPaths::cost(const SampledCurve& curve, const Sights& sights, int h) const {
    const auto a = sights.find(from(h)), b = sights.find(to(h));
    if (a == sights.end() || b == sights.end()) return -1;
    const double way = curve.forward(a->second.parameter, b->second.parameter);
    if (!(way >= 1)) return -1;
    const Vec3 edge = mesh_.points[at(to(h))] - mesh_.points[at(from(h))];
    const double length = edge.norm();
    const double step = curve.length / curve.last();
    if (way * step > kLongestStep * length || way * step < length / kLongestStep) return -1;
    const Vec3 along = curve.at(a->second.parameter + way) - curve.at(a->second.parameter);
    const double cosine = along.stableNormalized().dot(edge) / length;
    if (!(cosine > kLeastCosine)) return -1;
    const double away = std::max(a->second.distance, b->second.distance) / reach_;
    return length * (1 + kAwayCost * away * away + (1 - cosine));
}

std::vector<int> QuadPaths::search(const SampledCurve& curve, const Sights& sights,
                                   const std::map<int, double>& starts,
                                   const std::map<int, double>& goals) const {
    std::map<int, std::pair<double, int>> reached;  // per halfedge: cost, the one before
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const auto reach = [&](int h, double before, int last) {
        const double own = cost(curve, sights, h);
        if (own < 0) return;
        const auto [it, is_new] = reached.try_emplace(h, before + own, last);
        if (!is_new && it->second.first <= before + own) return;
        it->second = {before + own, last};
        queue.push({before + own, h});
    };
    for (const auto& [v, missed] : starts)
        for (const int h : out_[at(v)]) reach(h, missed, -1);
    int best = -1;
    double least = 0;
    while (!queue.empty()) {
        const auto [sum, h] = queue.top();
        queue.pop();
        if (sum > reached.at(h).first) continue;
        const auto goal = goals.find(to(h));
        if (goal != goals.end() && (best < 0 || sum + goal->second < least)) {
            best = h;
            least = sum + goal->second;
        }
        if (is_boundary_[at(to(h))] || (curve.is_closed && goal != goals.end())) continue;
        const int other = opposite_[at(h)];
        const int left = to(next_in_quad(h));
        const int right = other < 0 ? -1 : from(previous_in_quad(other));
        for (const int next : out_[at(to(h))])
            if (to(next) != left && to(next) != right && to(next) != from(h)) reach(next, sum, h);
    }
    std::vector<int> way;
    for (int h = best; h >= 0; h = reached.at(h).second) way.push_back(h);
    std::reverse(way.begin(), way.end());
    return way;
}

QuadPaths::Path QuadPaths::find(const SampledCurve& curve, int from_vertex, int to_vertex) {
    const Sights sights = look_from(curve, from_vertex, to_vertex);
    std::map<int, double> starts, goals;  // what is missed of the curve there
    const double step = curve.length / curve.last();
    if (curve.is_closed) {
        int best = -1;
        for (const auto& [v, sight] : sights)
            if (best < 0 || sight.distance < sights.at(best).distance) best = v;
        if (best >= 0) starts[best] = goals[best] = 0;
    } else {
        for (const auto& [v, sight] : sights) {
            const double before = sight.parameter * step, after = curve.length - before;
            if (from_vertex < 0 && before <= kEndShare * reach_) starts[v] = kMissedCost * before;
            if (to_vertex < 0 && after <= kEndShare * reach_) goals[v] = kMissedCost * after;
        }
        if (from_vertex >= 0) starts[from_vertex] = 0;
        if (to_vertex >= 0) goals[to_vertex] = 0;
    }
    const std::vector<int> way = search(curve, sights, starts, goals);
    Path path;
    if (way.empty()) return path;
    path.vertices.push_back(from(way.front()));
    path.parameters.push_back(sights.at(from(way.front())).parameter);
    for (const int h : way) {
        const Sight& sight = sights.at(to(h));
        path.parameters.push_back(path.parameters.back() +
                                  curve.forward(sights.at(from(h)).parameter, sight.parameter));
        path.vertices.push_back(to(h));
    }
    for (const int v : path.vertices) take(v);
    return path;
}

}  // namespace fcn
