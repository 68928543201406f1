// Local search: climbs by annealing chains over the whole problem and over windows of some hundred
// connected labels, with partition crossover after each (annealer.cpp) and the kind of chain chosen
// by what pays (chain_schedule.cpp). Two lanes anneal from the same best and their gains are merged
// by partition crossover; on large problems gains in different places add up, on small ones the
// second lane is a second try. A climb that has come to nothing for a while is put into a small
// pool and the next one starts hot. A finished climb is recombined with the pool: where two good
// labelings differ is annealed with everything else fixed (the idea of CHILS, Grossmann, Langedal &
// Schulz 2024, whose cores are these differences). In between, the best combination of the ends of
// the last chains is found exactly (solution_merger.cpp), also across climbs: that is why a climb
// need not go on for long.
#include "labeling/local_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "labeling/chain_schedule.h"
#include "labeling/errors.h"
#include "labeling/random.h"
#include "labeling/reduced_search.h"
#include "labeling/region_splitter.h"
#include "labeling/search_lanes.h"
#include "labeling/solution_merger.h"

namespace labeling {
namespace {

// Chosen by measurement on the development problems and generated ones at 1 and 10 s.
constexpr double kColdest = 0.2;
constexpr double kColdLow = 0.1;
constexpr double kColdHigh = 0.25;
constexpr std::array<double, 4> kReheats{1.2, 0.6, 2.4, 0.9};
constexpr std::int64_t kFirstTicks = 150;                         ///< per label
constexpr std::int64_t kFirstMost = 3'000'000, kFirstLeast = 25;  ///< where that is much
constexpr std::int64_t kSmallRegion = 4000, kLargeRegion = 16000, kManyLabels = 50'000;
constexpr double kLeastHeat = 0.5;
constexpr std::array<double, 3> kRestartHeats{3.0, 1.5, 1.5};
constexpr std::int64_t kFirstShare = 4;  ///< of the work, at most
constexpr std::int64_t kLeastRound = 20000;
constexpr double kPatience = 60;  ///< ticks per label without gain
constexpr std::int64_t kSplitSize = 1000, kSplitDegree = 2;
constexpr double kPatienceShare = 0.25;
constexpr std::uint32_t kSmallestWindow = 100, kLargestWindow = 500;
constexpr std::int64_t kLargeShare = 3, kSmallShare = 10;
constexpr double kWorthwhile = 3e-4;  ///< share of the value that counts as better for patience
constexpr std::size_t kPoolSize = 6;
constexpr std::size_t kEnds = 8;
constexpr std::int64_t kMergeShare = 4;  ///< of the work, at most
constexpr double kCoreTicks = 100;       ///< per label of a difference
constexpr int kCoreRounds = 3;

/// Gain per tick, with the past discounted.
struct RecentGain {
    double gain = 0, cost = 0;
    void add(double more_gain, double more_cost) {
        gain = 0.9 * gain + more_gain;
        cost = 0.9 * cost + more_cost;
    }
    double rate() const { return cost > 0 ? gain / cost : 0; }
};

class LocalSearch {
public:
    LocalSearch(const LabelingProblem& problem, const RowSystem& rows, RunControl& control,
                const Solution& start, const LocalSearchOptions& options,
                const std::function<void(Value)>& report)
        : options_(options),
          control_(control),
          report_(report),
          random_(options.seed),
          model_(problem, rows, PassGuard(control)),
          splitter_(model_),
          merger_(problem, rows, control, options.seed),
          lanes_(model_, start, options.seed, static_cast<std::size_t>(options.lanes),
                 options.threads, control),
          size_(static_cast<std::int64_t>(model_.proposals().size())),
          best_(start),
          climb_(start) {}

    void run() {
        if (size_ == 0) return;
        first_work_ = control_.work();
        last_worthwhile_ = first_work_;
        worthwhile_value_ = best_.value;
        try {
            while (!has_ended()) {
                climb();
                if (!options_.restarts) continue;
                if (options_.recombination) recombine();
                insert(climb_);
            }
        } catch (const StoppedInPass&) {  // between rounds: best_ is complete
        }
    }

    Solution take_best() { return std::move(best_); }
    LocalSearchStatistics statistics() {
        LocalSearchStatistics sum;
        sum.climbs = climbs_;
        sum.recombined = recombined_;
        sum.merges = merger_.statistics.merges;
        sum.merged = merger_.statistics.improved;
        for (std::size_t k = 0; k < lanes_.size(); ++k) {
            const AnnealerStatistics& s = lanes_.lane(k).statistics;
            sum.moves += s.moves;
            sum.accepted += s.accepted;
            sum.chains += s.chains;
            sum.windows += s.windows;
        }
        return sum;
    }

private:
    bool has_ended() const {
        if (control_.should_stop()) return true;
        const std::int64_t now = control_.work();
        return options_.patience > 0 &&
               now - last_worthwhile_ > std::max(options_.patience, (now - first_work_) / 3);
    }

