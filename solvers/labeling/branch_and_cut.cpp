// LP-based branch and cut on the term formulation: a column per label and per bonus, rows from
// cliques of the term conflict graph (conflicts, links and implications in one), rules as lazy
// rows, Gomory cuts at the root once cliques stall. Exactness: a node is pruned, and a label fixed
// by its reduced cost, only on bounds recomputed in integers (relaxation.cpp); solutions are
// complete propagated assignments with integer values. When fixing at the root has shrunk the
// problem by a third or split it, the rest is handed back to be solved as smaller problems, with
// new cliques and a smaller LP; otherwise the tree (cut_tree.cpp) closes what is left.
#include "labeling/branch_and_cut.h"

#include <algorithm>
#include <cmath>

#include "labeling/clique_cuts.h"
#include "labeling/cut_tree.h"
#include "labeling/gomory_cuts.h"
#include "labeling/greedy.h"
#include "labeling/local_search.h"
#include "labeling/rank_two_cuts.h"
#include "labeling/rows.h"
#include "labeling/subproblem.h"
#include "labeling/term_graph.h"
#include "labeling/triple_cuts.h"

namespace labeling {
namespace {

constexpr std::int64_t kNoIterationLimit = std::int64_t{1} << 40;

class BranchAndCut {
public:
    BranchAndCut(const LabelingProblem& problem, const std::optional<Solution>& start, Value lower,
                 RunControl& control, const BranchAndCutOptions& options)
        : problem_(problem),
          control_(control),
          options_(options),
          rows_(problem),
          propagator_(problem, rows_),
          is_consistent_(propagator_.propagate_all()),
          graph_(problem, propagator_, &control),
          lane_({problem, rows_, graph_, options.techniques, options.lp, options.seed},
                propagator_),
          relaxation_(lane_.relaxation),
          triples_(problem, rows_, graph_),
          rank_two_(problem, rows_, graph_),
          first_work_(control.work()) {
        lane_.use(control, options.threads);
        lane_.best_value = lower;
        if (start && start->value > lower) {
            result_.solution = start;
            lane_.best_value = start->value;
        }
    }

    TreeResult run() {
        if (is_consistent_ && control_.is_over()) {
            open_bound_ = sum_of_gains(problem_);
        } else if (is_consistent_ && begin()) {
            lane_.add_initial_rows();
            lane_.charge(graph_.work());
            solve_root();
        }
        result_.bound = std::max(lane_.best_value, open_bound_);
        return std::move(result_);
    }

    const BranchAndCutStatistics& statistics() const { return lane_.statistics; }

private:
    enum class NodeOutcome { Pruned, Branch, Stopped };

    bool begin() {
        lane_.begin();
        return fix_impossible();
    }

    bool fix_impossible() {
        for (TermGraph::Node v : graph_.impossible()) {
            if (graph_.is_off_node(v)) {
                if (!lane_.state.assign(graph_.column(v), true)) return false;
            } else if (v < graph_.label_count()) {
                if (!lane_.state.assign(v, false)) return false;
            } else {
                lane_.state.forbid_bonus(v - graph_.label_count());
            }
        }
        return true;
    }

    // ---- root -------------------------------------------------------------------------------

    void solve_root() {
        const NodeOutcome outcome = cut_root();
        root_bound_ = std::min(root_bound_, relaxation_.bound());
        if (outcome == NodeOutcome::Pruned) return;
        if (outcome == NodeOutcome::Stopped) {
            open_bound_ = root_bound_;
            return;
        }
        if (hand_back()) return;
        search_tree();
    }

