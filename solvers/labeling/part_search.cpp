// Which technique for which size. Narrow problems: dynamic programming. A few labels: the
// depth-first tree at once. Up to some dozens: the tree with a small allowance first, because no LP
// beats it there. More: local search, then branch-and-cut, which may hand back what is left of the
// problem after fixing; that comes through here again. The search is short where a proof is near:
// from the LP's solutions, which come soon, branch-and-cut finds better labelings in less time.
#include "labeling/part_search.h"

#include <algorithm>

#include "labeling/greedy.h"
#include "labeling/local_search.h"
#include "labeling/reduced_search.h"
#include "labeling/rows.h"
#include "labeling/subproblem.h"

namespace labeling {
namespace {

constexpr std::int64_t kSmallTreeTicks = 20000;
/// The search before a proof that is near, in ticks per label.
constexpr std::int64_t kShortChain = 15, kShortPatience = 10, kShortSearch = 60;
/// Where the first LP alone takes a good part of a second, nothing comes from it until it ends, so
/// the search may take a third of a second.
constexpr std::int64_t kSlowSearch = 4'000'000, kSlowPatience = 800'000, kSlowChain = 90;
constexpr std::size_t kSlowColumns = 8000, kSlowConflictsPerLabel = 5;
/// Where labels have so many rules, proofs are far and the search is long.
constexpr std::int64_t kManyRulesPerLabel = 5;
constexpr std::int64_t kPatiencePerLabel = 250;
constexpr std::int64_t kMostSearchTicksPerLabel = 6000;
/// Where labels have more rules than that, searches take longer and proofs are farther.
constexpr std::int64_t kRulesPerLabel = 4;
constexpr std::int64_t kMostPatienceFactor = 3;
/// Dynamic programming may take so long: branch-and-cut seldom takes less.
constexpr std::int64_t kWidthTicksPerLabel = 4000;
/// Beyond this many columns the first LP alone would take minutes; seconds.
constexpr std::size_t kMostColumns = 300000, kManyColumns = 30000;

TreeResult by_tree(const LabelingProblem& problem, const std::optional<Solution>& start,
                   RunControl& control, BranchAndCutStatistics* statistics) {
    TreeResult result = tree_search(problem, start ? start->value : kNoValue, control);
    if (statistics != nullptr) statistics->nodes += result.nodes;
    if (!result.solution) result.solution = start;
    return result;
}

/// For a run that is over: even the first bound would take too long on large problems.
TreeResult unproven(const LabelingProblem& problem, const std::optional<Solution>& start) {
    return {start, sum_of_gains(problem), 0};
}

/// nullopt: too wide.
std::optional<TreeResult> by_width(const LabelingProblem& problem, RunControl& control,
                                   const PartSearchOptions& options) {
    if (options.is_wide || !options.techniques.treewidth) return std::nullopt;
    TreewidthOptions width;
    width.most_ticks = kWidthTicksPerLabel * problem.label_count();
    return treewidth_search(problem, control, width, options.treewidth);
}

/// The search before any proof ends when it stands still for so long: 1 to 3 times the usual, by
/// the number of rules.
std::int64_t first_search_patience(const LabelingProblem& problem) {
    const auto labels = static_cast<std::int64_t>(problem.label_count());
    const auto rules = static_cast<std::int64_t>(problem.rule_count());
    return kPatiencePerLabel *
           std::clamp(rules / kRulesPerLabel, labels, kMostPatienceFactor * labels);
}

std::size_t column_count(const LabelingProblem& problem) {
    return static_cast<std::size_t>(problem.label_count()) + problem.bonus_count();
}

/// Far, too, where no LP or a slow one has to wait for its turn.
bool is_proof_far(const LabelingProblem& problem, const PartSearchOptions& options) {
    return !options.lp || column_count(problem) > kManyColumns ||
           static_cast<std::int64_t>(problem.rule_count()) >=
               kManyRulesPerLabel * problem.label_count();
}

/// Will the first LP be slow, by its size or by how dense the conflicts are?
bool is_lp_slow(const LabelingProblem& problem) {
    return column_count(problem) > kSlowColumns ||
           problem.conflict_count() >=
               kSlowConflictsPerLabel * static_cast<std::size_t>(problem.label_count());
}

/// How the search before the proof goes. Far from a proof: at most half of what is left, so that
/// the bound gets its turn, and that only while it gains.
std::int64_t first_search_ticks(const LabelingProblem& problem, const RunControl& control,
                                const PartSearchOptions& options, LocalSearchOptions& search) {
    const auto labels = static_cast<std::int64_t>(problem.label_count());
    if (is_proof_far(problem, options)) {
        search.patience = first_search_patience(problem);
        const std::int64_t least = 2 * search.patience;
        const std::int64_t most = kMostSearchTicksPerLabel * labels;
        return std::clamp(control.ticks_left() / 2, least, std::max(least, most));
    }
    if (is_lp_slow(problem)) {
        search.patience = kSlowPatience;
        search.first_chain = kSlowChain * labels;
        return kSlowSearch;
    }
    search.patience = kShortPatience * labels;
    search.first_chain = kShortChain * labels;
    return kShortSearch * labels;
}

}  // namespace

PartStart start_part(const LabelingProblem& problem, std::span<const std::int8_t> labels,
                     RunControl& control, const PartSearchOptions& options) {
    if (const auto narrow = by_width(problem, control, options)) {
        return {narrow->solution, !narrow->solution, narrow->solution.has_value()};
    }
    if (!options.techniques.heuristics) return {};
    if (options.has_labeling && control.is_over() && takes_long_to_reduce(problem)) return {};
    const RowSystem rows(problem);
    GreedyOptions greedy;
    greedy.start = labels;
    GreedyResult found = greedy_labeling(problem, rows, control, greedy);
    PartStart start{std::move(found.solution), found.is_infeasible, false};
    if (!start.solution) return start;
    if (options.report) options.report(start.solution->value, std::nullopt);
    if (problem.label_count() <= options.techniques.tree_size || control.should_stop())
        return start;
    LocalSearchOptions search;
    RunControl::Cap cap(control, first_search_ticks(problem, control, options, search));
    search.seed = options.seed;
    search.threads = options.threads;
    const std::function<void(Value)> report = [&](Value value) {
        if (options.report) options.report(value, std::nullopt);
    };
    start.solution =
        improve_labeling(problem, rows, control, std::move(*start.solution), search, report);
    return start;
}

TreeResult prove_part(const LabelingProblem& problem, const std::optional<Solution>& start,
                      RunControl& control, const PartSearchOptions& options,
                      BranchAndCutStatistics* statistics) {
    if (control.is_over()) return unproven(problem, start);
    if (auto narrow = by_width(problem, control, options)) return std::move(*narrow);
    const Label tree_size = options.techniques.tree_size;
    if (!options.lp || problem.label_count() <= tree_size || column_count(problem) > kMostColumns) {
        return by_tree(problem, start, control, statistics);
    }
    std::optional<Solution> best = start;
    if (2 * problem.label_count() <= 5 * tree_size) {
        RunControl::Cap cap(control, kSmallTreeTicks);
        TreeResult result = by_tree(problem, start, control, statistics);
        if (result.is_closed(kNoValue) || control.is_over()) return result;
        best = std::move(result.solution);
    }
    BranchAndCutOptions cut;
    cut.lp = options.lp;
    cut.seed = options.seed;
    cut.threads = options.threads;
    cut.techniques = options.techniques;
    cut.report = options.report;
    cut.solve_rest = [&](const LabelingProblem& rest, const std::optional<Solution>& rest_start) {
        PartSearchOptions quiet = options;
        quiet.report = {};
        quiet.is_wide = false;
        if (rest_start) return prove_part(rest, rest_start, control, quiet, statistics);
        const PartStart fresh = start_part(rest, {}, control, quiet);
        if (fresh.is_infeasible) return TreeResult{};
        if (fresh.is_optimal) return TreeResult{fresh.solution, fresh.solution->value, 0};
        quiet.is_wide = true;
        return prove_part(rest, fresh.solution, control, quiet, statistics);
    };
    return branch_and_cut(problem, best, kNoValue, control, cut, statistics);
}

}  // namespace labeling