    void climb() {
        const std::int64_t first = control_.work();
        begin_climb();
        ChainSchedule schedule(options_.windows && size_ > 2 * kSmallestWindow, options_.adaptive);
        std::int64_t last_gain = control_.work();
        while (!has_ended()) {
            const std::int64_t before = control_.work();
            const Value value = climb_.value;
            std::size_t kind = schedule.choose(random_);
            if (schedule.kind(kind).ticks * size_ > before - first) kind = 0;
            run_round(schedule.kind(kind));
            merge();
            const std::int64_t now = control_.work();
            schedule.credit(kind, static_cast<double>(climb_.value - value),
                            static_cast<double>(now - before));
            intensify(static_cast<double>(climb_.value - value), static_cast<double>(now - before));
            if (climb_.value > value) last_gain = now;
            const double patience =
                std::max(static_cast<double>(size_) * kPatience,
                         kPatienceShare * static_cast<double>(last_gain - first));
            if (options_.restarts && static_cast<double>(now - last_gain) > patience) break;
        }
        ++climbs_;
    }

    /// The first climb starts from what was given, the others from anywhere.
    void begin_climb() {
        Chain chain{climbs_ == 0 ? options_.start_temperature
                                 : kRestartHeats[climbs_ % kRestartHeats.size()],
                    kColdest, 0, false};
        chain.ticks = std::min(kFirstTicks * size_, std::max(kFirstMost, kFirstLeast * size_));
        if (climbs_ == 0 && options_.first_chain > 0) chain.ticks = options_.first_chain;
        // Where there is no time for a long chain, heat would only spoil what the start is worth.
        const std::int64_t share = control_.ticks_left() / kFirstShare;
        if (share < chain.ticks) {
            const double part = static_cast<double>(share) / static_cast<double>(chain.ticks);
            chain.hottest = std::max(std::min(kLeastHeat, chain.hottest), chain.hottest * part);
            chain.ticks = share;
        }
        chain.ticks /= options_.lanes;
        if (climbs_ == 0 && is_split()) {
            return anneal_regions(chain, chain.ticks * options_.lanes / size_);
        }
        if (climbs_ == 0) {
            lanes_.run(lanes_.size(), [&](Annealer& lane, std::size_t) { lane.run_chain(chain); });
        } else {
            lanes_.run(lanes_.size(), [&](Annealer& lane, std::size_t) { lane.restart(chain); });
            climb_ = lanes_.lane(0).best();
        }
        gather();
    }

    void run_round(const ChainKind& kind) {
        if (!kind.is_window && is_split()) return run_split(kind);
        const std::int64_t ticks =
            std::max(kLeastRound, (kind.is_window ? 25 : kind.ticks) * size_);
        const int used = kind.used;
        lanes_.run(lanes_.size(), [&](Annealer& lane, std::size_t k) {
            const std::int64_t end = lane.work() + ticks;
            for (std::size_t n = k; lane.work() < end && !lane.is_stopped(); ++n) {
                Chain chain{0, kColdLow + (kColdHigh - kColdLow) * lane.unit(), 0,
                            options_.by_worth && lane.unit() < 0.5};
                if (kind.is_window) {
                    const auto size = static_cast<std::int64_t>(
                        kSmallestWindow + lane.unit() * (kLargestWindow - kSmallestWindow));
                    chain.ticks = kind.ticks * size;
                    chain.hottest = 0.75 + 1.5 * lane.unit();
                    lane.run_random_window(static_cast<std::size_t>(size), chain);
                } else {
                    chain.ticks = kind.ticks * size_;
                    chain.hottest = kReheats[(used + n) % kReheats.size()];
                    lane.run_chain(chain);
                }
            }
        });
        gather();
    }

    /// On sparse problems gains add up without it, because differences fall apart.
    bool is_split() const {
        const LabelingProblem& problem = model_.problem();
        return options_.regions && lanes_.size() > 1 && size_ > kSplitSize &&
               static_cast<std::int64_t>(problem.conflict_count()) >
                   kSplitDegree * problem.label_count();
    }

    /// Each lane anneals a region of its own, so that all gains can be kept.
    void run_split(const ChainKind& kind) {
        const bool is_by_worth = options_.by_worth && random_.unit() < 0.5;
        const double coldest = kColdLow + (kColdHigh - kColdLow) * random_.unit();
        anneal_regions({kReheats[kind.used % kReheats.size()], coldest, 0, is_by_worth},
                       kind.ticks);
    }