    NodeOutcome cut_root() {
        relaxation_.set_drops_tight_rows(true);
        double last = 0;
        int stalled = 0, last_polish = -kPolishGap;
        bool is_polish_idle = false;        ///< the last one found nothing
        std::vector<double> gomory_bounds;  ///< before each round of Gomory cuts
        for (int round = 0;; ++round) {
            const auto lp = lane_.solve(kNoIterationLimit);
            root_bound_ = std::min(root_bound_, relaxation_.bound());
            if (lane_.is_prunable(root_bound_)) return NodeOutcome::Pruned;
            if (options_.report && root_bound_ < kHuge) options_.report(std::nullopt, root_bound_);
            if (lp == LpEngine::Outcome::Failed || lp == LpEngine::Outcome::Infeasible) {
                return NodeOutcome::Branch;
            }
            if (control_.should_stop()) return NodeOutcome::Stopped;
            if (!fix_by_bounds()) return NodeOutcome::Pruned;
            // A few rules are not worth an LP of their own: they go with the cuts.
            const std::size_t rules = lane_.add_violated_rules();
            if (rules > kManyRules) continue;
            if (rules == 0 && lane_.accept_if_integral()) {
                collect();
                if (lane_.is_prunable(root_bound_)) return NodeOutcome::Pruned;
                return NodeOutcome::Branch;
            }
            const double bound = static_cast<double>(relaxation_.bound());
            const double gap = bound - static_cast<double>(std::max(lane_.best_value, Value{0}));
            const bool is_stalled = round > 0 && last - bound < 0.01 * std::max(1.0, gap);
            stalled = is_stalled ? stalled + 1 : 0;
            last = bound;
            if (round % 8 == 3 || (stalled == 1 && round >= last_polish + kPolishGap)) {
                const Value before = lane_.best_value;
                lane_.polish();
                is_polish_idle = lane_.best_value == before;
                last_polish = round;
            }
            collect();
            search_wide(round, stalled > 0, gap);
            // A search pays where the LP's solutions lead nowhere and there is room for a gain.
            if (is_polish_idle && gap > kClosedGap * bound) intensify();
            if (lane_.is_prunable(root_bound_)) return NodeOutcome::Pruned;
            std::size_t added = rules;
            if (stalled < 3) {
                added += lane_.add_cliques(root_clique_options()) + add_triples() + add_rank_two();
            }
            if (added == 0 || stalled >= 2) {
                gomory_bounds.push_back(bound);
                if (is_over_gomory(gomory_bounds, gap) || stalled > 8) return NodeOutcome::Branch;
                added += add_gomory(gap);
            }
            if (added == 0) return NodeOutcome::Branch;
            drop_rows(round, gap);
        }
    }

    /// Slack rows leave at once: they are most rows, and each costs time in every iteration. Tight
    /// ones without a multiplier go now and then, and only where the LP is tall: sometimes Clp
    /// rejects the basis that is left and goes on with the primal simplex for long.
    void drop_rows(int round, double gap) {
        const int age = idle_age(gap);
        const bool is_tall =
            kTall * relaxation_.column_count() < static_cast<double>(relaxation_.row_count());
        if (is_tall && round % (age + 1) == age) relaxation_.drop_idle_rows(age);
        relaxation_.drop_slack_rows();
    }

    /// Rounds after which an idle row leaves the root's LP: the more rounds are to come, the
    /// sooner.
    int idle_age(double gap) const {
        if (is_large()) return 1;
        const auto value = static_cast<double>(std::max(lane_.best_value, Value{0}));
        return gap > kWideGap * value ? 2 : 4;
    }

    /// The last rounds of Gomory cuts closed less of the gap than as much work in the tree would.
    static bool is_over_gomory(const std::vector<double>& bounds, double gap) {
        if (bounds.size() > kMostGomoryRounds) return true;
        if (bounds.size() <= kGomoryPatience) return false;
        const double before = bounds[bounds.size() - 1 - kGomoryPatience];
        return before - bounds.back() < kGomoryGain * static_cast<double>(kGomoryPatience) * gap;
    }

    std::size_t add_triples() {
        if (!options_.techniques.triple_cuts) return 0;
        const std::int64_t before = triples_.work() + lane_.separator.work();
        std::size_t added = 0;
        for (Cut& cut : triples_.separate(relaxation_.x(), lane_.separator, lane_.propagator)) {
            added += relaxation_.add(std::move(cut)) ? 1 : 0;
        }
        lane_.charge(triples_.work() + lane_.separator.work() - before);
        lane_.statistics.triple_cuts += static_cast<std::int64_t>(added);
        return added;
    }

    std::size_t add_rank_two() {
        if (!options_.techniques.rank_two_cuts) return 0;
        RankTwoCutOptions options;
        if (is_large()) options.max_cuts = 1500;
        const std::int64_t before = rank_two_.work();
        std::size_t added = 0;
        for (Cut& cut : rank_two_.separate(relaxation_.x(), options)) {
            added += relaxation_.add(std::move(cut)) ? 1 : 0;
        }
        lane_.charge(rank_two_.work() - before);
        lane_.statistics.rank_two_cuts += static_cast<std::int64_t>(added);
        return added;
    }

