// Large-neighbourhood search (Shaw 1998) with exact windows, inside of the local search, which
// finds what no window spans and keeps the ends of its climbs. All labels outside of a window stay
// as they are in the present labeling; what propagation leaves open falls into parts, and each is
// solved by the exact search with the present value as its lower limit. A window is a breadth-first
// ball over bonuses, conflicts and small rules around a random label, or within the labels in which
// the present labeling differs from an earlier climb's end: there one of two good searches erred.
// The size adapts: windows that are solved grow, windows that run out of their allowance shrink.
#include "labeling/neighbourhood_search.h"

#include <algorithm>

#include "labeling/greedy.h"
#include "labeling/local_search.h"
#include "labeling/part_search.h"
#include "labeling/propagation.h"
#include "labeling/random.h"
#include "labeling/reduced_search.h"
#include "labeling/subproblem.h"

namespace labeling {
namespace {

constexpr double kSmallestWindow = 30, kFirstWindow = 60, kLargestWindow = 1000;
constexpr std::int64_t kWindowTicks = 400000;
constexpr std::size_t kLongestRow = 8;

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
          is_different_(problem.label_count(), 0),
          best_(std::move(start)) {}

    Solution run() {
        LocalSearchOptions search;
        search.seed = options_.seed;
        search.threads = options_.threads;
        if (is_consistent_ && propagator_.free_count() > 0) {
            search.intensify = [this](Solution& present, std::span<const Solution> others) {
                improve(present, others);
            };
        }
        return improve_labeling(problem_, rows_, control_, std::move(best_), search,
                                options_.report);
    }

    NeighbourhoodSearchStatistics statistics;

private:
    Label random_label() {
        return static_cast<Label>(
            random_.below(static_cast<std::uint32_t>(problem_.label_count())));
    }

    /// One window of the present labeling.
    void improve(Solution& present, std::span<const Solution> others) {
        std::swap(best_, present);
        std::vector<Label> difference;
        if (options_.differences && !others.empty() && random_.below(2) == 0) {
            const Solution& other =
                others[random_.below(static_cast<std::uint32_t>(others.size()))];
            for (Label i = 0; i < problem_.label_count(); ++i) {
                if (other.labels[i] != best_.labels[i]) difference.push_back(i);
            }
            control_.spend(problem_.label_count() / 64);
        }
        if (difference.empty()) {
            collect_ball(random_label(), window_size_, {});
            solve_window(window_size_);
        } else {
            const auto count = static_cast<std::uint32_t>(difference.size());
            collect_ball(difference[random_.below(count)], difference_size_, difference);
            ++statistics.differences;
            solve_window(difference_size_);
        }
        std::swap(best_, present);
    }

    /// Breadth-first around the label; labels of the difference, if any, come before others.
    void collect_ball(Label start, double most, std::span<const Label> difference) {
        const auto size = static_cast<std::size_t>(most);
        for (Label i : difference) is_different_[i] = 1;
        window_.clear();
        bool is_open = difference.empty();
        auto add = [&](Label i) {
            if (in_window_[i] != 0 || window_.size() >= size || !propagator_.is_free(i)) return;
            if (!is_open && is_different_[i] == 0) return;
            in_window_[i] = 1;
            window_.push_back(i);
        };
        add(start);
        spread(size, add);
        is_open = true;
        spread(size, add);
        for (Label i : difference) is_different_[i] = 0;
    }

    template <typename Add>
    void spread(std::size_t size, const Add& add) {
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

    /// Adapts `size` by how it went.
    void solve_window(double& size) {
        if (window_.empty()) return;
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
        size = std::clamp(size * factor, kSmallestWindow, kLargestWindow);
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
        if (is_better) ++statistics.improved;
        return is_solved;
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
    std::vector<std::uint8_t> in_window_, is_different_;
    std::vector<Label> window_;
    Solution best_;
    double window_size_ = kFirstWindow, difference_size_ = kFirstWindow;
};

class LnsSolver final : public Solver {
public:
    explicit LnsSolver(LpFactory lp) : lp_(std::move(lp)) {}
    std::string name() const override { return "lns"; }
    std::string description() const override {
        return "local search with exact search in windows and where good labelings differ";
    }
    bool is_exact() const override { return false; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        require_known_extras(options, name(), {"differences", "reductions"});
        std::optional<std::int64_t> work;
        if (!options.time_limit) work = 200'000'000;
        RunControl control(options, work);
        NeighbourhoodSearchStatistics statistics;
        auto found =
            search_reduced(problem, options, control,
                           extra_switch(options, "reductions", should_reduce_first(problem)),
                           [&](const LabelingProblem& rest, const RowSystem& rows, Solution start,
                               const std::function<void(Value)>& report) {
                               NeighbourhoodSearchOptions search{
                                   lp_, options.seed, options.threads,
                                   extra_switch(options, "differences", true), report};
                               return search_neighbourhoods(rest, rows, control, std::move(start),
                                                            search, &statistics);
                           });
        SolveResult result = finish(problem, name(), control, std::move(found.solution),
                                    std::nullopt, found.is_infeasible);
        result.statistics["windows"] = static_cast<double>(statistics.windows);
        result.statistics["windows-in-differences"] = static_cast<double>(statistics.differences);
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
    Solution best = search.run();
    if (statistics != nullptr) *statistics = search.statistics;
    return best;
}

std::shared_ptr<const Solver> make_lns_solver(LpFactory lp) {
    return std::make_shared<LnsSolver>(std::move(lp));
}

}  // namespace labeling
