#pragma once

#include <array>
#include <queue>
#include <utility>
#include <vector>

#include "features/mesh_arrays.h"
#include "features/wire_metric.h"

namespace fcn {

/// A vertex beside an end of a path, and the cost of the way between them.
struct WireSeed {
    int vertex = -1;
    double cost = 0;
};

/// Where a cheapest path runs, about: a search over the vertices of a mesh. Keeps references, and
/// memory of some 200 bytes a vertex. Not for several threads at once; an answer depends on the
/// seeds only.
class VertexSearch {
public:
    VertexSearch(const MeshArrays& arrays, const WireMetric& metric);

    /// Vertices of a path from a seed of one end to a seed of the other; empty if there is none.
    std::vector<int> path(const std::vector<WireSeed>& from, const std::vector<WireSeed>& to);

private:
    struct Neighbor {
        int vertex, edge;
        double length, cost;  ///< of the edge
    };
    struct Label {
        double cost, length;  ///< length: of the edge
        int parent, edge;     ///< edge to the parent
    };
    struct Front {
        std::vector<Label> labels;
        std::vector<int> reached;
        std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>,
                            std::greater<>>
            queue;  ///< (cost, vertex); outdated entries stay
    };

    void start(Front& front, const std::vector<WireSeed>& seeds);
    double least(Front& front) const;
    void expand(Front& front, const Front& other);
    double straight_cost(const Front& front, int vertex, const Neighbor& next, double least) const;
    void reach(Front& front, const Front& other, int vertex, const Label& label);

    const MeshArrays& arrays_;
    const WireMetric& metric_;
    std::vector<int> offsets_;
    std::vector<Neighbor> neighbors_;
    std::array<Front, 2> fronts_;
    double best_ = 0;
    int meeting_ = -1;
};

}  // namespace fcn