    /// Sparse cuts first; denser ones, which slow the LP down, only where these run dry and the gap
    /// will take a large tree.
    std::size_t add_gomory(double gap) {
        if (!options_.techniques.gomory_cuts) return 0;
        std::int64_t work = 0;
        std::size_t added = 0;
        while (true) {
            for (Cut& cut : gomory_cuts(relaxation_, gomory_options_, work)) {
                added += relaxation_.add(std::move(cut)) ? 1 : 0;
            }
            const bool may_be_dense =
                gap > kDenseGap * std::abs(static_cast<double>(lane_.best_value));
            if (added > 0 || !may_be_dense || gomory_options_.max_entries > kMostEntries / 2) break;
            gomory_options_.max_entries *= 2;
        }
        lane_.charge(work);
        lane_.statistics.gomory_cuts += static_cast<std::int64_t>(added);
        return added;
    }

    bool is_large() const { return relaxation_.column_count() > kLargeColumns; }

    CliqueCutOptions root_clique_options() const {
        CliqueCutOptions options;
        if (is_large()) options.max_cuts = 2000;
        return options;
    }

    /// Labels by the exact bound, then bonuses; false when that leaves no better solution.
    bool fix_by_bounds() {
        if (!lane_.fix_by_bounds()) return false;
        if (lane_.best_value == kNoValue || !options_.techniques.fixing) return true;
        for (std::int32_t k = 0; k < graph_.bonus_count(); ++k) {
            const std::int32_t column = problem_.label_count() + k;
            if (relaxation_.is_fixed(column)) continue;
            if (lane_.is_prunable(relaxation_.bound_if(column, true))) lane_.state.forbid_bonus(k);
        }
        return true;
    }

    /// The rest as smaller problems, if that pays; true when it did the job.
    bool hand_back() {
        if (!options_.solve_rest || !options_.techniques.restarts) return false;
        Decomposer decomposer(problem_, rows_);
        const auto parts = decomposer.parts(lane_.propagator);
        std::size_t largest = 0;
        for (const auto& part : parts) largest = std::max(largest, part.size());
        if (3 * largest > 2 * static_cast<std::size_t>(problem_.label_count())) return false;
        const Value decided = decided_value(problem_, lane_.propagator.values());
        Solution whole;
        whole.labels.resize(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) {
            whole.labels[i] = lane_.propagator.value(i) == 1;
        }
        whole.value = decided;
        Value bound = decided;
        bool is_complete = true;
        for (const auto& part : parts) {
            const Subproblem sub = decomposer.extract(lane_.propagator, part);
            const std::optional<Solution> start = restricted(sub);
            TreeResult rest = options_.solve_rest(sub.problem, start);
            result_.nodes += rest.nodes;
            if (rest.bound == kNoValue && !rest.solution) return true;  // no better solution
            bound += rest.bound;
            if (!rest.solution) {
                is_complete = false;
                continue;
            }
            whole.value += rest.solution->value;
            for (std::size_t k = 0; k < part.size(); ++k) {
                whole.labels[part[k]] = rest.solution->labels[k];
            }
        }
        if (is_complete && whole.value > lane_.best_value) accept(std::move(whole));
        open_bound_ = std::min(root_bound_, bound);
        return true;
    }

    /// The best solution on a part, where it is feasible there.
    std::optional<Solution> restricted(const Subproblem& sub) const {
        if (!result_.solution) return std::nullopt;
        Solution start;
        for (Label i : sub.to_parent) start.labels.push_back(result_.solution->labels[i]);
        start.value = labeling_value(sub.problem, start.labels);
        if (!check_solution(sub.problem, start).is_feasible) return std::nullopt;
        return start;
    }

    // ---- solutions --------------------------------------------------------------------------

    void accept(Solution solution) {
        lane_.best_value = solution.value;
        result_.solution = std::move(solution);
        if (options_.report) options_.report(lane_.best_value, std::nullopt);
    }

    /// What the lane has found on its own.
    void collect() {
        if (auto solution = lane_.take_solution()) accept(std::move(*solution));
    }

    /// Keeps a share of the work for the local search, in chunks long enough to be worth it.
    void intensify() {
        if (!options_.techniques.heuristics || !result_.solution) return;
        const std::int64_t due = (control_.work() - first_work_) / kSearchShare - search_work_;
        if (due < kSearchChunk * problem_.label_count()) return;
        search(due, 1.5, due / 4);
    }

