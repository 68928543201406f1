// Local search by simulated annealing (Kirkpatrick, Gelatt & Vecchi 1983) over compound moves, in
// many short chains. After a chain the best labeling so far and the chain's end are compared:
// labels in which they differ fall into parts that no conflict, bonus or rule joins, and each part
// is taken from whichever is better (partition crossover, Whitley, Hains & Howe 2009). So a chain
// loses nothing, however hot it starts, and short hot chains beat long slow ones by far (measured:
// four times smaller gap after equal work). Between chains over the whole problem come chains over
// windows of a few hundred connected labels, which matter on large dense problems, where the
// difference of a global chain is one single part.
// Temperature is in units of the median of w + half the bonuses; the threshold of a move is drawn
// before it is tried, which rejects most moves after one scan. Labels without weight and bonus (the
// keep-labels of extraordinary nodes) are never proposed: moves pull them in where a rule needs
// them.
#include "labeling/local_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "labeling/compound_move.h"
#include "labeling/difference_parts.h"
#include "labeling/greedy.h"
#include "labeling/random.h"
#include "labeling/search_model.h"
#include "labeling/search_state.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 24;
constexpr std::int64_t kEntriesPerMove = 12;
constexpr int kMovesPerCheck = 256;
constexpr int kLogTableBits = 12;

// Chosen by measurement on the problems in data/instances at 1, 10 and 60 million ticks.
constexpr double kColdest = 0.1;
constexpr std::array<double, 4> kReheats{1.2, 0.6, 2.4, 0.9};
constexpr std::int64_t kFirstChainTicks = 200;  ///< per label
constexpr std::int64_t kChainTicks = 25;        ///< per label
constexpr std::int64_t kWindowTicks = 30;       ///< per label of the window
constexpr int kWindowsPerChain = 5;
constexpr std::uint32_t kSmallestWindow = 100, kLargestWindow = 500;
constexpr std::uint32_t kMovesPerRun = 16;  ///< one insertion in so many is a run
constexpr std::uint32_t kLongestRun = 8;

class Annealer {
public:
    Annealer(const LabelingProblem& problem, const RowSystem& rows, RunControl& control,
             Solution start, const LocalSearchOptions& options,
             const std::function<void(Value)>& report)
        : problem_(problem),
          options_(options),
          control_(control),
          report_(report),
          random_(options.seed),
          model_(problem, rows),
          state_(model_, start.labels),
          moves_(model_, state_, random_),
          parts_(problem, rows),
          in_window_(problem.label_count(), 0),
          best_(std::move(start)),
          reported_(best_.value) {
        for (Label i = 0; i < problem.label_count(); ++i) {
            all_labels_.push_back(i);
            const bool is_proposed = problem.weight(i) > 0 || !problem.bonuses_of(i).empty();
            (is_proposed ? proposals_ : fillers_).push_back(i);
        }
        set_scale();
        for (std::size_t k = 0; k < log_table_.size(); ++k) {
            log_table_[k] =
                std::log((static_cast<double>(k) + 0.5) / static_cast<double>(log_table_.size()));
        }
    }

