// Dijkstra's algorithm among the faces of a band. Nodes are the vertices and evenly spaced points
// on the edges (Steiner points); within a face every two nodes are joined by a straight step, along
// an edge at the edge's own cost.

#include <algorithm>
#include <array>

#include "features/path_labels.h"
#include "features/wire_search.h"

namespace fcn {

/// Numbers the vertices and edges of the band; vertices are the first nodes.
class WireSearch::Band {
public:
    Band(WireSearch& search, const std::vector<int>& faces, int per_edge)
        : search_(search), arrays_(search.arrays_), per_edge_(per_edge), faces_(faces) {
        for (int f : faces) {
            search_.face_mark_[f] = 0;
            for (int v : arrays_.face_vertices[f]) number(v, search_.vertex_mark_, vertices_);
            for (int e : arrays_.face_edges[f]) number(e, search_.edge_mark_, edges_);
        }
        vertex_count_ = static_cast<int>(vertices_.size());
        for (int v : vertices_) positions_.push_back(arrays_.points[v]);
        for (int e : edges_) {
            const auto [a, b] = arrays_.edge_vertices[e];
            for (int k = 0; k < per_edge; ++k)
                positions_.push_back((1 - place(k)) * arrays_.points[a] +
                                     place(k) * arrays_.points[b]);
        }
    }
    ~Band() {
        for (int f : faces_) search_.face_mark_[f] = -1;
        for (int v : vertices_) search_.vertex_mark_[v] = -1;
        for (int e : edges_) search_.edge_mark_[e] = -1;
    }
    Band(const Band&) = delete;
    Band& operator=(const Band&) = delete;

    WirePath run(const WirePoint& from, const WirePoint& to) {
        PathLabels labels(static_cast<int>(positions_.size()));
        for (int f : search_.faces_at(from)) {
            if (search_.face_mark_[f] < 0) continue;
            list_nodes(f);
            for (const FaceNode& node : nodes_)
                labels.reach(node.node, search_.step(f, from, point(node.node)), -1);
        }
        goal_ = search_.faces_at(to);
        best_ = search_.cost_between(from, to);
        while (!labels.queue.empty()) {
            const auto [cost, u] = labels.queue.top();
            labels.queue.pop();
            if (cost > labels.cost[u]) continue;
            if (cost >= best_) break;
            if (u < vertex_count_) {
                const IndexRows& fans = search_.faces_;
                const int v = vertices_[u];
                for (const int* f = fans.begin(v); f != fans.end(v); ++f) leave(*f, u, to, labels);
            } else {
                for (int f : arrays_.edge_faces[edges_[(u - vertex_count_) / per_edge_]])
                    if (f >= 0) leave(f, u, to, labels);
            }
        }
        WirePath path;
        if (best_ == kUnreached) return path;
        path.cost = best_;
        path.points.push_back(to);
        for (int u = last_; u >= 0; u = labels.before[u]) path.points.push_back(point(u));
        path.points.push_back(from);
        std::ranges::reverse(path.points);
        return path;
    }

private:
    struct FaceNode {
        int node = -1;
        int sides = 0;  ///< bits of the face's edges that it lies on
    };

    static void number(int index, std::vector<int>& marks, std::vector<int>& list) {
        if (marks[index] >= 0) return;
        marks[index] = static_cast<int>(list.size());
        list.push_back(index);
    }

    double place(int k) const { return (k + 1.0) / (per_edge_ + 1); }

    WirePoint point(int node) const {
        if (node >= vertex_count_) {
            const int on_edges = node - vertex_count_;
            return search_.on_edge(edges_[on_edges / per_edge_], place(on_edges % per_edge_));
        }
        const int v = vertices_[node];
        return search_.point_at(surface_point_of_vertex(arrays_, v, *search_.faces_.begin(v)));
    }

    void list_nodes(int f) {
        nodes_.clear();
        for (int i = 0; i < 3; ++i) {
            const int v = arrays_.face_vertices[f][i], e = arrays_.face_edges[f][i];
            nodes_.push_back({search_.vertex_mark_[v], 1 << i | 1 << (i + 2) % 3});
            const int first = vertex_count_ + search_.edge_mark_[e] * per_edge_;
            for (int k = 0; k < per_edge_; ++k) nodes_.push_back({first + k, 1 << i});
        }
    }

    /// Relaxes all steps from a settled node within one face.
    void leave(int f, int u, const WirePoint& to, PathLabels& labels) {
        if (search_.face_mark_[f] < 0) return;
        const double cost = labels.cost[u];
        if (std::ranges::binary_search(goal_, f)) {
            const double total = cost + search_.step(f, point(u), to);
            if (total < best_) last_ = u;
            best_ = std::min(best_, total);
        }
        list_nodes(f);
        int sides = 0;
        for (const FaceNode& node : nodes_)
            if (node.node == u) sides = node.sides;
        for (const FaceNode& node : nodes_) {
            if (labels.cost[node.node] <= cost) continue;  // settled
            const Vec3 d = positions_[node.node] - positions_[u];
            const int shared = node.sides & sides;
            const int side = shared & 1 ? 0 : shared & 2 ? 1 : 2;
            const double value = shared != 0
                                     ? d.norm() * search_.metric_.along(arrays_.face_edges[f][side])
                                     : search_.metric_.across(f, d);
            labels.reach(node.node, cost + value, u);
        }
    }

    WireSearch& search_;
    const MeshArrays& arrays_;
    int per_edge_;
    std::vector<int> faces_, vertices_, edges_;
    int vertex_count_ = 0;
    std::vector<Vec3> positions_;
    std::vector<FaceNode> nodes_;  ///< of the face at hand
    std::vector<int> goal_;
    double best_ = kUnreached;
    int last_ = -1;
};

WirePath WireSearch::search(const std::vector<int>& faces, int per_edge, const WirePoint& from,
                            const WirePoint& to) {
    return Band(*this, faces, per_edge).run(from, to);
}

}  // namespace fcn