    /// Where the gap is wide, a short search tells whether that is for want of a labeling (of large
    /// problems it would have to be long). Where cliques leave it wide a proof is far, and what
    /// counts is the labeling: one long search, because many short ones find less.
    void search_wide(int round, bool is_stalled, double gap) {
        if (!options_.techniques.heuristics || !result_.solution || has_searched_long_) return;
        const std::int64_t left = control_.ticks_left();
        if (round >= 1 && !has_searched_short_ && !is_large() && is_wide(gap)) {
            has_searched_short_ = true;
            const Value before = lane_.best_value;
            search(std::min(kShortSearch * problem_.label_count(), left / 10), 1.5, 0);
            gap -= static_cast<double>(lane_.best_value - before);
        }
        const std::int64_t spent = control_.work() - first_work_;
        const bool is_due = round >= kLongSearchRound &&
                            (is_stalled || is_large() || round >= 2 * kLongSearchRound);
        if (!is_due && (round < 2 || spent < left / 3)) return;
        has_searched_long_ = true;
        if (!is_wide(gap)) return;
        search(std::min(kLongSearch * problem_.label_count(), left / 5 * 2), 3.0, 0);
    }

    bool is_wide(double gap) const {
        return gap >= kWideGap * std::abs(static_cast<double>(lane_.best_value));
    }

    void search(std::int64_t ticks, double temperature, std::int64_t first_chain) {
        const std::int64_t before = control_.work();
        RunControl::Cap cap(control_, ticks);
        LocalSearchOptions search;
        search.seed = options_.seed + 2000 + search_count_++;
        search.threads = options_.threads;
        search.start_temperature = temperature;
        search.first_chain = first_chain;
        Solution better = improve_labeling(problem_, rows_, control_, *result_.solution, search);
        search_work_ += control_.work() - before;
        if (better.value > lane_.best_value) accept(std::move(better));
    }

    // ---- tree -------------------------------------------------------------------------------

    void search_tree() {
        relaxation_.set_drops_tight_rows(false);
        relaxation_.drop_idle_rows(1);
        CutTreeOptions tree;
        tree.lanes = options_.techniques.tree_lanes;
        tree.threads = options_.threads;
        tree.report = [this](std::optional<Solution> solution, Value bound) {
            if (solution) accept(std::move(*solution));
            if (options_.report) options_.report(std::nullopt, bound);
        };
        tree.improve = [this] {
            intensify();
            return result_.solution;
        };
        const std::int64_t before = lane_.statistics.nodes;
        open_bound_ = search_cut_tree(lane_, root_bound_, tree);
        result_.nodes += lane_.statistics.nodes - before;
    }

    static constexpr Value kHuge = Value{1} << 60;
    static constexpr std::int64_t kSearchShare = 8;                        ///< one part in so many
    static constexpr std::int64_t kSearchChunk = 500;                      ///< ticks per label
    static constexpr std::int64_t kLongSearch = 8000, kShortSearch = 800;  ///< ticks per label
    static constexpr int kLongSearchRound = 6;
    static constexpr double kWideGap = 0.02;    ///< of the best value
    static constexpr double kClosedGap = 5e-4;  ///< of the bound
    static constexpr int kPolishGap = 4;        ///< rounds
    static constexpr double kTall = 4.0 / 3;    ///< rows per column
    static constexpr std::size_t kManyRules = 20;
    static constexpr std::size_t kMostGomoryRounds = 30, kGomoryPatience = 4;
    static constexpr double kGomoryGain = 0.08;  ///< of the gap, per round
    static constexpr std::size_t kMostEntries = 640;
    static constexpr double kDenseGap = 0.01;  ///< of the best value
    static constexpr std::int32_t kLargeColumns = 8000;

    const LabelingProblem& problem_;
    RunControl& control_;
    const BranchAndCutOptions& options_;
    const RowSystem rows_;
    Propagator propagator_;
    const bool is_consistent_;
    TermGraph graph_;
    CutLane lane_;
    Relaxation& relaxation_;
    TripleSeparator triples_;
    RankTwoSeparator rank_two_;
    GomoryCutOptions gomory_options_;
    TreeResult result_;
    Value root_bound_ = kHuge, open_bound_ = kNoValue;
    std::uint64_t search_count_ = 0;
    const std::int64_t first_work_;
    std::int64_t search_work_ = 0;
    bool has_searched_short_ = false, has_searched_long_ = false;
};

}  // namespace

TreeResult branch_and_cut(const LabelingProblem& problem, const std::optional<Solution>& start,
                          Value lower, RunControl& control, const BranchAndCutOptions& options,
                          BranchAndCutStatistics* statistics) {
    BranchAndCut search(problem, start, lower, control, options);
    TreeResult result = search.run();
    if (statistics != nullptr) {
        *statistics += search.statistics();
    }
    return result;
}

}  // namespace labeling
