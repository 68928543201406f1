// Large-neighbourhood search (Shaw 1998) with exact windows. All labels outside of a window stay as
// they are in the best labeling; what propagation leaves open falls into parts, and each is solved
// by the exact search with the present value as its lower limit. A window is a breadth-first ball
// over bonuses, conflicts and small rules around a random label, or around the labels that
// annealing has just changed for the better, since one improvement often makes room for another.
// The size adapts: windows that are solved at once grow, windows that run out of their allowance
// shrink. Annealing takes a share of the work because it crosses distances that no window spans.
#include "labeling/neighbourhood_search.h"

#include <algorithm>

#include "labeling/greedy.h"
#include "labeling/local_search.h"
#include "labeling/part_search.h"
#include "labeling/propagation.h"
#include "labeling/random.h"
#include "labeling/subproblem.h"

namespace labeling {
namespace {

constexpr double kSmallestWindow = 30, kFirstWindow = 60, kLargestWindow = 1000;
constexpr std::int64_t kWindowTicks = 400'000;
constexpr std::size_t kLongestRow = 8;
constexpr int kWindowsPerChain = 6;
constexpr std::int64_t kChainTicks = 400;   ///< per label
constexpr std::int64_t kStartTicks = 1000;  ///< of local search, per label

class NeighbourhoodSearch {
public:
    NeighbourhoodSearch(const LabelingProblem& problem, const RowSystem& rows, RunControl& control,
                        Solution start, const NeighbourhoodSearchOptions& options)
        : problem_(problem),
          rows_(rows),
          control_(control),
          options_(options),
          random_(options.seed),
          propagator_(problem, rows),
          decomposer_(problem, rows),
          is_consistent_(propagator_.propagate_all()),
          base_(propagator_.trail().size()),
          in_window_(problem.label_count(), 0),
          best_(std::move(start)) {}

    void run() {
        if (!is_consistent_ || propagator_.free_count() == 0) return;
        for (std::uint64_t round = 0; !control_.should_stop(); ++round) {
            for (int k = 0; k < kWindowsPerChain && !control_.should_stop(); ++k) {
                collect_ball({random_label()}, static_cast<std::size_t>(window_size_));
                solve_window();
            }
            anneal(round);
        }
    }

    Solution take_best() { return std::move(best_); }
    NeighbourhoodSearchStatistics statistics;

private:
    Label random_label() {
        return static_cast<Label>(
            random_.below(static_cast<std::uint32_t>(problem_.label_count())));
    }

    /// Breadth-first around `window`.
    void collect_ball(std::vector<Label> seeds, std::size_t size) {
        window_.clear();
        auto add = [&](Label i) {
            if (in_window_[i] != 0 || window_.size() >= size || !propagator_.is_free(i)) return;
            in_window_[i] = 1;
            window_.push_back(i);
        };
        for (Label i : seeds) add(i);
        std::int64_t entries = 0;
        for (std::size_t k = 0; k < window_.size() && window_.size() < size; ++k) {
            const Label i = window_[k];
            for (const auto& b : problem_.bonuses_of(i)) add(b.label);
            for (Label j : problem_.conflicts_of(i)) add(j);
            entries += static_cast<std::int64_t>(problem_.conflicts_of(i).size());
            for (const auto& use : rows_.uses(i)) {
                if (rows_.terms(use.row).size() > kLongestRow) continue;
                for (const Term& t : rows_.terms(use.row)) add(t.label);
                entries += static_cast<std::int64_t>(rows_.terms(use.row).size());
            }
        }
        control_.spend(1 + entries / 16);
    }

    void solve_window() {
        if (window_.empty() || control_.should_stop()) return;
        ++statistics.windows;
        const std::int64_t before = propagator_.work();
        bool is_possible = true;
        for (int value : {1, 0}) {
            for (Label i = 0; is_possible && i < problem_.label_count(); ++i) {
                const bool is_outside = in_window_[i] == 0 && propagator_.is_free(i);
                if (!is_outside || best_.labels[i] != value) continue;
                is_possible = propagator_.assign(i, value == 1);
            }
        }
        const bool is_solved = !is_possible || solve_parts();
        if (is_solved) ++statistics.solved;
        const double factor = is_solved ? 1.1 : 0.7;
        window_size_ = std::clamp(window_size_ * factor, kSmallestWindow, kLargestWindow);
        propagator_.undo(base_);
        for (Label i : window_) in_window_[i] = 0;
        control_.spend(1 + (propagator_.work() - before + 2 * problem_.label_count()) / 16);
    }

