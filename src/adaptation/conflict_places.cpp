#include "adaptation/conflict_places.h"

namespace fcn {

std::vector<ConflictPlace> conflict_places(const std::vector<Conflict>& conflicts,
                                           const SegmentGraph& graph,
                                           const std::vector<double>& weights,
                                           const std::vector<bool>& is_kept,
                                           const std::function<int(int)>& origin_of,
                                           std::size_t most) {
    const std::size_t step = most == 0 ? 1 : (conflicts.size() + most - 1) / most;
    const auto midpoint = [&](int segment) -> Vec3 {
        const auto& nodes = graph.segments[static_cast<std::size_t>(segment)].nodes;
        return (graph.nodes[static_cast<std::size_t>(nodes[0])].position +
                graph.nodes[static_cast<std::size_t>(nodes[1])].position) /
               2;
    };
    std::vector<ConflictPlace> places;
    for (std::size_t i = 0; i < conflicts.size(); i += step) {
        const Conflict& conflict = conflicts[i];
        const auto first = static_cast<std::size_t>(conflict.first);
        const auto second = static_cast<std::size_t>(conflict.second);
        ConflictPlace place;
        place.kind = to_string(conflict.kind);
        place.first = midpoint(conflict.first);
        place.second = midpoint(conflict.second);
        place.measured = conflict.kind == ConflictKind::Angle ? conflict.angle : conflict.distance;
        place.origin_arcs = {origin_of(conflict.first), origin_of(conflict.second)};
        place.weights = {weights[first], weights[second]};
        place.is_kept = {is_kept[first], is_kept[second]};
        places.push_back(std::move(place));
    }
    return places;
}

}  // namespace fcn
