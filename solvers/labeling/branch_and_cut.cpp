// LP-based branch and cut on the term formulation: a column per label and per bonus, rows from
// cliques of the term conflict graph (conflicts, links and implications in one), rules as lazy
// rows, Gomory cuts at the root once cliques stall. Exactness: a node is pruned, and a label fixed
// by its reduced cost, only on bounds recomputed in integers (relaxation.cpp); solutions are
// complete propagated assignments with integer values. When fixing at the root has shrunk the
// problem by a third or split it, the rest is handed back to be solved as smaller problems, with
// new cliques and a smaller LP. The tree dives into the child that looks better and continues with
// the best bound; the label to branch on is chosen by strong branching, later by pseudo costs
// (Achterberg, Koch & Martin 2005). Strong branching runs its LPs nearly to the end: cut off after
// 60 iterations they often show no gain at all, and the tree chose badly.
#include "labeling/branch_and_cut.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "labeling/clique_cuts.h"
#include "labeling/gomory_cuts.h"
#include "labeling/greedy.h"
#include "labeling/local_search.h"
#include "labeling/node_state.h"
#include "labeling/rank_two_cuts.h"
#include "labeling/rows.h"
#include "labeling/subproblem.h"
#include "labeling/term_graph.h"
#include "labeling/triple_cuts.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
constexpr std::int64_t kNoIterationLimit = std::int64_t{1} << 40;
constexpr double kIntegrality = 1e-6;
constexpr std::size_t kMostOpenNodes = 20000;

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
          relaxation_(problem, options.lp),
          state_(problem, propagator_, relaxation_),
          separator_(problem, graph_),
          triples_(problem, rows_, graph_),
          rank_two_(problem, rows_, graph_),
          best_value_(lower),
          pseudo_costs_(problem.label_count()),
          first_work_(control.work()) {
        if (start && start->value > lower) {
            result_.solution = start;
            best_value_ = start->value;
        }
    }

    TreeResult run() {
        if (is_consistent_ && control_.is_over()) {
            open_bound_ = sum_of_gains(problem_);
        } else if (is_consistent_ && fix_impossible()) {
            for (Cut& cut : initial_clique_cuts(problem_, graph_, control_)) {
                relaxation_.add(std::move(cut));
            }
            charge(graph_.work());
            solve_root();
        }
        result_.bound = std::max(best_value_, open_bound_);
        return std::move(result_);
    }

    BranchAndCutStatistics statistics;

