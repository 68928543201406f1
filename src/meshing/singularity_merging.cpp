// Two singularities of opposite index that are closer than a quad's edge cost a quad mesh two
// irregular vertices and a strip of squeezed quads, and mean nothing at its scale (Ebke, Campen,
// Bommes, Kobbelt 2014, section 4). A quarter turn more across an edge moves a quarter of index
// from one of its ends to the other, so turning all edges of a path cancels the pair. Nearest pairs
// go first; each quarter takes part once. Departure: the nodes of a conforming network are as far
// apart as its scale says and may both be singular, as the corners of a tooth are. In the same way
// quarters that share a vertex, as at tips, are taken apart: a vertex of two quads is worse than
// two of three.
#include "meshing/singularity_merging.h"

#include <algorithm>
#include <array>
#include <map>
#include <queue>
#include <unordered_map>

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Reached {
    double distance = 0;
    HalfedgeHandle by{};  ///< invalid at the source
};

/// Vertices within `distance` along inner edges.
std::unordered_map<int, Reached> reach(const Mesh& mesh, int source, double distance) {
    std::unordered_map<int, Reached> known;
    known.emplace(source, Reached{0, HalfedgeHandle()});
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.push({0, source});
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > known[v].distance) continue;
        for (const HalfedgeHandle h : mesh.voh_range(VertexHandle(v))) {
            if (mesh.is_boundary(mesh.edge_handle(h))) continue;
            const double next = d + mesh.calc_edge_length(h);
            if (next >= distance) continue;
            const int to = mesh.to_vertex_handle(h).idx();
            const auto [it, is_new] = known.try_emplace(to, Reached{next, h});
            if (!is_new && it->second.distance <= next) continue;
            it->second = {next, h};
            queue.push({next, to});
        }
    }
    return known;
}

struct Pair {
    double distance;
    int positive, negative;  ///< vertices
    bool operator<(const Pair& other) const {
        return std::array{distance, double(positive), double(negative)} <
               std::array{other.distance, double(other.positive), double(other.negative)};
    }
};

std::vector<Pair> opposite_pairs(const Mesh& mesh, const std::vector<Singularity>& singularities,
                                 double distance) {
    std::unordered_map<int, int> index;
    for (const Singularity& s : singularities) index[s.vertex] = s.index;
    std::vector<Pair> pairs;
    for (const Singularity& s : singularities) {
        if (s.index < 0) continue;
        for (const auto& [v, reached] : reach(mesh, s.vertex, distance)) {
            const auto it = index.find(v);
            if (it != index.end() && it->second < 0)
                pairs.push_back({reached.distance, s.vertex, v});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// A free inner vertex within `distance` of the first place, as far as can be from all; -1: none.
int farthest_place(const Mesh& mesh, const std::vector<int>& places, double distance,
                   const std::vector<bool>& is_taken) {
    std::map<int, double> nearest;  // distance to the nearest place
    for (const auto& [v, reached] : reach(mesh, places[0], distance))
        if (!is_taken[at(v)] && !mesh.is_boundary(VertexHandle(v))) nearest[v] = reached.distance;
    for (std::size_t i = 1; i < places.size(); ++i) {
        const auto known = reach(mesh, places[i], 2 * distance);
        for (auto& [v, d] : nearest) {
            const auto it = known.find(v);
            if (it != known.end()) d = std::min(d, it->second.distance);
        }
    }
    int best = -1;
    for (const auto& [v, d] : nearest)
        if (best < 0 || d > nearest[best]) best = v;
    return best;
}

class QuarterMover {
public:
    QuarterMover(const Mesh& mesh, const FaceConnection& connection, MatchedField& matched)
        : mesh_(mesh), connection_(connection), matched_(matched) {
        link_of_.assign(mesh.n_edges(), -1);
        for (std::size_t i = 0; i < connection.links.size(); ++i)
            link_of_[at(mesh.edge_handle(HalfedgeHandle(connection.links[i].halfedge)).idx())] =
                static_cast<int>(i);
    }

    /// Takes a quarter from `source` to `target`, whose distance is less than `distance`.
    void move_quarter(int source, int target, double distance) {
        const auto known = reach(mesh_, source, distance);
        for (HalfedgeHandle h = known.at(target).by; h.is_valid();
             h = known.at(mesh_.from_vertex_handle(h).idx()).by) {
            const int link = link_of_[at(mesh_.edge_handle(h).idx())];
            // Counter-clockwise around its origin, h is crossed from its right to its left.
            const bool is_along = connection_.links[at(link)].halfedge == h.idx();
            turn_link(mesh_, connection_, at(link), is_along ? -1 : 1, matched_);
        }
    }

private:
    const Mesh& mesh_;
    const FaceConnection& connection_;
    MatchedField& matched_;
    std::vector<int> link_of_;
};

}  // namespace

std::vector<Singularity> inner_singularities(const Mesh& mesh, const std::vector<int>& indices) {
    std::vector<Singularity> result;
    for (const VertexHandle v : mesh.vertices())
        if (!mesh.is_boundary(v) && !mesh.is_isolated(v) && indices[at(v.idx())] != 0)
            result.push_back({v.idx(), indices[at(v.idx())]});
    return result;
}

int merge_singularities(const Mesh& mesh, const FaceConnection& connection,
                        const MergingOptions& options, MatchedField& matched) {
    int merged = 0;
    const auto is_kept = [&](int v) { return !options.is_kept.empty() && options.is_kept[at(v)]; };
    const std::vector<Singularity> singularities = inner_singularities(mesh, matched.indices);
    QuarterMover mover(mesh, connection, matched);
    for (const Pair& pair : opposite_pairs(mesh, singularities, options.distance)) {
        if (is_kept(pair.positive) && is_kept(pair.negative) &&
            pair.distance >= options.kept_distance)
            continue;
        while (matched.indices[at(pair.positive)] > 0 && matched.indices[at(pair.negative)] < 0) {
            mover.move_quarter(pair.positive, pair.negative, options.distance);
            ++merged;
        }
    }
    return merged;
}

int separate_quarters(const Mesh& mesh, const FaceConnection& connection, double distance,
                      MatchedField& matched) {
    int moved = 0;
    QuarterMover mover(mesh, connection, matched);
    const std::vector<Singularity> singularities = inner_singularities(mesh, matched.indices);
    std::vector<bool> is_taken(mesh.n_vertices(), false);
    for (const Singularity& s : singularities) is_taken[at(s.vertex)] = true;
    for (const Singularity& s : singularities) {
        const int sign = s.index > 0 ? 1 : -1;
        std::vector<int> places{s.vertex};
        for (int left = s.index * sign; left > 1; --left) {
            const int to = farthest_place(mesh, places, distance, is_taken);
            if (to < 0) break;
            mover.move_quarter(sign > 0 ? s.vertex : to, sign > 0 ? to : s.vertex, distance);
            is_taken[at(to)] = true;
            places.push_back(to);
            ++moved;
        }
    }
    return moved;
}

int close_pairs(const Mesh& mesh, const std::vector<Singularity>& singularities, double distance) {
    return static_cast<int>(opposite_pairs(mesh, singularities, distance).size());
}

}  // namespace fcn
