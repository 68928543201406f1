// Which technique for which size. A few labels: the depth-first tree at once. Up to some dozens:
// the tree with a small allowance first, because no LP beats it there. More: local search, then
// branch-and-cut, which may hand back what is left of the problem after fixing; that comes through
// here again.
#include "labeling/part_search.h"

#include "labeling/greedy.h"
#include "labeling/local_search.h"
#include "labeling/rows.h"

namespace labeling {
namespace {

constexpr Label kTinyPart = 24;
constexpr Label kSmallPart = 60;
constexpr std::int64_t kSmallTreeTicks = 20000;
constexpr std::int64_t kSearchTicksPerLabel = 1000;
/// Beyond this many columns the first LP alone would take minutes.
constexpr std::size_t kMostColumns = 100000;

class PartSearch {
public:
    PartSearch(RunControl& control, const PartSearchOptions& options,
               BranchAndCutStatistics* statistics)
        : control_(control), options_(options), statistics_(statistics) {}

    TreeResult solve(const LabelingProblem& problem) {
        const RowSystem rows(problem);
        GreedyOptions greedy;
        greedy.start = options_.start;
        GreedyResult found = greedy_labeling(problem, rows, control_, greedy);
        if (found.is_infeasible) return {};
        std::optional<Solution> start = std::move(found.solution);
        if (start && options_.report) options_.report(start->value, std::nullopt);
        if (start && problem.label_count() > kTinyPart && !control_.should_stop()) {
            start = improved(problem, rows, std::move(*start));
            if (options_.report) options_.report(start->value, std::nullopt);
        }
        return prove(problem, start, options_.report);
    }

private:
    using Report = std::function<void(std::optional<Value>, std::optional<Value>)>;

    Solution improved(const LabelingProblem& problem, const RowSystem& rows, Solution start) {
        RunControl::Cap cap(control_, kSearchTicksPerLabel * problem.label_count());
        LocalSearchOptions search;
        search.seed = options_.seed;
        return improve_labeling(problem, rows, control_, std::move(start), search);
    }

    TreeResult by_tree(const LabelingProblem& problem, const std::optional<Solution>& start) {
        TreeResult result = tree_search(problem, start ? start->value : kNoValue, control_);
        if (statistics_ != nullptr) statistics_->nodes += result.nodes;
        if (!result.solution) result.solution = start;
        return result;
    }

    TreeResult prove(const LabelingProblem& problem, std::optional<Solution> start,
                     const Report& report) {
        const std::size_t columns =
            static_cast<std::size_t>(problem.label_count()) + problem.bonus_count();
        if (!options_.lp || problem.label_count() <= kTinyPart || columns > kMostColumns) {
            return by_tree(problem, start);
        }
        if (problem.label_count() <= kSmallPart) {
            RunControl::Cap cap(control_, kSmallTreeTicks);
            TreeResult result = by_tree(problem, start);
            if (result.is_closed(kNoValue) || control_.is_over()) return result;
            start = std::move(result.solution);
        }
        BranchAndCutOptions cut;
        cut.lp = options_.lp;
        cut.seed = options_.seed;
        cut.report = report;
        cut.solve_rest = [this](const LabelingProblem& rest,
                                const std::optional<Solution>& rest_start, Value) {
            if (rest_start) return prove(rest, rest_start, {});
            PartSearchOptions plain;
            plain.lp = options_.lp;
            plain.seed = options_.seed;
            return PartSearch(control_, plain, statistics_).solve(rest);
        };
        return branch_and_cut(problem, start, kNoValue, control_, cut, statistics_);
    }

    RunControl& control_;
    const PartSearchOptions& options_;
    BranchAndCutStatistics* statistics_;
};

}  // namespace

TreeResult search_part(const LabelingProblem& problem, RunControl& control,
                       const PartSearchOptions& options, BranchAndCutStatistics* statistics) {
    return PartSearch(control, options, statistics).solve(problem);
}

}  // namespace labeling
