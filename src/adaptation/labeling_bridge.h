#pragma once

#include <string>
#include <utility>
#include <vector>

#include "adaptation/conflicts.h"
#include "adaptation/segment_graph.h"
#include "adaptation/weights.h"
#include "labeling/problem.h"
#include "labeling/solution.h"

namespace fcn {

/// What the bridge needs to know of the geometric side.
struct BridgeInput {
    const SegmentGraph* graph = nullptr;
    const ConflictResult* conflicts = nullptr;
    std::vector<double> weights;  ///< w(e) per segment, real units, >= 0
    std::vector<PairBonus> bonuses;
    /// Segments of equal group share one label (orbits, whole curves); groups 0 .. n-1, each
    /// used. Empty = every segment its own.
    std::vector<int> groups;
    std::vector<bool> is_forced_out;  ///< per segment (a user's pin); empty = none
};

/// The labeling problem of one iteration, in real units and still open for further rules, and the
/// way back to segments and nodes. The only place that translates between the two worlds.
class LabelingBridge {
public:
    explicit LabelingBridge(const BridgeInput& input);

    /// Adds: the segments of `piece` cannot all be kept unless one of `neighbours` is.
    void forbid_alone(const std::vector<int>& piece, const std::vector<int>& neighbours);

    /// Weights scaled by a power of ten so that all positive terms sum to at least 1e9 (10^6 a
    /// label for larger problems) and at most ten times that.
    labeling::LabelingProblem build() const;

    int label_of_segment(int segment) const { return label_of_segment_[segment]; }
    int label_of_node(int node) const { return label_of_node_[node]; }  ///< c label; -1 none
    int label_count() const { return static_cast<int>(weights_.size()); }
    const std::vector<int>& segments_of_label(int label) const { return segments_[label]; }

    /// Sets every c label to 1 only where its star needs it.
    void relax_node_labels(labeling::Solution& solution) const;
    std::vector<bool> kept_segments(const labeling::Solution& solution) const;

    /// A label that an inner conflict of its group forced out, with the two segments.
    struct InnerConflict {
        int label = -1, first = -1, second = -1;
    };
    const std::vector<InnerConflict>& inner_conflicts() const { return inner_conflicts_; }

private:
    void add_segment_labels(const BridgeInput& input);
    void add_conflicts(const BridgeInput& input);
    void add_pins(const BridgeInput& input);
    void add_valence_rules(const BridgeInput& input);
    void add_support_rules(const BridgeInput& input);
    void add_inherited_rules(const BridgeInput& input);
    void add_bonuses(const BridgeInput& input);
    bool in_conflict(int label, int other) const;

    std::vector<double> weights_;
    std::vector<std::string> names_;
    std::vector<std::vector<int>> segments_;
    std::vector<int> label_of_segment_, label_of_node_;
    std::vector<std::pair<int, int>> conflicts_;  ///< sorted label pairs
    std::vector<PairBonus> bonuses_;              ///< between labels
    std::vector<labeling::Rule> rules_;
    std::vector<InnerConflict> inner_conflicts_;
    struct Star {
        int label = -1;  ///< c
        std::vector<int> members;
    };
    std::vector<Star> stars_;
};

/// Splits groups of segments so that no conflict lies inside one: best mode's way to share
/// labels. `order` gives the segments of each group in their order along the curve; a conflict
/// cuts it halfway between its two segments. With `is_dissolving` the group falls apart instead.
std::vector<int> split_groups(const std::vector<std::vector<int>>& order, int segment_count,
                              const std::vector<Conflict>& conflicts, bool is_dissolving);

}  // namespace fcn