    /// Several regions a lane where there are many labels: a small one stays in the cache. Where
    /// there are very many, chains are too short for what regions lose at their borders.
    void anneal_regions(const Chain& pattern, std::int64_t ticks) {
        const std::int64_t largest = size_ > kManyLabels ? kLargeRegion : kSmallRegion;
        const auto each = static_cast<std::int64_t>(lanes_.size()) * largest;
        const auto regions = splitter_.split(
            random_, lanes_.size() * static_cast<std::size_t>((size_ + each - 1) / each),
            PassGuard(control_));
        control_.spend(splitter_.take_work() / 16);
        std::vector<std::vector<std::size_t>> shares(lanes_.size());
        std::vector<std::size_t> labels(lanes_.size(), 0);
        for (std::size_t r = 0; r < regions.size(); ++r) {
            const auto k = static_cast<std::size_t>(std::min_element(labels.begin(), labels.end()) -
                                                    labels.begin());
            shares[k].push_back(r);
            labels[k] += regions[r].size();
        }
        lanes_.run(lanes_.size(), [&](Annealer& lane, std::size_t k) {
            for (std::size_t r : shares[k]) {
                Chain chain = pattern;
                chain.ticks = ticks * static_cast<std::int64_t>(regions[r].size());
                lane.run_window(regions[r], chain);
            }
        });
        gather();
    }

    /// All lanes go on from the best of their parts.
    void gather() {
        gather_ends();
        lanes_.run(1, [&](Annealer& lane, std::size_t) {
            for (std::size_t k = 1; k < lanes_.size(); ++k) lane.merge(lanes_.lane(k).best());
        });
        climb_ = lanes_.lane(0).best();
        share_best();
        note();
    }

    /// The ends of the last chains, what of them was not taken over included.
    void gather_ends() {
        for (std::size_t k = 0; k < lanes_.size(); ++k) {
            const auto changed = lanes_.lane(k).take_changes();
            if (!options_.merging || changed.empty()) continue;
            if (ends_.size() == kEnds) ends_.pop_back();
            ends_.insert(ends_.begin(), climb_.labels);
            for (const auto& [i, value] : changed) ends_.front()[i] = value;
        }
    }

    /// Takes over the best combination of the climb and the last ends.
    void merge() {
        if (ends_.size() < 2) return;
        const std::int64_t before = control_.work();
        if (kMergeShare * merge_work_ > before - first_work_) return;
        const Value value = climb_.value;
        merger_.merge(climb_, ends_);
        merge_work_ += control_.work() - before;
        if (climb_.value == value) return;
        share_best();
        note();
    }

    /// Lets the caller's search have what is due to it: more if it has gained more per tick of
    /// late.
    void intensify(double round_gain, double round_cost) {
        if (!options_.intensify) return;
        rounds_.add(round_gain, round_cost);
        const std::int64_t share = outside_.rate() > rounds_.rate() ? kLargeShare : kSmallShare;
        while (!control_.should_stop() && share * intensify_work_ < control_.work() - first_work_) {
            const std::int64_t before = control_.work();
            const Value value = climb_.value;
            options_.intensify(climb_, pool_);
            const std::int64_t work = control_.work() - before + 1;
            intensify_work_ += work;
            outside_.add(static_cast<double>(climb_.value - value), static_cast<double>(work));
            if (climb_.value == value) continue;
            share_best();
            note();
        }
    }

    void share_best() {
        for (std::size_t k = 0; k < lanes_.size(); ++k) lanes_.lane(k).adopt(climb_);
    }

    void note() {
        if (climb_.value <= best_.value) return;
        best_ = climb_;
        const double gain = static_cast<double>(best_.value - worthwhile_value_);
        if (gain > kWorthwhile * std::abs(static_cast<double>(best_.value))) {
            worthwhile_value_ = best_.value;
            last_worthwhile_ = control_.work();
        }
        if (report_) report_(best_.value);
    }

    /// Anneals where the climb differs from each of the pool.
    void recombine() {
        for (const Solution& other : pool_) {
            for (int round = 0; round < kCoreRounds; ++round) {
                if (control_.should_stop()) return;
                const Value before = climb_.value;
                lanes_.run(1, [&](Annealer& lane, std::size_t) { lane.merge(other); });
                climb_ = lanes_.lane(0).best();
                share_best();
                std::vector<Label> core;
                for (Label i : model_.proposals()) {
                    if (climb_.labels[i] != other.labels[i]) core.push_back(i);
                }
                if (core.empty()) break;
                lanes_.run(lanes_.size(), [&](Annealer& lane, std::size_t k) {
                    Chain chain{
                        kReheats[(k + static_cast<std::size_t>(round)) % kReheats.size()], kColdest,
                        static_cast<std::int64_t>(kCoreTicks * static_cast<double>(core.size())),
                        false};
                    lane.run_window(core, chain);
                });
                gather();
                if (climb_.value > before) ++recombined_;
            }
        }
    }

