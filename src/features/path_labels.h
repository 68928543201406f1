#pragma once

#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace fcn {

inline constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// Costs and predecessors of Dijkstra's algorithm. Of equal costs the lower predecessor stands, so
/// that paths do not depend on the order in which nodes are settled.
struct PathLabels {
    std::vector<double> cost;
    std::vector<int> before;
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>,
                        std::greater<>>
        queue;  ///< (cost, node); outdated entries stay

    explicit PathLabels(int count) : cost(count, kUnreached), before(count, -1) {}

    void reach(int node, double value, int from) {
        if (value > cost[node] || (value == cost[node] && from >= before[node])) return;
        if (value < cost[node]) queue.emplace(value, node);
        cost[node] = value;
        before[node] = from;
    }
};

}  // namespace fcn
