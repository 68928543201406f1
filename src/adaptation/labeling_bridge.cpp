// From conflicts and weights to the binary labeling problem (paper section 5.3.2) and back.
// A label per segment b_e (or per group that shares one), a label c_v per extraordinary node that
// is in a vertex conflict. (3), (4) become conflicts. The quadratic (5) and (6) are linear in the
// star S of a node without pseudo variables: sum_S b <= 2 + (|S| - 2) c_v, and b <= c_v at
// valence 1; the paper's (7) would need its p_j per node and edge. (8) keeps short segments
// supported; (9) hands the conflicts of a short segment to its neighbours and is not written where
// a conflict implies it already. Groups merge by summing weights and coefficients; a bonus inside
// a group becomes weight.

#include "adaptation/labeling_bridge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace fcn {

namespace {

using labeling::Relation;
using labeling::Rule;

Rule unit_rule(int label, int value) { return Rule{Relation::Equal, value, {{1, label}}}; }

}  // namespace

LabelingBridge::LabelingBridge(const BridgeInput& input) {
    add_segment_labels(input);
    add_conflicts(input);
    add_pins(input);
    add_valence_rules(input);
    add_support_rules(input);
    add_inherited_rules(input);
    add_bonuses(input);
}

void LabelingBridge::add_segment_labels(const BridgeInput& input) {
    const int count = static_cast<int>(input.graph->segments.size());
    label_of_segment_ = input.groups;
    if (label_of_segment_.empty()) {
        label_of_segment_.resize(count);
        std::iota(label_of_segment_.begin(), label_of_segment_.end(), 0);
    }
    const int labels =
        count == 0 ? 0 : *std::max_element(label_of_segment_.begin(), label_of_segment_.end()) + 1;
    weights_.assign(labels, 0.0);
    segments_.assign(labels, {});
    for (int s = 0; s < count; ++s) {
        weights_[label_of_segment_[s]] += input.weights[s];
        segments_[label_of_segment_[s]].push_back(s);
    }
    for (int l = 0; l < labels; ++l) names_.push_back("s" + std::to_string(segments_[l].front()));
}

bool LabelingBridge::in_conflict(int label, int other) const {
    const auto pair = std::minmax(label, other);
    return std::binary_search(conflicts_.begin(), conflicts_.end(),
                              std::pair<int, int>(pair.first, pair.second));
}

void LabelingBridge::add_conflicts(const BridgeInput& input) {
    std::set<int> forced_out;
    for (const Conflict& conflict : input.conflicts->conflicts) {
        const int i = label_of_segment_[conflict.first];
        const int j = label_of_segment_[conflict.second];
        if (i == j) {
            if (forced_out.insert(i).second) {
                inner_conflicts_.push_back({i, conflict.first, conflict.second});
                rules_.push_back(unit_rule(i, 0));
            }
            continue;
        }
        conflicts_.emplace_back(std::min(i, j), std::max(i, j));
    }
    label_of_node_.assign(input.graph->nodes.size(), -1);
    for (const VertexConflict& conflict : input.conflicts->vertex_conflicts) {
        for (int node : {conflict.first, conflict.second}) {
            if (label_of_node_[node] >= 0) continue;
            label_of_node_[node] = static_cast<int>(weights_.size());
            weights_.push_back(0.0);
            segments_.emplace_back();
            names_.push_back("c" + std::to_string(node));
        }
        const int i = label_of_node_[conflict.first];
        const int j = label_of_node_[conflict.second];
        conflicts_.emplace_back(std::min(i, j), std::max(i, j));
    }
    std::sort(conflicts_.begin(), conflicts_.end());
    conflicts_.erase(std::unique(conflicts_.begin(), conflicts_.end()), conflicts_.end());
}

void LabelingBridge::add_pins(const BridgeInput& input) {
    const SegmentGraph& graph = *input.graph;
    const auto must_stay = [&](int node) {
        const int pinned = graph.nodes[node].pinned_valence;
        return pinned == 1 || pinned >= 3;
    };
    std::map<int, int> value_of_label;
    for (int s = 0; s < static_cast<int>(graph.segments.size()); ++s) {
        const GraphSegment& segment = graph.segments[s];
        if (segment.is_pinned) {
            value_of_label[label_of_segment_[s]] = 1;
        } else if ((!input.is_forced_out.empty() && input.is_forced_out[s]) ||
                   (segment.is_short && must_stay(segment.nodes[0]) &&
                    must_stay(segment.nodes[1]))) {
            // A short segment between two nodes that pins hold can be neither fused nor collapsed.
            value_of_label[label_of_segment_[s]] = 0;
        }
    }
    for (const auto& [label, value] : value_of_label) rules_.push_back(unit_rule(label, value));
}

