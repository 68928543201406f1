#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/relaxation.h"
#include "labeling/term_graph.h"

namespace labeling {

/// Row "at most one of these literals": columns of off-nodes enter with -1.
Cut clique_cut(const TermGraph& graph, std::span<const TermGraph::Node> clique);

/// Maximal cliques that contain every label conflict. Incomplete when `control` is over.
std::vector<Cut> conflict_clique_cuts(const LabelingProblem& problem, const TermGraph& graph,
                                      RunControl& control);
/// For every one of these bonuses and each of its labels a maximal clique with "label off" and the
/// bonus: together they imply the links y <= b. Incomplete when `control` is over.
std::vector<Cut> link_clique_cuts(const LabelingProblem& problem, const TermGraph& graph,
                                  std::span<const std::int32_t> bonuses, RunControl& control);
/// Both, for all bonuses.
std::vector<Cut> initial_clique_cuts(const LabelingProblem& problem, const TermGraph& graph,
                                     RunControl& control);

struct CliqueCutOptions {
    double min_violation = 1e-3;
    std::size_t max_cuts = 800;
    int max_steps = 300;  ///< of the exact search, per starting node
};

/// Separates violated clique rows of the term graph.
class CliqueSeparator {
public:
    CliqueSeparator(const LabelingProblem& problem, const TermGraph& graph);

    /// Cuts that x violates, the most violated first.
    std::vector<Cut> separate(std::span<const double> x, const CliqueCutOptions& options = {});
    /// After separate(): a clique of large value among the candidates (a short exact search); its
    /// value into `weight`. Candidates of value 0 or 1 are ignored.
    std::vector<TermGraph::Node> best_clique(std::span<const TermGraph::Node> candidates,
                                             double& weight, int max_steps = 100);
    std::int64_t work() const { return work_; }

private:
    using Node = TermGraph::Node;
    using Bits = std::vector<std::uint64_t>;

    void build_support(std::span<const double> x);
    void search(std::size_t depth, double weight, int& steps_left);

    const LabelingProblem& problem_;
    const TermGraph& graph_;
    std::vector<Node> support_;             ///< by falling value
    std::vector<double> values_;            ///< per support index
    std::vector<std::int32_t> local_;       ///< per node, -1 outside of the support
    std::vector<std::uint64_t> adjacency_;  ///< support x support bits
    std::size_t words_ = 0;
    std::vector<Bits> candidates_;  ///< per search depth
    std::vector<std::int32_t> current_, best_;
    double best_weight_ = 0;
    std::vector<double> worth_;  ///< per column: preference among columns at zero
    std::int64_t work_ = 0;
};

}  // namespace labeling