    /// True when every part was solved to the end.
    bool solve_parts() {
        bool is_solved = true, is_better = false;
        const std::int64_t before = decomposer_.work();
        for (const auto& members : decomposer_.parts(propagator_)) {
            const Subproblem sub = decomposer_.extract(propagator_, members);
            Solution present;
            for (Label i : members) present.labels.push_back(best_.labels[i]);
            present.value = labeling_value(sub.problem, present.labels);
            PartSearchOptions exact;
            exact.lp = options_.lp;
            exact.seed = options_.seed;
            RunControl::Cap cap(control_, kWindowTicks);
            const TreeResult result = prove_part(sub.problem, present, control_, exact, nullptr);
            const Value value = result.solution ? result.solution->value : present.value;
            is_solved = is_solved && result.bound <= value;
            if (value <= present.value) continue;
            is_better = true;
            for (std::size_t k = 0; k < members.size(); ++k) {
                best_.labels[members[k]] = result.solution->labels[k];
            }
            best_.value += value - present.value;
        }
        control_.spend((decomposer_.work() - before) / 16);
        if (is_better) {
            ++statistics.improved;
            if (options_.report) options_.report(best_.value);
        }
        return is_solved;
    }

    /// A chain from the best; where it ends differently is the next window.
    void anneal(std::uint64_t round) {
        if (control_.should_stop()) return;
        RunControl::Cap cap(control_, kChainTicks * problem_.label_count());
        LocalSearchOptions search;
        search.seed = options_.seed * 1000003 + round;
        search.start_temperature = round % 2 == 0 ? 0.8 : 1.6;
        search.first_chain = kChainTicks * problem_.label_count() / 2;
        const Solution other = improve_labeling(problem_, rows_, control_, best_, search);
        if (other.value <= best_.value) return;
        std::vector<Label> changed;
        for (Label i = 0; i < problem_.label_count(); ++i) {
            if (other.labels[i] != best_.labels[i]) changed.push_back(i);
        }
        best_ = other;
        if (options_.report) options_.report(best_.value);
        collect_ball(changed, std::max(changed.size(), static_cast<std::size_t>(window_size_)));
        solve_window();
    }

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    RunControl& control_;
    const NeighbourhoodSearchOptions& options_;
    Random random_;
    Propagator propagator_;
    Decomposer decomposer_;
    const bool is_consistent_;
    const std::size_t base_;
    std::vector<std::uint8_t> in_window_;
    std::vector<Label> window_;
    Solution best_;
    double window_size_ = kFirstWindow;
};

class LnsSolver final : public Solver {
public:
    explicit LnsSolver(LpFactory lp) : lp_(std::move(lp)) {}
    std::string name() const override { return "lns"; }
    std::string description() const override {
        return "local search, then exact search in windows of the best labeling";
    }
    bool is_exact() const override { return false; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        require_known_extras(options, name(), {});
        std::optional<std::int64_t> work;
        if (!options.time_limit) work = 200'000'000;
        RunControl control(options, work);
        const RowSystem rows(problem);
        GreedyOptions greedy;
        greedy.start = options.warm_start;
        GreedyResult found = greedy_labeling(problem, rows, control, greedy);
        NeighbourhoodSearchStatistics statistics;
        if (found.solution) {
            const auto report = [&control](Value value) { control.report(value, std::nullopt); };
            report(found.solution->value);
            {
                RunControl::Cap cap(control, kStartTicks * problem.label_count());
                LocalSearchOptions search;
                search.seed = options.seed;
                found.solution = improve_labeling(problem, rows, control,
                                                  std::move(*found.solution), search, report);
            }
            found.solution =
                search_neighbourhoods(problem, rows, control, std::move(*found.solution),
                                      {lp_, options.seed, report}, &statistics);
        }
        SolveResult result = finish(problem, name(), control, std::move(found.solution),
                                    std::nullopt, found.is_infeasible);
        result.statistics["windows"] = static_cast<double>(statistics.windows);
        result.statistics["windows-solved"] = static_cast<double>(statistics.solved);
        result.statistics["windows-improved"] = static_cast<double>(statistics.improved);
        return result;
    }

private:
    LpFactory lp_;
};

}  // namespace

Solution search_neighbourhoods(const LabelingProblem& problem, const RowSystem& rows,
                               RunControl& control, Solution start,
                               const NeighbourhoodSearchOptions& options,
                               NeighbourhoodSearchStatistics* statistics) {
    NeighbourhoodSearch search(problem, rows, control, std::move(start), options);
    search.run();
    if (statistics != nullptr) *statistics = search.statistics;
    return search.take_best();
}

std::shared_ptr<const Solver> make_lns_solver(LpFactory lp) {
    return std::make_shared<LnsSolver>(std::move(lp));
}

}  // namespace labeling