    /// Keeps the best different ones.
    void insert(const Solution& solution) {
        for (const Solution& other : pool_) {
            if (other.value == solution.value) return;
        }
        pool_.push_back(solution);
        std::sort(pool_.begin(), pool_.end(),
                  [](const Solution& a, const Solution& b) { return a.value > b.value; });
        if (pool_.size() > kPoolSize) pool_.pop_back();
    }

    const LocalSearchOptions& options_;
    RunControl& control_;
    const std::function<void(Value)>& report_;
    Random random_;
    SearchModel model_;
    RegionSplitter splitter_;
    SolutionMerger merger_;
    SearchLanes lanes_;
    const std::int64_t size_;
    Solution best_, climb_;
    std::vector<Solution> pool_;
    std::vector<SolutionMerger::Labels> ends_;  ///< of chains, latest first
    RecentGain rounds_, outside_;
    Value worthwhile_value_ = 0;  ///< of the best at last_worthwhile_
    std::int64_t climbs_ = 0, recombined_ = 0, first_work_ = 0, last_worthwhile_ = 0,
                 intensify_work_ = 0, merge_work_ = 0;
};

struct Switch {
    const char* key;
    bool LocalSearchOptions::*field;
};

constexpr std::array kSwitches{
    Switch{"regions", &LocalSearchOptions::regions},
    Switch{"windows", &LocalSearchOptions::windows},
    Switch{"adaptive", &LocalSearchOptions::adaptive},
    Switch{"by-worth", &LocalSearchOptions::by_worth},
    Switch{"restarts", &LocalSearchOptions::restarts},
    Switch{"recombination", &LocalSearchOptions::recombination},
    Switch{"merging", &LocalSearchOptions::merging},
};

LocalSearchOptions search_options(const SolveOptions& options, std::string_view solver) {
    require_known_extras(options, solver,
                         {"first-chain", "lanes", "reductions", "regions", "windows", "adaptive",
                          "by-worth", "restarts", "recombination", "merging"});
    LocalSearchOptions search;
    search.seed = options.seed;
    search.threads = options.threads;
    search.lanes = static_cast<int>(extra_integer(options, "lanes", search.lanes, 1, 16));
    search.first_chain = extra_integer(options, "first-chain", 0, 0, std::int64_t{1} << 40);
    for (const Switch& s : kSwitches) {
        search.*s.field = extra_switch(options, s.key, search.*s.field);
    }
    return search;
}

class LocalSearchSolver final : public Solver {
public:
    std::string name() const override { return "local-search"; }
    std::string description() const override {
        return "annealing over compound moves with partition crossover, restarts and recombination";
    }
    bool is_exact() const override { return false; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        const LocalSearchOptions search = search_options(options, name());
        // About ten seconds unless the caller limits either work or time.
        std::optional<std::int64_t> work;
        if (!options.time_limit) work = 100'000'000;
        RunControl control(options, work);
        LocalSearchStatistics statistics;
        auto found =
            search_reduced(problem, options, control,
                           extra_switch(options, "reductions", should_reduce_first(problem)),
                           [&](const LabelingProblem& rest, const RowSystem& rows, Solution start,
                               const std::function<void(Value)>& report) {
                               return improve_labeling(rest, rows, control, std::move(start),
                                                       search, report, &statistics);
                           });
        SolveResult result = finish(problem, name(), control, std::move(found.solution),
                                    std::nullopt, found.is_infeasible);
        result.statistics["moves"] = static_cast<double>(statistics.moves);
        result.statistics["accepted"] = static_cast<double>(statistics.accepted);
        result.statistics["chains"] = static_cast<double>(statistics.chains);
        result.statistics["windows"] = static_cast<double>(statistics.windows);
        result.statistics["climbs"] = static_cast<double>(statistics.climbs);
        result.statistics["recombined"] = static_cast<double>(statistics.recombined);
        result.statistics["merges"] = static_cast<double>(statistics.merges);
        result.statistics["merged-parts"] = static_cast<double>(statistics.merged);
        return result;
    }
};

}  // namespace

Solution improve_labeling(const LabelingProblem& problem, const RowSystem& rows,
                          RunControl& control, Solution start, const LocalSearchOptions& options,
                          const std::function<void(Value)>& report,
                          LocalSearchStatistics* statistics) {
    try {
        LocalSearch search(problem, rows, control, start, options, report);
        search.run();
        if (statistics != nullptr) *statistics = search.statistics();
        return search.take_best();
    } catch (const StoppedInPass&) {
        return start;
    }
}

std::shared_ptr<const Solver> make_local_search_solver() {
    return std::make_shared<LocalSearchSolver>();
}

}  // namespace labeling
