// Weights and labels speak of segments, what is known belongs to the dense samples between their
// ends and to the arcs of the initial network these came from: averages by length (paper section
// 5.3.1), and which segments share a label.
#include "adaptation/segment_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "adaptation/labeling_bridge.h"
#include "adaptation/network_output.h"

namespace fcn {

SegmentAttributes attributes_of_stretch(const WorkingArc& arc, int first, int last, double chord,
                                        const std::vector<OriginAttributes>& origins) {
    SegmentAttributes result;
    double length = 0, loop = 0, symmetric = 0, log_contrast = 0;
    for (int k = first; k < last; ++k) {
        const double piece = (arc.points[k + 1] - arc.points[k]).norm();
        const OriginAttributes& origin = origins[arc.origins[k]];
        const double crease = (arc.crease[k] + arc.crease[k + 1]) / 2;
        length += piece;
        result.sharpness += piece * (arc.sharpness[k] + arc.sharpness[k + 1]) / 2;
        log_contrast += piece * std::log(crease_contrast(crease));
        result.curve_length += piece * origin.curve_length;
        loop += origin.is_on_loop ? piece : 0;
        symmetric += origin.is_symmetric ? piece : 0;
    }
    if (length > 0) {
        result.sharpness /= length;
        result.curve_length /= length;
        result.contrast = std::exp(log_contrast / length);
    }
    result.is_on_loop = loop > length / 2;
    result.is_symmetric = symmetric > length / 2;
    result.length = chord;
    return result;
}

std::vector<SegmentAttributes> attributes_of(const NetworkGraph& graph,
                                             const WorkingNetwork& network,
                                             const std::vector<OriginAttributes>& origins) {
    std::vector<SegmentAttributes> result;
    result.reserve(graph.sources.size());
    for (std::size_t s = 0; s < graph.sources.size(); ++s) {
        const SegmentSource& source = graph.sources[s];
        result.push_back(attributes_of_stretch(network.arcs[source.arc], source.first_sample,
                                               source.last_sample,
                                               graph.graph.length(static_cast<int>(s)), origins));
    }
    return result;
}

std::vector<int> label_groups(const NetworkGraph& graph, const WorkingNetwork& network,
                              const std::vector<OriginAttributes>& origins,
                              const std::vector<Conflict>& conflicts,
                              const AdaptationOptions& options) {
    const int count = static_cast<int>(graph.sources.size());
    std::map<int, std::vector<std::array<int, 4>>> members;  // rank, arc, position, segment
    for (int s = 0; s < count; ++s) {
        const SegmentSource& source = graph.sources[s];
        const WorkingArc& arc = network.arcs[source.arc];
        if (arc.is_pinned) continue;
        if (options.unit == LabelUnit::Curve) {
            const OriginAttributes& origin =
                origins[majority_origin(arc, source.first_sample, source.last_sample)];
            const int along = origin.is_reversed_in_curve ? -source.position : source.position;
            members[origin.curve].push_back({origin.rank_in_curve, source.arc, along, s});
        } else if (!arc.orbit_classes.empty() && arc.orbit_classes[source.position] >= 0) {
            members[arc.orbit_classes[source.position]].push_back({0, 0, 0, s});
        }
    }
    if (members.empty()) return {};
    std::vector<std::vector<int>> order;
    for (auto& [key, list] : members) {
        std::ranges::sort(list);
        order.emplace_back();
        for (const auto& entry : list) order.back().push_back(entry[3]);
    }
    const bool splits = options.mode == AdaptationMode::Best;
    return split_groups(order, count, splits ? conflicts : std::vector<Conflict>{},
                        options.unit == LabelUnit::Segment);
}

}  // namespace fcn
