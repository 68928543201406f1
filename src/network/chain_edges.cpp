// Edges to arcs: weld equal points, drop what is no edge, decide which points are nodes, then walk
// from every edge not yet used to the nodes on both sides.

#include "network/chain_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace fcn {
namespace {

class Chainer {
public:
    explicit Chainer(const EdgeSoup& soup) : soup_(soup), edges_(soup.edges) {}

    FeatureCurveNetwork run() {
        weld();
        drop_degenerate();
        index_edges();
        std::vector<std::size_t> order(edges_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        // Edges without an arc number come last, as unsigned -1 is the largest.
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return static_cast<unsigned>(edges_[a].arc) < static_cast<unsigned>(edges_[b].arc);
        });
        is_used_.assign(edges_.size(), false);
        node_of_.assign(soup_.points.size(), -1);
        for (std::size_t seed : order)
            if (!is_used_[seed]) trace(static_cast<int>(seed));
        network_.dropped = soup_.dropped;
        return std::move(network_);
    }

private:
    /// The lowest index among equal points stands for all of them; -0 equals 0.
    void weld() {
        std::vector<int> used;
        for (const EdgeSoup::Edge& edge : edges_) used.insert(used.end(), {edge.from, edge.to});
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        const auto key = [&](int p) {
            const Vec3& x = soup_.points[p];
            return std::tuple(x[0], x[1], x[2]);
        };
        std::stable_sort(used.begin(), used.end(), [&](int a, int b) { return key(a) < key(b); });
        std::vector<int> representative(soup_.points.size(), -1);
        for (std::size_t k = 0; k < used.size(); ++k)
            representative[used[k]] =
                k > 0 && key(used[k]) == key(used[k - 1]) ? representative[used[k - 1]] : used[k];
        for (EdgeSoup::Edge& edge : edges_) {
            edge.from = representative[edge.from];
            edge.to = representative[edge.to];
        }
    }

    void drop_degenerate() {
        const std::size_t before = edges_.size();
        std::erase_if(edges_, [](const EdgeSoup::Edge& e) { return e.from == e.to; });
        note(before - edges_.size(), "edges without length");

        const auto key = [&](std::size_t e) {
            const auto [low, high] = std::minmax(edges_[e].from, edges_[e].to);
            return std::tuple(low, high, edges_[e].arc);
        };
        std::vector<std::size_t> order(edges_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
        std::vector<bool> is_repeated(edges_.size(), false);
        for (std::size_t k = 1; k < order.size(); ++k)
            is_repeated[order[k]] = key(order[k]) == key(order[k - 1]);
        std::size_t kept = 0;
        for (std::size_t e = 0; e < edges_.size(); ++e)
            if (!is_repeated[e]) edges_[kept++] = edges_[e];
        note(edges_.size() - kept, "repeated edges");
        edges_.resize(kept);
    }

    void note(std::size_t count, const std::string& what) {
        if (count > 0)
            network_.notes.push_back("import: dropped " + std::to_string(count) + " " + what);
    }

    void index_edges() {
        first_.assign(soup_.points.size() + 1, 0);
        for (const EdgeSoup::Edge& edge : edges_) {
            ++first_[edge.from + 1];
            ++first_[edge.to + 1];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        incident_.resize(2 * edges_.size());
        std::vector<std::size_t> fill(first_.begin(), first_.end() - 1);
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            incident_[fill[edges_[e].from]++] = static_cast<int>(e);
            incident_[fill[edges_[e].to]++] = static_cast<int>(e);
        }
    }

    bool is_regular(int point) const {
        if (first_[point + 1] - first_[point] != 2) return false;
        const int a = incident_[first_[point]], b = incident_[first_[point] + 1];
        return edges_[a].arc == edges_[b].arc;
    }

    /// Points from the far end of `edge` on, away from `from`, up to a node or to `start`.
    std::vector<int> walk(int edge, int from, int start) {
        std::vector<int> points;
        int point = from;
        while (true) {
            is_used_[edge] = true;
            point = edges_[edge].from == point ? edges_[edge].to : edges_[edge].from;
            points.push_back(point);
            if (point == start || !is_regular(point)) return points;
            const int a = incident_[first_[point]], b = incident_[first_[point] + 1];
            edge = a == edge ? b : a;
        }
    }

    void trace(int seed) {
        const int from = edges_[seed].from;
        std::vector<int> chain{from};
        const std::vector<int> ahead = walk(seed, from, from);
        const bool is_closed = ahead.back() == from;
        if (!is_closed && is_regular(from)) {
            const int a = incident_[first_[from]], b = incident_[first_[from] + 1];
            const std::vector<int> behind = walk(a == seed ? b : a, from, -1);
            chain.insert(chain.begin(), behind.rbegin(), behind.rend());
        }
        chain.insert(chain.end(), ahead.begin(), ahead.end());
        NetworkArc arc;
        arc.nodes = {node_at(chain.front()), node_at(chain.back())};
        arc.source = "import";
        for (int point : chain) arc.samples.push_back({soup_.points[point], {}});
        network_.arcs.push_back(std::move(arc));
    }

    int node_at(int point) {
        if (node_of_[point] < 0) {
            node_of_[point] = static_cast<int>(network_.nodes.size());
            network_.nodes.push_back({soup_.points[point], {}});
        }
        return node_of_[point];
    }

    const EdgeSoup& soup_;
    std::vector<EdgeSoup::Edge> edges_;
    std::vector<std::size_t> first_;  ///< per point its range of incident_
    std::vector<int> incident_;
    std::vector<bool> is_used_;
    std::vector<int> node_of_;
    FeatureCurveNetwork network_;
};

}  // namespace

void EdgeSoup::add_polyline(const std::vector<int>& indices, int arc) {
    for (std::size_t k = 1; k < indices.size(); ++k)
        edges.push_back({indices[k - 1], indices[k], arc});
}

FeatureCurveNetwork chain_edges(const EdgeSoup& soup) { return Chainer(soup).run(); }

}  // namespace fcn
