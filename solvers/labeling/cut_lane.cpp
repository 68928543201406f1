#include "labeling/cut_lane.h"

#include <algorithm>

#include "labeling/greedy.h"
#include "labeling/local_search.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
constexpr std::int64_t kPolishTicks = 40, kPolishChain = 15;  ///< per label

}  // namespace

BranchAndCutStatistics& BranchAndCutStatistics::operator+=(const BranchAndCutStatistics& other) {
    nodes += other.nodes;
    lp_iterations += other.lp_iterations;
    clique_cuts += other.clique_cuts;
    triple_cuts += other.triple_cuts;
    rank_two_cuts += other.rank_two_cuts;
    gomory_cuts += other.gomory_cuts;
    rule_rows += other.rule_rows;
    fixed_labels += other.fixed_labels;
    tree_work += other.tree_work;
    tree_path += other.tree_path;
    return *this;
}

CutLane::CutLane(const Shared& all, const Propagator& decided)
    : shared(all),
      propagator(decided),
      relaxation(all.problem, all.lp),
      state(all.problem, propagator, relaxation),
      separator(all.problem, all.graph) {}

CutLane::CutLane(const CutLane& other, std::size_t trail_size, std::uint32_t number)
    : best_value(other.best_value),
      shared(other.shared),
      propagator(other.propagator),
      relaxation(other.relaxation, shared.lp, number),
      state(other.state, propagator, relaxation),
      separator(shared.problem, shared.graph),
      late_bonuses_(other.late_bonuses_),
      number_(number) {
    state.undo(trail_size);
}

bool CutLane::charge(std::int64_t entries) {
    return control_->spend(entries / kEntriesPerTick + 1);
}

std::optional<Solution> CutLane::take_solution() {
    std::optional<Solution> taken;
    taken.swap(found_);
    return taken;
}

void CutLane::accept(Solution solution) {
    best_value = solution.value;
    found_ = std::move(solution);
}

LpEngine::Outcome CutLane::solve(std::int64_t max_iterations) {
    const auto outcome = relaxation.solve(*control_, max_iterations);
    statistics.lp_iterations += relaxation.iterations();
    return outcome;
}

void CutLane::begin() {
    if (shared.techniques.late_bonuses) {
        late_bonuses_.leave_out(shared.problem, relaxation, shared.techniques.many_bonuses);
    }
}

void CutLane::add_initial_rows() {
    for (Cut& cut : conflict_clique_cuts(shared.problem, shared.graph, *control_)) {
        relaxation.add(std::move(cut));
    }
    std::vector<std::int32_t> present;
    for (std::int32_t k = 0; k < shared.graph.bonus_count(); ++k) {
        if (!relaxation.is_left_out(shared.problem.label_count() + k)) present.push_back(k);
    }
    for (Cut& cut : link_clique_cuts(shared.problem, shared.graph, present, *control_)) {
        relaxation.add(std::move(cut));
    }
}

bool CutLane::fix_by_bounds() {
    if (best_value == kNoValue || !shared.techniques.fixing) return true;
    for (bool is_new = true; is_new;) {
        is_new = false;
        for (Label i = 0; i < shared.problem.label_count(); ++i) {
            if (!propagator.is_free(i)) continue;
            const bool no_one = is_prunable(relaxation.bound_if(i, true));
            const bool no_zero = is_prunable(relaxation.bound_if(i, false));
            if (no_one && no_zero) return false;
            if (!no_one && !no_zero) continue;
            if (!state.assign(i, no_zero)) return false;
            ++statistics.fixed_labels;
        }
    }
    return true;
}

std::size_t CutLane::add_violated_rules() {
    const auto x = relaxation.x();
    const RowSystem& rows = shared.rows;
    std::int64_t entries = 0;
    const double gap = static_cast<double>(relaxation.bound() - std::max(best_value, Value{0}));
    std::size_t added =
        late_bonuses_.bring_in(shared.problem, shared.graph, gap, relaxation, *control_);
    added += relaxation.restore_violated_rows(entries);
    for (std::int32_t r = 0; r < rows.row_count(); ++r) {
        double activity = 0;
        for (const Term& t : rows.terms(r)) activity += t.coefficient * x[t.label];
        entries += static_cast<std::int64_t>(rows.terms(r).size());
        if (activity <= static_cast<double>(rows.right_hand_side(r)) + 1e-6) continue;
        Cut cut;
        cut.right_hand_side = rows.right_hand_side(r);
        for (const Term& t : rows.terms(r)) cut.entries.push_back({t.label, t.coefficient});
        added += relaxation.add(std::move(cut)) ? 1 : 0;
    }
    charge(entries);
    statistics.rule_rows += static_cast<std::int64_t>(added);
    return added;
}

std::size_t CutLane::add_cliques(const CliqueCutOptions& options) {
    if (!shared.techniques.clique_cuts) return 0;
    const std::int64_t before = separator.work();
    std::size_t added = 0;
    for (Cut& cut : separator.separate(relaxation.x(), options)) {
        added += relaxation.add(std::move(cut)) ? 1 : 0;
    }
    charge(separator.work() - before);
    statistics.clique_cuts += static_cast<std::int64_t>(added);
    return added;
}

bool CutLane::accept_if_integral() {
    const auto x = relaxation.x();
    Solution solution;
    solution.labels.resize(shared.problem.label_count());
    for (Label i = 0; i < shared.problem.label_count(); ++i) {
        if (std::min(x[i], 1 - x[i]) > kIntegrality) return false;
        solution.labels[i] = x[i] > 0.5;
    }
    solution.value = labeling_value(shared.problem, solution.labels);
    if (!check_solution(shared.problem, solution).is_feasible) return false;
    if (solution.value > best_value) accept(std::move(solution));
    return true;
}

void CutLane::accept_leaf() {
    Solution solution;
    solution.labels.resize(shared.problem.label_count());
    for (Label i = 0; i < shared.problem.label_count(); ++i) {
        solution.labels[i] = propagator.value(i) == 1;
    }
    solution.value = labeling_value(shared.problem, solution.labels);
    if (solution.value > best_value) accept(std::move(solution));
}

void CutLane::polish() {
    if (!shared.techniques.heuristics) return;
    const LabelingProblem& problem = shared.problem;
    std::vector<std::int8_t> start(problem.label_count(), -1);
    const auto x = relaxation.x();
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (x[i] > 0.5) start[i] = 1;
    }
    GreedyOptions greedy;
    greedy.start = start;
    greedy.max_backtracks = 100;
    GreedyResult found = greedy_labeling(problem, shared.rows, *control_, greedy);
    if (!found.solution) return;
    RunControl::Cap cap(*control_, kPolishTicks * problem.label_count());
    constexpr std::uint64_t kSeedsPerLane = 1'000'000;
    LocalSearchOptions search;
    search.seed = shared.seed + 1000 + number_ * kSeedsPerLane + polish_count_++;
    search.threads = threads_;
    search.start_temperature = 0.25;
    search.first_chain = kPolishChain * problem.label_count();
    Solution better =
        improve_labeling(problem, shared.rows, *control_, std::move(*found.solution), search);
    if (better.value > best_value) accept(std::move(better));
}

}  // namespace labeling