private:
    struct Decision {
        Label label;
        bool value;
    };
    struct Node {
        std::vector<Decision> decisions;
        Value bound = 0;
        std::shared_ptr<const Relaxation::SavedBasis> basis;
        std::int64_t number = 0;
    };
    struct WorseNode {
        bool operator()(const Node& a, const Node& b) const {
            return a.bound != b.bound ? a.bound < b.bound : a.number < b.number;
        }
    };
    struct PseudoCost {
        double sum[2] = {0, 0};
        int count[2] = {0, 0};
    };
    enum class NodeOutcome { Pruned, Branch, Stopped };

    bool charge(std::int64_t entries) { return control_.spend(entries / kEntriesPerTick + 1); }

    bool fix_impossible() {
        for (TermGraph::Node v : graph_.impossible()) {
            if (graph_.is_off_node(v)) {
                if (!state_.assign(graph_.column(v), true)) return false;
            } else if (v < graph_.label_count()) {
                if (!state_.assign(v, false)) return false;
            } else {
                state_.forbid_bonus(v - graph_.label_count());
            }
        }
        return true;
    }

    bool is_prunable(Value bound) const { return bound <= best_value_; }

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
        int stalled = 0;
        std::vector<double> gomory_bounds;  ///< before each round of Gomory cuts
        for (int round = 0;; ++round) {
            const auto lp = relaxation_.solve(control_, kNoIterationLimit);
            statistics.lp_iterations += relaxation_.engine().iterations();
            root_bound_ = std::min(root_bound_, relaxation_.bound());
            if (is_prunable(root_bound_)) return NodeOutcome::Pruned;
            if (options_.report && root_bound_ < kHuge) options_.report(std::nullopt, root_bound_);
            if (lp == LpEngine::Outcome::Failed || lp == LpEngine::Outcome::Infeasible) {
                return NodeOutcome::Branch;
            }
            if (control_.should_stop()) return NodeOutcome::Stopped;
            if (!fix_by_bounds(true)) return NodeOutcome::Pruned;
            // A few rules are not worth an LP of their own: they go with the cuts.
            const std::size_t rules = add_violated_rules();
            if (rules > kManyRules) continue;
            if (rules == 0 && accept_if_integral()) {
                if (is_prunable(root_bound_)) return NodeOutcome::Pruned;
                return NodeOutcome::Branch;
            }
            const double bound = static_cast<double>(relaxation_.bound());
            const double gap = bound - static_cast<double>(std::max(best_value_, Value{0}));
            const bool is_stalled = round > 0 && last - bound < 0.01 * std::max(1.0, gap);
            stalled = is_stalled ? stalled + 1 : 0;
            last = bound;
            if (round % 8 == 3 || (stalled == 1)) polish();
            search_long(round, gap);
            intensify();
            if (is_prunable(root_bound_)) return NodeOutcome::Pruned;
            std::size_t added = rules;
            if (stalled < 3) {
                added += add_cliques(root_clique_options()) + add_triples() + add_rank_two();
            }
            if (added == 0 || stalled >= 2) {
                gomory_bounds.push_back(bound);
                if (is_over_gomory(gomory_bounds, gap) || stalled > 8) return NodeOutcome::Branch;
                added += add_gomory(gap);
            }
            if (added == 0) return NodeOutcome::Branch;
            const int age = is_large() ? 1 : 2;
            if (round % (age + 1) == age) relaxation_.drop_idle_rows(age);
        }
    }

    /// The last rounds of Gomory cuts closed less of the gap than as much work in the tree would.
    static bool is_over_gomory(const std::vector<double>& bounds, double gap) {
        if (bounds.size() > kMostGomoryRounds) return true;
        if (bounds.size() <= kGomoryPatience) return false;
        const double before = bounds[bounds.size() - 1 - kGomoryPatience];
        return before - bounds.back() < kGomoryGain * static_cast<double>(kGomoryPatience) * gap;
    }

    std::size_t add_cliques(const CliqueCutOptions& options) {
        if (!options_.techniques.clique_cuts) return 0;
        const std::int64_t before = separator_.work();
        std::size_t added = 0;
        for (Cut& cut : separator_.separate(relaxation_.x(), options)) {
            added += relaxation_.add(std::move(cut)) ? 1 : 0;
        }
        charge(separator_.work() - before);
        statistics.clique_cuts += static_cast<std::int64_t>(added);
        return added;
    }

    std::size_t add_triples() {
        if (!options_.techniques.triple_cuts) return 0;
        const std::int64_t before = triples_.work() + separator_.work();
        std::size_t added = 0;
        for (Cut& cut : triples_.separate(relaxation_.x(), separator_, propagator_)) {
            added += relaxation_.add(std::move(cut)) ? 1 : 0;
        }
        charge(triples_.work() + separator_.work() - before);
        statistics.triple_cuts += static_cast<std::int64_t>(added);
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
        charge(rank_two_.work() - before);
        statistics.rank_two_cuts += static_cast<std::int64_t>(added);
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
            const bool may_be_dense = gap > kDenseGap * std::abs(static_cast<double>(best_value_));
            if (added > 0 || !may_be_dense || gomory_options_.max_entries > kMostEntries / 2) break;
            gomory_options_.max_entries *= 2;
        }
        charge(work);
        statistics.gomory_cuts += static_cast<std::int64_t>(added);
        return added;
    }

    bool is_large() const { return relaxation_.column_count() > kLargeColumns; }

    CliqueCutOptions root_clique_options() const {
        CliqueCutOptions options;
        if (is_large()) options.max_cuts = 2000;
        return options;
    }

    /// Rows left out of the LP that its solution violates: dropped ones and rules.
    std::size_t add_violated_rules() {
        const auto x = relaxation_.x();
        std::int64_t entries = 0;
        std::size_t added = relaxation_.restore_violated_rows(entries);
        for (std::int32_t r = 0; r < rows_.row_count(); ++r) {
            double activity = 0;
            for (const Term& t : rows_.terms(r)) activity += t.coefficient * x[t.label];
            entries += static_cast<std::int64_t>(rows_.terms(r).size());
            if (activity <= static_cast<double>(rows_.right_hand_side(r)) + 1e-6) continue;
            Cut cut;
            cut.right_hand_side = rows_.right_hand_side(r);
            for (const Term& t : rows_.terms(r)) cut.entries.push_back({t.label, t.coefficient});
            added += relaxation_.add(std::move(cut)) ? 1 : 0;
        }
        charge(entries);
        statistics.rule_rows += static_cast<std::int64_t>(added);
        return added;
    }

    /// Fixes what the exact bound allows; false when that leaves no better solution.
    bool fix_by_bounds(bool is_root) {
        if (best_value_ == kNoValue || !options_.techniques.fixing) return true;
        for (bool is_new = true; is_new;) {
            is_new = false;
            for (Label i = 0; i < problem_.label_count(); ++i) {
                if (!propagator_.is_free(i)) continue;
                const bool no_one = is_prunable(relaxation_.bound_if(i, true));
                const bool no_zero = is_prunable(relaxation_.bound_if(i, false));
                if (no_one && no_zero) return false;
                if (!no_one && !no_zero) continue;
                if (!state_.assign(i, no_zero)) return false;
                ++statistics.fixed_labels;
            }
        }
        if (!is_root) return true;
        for (std::int32_t k = 0; k < graph_.bonus_count(); ++k) {
            const std::int32_t column = problem_.label_count() + k;
            if (relaxation_.is_fixed(column)) continue;
            if (is_prunable(relaxation_.bound_if(column, true))) state_.forbid_bonus(k);
        }
        return true;
    }

    /// The rest as smaller problems, if that pays; true when it did the job.
    bool hand_back() {
        if (!options_.solve_rest || !options_.techniques.restarts) return false;
        Decomposer decomposer(problem_, rows_);
        const auto parts = decomposer.parts(propagator_);
        std::size_t largest = 0;
        for (const auto& part : parts) largest = std::max(largest, part.size());
        if (3 * largest > 2 * static_cast<std::size_t>(problem_.label_count())) return false;
        const Value decided = decided_value(problem_, propagator_.values());
        Solution whole;
        whole.labels.resize(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) {
            whole.labels[i] = propagator_.value(i) == 1;
        }
        whole.value = decided;
        Value bound = decided;
        bool is_complete = true;
        for (const auto& part : parts) {
            const Subproblem sub = decomposer.extract(propagator_, part);
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
        if (is_complete && whole.value > best_value_) accept(std::move(whole));
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
        best_value_ = solution.value;
        result_.solution = std::move(solution);
        if (options_.report) options_.report(best_value_, std::nullopt);
    }

    /// Rounds an integral LP solution; true when it was integral and feasible.
    bool accept_if_integral() {
        const auto x = relaxation_.x();
        Solution solution;
        solution.labels.resize(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) {
            if (std::min(x[i], 1 - x[i]) > kIntegrality) return false;
            solution.labels[i] = x[i] > 0.5;
        }
        solution.value = labeling_value(problem_, solution.labels);
        if (!check_solution(problem_, solution).is_feasible) return false;
        if (solution.value > best_value_) accept(std::move(solution));
        return true;
    }

    /// Completes the rounded LP solution greedily and improves it a little.
    void polish() {
        if (!options_.techniques.heuristics) return;
        std::vector<std::int8_t> start(problem_.label_count(), -1);
        const auto x = relaxation_.x();
        for (Label i = 0; i < problem_.label_count(); ++i) {
            if (x[i] > 0.5) start[i] = 1;
        }
        GreedyOptions greedy;
        greedy.start = start;
        greedy.max_backtracks = 100;
        GreedyResult found = greedy_labeling(problem_, rows_, control_, greedy);
        if (!found.solution) return;
        RunControl::Cap cap(control_, 40 * std::int64_t{problem_.label_count()});
        LocalSearchOptions search;
        search.seed = options_.seed + 1000 + static_cast<std::uint64_t>(polish_count_++);
        search.threads = options_.threads;
        search.start_temperature = 0.25;
        search.first_chain = 15 * std::int64_t{problem_.label_count()};
        Solution better =
            improve_labeling(problem_, rows_, control_, std::move(*found.solution), search);
        if (better.value > best_value_) accept(std::move(better));
    }

    /// Keeps a share of the work for the local search, in chunks long enough to be worth it.
    void intensify() {
        if (!options_.techniques.heuristics || !result_.solution) return;
        const std::int64_t due = (control_.work() - first_work_) / kSearchShare - search_work_;
        if (due < kSearchChunk * problem_.label_count()) return;
        search(due, 1.5, due / 4);
    }

    /// Where cliques leave a wide gap a proof is far, and what counts is the labeling: one long
    /// search, because many short ones find less.
    void search_long(int round, double gap) {
        if (!options_.techniques.heuristics || !result_.solution || has_searched_long_) return;
        const std::int64_t left = control_.ticks_left();
        const std::int64_t spent = control_.work() - first_work_;
        if (round < kLongSearchRound && (round < 2 || spent < left / 3)) return;
        has_searched_long_ = true;
        if (gap < kWideGap * std::abs(static_cast<double>(best_value_))) return;
        search(std::min(kLongSearch * problem_.label_count(), left / 5 * 2), 3.0, 0);
    }

    void search(std::int64_t ticks, double temperature, std::int64_t first_chain) {
        const std::int64_t before = control_.work();
        RunControl::Cap cap(control_, ticks);
        LocalSearchOptions search;
        search.seed = options_.seed + 2000 + static_cast<std::uint64_t>(polish_count_++);
        search.threads = options_.threads;
        search.start_temperature = temperature;
        search.first_chain = first_chain;
        Solution better = improve_labeling(problem_, rows_, control_, *result_.solution, search);
        search_work_ += control_.work() - before;
        if (better.value > best_value_) accept(std::move(better));
    }

    // ---- tree -------------------------------------------------------------------------------

    void search_tree() {
        root_size_ = state_.size();
        relaxation_.set_drops_tight_rows(false);
        relaxation_.drop_idle_rows(1);
        tree_rows_ = relaxation_.row_count();
        Node current;
        current.bound = root_bound_;
        bool has_current = true;
        while (true) {
            if (!has_current) {
                while (!open_.empty() && is_prunable(open_.top().bound)) open_.pop();
                if (open_.empty()) return;
                current = open_.top();
                open_.pop();
                if (!load(current)) continue;
            }
            has_current = false;
            intensify();
            ++statistics.nodes;
            ++result_.nodes;
            const NodeOutcome outcome = process(current);
            if (outcome == NodeOutcome::Pruned) continue;
            if (outcome == NodeOutcome::Stopped) {
                remember_open(current.bound);
                return;
            }
            report_bound(current.bound);
            has_current = branch(current);
            if (control_.should_stop()) {
                if (has_current) open_.push(std::move(current));
                remember_open(kNoValue);
                return;
            }
        }
    }

    void remember_open(Value bound) {
        open_bound_ = std::max(open_bound_, bound);
        if (!open_.empty()) open_bound_ = std::max(open_bound_, open_.top().bound);
        open_bound_ = std::min(open_bound_, root_bound_);
    }

    void report_bound(Value current) {
        Value bound = current;
        if (!open_.empty()) bound = std::max(bound, open_.top().bound);
        if (options_.report) {
            options_.report(std::nullopt, std::max(best_value_, std::min(bound, root_bound_)));
        }
    }

    /// Goes to a node that was left; false when it turns out contradictory.
    bool load(const Node& node) {
        state_.undo(root_size_);
        for (const Decision& d : node.decisions) {
            if (!state_.assign(d.label, d.value)) return false;
        }
        if (node.basis) relaxation_.restore_basis(*node.basis);
        return true;
    }

    NodeOutcome process(Node& node) {
        for (int round = 0;; ++round) {
            const auto lp = relaxation_.solve(control_, kNoIterationLimit);
            statistics.lp_iterations += relaxation_.engine().iterations();
            node.bound = std::min(node.bound, relaxation_.bound());
            if (is_prunable(node.bound)) return NodeOutcome::Pruned;
            if (control_.should_stop()) return NodeOutcome::Stopped;
            if (propagator_.free_count() == 0) return settle_leaf(node);
            if (lp == LpEngine::Outcome::Failed || lp == LpEngine::Outcome::Infeasible) {
                return NodeOutcome::Branch;
            }
            const std::size_t before = state_.size();
            if (!fix_by_bounds(false)) return NodeOutcome::Pruned;
            if (add_violated_rules() > 0) continue;
            if (state_.size() > before + 4 && round < 10) continue;
            if (accept_if_integral() && is_prunable(node.bound)) return NodeOutcome::Pruned;
            if (result_.nodes % 16 == 1 && round == 0) polish();
            if (round >= kNodeRounds || add_cliques({0.01, 200, 200}) == 0) break;
        }
        if (relaxation_.row_count() > tree_rows_ + tree_rows_ / 2) {
            relaxation_.drop_idle_rows(10);
            tree_rows_ = std::max(tree_rows_, relaxation_.row_count());
        }
        return NodeOutcome::Branch;
    }

    /// All labels are decided and consistent: the value is exact.
    NodeOutcome settle_leaf(const Node&) {
        Solution solution;
        solution.labels.resize(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) {
            solution.labels[i] = propagator_.value(i) == 1;
        }
        solution.value = labeling_value(problem_, solution.labels);
        if (solution.value > best_value_) accept(std::move(solution));
        return NodeOutcome::Pruned;
    }

    /// Branches; the better child becomes current, the other is left open. False: no child is left
    /// to go to directly.
    bool branch(Node& node) {
        const auto basis = std::make_shared<const Relaxation::SavedBasis>(relaxation_.save_basis());
        const std::size_t size = state_.size();
        bool is_settled = false;
        const Label label = choose(node, *basis, is_settled);
        if (is_settled) return false;
        if (label < 0) return true;  // strong branching decided labels: same node again
        const double x = std::clamp(relaxation_x_[label], 0.0, 1.0);
        const bool first_value = x > 0.4;
        Node other = node;
        other.decisions.push_back({label, !first_value});
        other.basis = basis;
        other.number = ++node_number_;
        const Value other_bound = first_value ? child_bounds_.first : child_bounds_.second;
        other.bound = std::min(node.bound, other_bound);
        if (!is_prunable(other.bound)) open_.push(std::move(other));
        if (open_.size() > kMostOpenNodes) drop_worst();
        node.decisions.push_back({label, first_value});
        const Value bound = first_value ? child_bounds_.second : child_bounds_.first;
        node.bound = std::min(node.bound, bound);
        state_.undo(size);
        if (is_prunable(node.bound) || !state_.assign(label, first_value)) return false;
        return true;
    }

    /// Memory bound: forgets every open node but remembers the largest bound.
    void drop_worst() {
        std::vector<Node> kept;
        while (!open_.empty() && kept.size() < kMostOpenNodes / 2) {
            kept.push_back(open_.top());
            open_.pop();
        }
        if (!open_.empty()) open_bound_ = std::max(open_bound_, open_.top().bound);
        open_ = {};
        for (Node& node : kept) open_.push(std::move(node));
    }

    /// Value of the relaxation that goes with each label: its own and half of its bonuses'.
    void weigh_labels() {
        masses_.assign(problem_.label_count(), 0.0);
        for (Label i = 0; i < problem_.label_count(); ++i) {
            masses_[i] = relaxation_x_[i] * static_cast<double>(problem_.weight(i));
        }
        for (std::int32_t k = 0; k < graph_.bonus_count(); ++k) {
            const Bonus& b = problem_.bonuses()[k];
            const double mass =
                relaxation_x_[problem_.label_count() + k] * static_cast<double>(b.value);
            masses_[b.first] += mass;
            masses_[b.second] += mass;
        }
    }

    /// What switching the label off (on) displaces: a guess of the gain before anything is known.
    double displaced(Label i, bool value) const {
        if (!value) return masses_[i];
        double sum = 0;
        for (Label j : problem_.conflicts_of(i)) sum += masses_[j];
        return sum;
    }

    double expected_gain(Label i, bool value) const {
        const PseudoCost& cost = pseudo_costs_[i];
        const double x = relaxation_x_[i];
        if (cost.count[value] > 0) {
            return cost.sum[value] / cost.count[value] * (value ? 1 - x : x);
        }
        return gain_per_mass_[value] * displaced(i, value);
    }

    double score(Label i) const {
        return std::max(1.0, expected_gain(i, false)) * std::max(1.0, expected_gain(i, true));
    }

    /// Label to branch on. -1: labels were decided instead and the node must be solved again.
    Label choose(Node& node, const Relaxation::SavedBasis& basis, bool& is_settled) {
        relaxation_x_.assign(relaxation_.x().begin(), relaxation_.x().end());
        child_bounds_ = {node.bound, node.bound};
        weigh_labels();
        std::vector<std::pair<double, Label>> candidates;
        for (Label i = 0; i < problem_.label_count(); ++i) {
            if (!propagator_.is_free(i)) continue;
            const double x = relaxation_x_[i];
            if (x > kIntegrality && x < 1 - kIntegrality) {
                candidates.emplace_back(score(i), i);
            }
        }
        if (candidates.empty()) {
            for (Label i = 0; i < problem_.label_count(); ++i) {
                if (propagator_.is_free(i)) return i;
            }
            settle_leaf(node);  // fixing by bounds decided the last labels
            is_settled = true;
            return -1;
        }
        std::stable_sort(candidates.begin(), candidates.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        if (!options_.techniques.strong_branching) return candidates[0].second;
        return strong_branch(node, basis, candidates, is_settled);
    }

    Label strong_branch(Node& node, const Relaxation::SavedBasis& basis,
                        const std::vector<std::pair<double, Label>>& candidates, bool& is_settled) {
        Label best = candidates[0].second;
        double best_score = -1;
        int tried = 0, without_gain = 0;
        bool has_decided = false;
        for (const auto& [score_now, i] : candidates) {
            if (tried >= kMostStrong || without_gain >= kPatience || control_.should_stop()) break;
            const PseudoCost& cost = pseudo_costs_[i];
            double gains[2];
            Value bounds[2] = {node.bound, node.bound};
            if (std::min(cost.count[0], cost.count[1]) >= kReliable) {
                gains[0] = cost.sum[0] / cost.count[0] * relaxation_x_[i];
                gains[1] = cost.sum[1] / cost.count[1] * (1 - relaxation_x_[i]);
            } else {
                ++tried;
                for (int value : {0, 1}) bounds[value] = probe(i, value == 1, node.bound);
                relaxation_.restore_basis(basis);
                if (is_prunable(bounds[0]) && is_prunable(bounds[1])) {
                    is_settled = true;
                    return -1;
                }
                if (is_prunable(bounds[0]) || is_prunable(bounds[1])) {
                    if (!state_.assign(i, is_prunable(bounds[0]))) {
                        is_settled = true;
                        return -1;
                    }
                    node.decisions.push_back({i, is_prunable(bounds[0])});
                    has_decided = true;
                    if (++without_gain >= 2) break;
                    continue;
                }
                for (int value : {0, 1}) {
                    gains[value] = static_cast<double>(node.bound - bounds[value]);
                    const double distance = value == 0 ? relaxation_x_[i] : 1 - relaxation_x_[i];
                    learn(i, value, gains[value], distance);
                }
            }
            const double score = std::max(1.0, gains[0]) * std::max(1.0, gains[1]);
            ++without_gain;
            if (score > best_score) {
                best_score = score;
                best = i;
                child_bounds_ = {bounds[0], bounds[1]};
                without_gain = 0;
            }
        }
        return has_decided ? -1 : best;
    }

    /// Bound of a child after a few dual simplex iterations.
    Value probe(Label i, bool value, Value parent) {
        const std::size_t size = state_.size();
        Value bound = kNoValue;
        if (state_.assign(i, value)) {
            relaxation_.solve(control_, kStrongIterations);
            statistics.lp_iterations += relaxation_.engine().iterations();
            bound = std::min(parent, relaxation_.bound());
        }
        state_.undo(size);
        return bound;
    }

    void learn(Label i, int value, double gain, double distance) {
        pseudo_costs_[i].sum[value] += gain / std::max(1e-6, distance);
        ++pseudo_costs_[i].count[value];
        total_gain_[value] += gain;
        total_mass_[value] += displaced(i, value == 1);
        if (total_mass_[value] > 0) gain_per_mass_[value] = total_gain_[value] / total_mass_[value];
    }

    static constexpr Value kHuge = Value{1} << 60;
    static constexpr std::int64_t kSearchShare = 6;    ///< one part in so many
    static constexpr std::int64_t kSearchChunk = 500;  ///< ticks per label
    static constexpr std::int64_t kLongSearch = 8000;  ///< ticks per label
    static constexpr int kLongSearchRound = 6;
    static constexpr double kWideGap = 0.02;  ///< of the best value
    static constexpr std::size_t kManyRules = 20;
    static constexpr std::size_t kMostGomoryRounds = 30, kGomoryPatience = 4;
    static constexpr double kGomoryGain = 0.08;  ///< of the gap, per round
    static constexpr std::size_t kMostEntries = 640;
    static constexpr double kDenseGap = 0.01;  ///< of the best value
    static constexpr std::int32_t kLargeColumns = 8000;
    static constexpr int kNodeRounds = 1;
    static constexpr int kMostStrong = 4;
    static constexpr int kPatience = 3;
    static constexpr int kReliable = 1;
    static constexpr std::int64_t kStrongIterations = 500;

    const LabelingProblem& problem_;
    RunControl& control_;
    const BranchAndCutOptions& options_;
    const RowSystem rows_;
    Propagator propagator_;
    const bool is_consistent_;
    TermGraph graph_;
    Relaxation relaxation_;
    NodeState state_;
    CliqueSeparator separator_;
    TripleSeparator triples_;
    RankTwoSeparator rank_two_;
    GomoryCutOptions gomory_options_;
    TreeResult result_;
    Value best_value_;
    Value root_bound_ = kHuge, open_bound_ = kNoValue;
    std::size_t root_size_ = 0;
    std::int32_t tree_rows_ = 0;
    std::priority_queue<Node, std::vector<Node>, WorseNode> open_;
    std::int64_t node_number_ = 0;
    std::vector<double> relaxation_x_;
    std::pair<Value, Value> child_bounds_;  ///< of the chosen label at 0 and at 1
    std::vector<PseudoCost> pseudo_costs_;
    std::vector<double> masses_;  ///< per label, see weigh_labels()
    double total_gain_[2] = {0, 0}, total_mass_[2] = {0, 0}, gain_per_mass_[2] = {1, 1};
    int polish_count_ = 0;
    const std::int64_t first_work_;
    std::int64_t search_work_ = 0;
    bool has_searched_long_ = false;
};

}  // namespace

TreeResult branch_and_cut(const LabelingProblem& problem, const std::optional<Solution>& start,
                          Value lower, RunControl& control, const BranchAndCutOptions& options,
                          BranchAndCutStatistics* statistics) {
    BranchAndCut search(problem, start, lower, control, options);
    TreeResult result = search.run();
    if (statistics != nullptr) {
        statistics->nodes += search.statistics.nodes;
        statistics->lp_iterations += search.statistics.lp_iterations;
        statistics->clique_cuts += search.statistics.clique_cuts;
        statistics->triple_cuts += search.statistics.triple_cuts;
        statistics->rank_two_cuts += search.statistics.rank_two_cuts;
        statistics->gomory_cuts += search.statistics.gomory_cuts;
        statistics->rule_rows += search.statistics.rule_rows;
        statistics->fixed_labels += search.statistics.fixed_labels;
    }
    return result;
}

}  // namespace labeling
