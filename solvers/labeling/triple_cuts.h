#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "labeling/clique_cuts.h"
#include "labeling/propagation.h"
#include "labeling/relaxation.h"
#include "labeling/rows.h"
#include "labeling/term_graph.h"

namespace labeling {

/// Cuts from rules that bind three labels at a time: valence rules with a keep-label c,
/// sum_S b - k c <= 2, and rules b_i + b_j + b_k <= 2.
class TripleSeparator {
public:
    TripleSeparator(const LabelingProblem& problem, const RowSystem& rows, const TermGraph& graph);

    /// Cuts that x violates, the most violated first. `cliques` must have separated x before;
    /// `propagator` is probed and restored.
    std::vector<Cut> separate(std::span<const double> x, CliqueSeparator& cliques,
                              Propagator& propagator, std::size_t max_cuts = 300);
    std::int64_t work() const { return work_; }

private:
    using Node = TermGraph::Node;

    /// "Labels a and b are on", as the bonus between them or as b_a + b_b - 1, and the nodes that
    /// exclude it.
    struct Pair {
        Label a = 0, b = 0;
        Node bonus = -1;
    };
    struct Star {
        std::vector<Label> labels;
        Label keep = 0;
    };

    const std::vector<Node>& excluded(Label a, Label b, Propagator& propagator);
    double value(const Pair& pair, std::span<const double> x) const;
    void separate_star(const Star& star, std::span<const double> x, CliqueSeparator& cliques,
                       Propagator& propagator);
    void separate_triple(std::int32_t row, std::span<const double> x, CliqueSeparator& cliques,
                         Propagator& propagator);
    void add_cut(const Pair& pair, std::vector<Node> clique, const std::vector<Node>& allowed,
                 Label keep, std::span<const double> x);

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    const TermGraph& graph_;
    std::vector<Star> stars_;
    std::vector<std::int32_t> triples_;                         ///< rows b_i + b_j + b_k <= 2
    std::unordered_map<std::uint64_t, std::int32_t> bonus_of_;  ///< by label pair
    std::unordered_map<std::uint64_t, std::vector<Node>> excluded_;
    std::vector<std::pair<double, Cut>> found_;
    std::vector<std::uint8_t> mark_;  ///< per node
    std::int64_t work_ = 0;
};

}  // namespace labeling
