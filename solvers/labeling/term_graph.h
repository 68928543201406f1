#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"
#include "labeling/propagation.h"
#include "labeling/run_control.h"

namespace labeling {

/// Term conflict graph over literals. Nodes: label i is on (i), bonus k is earned (n + k), label i
/// is off (n + m + i). Two nodes are adjacent when no solution has both; found by probing: each
/// node is assumed in turn and propagated through conflicts and rules. So an implication a -> b is
/// the edge between a and "b is off", and y <= b_i is the edge between bonus and "label i is off".
class TermGraph {
public:
    using Node = std::int32_t;
    /// Some 70 MB. Fewer and more were slower on quads, whose bonuses are the many.
    static constexpr std::size_t kMostEdges = 3'000'000;

    /// `propagator` must be propagated; it is probed and restored. Labels that are decided have no
    /// edges. Nodes that probing refutes are listed in impossible(). Edges are missing when
    /// `control` ended the run meanwhile, and between light bonuses when `most_edges` are found.
    TermGraph(const LabelingProblem& problem, Propagator& propagator, RunControl* control = nullptr,
              std::size_t most_edges = kMostEdges);

    Node node_count() const { return 2 * label_count_ + bonus_count_; }
    Label label_count() const { return label_count_; }
    std::int32_t bonus_count() const { return bonus_count_; }
    Node label_node(Label i) const { return i; }
    Node bonus_node(std::int32_t k) const { return label_count_ + k; }
    Node off_node(Label i) const { return label_count_ + bonus_count_ + i; }
    bool is_off_node(Node v) const { return v >= label_count_ + bonus_count_; }
    /// Column of the linear relaxation (labels, then bonuses) that the node speaks of.
    std::int32_t column(Node v) const {
        return is_off_node(v) ? v - label_count_ - bonus_count_ : v;
    }

    std::span<const Node> neighbours(Node v) const {
        return {adjacency_.data() + begin_[v], begin_[v + 1] - begin_[v]};
    }
    bool adjacent(Node u, Node v) const;

    /// Nodes that are true in no solution.
    const std::vector<Node>& impossible() const { return impossible_; }
    std::int64_t work() const { return work_; }

private:
    std::vector<Node> probing_order(const LabelingProblem& problem) const;
    void probe(const LabelingProblem& problem, Propagator& propagator, Node v,
               std::vector<std::uint64_t>& edges);

    void build_adjacency(std::span<const std::uint64_t> edges);

    Label label_count_ = 0;
    std::int32_t bonus_count_ = 0;
    std::vector<std::size_t> begin_;
    std::vector<Node> adjacency_;
    std::vector<Node> impossible_;
    std::vector<std::size_t> bonus_begin_;  ///< per label
    std::vector<std::int32_t> bonuses_at_;  ///< bonus indices by label
    std::vector<std::uint64_t> matrix_;     ///< adjacency bits, only for few nodes
    std::size_t words_per_row_ = 0;
    std::size_t most_edges_ = 0;
    std::int64_t work_ = 0;
};

}  // namespace labeling
