// Dijkstra's algorithm over vertices, from both ends at once: two fronts of half the radius settle
// half of the vertices, and less where a feature leads from one to the other. A vertex is reached
// by straight steps from its last few predecessors too, not by mesh edges only, which would err by
// several times where the metric is strongly anisotropic (the idea of short-term vectors in Campen,
// Heistermann and Kobbelt 2013, "Practical anisotropic geodesy"). Straight steps do not cross from
// one front to the other; as the path only says where to look closer, that does not matter. A
// direction of search toward the other end pays nothing: the bound on what remains is a fifteenth
// of the distance, since a step along a feature may be that cheap.

#include "features/wire_vertices.h"

#include <algorithm>

#include "features/path_labels.h"

namespace fcn {
namespace {

constexpr int kPredecessors = 4;
constexpr double kStraightness = 0.7;  ///< of the steps that one straight step replaces

}  // namespace

VertexSearch::VertexSearch(const MeshArrays& arrays, const WireMetric& metric)
    : arrays_(arrays), metric_(metric) {
    const IndexRows edges = edges_of_vertices(arrays, std::vector<bool>(arrays.edge_count(), true));
    neighbors_.reserve(edges.values.size());
    for (int v = 0; v < arrays.vertex_count(); ++v) {
        for (const int* e = edges.begin(v); e != edges.end(v); ++e) {
            const auto [a, b] = arrays.edge_vertices[*e];
            const double length = arrays.edge_length(*e);
            neighbors_.push_back({a == v ? b : a, *e, length, length * metric.along(*e)});
        }
    }
    offsets_ = edges.offsets;
    for (Front& front : fronts_)
        front.labels.assign(arrays.vertex_count(), {kUnreached, 0, -1, -1});
}

void VertexSearch::start(Front& front, const std::vector<WireSeed>& seeds) {
    for (int v : front.reached) front.labels[v] = {kUnreached, 0, -1, -1};
    front.reached.clear();
    front.queue = {};
    for (const WireSeed& seed : seeds) reach(front, front, seed.vertex, {seed.cost, 0, -1, -1});
}

/// Of equal costs the lower parent stands, so that paths do not depend on the order of the queue.
void VertexSearch::reach(Front& front, const Front& other, int vertex, const Label& label) {
    Label& known = front.labels[vertex];
    if (label.cost > known.cost || (label.cost == known.cost && label.parent >= known.parent))
        return;
    if (label.cost < known.cost) {
        if (known.cost == kUnreached) front.reached.push_back(vertex);
        front.queue.emplace(label.cost, vertex);
    }
    known = label;
    if (&front == &other) return;
    const double total = label.cost + other.labels[vertex].cost;
    if (total < best_ || (total == best_ && vertex < meeting_)) {
        best_ = total;
        meeting_ = total < kUnreached ? vertex : -1;
    }
}

/// The cost of what is settled next.
double VertexSearch::least(Front& front) const {
    while (!front.queue.empty()) {
        const auto [cost, v] = front.queue.top();
        if (cost <= front.labels[v].cost) return cost;
        front.queue.pop();
    }
    return kUnreached;
}

/// Of the cheapest straight step that replaces the last few and the next, if that is less.
double VertexSearch::straight_cost(const Front& front, int vertex, const Neighbor& next,
                                   double least) const {
    const auto mean_across = [&](int edge, const Vec3& d) {
        const auto [f, g] = arrays_.edge_faces[edge];
        if (f < 0 || g < 0) return metric_.across(std::max(f, g), d);
        return (metric_.across(f, d) + metric_.across(g, d)) / 2;
    };
    double length = next.length;
    std::array<int, kPredecessors + 1> chain{next.edge};
    int u = vertex;
    for (int count = 1; count <= kPredecessors && front.labels[u].edge >= 0; ++count) {
        chain[count] = front.labels[u].edge;
        length += front.labels[u].length;
        u = front.labels[u].parent;
        const Vec3 d = arrays_.points[next.vertex] - arrays_.points[u];
        if (d.norm() < kStraightness * length) break;
        double sum = 0;
        for (int k = 0; k <= count; ++k) sum += mean_across(chain[k], d);
        least = std::min(least, front.labels[u].cost + sum / (count + 1));
    }
    return least;
}

void VertexSearch::expand(Front& front, const Front& other) {
    const auto [cost, v] = front.queue.top();
    front.queue.pop();
    for (int k = offsets_[v]; k < offsets_[v + 1]; ++k) {
        const Neighbor& next = neighbors_[k];
        // What is settled stays; nothing gets there for less.
        if (front.labels[next.vertex].cost <= cost) continue;
        const double value = straight_cost(front, v, next, cost + next.cost);
        // A straight step never goes back in time.
        reach(front, other, next.vertex, {std::max(value, cost), next.length, v, next.edge});
    }
}

std::vector<int> VertexSearch::path(const std::vector<WireSeed>& from,
                                    const std::vector<WireSeed>& to) {
    best_ = kUnreached;
    meeting_ = -1;
    start(fronts_[0], from);
    start(fronts_[1], to);
    for (const WireSeed& seed : from) {
        const double total = seed.cost + fronts_[1].labels[seed.vertex].cost;
        if (total < best_) meeting_ = seed.vertex;
        best_ = std::min(best_, total);
    }
    while (true) {
        const double first = least(fronts_[0]), second = least(fronts_[1]);
        if (first == kUnreached || second == kUnreached || first + second >= best_) break;
        const int side = first <= second ? 0 : 1;
        expand(fronts_[side], fronts_[1 - side]);
    }
    std::vector<int> vertices;
    if (meeting_ < 0) return vertices;
    for (const Front& front : fronts_) {
        for (int v = meeting_; v >= 0; v = front.labels[v].parent) vertices.push_back(v);
    }
    return vertices;
}

}  // namespace fcn
