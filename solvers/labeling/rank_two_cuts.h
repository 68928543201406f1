#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"
#include "labeling/relaxation.h"
#include "labeling/rows.h"
#include "labeling/term_graph.h"
#include "labeling/triple_table.h"

namespace labeling {

struct RankTwoCutOptions {
    double min_violation = 0.01;
    std::size_t max_cuts = 600;
    std::size_t max_starts = 6000;  ///< three-label rules that a search starts from
    int max_uses = 4;               ///< of a term as member of cuts found, before starts skip it
    int max_tries = 24;             ///< of a label as part of a start
};

/// Separates rows "at most two of these terms", which rules of three labels and conflicts imply.
class RankTwoSeparator {
public:
    RankTwoSeparator(const LabelingProblem& problem, const RowSystem& rows, const TermGraph& graph);

    /// Cuts that x violates, the most violated first.
    std::vector<Cut> separate(std::span<const double> x, const RankTwoCutOptions& options = {});
    std::int64_t work() const { return work_; }

private:
    using Node = TermGraph::Node;
    using Bits = std::vector<std::uint64_t>;
    using Start = std::array<Node, 3>;

    /// One or two labels that the term needs.
    std::span<const Label> labels_of(Node v) const;
    std::span<const std::int32_t> bonuses_of(Label i) const;
    /// False only if all three may be on together.
    bool excludes(Node u, Node v, Node w) const;
    template <typename Visit>
    void visit_thirds(Node u, Node v, const Visit& visit) const;

    void build_support(std::span<const double> x);
    std::vector<Start> starts(std::span<const double> x, std::size_t most);
    bool with_bonuses(std::span<const double> x, Start& start) const;
    void begin(const Start& start);
    void insert(Node v);
    Node next_candidate(int skip) const;
    void grow(int skip);
    void lift_by_two(std::span<const double> x);
    void lift_by_one();
    Cut cut() const;

    const TermGraph& graph_;
    const TripleTable table_;
    std::vector<std::array<Label, 2>> ends_;  ///< per bonus
    std::vector<Label> identity_;
    std::vector<std::size_t> bonus_begin_;
    std::vector<std::int32_t> bonuses_at_;  ///< bonus indices by label
    std::vector<Node> support_;             ///< fractional terms, by falling value
    std::vector<std::int32_t> local_;       ///< per node, -1 outside of the support
    std::vector<std::uint64_t> adjacency_;  ///< support x support bits
    std::size_t words_ = 0;
    Bits candidates_, excluded_;
    std::vector<Node> ones_, twos_;  ///< terms of the cut, by coefficient
    std::int64_t work_ = 0;
};

}  // namespace labeling