void LabelingBridge::add_valence_rules(const BridgeInput& input) {
    for (int v = 0; v < static_cast<int>(label_of_node_.size()); ++v) {
        const int c = label_of_node_[v];
        if (c < 0) continue;
        const std::vector<int>& star = input.graph->incident[v];
        Rule rule;
        if (star.size() == 1) {
            rule = {Relation::LessEqual, 0, {{1, label_of_segment_[star[0]]}, {-1, c}}};
        } else {
            rule.right_hand_side = 2;
            for (int s : star) rule.terms.push_back({1, label_of_segment_[s]});
            rule.terms.push_back({-(static_cast<int>(star.size()) - 2), c});
        }
        rules_.push_back(std::move(rule));
        stars_.push_back({c, {}});
        for (int s : star) stars_.back().members.push_back(label_of_segment_[s]);
    }
}

void LabelingBridge::add_support_rules(const BridgeInput& input) {
    const SegmentGraph& graph = *input.graph;
    for (int s = 0; s < static_cast<int>(graph.segments.size()); ++s) {
        const GraphSegment& segment = graph.segments[s];
        if (!segment.is_short || segment.is_pinned) continue;
        Rule rule{Relation::GreaterEqual, 0, {{-1, label_of_segment_[s]}}};
        for (int node : segment.nodes) {
            for (int other : graph.incident[node]) {
                if (other != s) rule.terms.push_back({1, label_of_segment_[other]});
            }
        }
        rules_.push_back(std::move(rule));
    }
}

void LabelingBridge::add_inherited_rules(const BridgeInput& input) {
    const SegmentGraph& graph = *input.graph;
    std::set<std::array<int, 3>> written;
    const auto inherit = [&](int s, int conflicting) {
        const int c = label_of_segment_[conflicting];
        for (int e : graph.incident[graph.segments[s].nodes[0]]) {
            for (int f : graph.incident[graph.segments[s].nodes[1]]) {
                if (e == s || f == s || e == f) continue;
                std::array<int, 3> labels{c, label_of_segment_[e], label_of_segment_[f]};
                if (labels[0] == labels[1] || labels[0] == labels[2]) continue;
                if (in_conflict(labels[0], labels[1]) || in_conflict(labels[0], labels[2]) ||
                    in_conflict(labels[1], labels[2])) {
                    continue;
                }
                if (graph.segments[e].is_pinned && graph.segments[f].is_pinned &&
                    graph.segments[conflicting].is_pinned) {
                    continue;
                }
                std::sort(labels.begin(), labels.end());
                if (!written.insert(labels).second) continue;
                rules_.push_back(
                    Rule{Relation::LessEqual, 2, {{1, labels[0]}, {1, labels[1]}, {1, labels[2]}}});
            }
        }
    };
    for (const Conflict& conflict : input.conflicts->conflicts) {
        if (graph.segments[conflict.first].is_short) inherit(conflict.first, conflict.second);
        if (graph.segments[conflict.second].is_short) inherit(conflict.second, conflict.first);
    }
}

void LabelingBridge::add_bonuses(const BridgeInput& input) {
    std::map<std::pair<int, int>, double> sums;
    for (const PairBonus& bonus : input.bonuses) {
        const int i = label_of_segment_[bonus.first];
        const int j = label_of_segment_[bonus.second];
        if (i == j) {
            weights_[i] += bonus.value;
        } else {
            sums[{std::min(i, j), std::max(i, j)}] += bonus.value;
        }
    }
    for (const auto& [pair, value] : sums) {
        if (!in_conflict(pair.first, pair.second)) {
            bonuses_.push_back({pair.first, pair.second, value});
        }
    }
}

