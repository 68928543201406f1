#include "meshing/weighted_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/maximum_weighted_matching.hpp>
#include <random>

namespace fcn {
namespace {

using Edges = std::vector<MatchingEdge>;

/// Checks that it is a matching along edges; its weight (parallel edges count as the heaviest).
std::int64_t weight_of(int n, const Edges& edges, const std::vector<int>& partner) {
    EXPECT_EQ(partner.size(), static_cast<std::size_t>(n));
    std::int64_t sum = 0;
    for (int v = 0; v < n; ++v) {
        const int w = partner[static_cast<std::size_t>(v)];
        if (w < 0) continue;
        EXPECT_EQ(partner[static_cast<std::size_t>(w)], v);
        std::int64_t best = 0;
        for (const MatchingEdge& edge : edges)
            if (std::minmax(edge.a, edge.b) == std::minmax(v, w))
                best = std::max(best, edge.weight);
        EXPECT_GT(best, 0) << "no edge between " << v << " and " << w;
        if (v < w) sum += best;
    }
    return sum;
}

/// By dynamic programming over sets of vertices.
std::int64_t best_weight(int n, const Edges& edges) {
    std::vector<std::int64_t> best(std::size_t{1} << n, 0);
    for (std::size_t set = 1; set < best.size(); ++set) {
        const int low = std::countr_zero(set);
        best[set] = best[set & (set - 1)];
        for (const MatchingEdge& edge : edges) {
            if (std::min(edge.a, edge.b) != low && std::max(edge.a, edge.b) != low) continue;
            const std::size_t both = std::size_t{1} << edge.a | std::size_t{1} << edge.b;
            if ((set & both) == both)
                best[set] = std::max(best[set], best[set & ~both] + edge.weight);
        }
    }
    return best.back();
}

std::int64_t boost_weight(int n, const Edges& edges) {
    using Graph =
        boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                              boost::property<boost::edge_weight_t, std::int64_t>>;
    Graph graph(static_cast<std::size_t>(n));
    for (const MatchingEdge& edge : edges)
        boost::add_edge(static_cast<std::size_t>(edge.a), static_cast<std::size_t>(edge.b),
                        edge.weight, graph);
    std::vector<Graph::vertex_descriptor> mate(static_cast<std::size_t>(n));
    boost::maximum_weighted_matching(graph, mate.data());
    return boost::matching_weight_sum(graph, mate.data());
}

Edges random_edges(std::mt19937& random, int n, double density, int range) {
    std::uniform_real_distribution<double> chance(0, 1);
    std::uniform_int_distribution<int> weight(-range / 5, range);
    Edges edges;
    for (int a = 0; a < n; ++a)
        for (int b = a + 1; b < n; ++b)
            if (chance(random) < density) edges.push_back({a, b, weight(random)});
    std::shuffle(edges.begin(), edges.end(), random);
    return edges;
}

TEST(HeaviestMatching, IsOptimalOnSmallGraphs) {
    constexpr unsigned kSeed = 20260101;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937 random(kSeed);
    for (int round = 0; round < 3000; ++round) {
        const int n = 2 + static_cast<int>(random() % 10);
        const double density = 0.15 + 0.8 * static_cast<double>(random() % 100) / 100;
        const int range = std::array{3, 10, 1000}[random() % 3];
        const Edges edges = random_edges(random, n, density, range);
        ASSERT_EQ(weight_of(n, edges, heaviest_matching(n, edges)), best_weight(n, edges))
            << "round " << round;
    }
}

/// Dual graph of a triangulated torus with random diagonals and weights, where many blossoms form.
Edges cubic_graph(std::mt19937& random, int m, int range) {
    Edges edges;
    const auto cell = [&](int i, int j) { return 2 * (((j + m) % m) * m + (i + m) % m); };
    std::uniform_int_distribution<int> weight(1, range);
    for (int j = 0; j < m; ++j)
        for (int i = 0; i < m; ++i) {
            // The lower triangle of a cell has its bottom; which side it has is random.
            edges.push_back({cell(i, j), cell(i, j) + 1, weight(random)});
            edges.push_back({cell(i, j) + 1, cell(i, j + 1), weight(random)});
            const int left = cell(i, j) + static_cast<int>(random() % 2);
            const int right = cell(i + 1, j) + static_cast<int>(random() % 2);
            edges.push_back({left, right, weight(random)});
        }
    return edges;
}

TEST(HeaviestMatching, AgreesWithBoostOnSparseGraphs) {
    constexpr unsigned kSeed = 7;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937 random(kSeed);
    for (const int range : {2, 5, 100, 100000}) {
        for (int round = 0; round < 10; ++round) {
            const Edges edges = cubic_graph(random, 7, range);
            ASSERT_EQ(weight_of(98, edges, heaviest_matching(98, edges)), boost_weight(98, edges));
        }
    }
}

TEST(HeaviestMatching, LargeGraphsMatchAlmostAll) {
    std::mt19937 random(3);
    const Edges edges = cubic_graph(random, 150, 1000);
    const std::vector<int> partner = heaviest_matching(45000, edges);
    const auto single = std::count(partner.begin(), partner.end(), -1);
    EXPECT_LT(single, 4500);
    EXPECT_EQ(partner, heaviest_matching(45000, edges));
}

}  // namespace
}  // namespace fcn
