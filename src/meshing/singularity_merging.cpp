// Two singularities of opposite index that are closer than a quad's edge cost a quad mesh two
// irregular vertices and a strip of squeezed quads, and mean nothing at its scale (Ebke, Campen,
// Bommes, Kobbelt 2014, section 4). A quarter turn more across an edge moves a quarter of index
// from one of its ends to the other, so turning all edges of a path cancels the pair. Nearest pairs
// go first; each quarter takes part once.
#include "meshing/singularity_merging.h"

#include <algorithm>
#include <array>
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

class Merger {
public:
    Merger(const Mesh& mesh, const FaceConnection& connection, MatchedField& matched)
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

std::vector<Singularity> inner_singularities(const Mesh& mesh, const CrossField& field) {
    const std::vector<int> indices = vertex_indices(mesh, field);
    std::vector<Singularity> result;
    for (const VertexHandle v : mesh.vertices())
        if (!mesh.is_boundary(v) && !mesh.is_isolated(v) && indices[at(v.idx())] != 0)
            result.push_back({v.idx(), indices[at(v.idx())]});
    return result;
}

MergingStatistics merge_singularities(const Mesh& mesh, const FaceConnection& connection,
                                      double distance, MatchedField& matched) {
    MergingStatistics statistics;
    const std::vector<Singularity> singularities = inner_singularities(mesh, matched.field);
    std::unordered_map<int, int> left;
    for (const Singularity& s : singularities) left[s.vertex] = s.index;
    Merger merger(mesh, connection, matched);
    for (const Pair& pair : opposite_pairs(mesh, singularities, distance)) {
        int &positive = left[pair.positive], &negative = left[pair.negative];
        while (positive > 0 && negative < 0) {
            merger.move_quarter(pair.positive, pair.negative, distance);
            --positive;
            ++negative;
            ++statistics.merged_pairs;
        }
    }
    return statistics;
}

int close_pairs(const Mesh& mesh, const std::vector<Singularity>& singularities, double distance) {
    return static_cast<int>(opposite_pairs(mesh, singularities, distance).size());
}

}  // namespace fcn
