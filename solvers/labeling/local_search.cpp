// Local search by simulated annealing (Kirkpatrick, Gelatt & Vecchi 1983) over compound moves, in
// chains: the first from the given labeling, later ones reheated from the best so far. After a
// chain the best and the chain's end are compared: labels in which they differ fall into components
// that no conflict, bonus or rule joins, and each component that is better in the chain's end is
// taken over (partition crossover, Whitley, Hains & Howe 2009), so no part of a chain is lost.
// Temperature is set from the median of w + half the bonuses; the threshold of a move is drawn
// before it is tried, which rejects most moves after one scan. Keep-labels (weight 0, no bonus) are
// never proposed: moves pull them in where a rule needs them.
#include "labeling/local_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "labeling/compound_move.h"
#include "labeling/greedy.h"
#include "labeling/random.h"
#include "labeling/search_state.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 24;
constexpr int kMovesPerCheck = 256;

/// Groups of differing labels that no constraint and no bonus joins.
class DifferenceParts {
public:
    DifferenceParts(const LabelingProblem& problem, const RowSystem& rows)
        : problem_(problem),
          rows_(rows),
          parent_(problem.label_count()),
          row_mark_(rows.row_count(), -1),
          is_different_(problem.label_count(), 0) {}

    /// Parts of the labels in which a and b differ, each as a list, ordered by first label.
    std::vector<std::vector<Label>> split(std::span<const std::uint8_t> a,
                                          std::span<const std::uint8_t> b) {
        std::vector<Label> differing;
        for (Label i = 0; i < problem_.label_count(); ++i) {
            is_different_[i] = a[i] != b[i];
            if (!is_different_[i]) continue;
            differing.push_back(i);
            parent_[i] = i;
        }
        for (Label i : differing) {
            for (Label j : problem_.conflicts_of(i)) join(i, j);
            for (const auto& bonus : problem_.bonuses_of(i)) join(i, bonus.label);
            for (const auto& use : rows_.uses(i)) {
                if (row_mark_[use.row] >= 0) join(i, row_mark_[use.row]);
                row_mark_[use.row] = i;
            }
        }
        for (Label i : differing) {
            for (const auto& use : rows_.uses(i)) row_mark_[use.row] = -1;
        }
        std::vector<std::vector<Label>> parts;
        std::vector<std::int32_t> part_of(problem_.label_count(), -1);
        for (Label i : differing) {
            const Label root = find(i);
            if (part_of[root] < 0) {
                part_of[root] = static_cast<std::int32_t>(parts.size());
                parts.emplace_back();
            }
            parts[part_of[root]].push_back(i);
        }
        return parts;
    }

private:
    Label find(Label i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(Label i, Label j) {
        if (!is_different_[j]) return;
        i = find(i);
        j = find(j);
        if (i != j) parent_[std::max(i, j)] = std::min(i, j);
    }

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    std::vector<Label> parent_, row_mark_;
    std::vector<std::uint8_t> is_different_;
};

class Annealer {
public:
    Annealer(const LabelingProblem& problem, const RowSystem& rows, RunControl& control,
             Solution start, const LocalSearchOptions& options,
             const std::function<void(Value)>& report)
        : problem_(problem),
          rows_(rows),
          control_(control),
          report_(report),
          random_(options.seed),
          state_(problem, rows, start.labels),
          moves_(problem, rows, state_, random_),
          parts_(problem, rows),
          best_(std::move(start)),
          reported_(best_.value),
          start_temperature_(options.start_temperature),
          chain_work_(options.first_chain) {
        for (Label i = 0; i < problem.label_count(); ++i) {
            if (problem.weight(i) > 0 || !problem.bonuses_of(i).empty()) proposals_.push_back(i);
        }
        if (chain_work_ <= 0) {
            chain_work_ = 2000 + 400 * static_cast<std::int64_t>(proposals_.size());
        }
        longest_chain_ = 16 * chain_work_;
        set_scale();
        for (std::size_t k = 0; k < log_table_.size(); ++k) {
            log_table_[k] =
                std::log((static_cast<double>(k) + 0.5) / static_cast<double>(log_table_.size()));
        }
    }

    void run() {
        if (proposals_.empty()) return;
        for (double hot = start_temperature_; !control_.should_stop();) {
            anneal(hot * scale_, 0.03 * scale_);
            descend();
            recombine();
            ++statistics.chains;
            chain_work_ = std::min(longest_chain_, chain_work_ + chain_work_ / 2);
            constexpr std::array<double, 4> kReheats{0.8, 0.4, 1.6, 0.6};
            hot = kReheats[statistics.chains % kReheats.size()];
        }
    }

    Solution take_best() { return std::move(best_); }
    LocalSearchStatistics statistics;

private:
    void set_scale() {
        std::vector<double> worths;
        for (Label i : proposals_) {
            double worth = static_cast<double>(problem_.weight(i));
            for (const auto& b : problem_.bonuses_of(i)) {
                worth += 0.5 * static_cast<double>(b.value);
            }
            if (worth > 0) worths.push_back(worth);
        }
        if (worths.empty()) return;
        const auto middle = worths.begin() + static_cast<std::ptrdiff_t>(worths.size() / 2);
        std::nth_element(worths.begin(), middle, worths.end());
        scale_ = std::max(1.0, *middle);
    }

    void anneal(double hot, double cold) {
        const std::int64_t first = control_.work();
        const std::int64_t budget = std::min(chain_work_, control_.work_left());
        const double ratio = std::log(cold / hot);
        while (true) {
            const double progress = static_cast<double>(control_.work() - first) /
                                    static_cast<double>(std::max<std::int64_t>(1, budget));
            if (progress >= 1.0) return;
            const double temperature = hot * std::exp(ratio * progress);
            const std::int64_t before = state_.work();
            for (int k = 0; k < kMovesPerCheck; ++k) propose(temperature);
            report_best();
            const std::int64_t entries = state_.work() - before + 12 * kMovesPerCheck;
            if (control_.spend(1 + entries / kEntriesPerTick)) return;
        }
    }

