#pragma once

#include <functional>
#include <queue>
#include <tuple>
#include <vector>

namespace fcn {

/// An item that a region may take next while regions grow.
struct Candidate {
    double error;
    int region;
    int item;
    bool operator>(const Candidate& other) const {
        return std::tie(error, region, item) > std::tie(other.error, other.region, other.item);
    }
};

/// Least error first; ties by region, then item.
using Frontier = std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>>;

}  // namespace fcn
