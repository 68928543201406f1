// On a noisy mesh a crease comes as a chain with defects of a few edges, each of a kind. Faces that
// fit neither side are enclosed by two chains instead of lying beside one: such islands are given
// to the neighbour across the weakest of their borders. A facet of noise beside a crease leaves a
// spur, a dead end that goes. Where the crease itself is weak there is a gap: from its end runs a
// search for the cheapest path along mesh edges (Dijkstra) to the next chain, on which edges that
// turn as the crease does cost less; it is taken if it goes on in the direction of the chain, is
// nearly straight, and turns the same way on average.

#include "features/mend_chains.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>
#include <set>

namespace fcn {
namespace {

constexpr std::size_t kIslandFaces = 6;
constexpr double kFaceShare = 0.75;   // of the high angle: weaker borders of a small face go
constexpr double kBubbleShare = 1.5;  // the same, of an island on a crease
constexpr double kShortSpurShare = 1.5;
constexpr int kSpurEdges = 3;      // always noise
constexpr int kWeakSpurEdges = 6;  // noise if not as strong as a seed
constexpr double kGapEdges = 6;
constexpr int kDirectionEdges = 4;     // at the end of a chain, for its direction
constexpr double kAheadCosine = 0.5;   // of a gap to that direction
constexpr double kStraightness = 1.4;  // length over chord of a gap
constexpr double kWeakness = 3;        // cost of an edge without angle over that of a crease
constexpr double kLeastAngle = 6 * std::numbers::pi / 180;  // mean angle in a gap

struct Path {
    std::vector<int> edges;
    std::vector<int> vertices;  ///< one more
};

class Mender {
public:
    Mender(const MeshArrays& arrays, const RobustDihedrals& dihedrals, double high_angle,
           std::vector<bool>& is_sharp)
        : arrays_(arrays),
          dihedrals_(dihedrals),
          high_angle_(high_angle),
          is_sharp_(is_sharp),
          at_vertex_(edges_of_vertices(arrays, std::vector<bool>(arrays.edge_count(), true))),
          valence_(arrays.vertex_count(), 0),
          is_boundary_(arrays.vertex_count(), false) {
        for (int e = 0; e < arrays.edge_count(); ++e) {
            for (int v : arrays.edge_vertices[e]) {
                if (is_sharp[e]) ++valence_[v];
                if (arrays.is_boundary(e)) is_boundary_[v] = true;
            }
        }
    }

    void run() {
        dissolve_islands();
        drop_spurs();
        close_gaps();
        dissolve_islands();
        drop_spurs();
    }

private:
    int other_end(int edge, int vertex) const {
        const auto [a, b] = arrays_.edge_vertices[edge];
        return a == vertex ? b : a;
    }

    void mark(int edge, bool is_sharp) {
        if (is_sharp_[edge] == is_sharp) return;
        is_sharp_[edge] = is_sharp;
        for (int v : arrays_.edge_vertices[edge]) valence_[v] += is_sharp ? 1 : -1;
    }

    /// The sharp edge at a vertex other than `edge`; -1 if there is not exactly one.
    int next_edge(int edge, int vertex) const {
        if (valence_[vertex] != 2) return -1;
        for (const int* e = at_vertex_.begin(vertex); e != at_vertex_.end(vertex); ++e)
            if (*e != edge && is_sharp_[*e]) return *e;
        return -1;
    }

    /// The chain from a vertex along an edge, to a vertex that is not of valence two, at most
    /// `limit` edges.
    Path chain(int vertex, int edge, int limit) const {
        Path path{{}, {vertex}};
        while (edge >= 0 && static_cast<int>(path.edges.size()) < limit) {
            path.edges.push_back(edge);
            path.vertices.push_back(other_end(edge, path.vertices.back()));
            if (path.vertices.back() == vertex) break;
            edge = next_edge(edge, path.vertices.back());
        }
        return path;
    }

    double length(const std::vector<int>& edges) const {
        double sum = 0;
        for (int e : edges) sum += arrays_.edge_length(e);
        return sum;
    }

