#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "labeling/clique_cuts.h"
#include "labeling/late_bonuses.h"
#include "labeling/lp_engine.h"
#include "labeling/node_state.h"
#include "labeling/problem.h"
#include "labeling/propagation.h"
#include "labeling/relaxation.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"
#include "labeling/techniques.h"
#include "labeling/term_graph.h"
#include "labeling/tree_search.h"

namespace labeling {

struct BranchAndCutStatistics {
    std::int64_t nodes = 0, lp_iterations = 0, clique_cuts = 0, triple_cuts = 0, rank_two_cuts = 0,
                 gomory_cuts = 0, rule_rows = 0;
    std::int64_t fixed_labels = 0;
    /// Ticks of the tree, and what is left of them with a thread for each lane.
    std::int64_t tree_work = 0, tree_path = 0;

    BranchAndCutStatistics& operator+=(const BranchAndCutStatistics& other);
};

/// One relaxation with the partial assignment it stands at, and what is done with either at any
/// node: fixing by bounds, rows and cliques that are violated, labelings from its solution. Lanes
/// of one problem share what never changes (problem, rows, graph) and nothing else.
class CutLane {
public:
    struct Shared {
        const LabelingProblem& problem;
        const RowSystem& rows;
        const TermGraph& graph;
        const Techniques& techniques;
        const LpFactory& lp;
        std::uint64_t seed = 1;
    };

    CutLane(const Shared& shared, const Propagator& propagator);
    /// A copy at the first `trail_size` decisions, with an LP solver of its own. `number` tells the
    /// lanes apart; of two lanes none may have the other's.
    CutLane(const CutLane& other, std::size_t trail_size, std::uint32_t number);

    /// Everything below spends its work there. Threads: of the local search.
    void use(RunControl& control, int threads) {
        control_ = &control;
        threads_ = threads;
    }
    RunControl& control() { return *control_; }
    bool charge(std::int64_t entries);

    /// Solutions of value > this are looked for; accept() and whoever shares them raises it.
    Value best_value = kNoValue;
    bool is_prunable(Value bound) const { return bound <= best_value; }
    /// Better solutions since the last call: the best of them.
    std::optional<Solution> take_solution();
    void accept(Solution solution);

    LpEngine::Outcome solve(std::int64_t max_iterations);
    /// Before anything else: leaves small bonuses out of the LP where labels have many.
    void begin();
    /// Conflicts, and the links of the bonuses in the LP.
    void add_initial_rows();
    /// Fixes what the exact bound allows; false when that leaves no better solution.
    bool fix_by_bounds();
    /// Rows left out of the LP that its solution violates: dropped ones and rules; bonuses that it
    /// overrates.
    std::size_t add_violated_rules();
    std::size_t add_cliques(const CliqueCutOptions& options);
    /// Rounds an integral LP solution; true when it was integral and feasible.
    bool accept_if_integral();
    /// All labels are decided and consistent: the value is exact.
    void accept_leaf();
    /// Completes the rounded LP solution greedily and improves it a little.
    void polish();

    const Shared shared;
    Propagator propagator;
    Relaxation relaxation;
    NodeState state;
    CliqueSeparator separator;
    BranchAndCutStatistics statistics;

    static constexpr double kIntegrality = 1e-6;

private:
    std::optional<Solution> found_;
    LateBonuses late_bonuses_;
    RunControl* control_ = nullptr;
    int threads_ = 1;
    std::uint32_t number_ = 0;
    std::uint64_t polish_count_ = 0;
};

}  // namespace labeling