    void run() {
        if (proposals_.empty()) return;
        const auto size = static_cast<std::int64_t>(proposals_.size());
        run_chain(options_.start_temperature,
                  options_.first_chain > 0 ? options_.first_chain : kFirstChainTicks * size);
        while (!control_.should_stop()) {
            const bool has_windows = proposals_.size() > 2 * kSmallestWindow;
            for (int k = 0; has_windows && k < kWindowsPerChain; ++k) run_window();
            run_chain(kReheats[statistics.chains % kReheats.size()], 100 + kChainTicks * size);
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

    void run_chain(double hottest, std::int64_t ticks) {
        anneal(hottest * scale_, kColdest * scale_, ticks);
        descend();
        recombine();
        ++statistics.chains;
    }

    /// A chain that may change only labels near a random one (and keep-labels).
    void run_window() {
        if (control_.should_stop()) return;
        const std::size_t size =
            kSmallestWindow + random_.below(kLargestWindow - kSmallestWindow + 1);
        collect_window(std::min(size, proposals_.size() / 2));
        moves_.restrict_to(&in_window_);
        window_.swap(proposals_);
        const double hottest = (0.75 + 1.5 * random_.unit()) * scale_;
        anneal(hottest, kColdest * scale_,
               kWindowTicks * static_cast<std::int64_t>(proposals_.size()));
        descend();
        window_.swap(proposals_);
        moves_.restrict_to(nullptr);
        for (Label i : window_) in_window_[i] = 0;
        recombine();
        ++statistics.windows;
    }

    /// Breadth-first from a random label over bonuses and conflicts.
    void collect_window(std::size_t size) {
        for (Label i : fillers_) in_window_[i] = 0;
        window_.clear();
        auto add = [&](Label i) {
            if (in_window_[i] != 0 || window_.size() >= size) return;
            in_window_[i] = 1;
            window_.push_back(i);
        };
        add(proposals_[random_.below(static_cast<std::uint32_t>(proposals_.size()))]);
        for (std::size_t k = 0; k < window_.size() && window_.size() < size; ++k) {
            for (const auto& b : problem_.bonuses_of(window_[k])) add(b.label);
            for (Label j : problem_.conflicts_of(window_[k])) add(j);
        }
        for (Label i : fillers_) in_window_[i] = 1;
    }

    void anneal(double hot, double cold, std::int64_t ticks) {
        const std::int64_t first = control_.work();
        const auto budget =
            static_cast<double>(std::max<std::int64_t>(1, std::min(ticks, control_.work_left())));
        const double ratio = std::log(cold / hot);
        while (!control_.should_stop()) {
            const double progress = static_cast<double>(control_.work() - first) / budget;
            if (progress >= 1.0) return;
            const double temperature = hot * std::exp(ratio * progress);
            const std::int64_t before = state_.work();
            for (int k = 0; k < kMovesPerCheck; ++k) propose(temperature);
            report_best();
            charge(state_.work() - before + kEntriesPerMove * kMovesPerCheck);
        }
    }

    void propose(double temperature) {
        ++statistics.moves;
        const Label i = proposals_[random_.below(static_cast<std::uint32_t>(proposals_.size()))];
        const auto threshold =
            static_cast<Value>(temperature * log_table_[random_.next() >> (64 - kLogTableBits)]);
        bool is_done = false;
        if (!state_.is_on(i) && random_.below(kMovesPerRun) == 0) {
            const int length = 2 + static_cast<int>(random_.below(kLongestRun - 1));
            is_done = moves_.insert_run(i, length, threshold);
        } else {
            is_done = moves_.flip(i, threshold);
        }
        if (is_done) accept();
    }

    void accept() {
        ++statistics.accepted;
        if (is_tracking_) {
            since_best_.insert(since_best_.end(), state_.log().begin(), state_.log().end());
            if (since_best_.size() > best_.labels.size()) {
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
                if (!moves_.flip(i, 1)) continue;
                accept();
                is_better = true;
            }
            const auto moves = static_cast<std::int64_t>(proposals_.size());
            charge(state_.work() - before + kEntriesPerMove * moves);
        }
    }

    /// Takes over the parts of the current labeling that beat the best, then continues from it.
    void recombine() {
        const std::int64_t before = state_.work();
        const std::vector<Label>& candidates = is_tracking_ ? since_best_ : all_labels_;
        const auto parts = parts_.split(candidates, best_.labels, state_.labels());
        for (const auto& part : parts) {
            const Value value = state_.value();
            for (Label i : part) state_.flip(i);
            // Now the part is as in the best; the chain's version returns if it was better.
            if (state_.value() < value) {
                state_.roll_back();
            } else {
                state_.commit();
            }
        }
        const auto looked_at = static_cast<std::int64_t>(candidates.size());
        if (state_.value() > best_.value) {
            statistics.crossover_gain += state_.value() - best_.value;
            keep();
        }
        // Every part that is no better was put back: the two labelings are equal now.
        since_best_.clear();
        is_tracking_ = true;
        report_best();
        charge(2 * (state_.work() - before) + looked_at);
    }

    void charge(std::int64_t entries) { control_.spend(1 + entries / kEntriesPerTick); }

    const LabelingProblem& problem_;
    const LocalSearchOptions& options_;
    RunControl& control_;
    const std::function<void(Value)>& report_;
    Random random_;
    SearchModel model_;
    SearchState state_;
    CompoundMoves moves_;
    DifferenceParts parts_;
    std::vector<Label> proposals_;  ///< labels that moves start from
    std::vector<Label> fillers_;    ///< labels that only rules call for
    std::vector<Label> all_labels_, window_;
    std::vector<std::uint8_t> in_window_;
    Solution best_;
    Value reported_;
    std::vector<Label> since_best_;  ///< flips from the best to the current labeling
    bool is_tracking_ = true;        ///< since_best_ is complete
    double scale_ = 1;
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
        // About ten seconds unless the caller limits either work or time.
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
        result.statistics["windows"] = static_cast<double>(statistics.windows);
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