void LabelingBridge::forbid_alone(const std::vector<int>& piece,
                                  const std::vector<int>& neighbours) {
    std::set<int> inside, outside;
    for (int s : piece) inside.insert(label_of_segment_[s]);
    for (int s : neighbours) outside.insert(label_of_segment_[s]);
    Rule rule{Relation::LessEqual, static_cast<std::int64_t>(inside.size()) - 1, {}};
    for (int label : inside) rule.terms.push_back({1, label});
    for (int label : outside) {
        if (!inside.contains(label)) rule.terms.push_back({-1, label});
    }
    rules_.push_back(std::move(rule));
}

labeling::LabelingProblem LabelingBridge::build() const {
    double sum = 0;
    for (double weight : weights_) sum += weight;
    for (const PairBonus& bonus : bonuses_) sum += bonus.value;
    double units = 1;
    if (sum > 0) {
        const double target = std::max(1e9, 1e6 * static_cast<double>(weights_.size()));
        units = std::pow(10.0, std::ceil(std::log10(target / sum)));
    }
    labeling::ProblemBuilder builder;
    builder.set_units_per_one(units);
    for (std::size_t l = 0; l < weights_.size(); ++l) {
        const bool is_segment = !segments_[l].empty();
        const auto weight = static_cast<labeling::Value>(std::llround(weights_[l] * units));
        builder.add_label(is_segment ? std::max<labeling::Value>(1, weight) : 0, names_[l]);
    }
    for (const auto& [i, j] : conflicts_) builder.add_conflict(i, j);
    for (const PairBonus& bonus : bonuses_) {
        builder.add_bonus(bonus.first, bonus.second, std::llround(bonus.value * units));
    }
    for (const Rule& rule : rules_) builder.add_rule(rule);
    return builder.build();
}

void LabelingBridge::relax_node_labels(labeling::Solution& solution) const {
    for (const Star& star : stars_) {
        int kept = 0;
        for (int label : star.members) kept += solution.labels[label];
        solution.labels[star.label] = kept > (star.members.size() == 1 ? 0 : 2);
    }
}

std::vector<bool> LabelingBridge::kept_segments(const labeling::Solution& solution) const {
    std::vector<bool> kept(label_of_segment_.size());
    for (std::size_t s = 0; s < kept.size(); ++s) {
        kept[s] = solution.labels[label_of_segment_[s]] == 1;
    }
    return kept;
}

std::vector<int> split_groups(const std::vector<std::vector<int>>& order, int segment_count,
                              const std::vector<Conflict>& conflicts, bool is_dissolving) {
    std::vector<int> curve(segment_count, -1), place(segment_count, -1);
    for (std::size_t g = 0; g < order.size(); ++g) {
        for (std::size_t k = 0; k < order[g].size(); ++k) {
            curve[order[g][k]] = static_cast<int>(g);
            place[order[g][k]] = static_cast<int>(k);
        }
    }
    // cut[g][k]: a new group begins at the k-th segment of curve g. Short spans first, so that one
    // cut serves every longer conflict across it.
    std::vector<std::set<int>> cuts(order.size());
    std::vector<std::array<int, 3>> inner;
    for (const Conflict& conflict : conflicts) {
        if (curve[conflict.first] < 0 || curve[conflict.first] != curve[conflict.second]) continue;
        const auto span = std::minmax(place[conflict.first], place[conflict.second]);
        inner.push_back({span.second - span.first, curve[conflict.first], span.first});
    }
    std::sort(inner.begin(), inner.end());
    for (const auto& [span, g, first] : inner) {
        if (is_dissolving) {
            for (int k = 1; k < static_cast<int>(order[g].size()); ++k) cuts[g].insert(k);
            continue;
        }
        const auto cut = cuts[g].upper_bound(first);
        if (cut != cuts[g].end() && *cut <= first + span) continue;
        cuts[g].insert(first + (span + 1) / 2);
    }
    std::vector<int> groups(segment_count, -1);
    int next = 0;
    for (std::size_t g = 0; g < order.size(); ++g) {
        for (std::size_t k = 0; k < order[g].size(); ++k) {
            if (k == 0 || cuts[g].contains(static_cast<int>(k))) ++next;
            groups[order[g][k]] = next - 1;
        }
    }
    for (int s = 0; s < segment_count; ++s) {
        if (groups[s] < 0) groups[s] = next++;
    }
    return groups;
}

}  // namespace fcn