    double mean_angle(const std::vector<int>& edges) const {
        double sum = 0;
        for (int e : edges) sum += arrays_.edge_length(e) * dihedrals_.angles[e];
        return sum / length(edges);
    }

    bool is_all_noisy(const std::vector<int>& edges) const {
        return std::all_of(edges.begin(), edges.end(),
                           [&](int e) { return dihedrals_.is_noisy_edge[e]; });
    }

    void dissolve_islands();
    void dissolve(const std::vector<int>& border);
    void drop_spurs();
    void close_gaps();
    Path gap_from(int end) const;

    const MeshArrays& arrays_;
    const RobustDihedrals& dihedrals_;
    double high_angle_;
    std::vector<bool>& is_sharp_;
    IndexRows at_vertex_;
    std::vector<int> valence_;  ///< sharp edges at each vertex
    std::vector<bool> is_boundary_;
};

/// Removes the weakest of the chains that make up the border of an island. One without
/// junctions is a spike, one between two lies on a crease; with more corners it may be a face of
/// the shape, and stays unless a border is weak.
void Mender::dissolve(const std::vector<int>& border) {
    std::set<int> left(border.begin(), border.end()), junctions;
    for (int e : border)
        for (int v : arrays_.edge_vertices[e])
            if (valence_[v] != 2) junctions.insert(v);
    std::vector<int> weakest;
    double least = (junctions.size() == 2 ? kBubbleShare : kFaceShare) * high_angle_;
    if (junctions.empty()) least = std::numbers::pi;
    while (!left.empty()) {
        const int first = *left.begin();
        std::set<int> run{first};
        for (int v : arrays_.edge_vertices[first]) {
            int edge = first, vertex = v;
            while (true) {
                edge = next_edge(edge, vertex);
                if (edge < 0 || !left.contains(edge) || !run.insert(edge).second) break;
                vertex = other_end(edge, vertex);
            }
        }
        for (int e : run) left.erase(e);
        const std::vector<int> edges(run.begin(), run.end());
        const double strength = std::abs(mean_angle(edges));
        if (!is_all_noisy(edges) || strength >= least) continue;
        weakest = edges;
        least = strength;
    }
    for (int e : weakest) mark(e, false);
}

void Mender::dissolve_islands() {
    std::vector<int> visit(arrays_.face_count(), -1);
    for (int e = 0; e < arrays_.edge_count(); ++e) {
        if (!is_sharp_[e] || !dihedrals_.is_noisy_edge[e]) continue;
        for (int start : arrays_.edge_faces[e]) {
            if (start < 0 || visit[start] == start) continue;
            std::vector<int> faces{start}, border;
            visit[start] = start;
            for (std::size_t i = 0; i < faces.size() && faces.size() <= kIslandFaces; ++i) {
                for (int k = 0; k < 3; ++k) {
                    const int edge = arrays_.face_edges[faces[i]][k];
                    const int next = arrays_.face_neighbors[faces[i]][k];
                    if (is_sharp_[edge]) {
                        border.push_back(edge);
                    } else if (next >= 0 && visit[next] != start) {
                        visit[next] = start;
                        faces.push_back(next);
                    }
                }
            }
            if (faces.size() <= kIslandFaces) dissolve(border);
        }
    }
}

void Mender::drop_spurs() {
    std::vector<int> ends;
    for (int v = 0; v < arrays_.vertex_count(); ++v)
        if (valence_[v] == 1 && !is_boundary_[v]) ends.push_back(v);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const int end = ends[i];
        if (valence_[end] != 1) continue;
        int first = -1;
        for (const int* e = at_vertex_.begin(end); e != at_vertex_.end(end); ++e)
            if (is_sharp_[*e]) first = *e;
        const Path spur = chain(end, first, kWeakSpurEdges);
        const int junction = spur.vertices.back(), count = static_cast<int>(spur.edges.size());
        if (valence_[junction] < 3 || !is_all_noisy(spur.edges)) continue;
        const double most = (count > kSpurEdges ? 1 : kShortSpurShare) * high_angle_;
        if (std::abs(mean_angle(spur.edges)) >= most) continue;
        if (count >= kWeakSpurEdges) continue;
        for (int e : spur.edges) mark(e, false);
    }
}

Path Mender::gap_from(int end) const {
    int first = -1;
    for (const int* e = at_vertex_.begin(end); e != at_vertex_.end(end); ++e)
        if (is_sharp_[*e]) first = *e;
    const Path tail = chain(end, first, 2 * static_cast<int>(kGapEdges));
    const std::vector<int> near(
        tail.edges.begin(),
        tail.edges.begin() + std::min<std::ptrdiff_t>(kDirectionEdges, std::ssize(tail.edges)));
    const Vec3& at = arrays_.points[end];
    const Vec3 ahead = (at - arrays_.points[tail.vertices[near.size()]]).normalized();
    const double sign = mean_angle(near) < 0 ? -1 : 1;
    const double reach = kGapEdges * length(near) / static_cast<double>(near.size());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::map<int, std::pair<double, int>> best;  // cost and edge from which a vertex is reached
    best[end] = {0, -1};
    queue.push({0, end});
    while (!queue.empty()) {
        const auto [cost, v] = queue.top();
        queue.pop();
        if (cost > best[v].first) continue;
        const bool is_own =
            std::find(tail.vertices.begin(), tail.vertices.end(), v) != tail.vertices.end();
        if (v != end && is_own) continue;
        if (v != end && (valence_[v] > 0 || is_boundary_[v])) {
            Path path{{}, {v}};
            while (path.vertices.back() != end) {
                path.edges.push_back(best[path.vertices.back()].second);
                path.vertices.push_back(other_end(path.edges.back(), path.vertices.back()));
            }
            return path;
        }
        for (const int* e = at_vertex_.begin(v); e != at_vertex_.end(v); ++e) {
            const int w = other_end(*e, v);
            const Vec3 way = arrays_.points[w] - at;
            if (is_sharp_[*e] || way.norm() > reach) continue;
            if (way.dot(ahead) < kAheadCosine * way.norm()) continue;
            const double share = std::clamp(sign * dihedrals_.angles[*e] / high_angle_, 0.0, 1.0);
            const double next = cost + arrays_.edge_length(*e) * (1 + kWeakness * (1 - share));
            const auto known = best.find(w);
            if (known != best.end() && known->second.first <= next) continue;
            best[w] = {next, *e};
            queue.push({next, w});
        }
    }
    return {};
}

void Mender::close_gaps() {
    for (int v = 0; v < arrays_.vertex_count(); ++v) {
        if (valence_[v] != 1 || is_boundary_[v]) continue;
        const Path gap = gap_from(v);
        if (gap.edges.empty() || !is_all_noisy(gap.edges)) continue;
        const double chord =
            (arrays_.points[gap.vertices.front()] - arrays_.points[gap.vertices.back()]).norm();
        if (length(gap.edges) > kStraightness * chord) continue;
        int last = -1;
        for (const int* e = at_vertex_.begin(v); e != at_vertex_.end(v); ++e)
            if (is_sharp_[*e]) last = *e;
        const double sign = dihedrals_.angles[last] < 0 ? -1 : 1;
        const bool is_end = valence_[gap.vertices.front()] == 1;
        if (sign * mean_angle(gap.edges) < (is_end ? 0 : kLeastAngle)) continue;
        for (int e : gap.edges) mark(e, true);
    }
}

}  // namespace

void mend_chains(const MeshArrays& arrays, const RobustDihedrals& dihedrals, double high_angle,
                 std::vector<bool>& is_sharp) {
    const auto& noisy = dihedrals.is_noisy_edge;
    if (std::none_of(noisy.begin(), noisy.end(), [](bool is) { return is; })) return;
    Mender(arrays, dihedrals, high_angle, is_sharp).run();
}

}  // namespace fcn
