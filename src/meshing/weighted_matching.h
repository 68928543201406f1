#pragma once

#include <cstdint>
#include <vector>

namespace fcn {

struct MatchingEdge {
    int a = -1, b = -1;       ///< vertices, different
    std::int64_t weight = 0;  ///< within +-2^40; an edge of weight <= 0 is never taken
};

/// A set of edges without common ends, of the largest total weight, in any graph. Returns per
/// vertex the one it is matched to, -1: none. Exact and deterministic; fast on sparse graphs whose
/// optimum is found nearby (the dual graph of a triangle mesh: about linear). Throws LogicError on
/// bad indices.
std::vector<int> heaviest_matching(int vertex_count, const std::vector<MatchingEdge>& edges);

}  // namespace fcn
