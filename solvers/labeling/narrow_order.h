#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "labeling/elimination_order.h"
#include "labeling/random.h"
#include "labeling/run_control.h"

namespace labeling {

/// Some labels, numbered from 0, and what joins them.
struct LabelGraph {
    std::vector<std::vector<Label>> conflicts;   ///< per label
    std::vector<std::vector<Label>> neighbours;  ///< by conflicts, bonuses, rules; ascending
    std::vector<std::uint8_t> is_on;             ///< at present
};

/// An elimination order of most labels, in which none is joined with more than `most_neighbours`;
/// the labels that are not in it are to keep their present values. A label that conflicts with one
/// that stays on is never in it. Each time it is another one, if it is not all labels. nullopt when
/// `control` stops.
std::optional<EliminationOrder> narrow_order(LabelGraph graph, std::size_t most_neighbours,
                                             Random& random, RunControl& control);

}  // namespace labeling
