#include "labeling/reduced_search.h"

#include <algorithm>

#include "labeling/greedy.h"
#include "labeling/reductions.h"

namespace labeling {
namespace {

/// Reductions get so much of the work, at most; of the time, where that is less.
constexpr std::int64_t kReductionShare = 8;
constexpr Label kLargeProblem = 20000;  ///< labels
constexpr std::size_t kLargeConflicts = 200'000;

std::optional<Solution> greedy_start(const LabelingProblem& problem, const RowSystem& rows,
                                     RunControl& control, std::span<const std::int8_t> labels,
                                     ReducedSearchResult& result) {
    GreedyOptions greedy;
    greedy.start = labels;
    GreedyResult found = greedy_labeling(problem, rows, control, greedy);
    result.is_infeasible = found.is_infeasible;
    return std::move(found.solution);
}

}  // namespace

bool takes_long_to_reduce(const LabelingProblem& problem) {
    return problem.label_count() > kLargeProblem || problem.conflict_count() > kLargeConflicts;
}

bool should_reduce_first(const LabelingProblem& problem) {
    return problem.rule_count() == 0 || takes_long_to_reduce(problem);
}

ReducedSearchResult search_reduced(const LabelingProblem& problem, const SolveOptions& options,
                                   RunControl& control, bool is_reducing, const Improve& improve) {
    ReducedSearchResult result;
    std::optional<Solution> given;
    const bool is_wanted_first = takes_long_to_reduce(problem);
    if (!is_reducing || is_wanted_first || !options.warm_start.empty()) {
        const RowSystem rows(problem);
        given = greedy_start(problem, rows, control, options.warm_start, result);
        if (given) control.report(given->value, std::nullopt);
        if (result.is_infeasible || !is_reducing) {
            const auto report = [&](Value value) { control.report(value, std::nullopt); };
            if (given && !control.is_over()) {
                given = improve(problem, rows, std::move(*given), report);
            }
            result.solution = std::move(given);
            return result;
        }
    }
    std::optional<ReducedProblem> reduced;
    {
        RunControl::Cap cap(control, control.ticks_left() / kReductionShare);
        try {
            reduced =
                reduce_problem(problem, control, {}, given ? PassGuard(control) : PassGuard());
        } catch (const StoppedInPass&) {
            result.solution = std::move(given);
            return result;
        }
    }
    if (reduced->is_infeasible()) {
        result.is_infeasible = true;
        return result;
    }
    std::vector<std::int8_t> start;
    if (given && !options.warm_start.empty()) {
        start.assign(given->labels.begin(), given->labels.end());
        start = reduced->project(start);
    }
    if (given && control.is_over()) {
        result.solution = std::move(given);
        return result;
    }
    const RowSystem rows(reduced->problem());
    std::optional<Solution> found = greedy_start(reduced->problem(), rows, control, start, result);
    if (found) {
        const auto report = [&](Value value) {
            control.report(value + reduced->offset(), std::nullopt);
        };
        report(found->value);
        *found = improve(reduced->problem(), rows, std::move(*found), report);
        result.solution = reduced->lift(problem, *found);
    }
    if (given && (!result.solution || result.solution->value < given->value)) {
        result.solution = std::move(given);
    }
    return result;
}

}  // namespace labeling