    void propose(double temperature) {
        ++statistics.moves;
        const Label i = proposals_[random_.below(static_cast<std::uint32_t>(proposals_.size()))];
        const auto threshold =
            static_cast<Value>(temperature * log_table_[random_.next() >> (64 - kLogTableBits)]);
        bool is_done = false;
        if (!state_.is_on(i) && random_.below(16) == 0) {
            is_done = moves_.insert_run(i, 2 + static_cast<int>(random_.below(7)), threshold);
        } else {
            is_done = moves_.flip(i, threshold);
        }
        if (is_done) accept();
    }

    void accept() {
        ++statistics.accepted;
        if (is_tracking_) {
            since_best_.insert(since_best_.end(), state_.log().begin(), state_.log().end());
            if (since_best_.size() > best_.labels.size() / 4) {
                is_tracking_ = false;
                since_best_.clear();
            }
        }
        state_.commit();
        if (state_.value() > best_.value) keep();
    }

    /// The current labeling becomes the best.
    void keep() {
        best_.value = state_.value();
        if (is_tracking_) {
            for (Label i : since_best_) best_.labels[i] = state_.is_on(i) ? 1 : 0;
        } else {
            best_.labels.assign(state_.labels().begin(), state_.labels().end());
        }
        since_best_.clear();
        is_tracking_ = true;
    }

    void report_best() {
        if (best_.value == reported_) return;
        reported_ = best_.value;
        if (report_) report_(reported_);
    }

    /// Improving moves until a pass finds none.
    void descend() {
        for (bool is_better = true; is_better && !control_.should_stop();) {
            is_better = false;
            const std::int64_t before = state_.work();
            for (Label i : proposals_) {
                if (moves_.flip(i, 1)) {
                    accept();
                    is_better = true;
                }
            }
            const auto entries =
                state_.work() - before + 12 * static_cast<std::int64_t>(proposals_.size());
            control_.spend(1 + entries / kEntriesPerTick);
        }
    }

    /// Takes over the parts of the current labeling that beat the best, then continues from it.
    void recombine() {
        const auto parts = parts_.split(best_.labels, state_.labels());
        for (const auto& part : parts) {
            const Value before = state_.value();
            for (Label i : part) state_.flip(i);
            // Now the part is as in the best; keep that unless the chain's version was better.
            if (state_.value() < before) {
                state_.roll_back();
            } else {
                state_.commit();
            }
        }
        is_tracking_ = false;
        if (state_.value() > best_.value) {
            statistics.crossover_gain += state_.value() - best_.value;
            keep();
        }
        // Every part that is no better was put back: the two labelings are equal now.
        since_best_.clear();
        is_tracking_ = true;
        report_best();
        control_.spend(1 + problem_.label_count() / 4);
    }

    static constexpr int kLogTableBits = 12;

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    RunControl& control_;
    const std::function<void(Value)>& report_;
    Random random_;
    SearchState state_;
    CompoundMoves moves_;
    DifferenceParts parts_;
    Solution best_;
    Value reported_;
    std::vector<Label> proposals_;
    std::vector<Label> since_best_;  ///< flips from the best to the current labeling
    bool is_tracking_ = true;        ///< since_best_ is complete
    double scale_ = 1;
    const double start_temperature_;
    std::int64_t chain_work_, longest_chain_ = 0;
    std::array<double, std::size_t{1} << kLogTableBits> log_table_{};
};

class LocalSearchSolver final : public Solver {
public:
    std::string name() const override { return "local-search"; }
    std::string description() const override {
        return "simulated annealing over compound moves with partition crossover";
    }
    bool is_exact() const override { return false; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        require_known_extras(options, name(), {"first-chain"});
        // Ten seconds unless the caller limits either work or time.
        std::optional<std::int64_t> work;
        if (!options.time_limit) work = 100'000'000;
        RunControl control(options, work);
        const RowSystem rows(problem);
        GreedyOptions greedy;
        greedy.start = options.warm_start;
        GreedyResult found = greedy_labeling(problem, rows, control, greedy);
        LocalSearchStatistics statistics;
        if (found.solution) {
            auto report = [&control](Value value) { control.report(value, std::nullopt); };
            report(found.solution->value);
            LocalSearchOptions search;
            search.seed = options.seed;
            search.first_chain = extra_integer(options, "first-chain", 0, 0, std::int64_t{1} << 40);
            found.solution = improve_labeling(problem, rows, control, std::move(*found.solution),
                                              search, report, &statistics);
        }
        SolveResult result = finish(problem, name(), control, std::move(found.solution),
                                    std::nullopt, found.is_infeasible);
        result.statistics["moves"] = static_cast<double>(statistics.moves);
        result.statistics["accepted"] = static_cast<double>(statistics.accepted);
        result.statistics["chains"] = static_cast<double>(statistics.chains);
        return result;
    }
};

}  // namespace

Solution improve_labeling(const LabelingProblem& problem, const RowSystem& rows,
                          RunControl& control, Solution start, const LocalSearchOptions& options,
                          const std::function<void(Value)>& report,
                          LocalSearchStatistics* statistics) {
    Annealer annealer(problem, rows, control, std::move(start), options, report);
    annealer.run();
    if (statistics != nullptr) *statistics = annealer.statistics;
    return annealer.take_best();
}

std::shared_ptr<const Solver> make_local_search_solver() {
    return std::make_shared<LocalSearchSolver>();
}

}  // namespace labeling
