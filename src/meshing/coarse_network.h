#pragma once

#include <array>
#include <vector>

#include "network/network.h"

namespace fcn {

/// An adapted network with segments joined in twos, so that halving them gives the old ones back.
struct CoarseNetwork {
    FeatureCurveNetwork network;
    /// Per segment the one or two it is made of, in the order of its nodes; -1: none.
    std::vector<std::array<int, 2>> parts;
    std::vector<int> middle;  ///< per segment the node between its parts, -1: none
};

/// Joins segments that continue each other within 40 degrees through a node of no others, up to
/// `longest` from end to end; those of `kept_apart`, by segment, are left alone. Two segments never
/// get the same ends by it. A network without segments comes back as it is.
CoarseNetwork join_segments(const FeatureCurveNetwork& network, double longest,
                            const std::vector<bool>& kept_apart = {});

}  // namespace fcn
