// What the local search is made of, against plain recomputation, and what it promises as a whole:
// the same answer on any number of threads and with any technique switched off a valid one.
#include "labeling/local_search.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "labeling/annealer.h"
#include "labeling/errors.h"
#include "labeling/generators.h"
#include "labeling/greedy.h"
#include "labeling/problems.h"
#include "labeling/region_splitter.h"
#include "labeling/run_control.h"
#include "labeling/solution_merger.h"

namespace labeling_test {
namespace {

using labeling::Label;
using labeling::RowSystem;
using labeling::SearchModel;
using labeling::SearchState;
using labeling::Solution;
using labeling::SolveOptions;

LabelingProblem curves(std::uint64_t seed, int bundles, double extent) {
    labeling::CurveFamilyOptions options;
    options.seed = seed;
    options.bundles = bundles;
    options.extent = extent;
    return labeling::curve_family(options).problem;
}

Solution start_of(const LabelingProblem& problem, const RowSystem& rows) {
    const SolveOptions options;
    labeling::RunControl control(options);
    const auto found = greedy_labeling(problem, rows, control);
    EXPECT_TRUE(found.solution);
    return *found.solution;
}

/// Rows that are violated, by plain summation.
std::set<std::int32_t> violated_rows(const RowSystem& rows, std::span<const std::uint8_t> labels) {
    std::set<std::int32_t> violated;
    for (std::int32_t row = 0; row < rows.row_count(); ++row) {
        std::int64_t sum = 0;
        for (const labeling::Term& t : rows.terms(row)) {
            if (labels[t.label] != 0) sum += t.coefficient;
        }
        if (sum > rows.right_hand_side(row)) violated.insert(row);
    }
    return violated;
}

TEST(SearchStateTest, GainsBlockersAndBrokenRulesFollowEveryFlip) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 2 == 0 ? frustrated_problem(engine, 20) : random_problem(engine, 20);
        const RowSystem rows(problem);
        const SearchModel model(problem, rows);
        const std::vector<std::uint8_t> none(problem.label_count(), 0);
        SearchState state(model, none);
        if (problem.label_count() == 0) continue;
        for (int flips = 0; flips < 60; ++flips) {
            const auto before = violated_rows(rows, state.labels());
            state.commit();
            state.flip(static_cast<Label>(pick(engine, 0, problem.label_count() - 1)));
            ASSERT_EQ(state.value(), labeling_value(problem, state.labels()));
            for (Label i = 0; i < problem.label_count(); ++i) {
                Value gain = problem.weight(i);
                for (const auto& b : problem.bonuses_of(i)) gain += state.is_on(b.label) * b.value;
                std::int32_t blockers = 0;
                for (Label j : problem.conflicts_of(i)) blockers += state.is_on(j) ? 1 : 0;
                ASSERT_EQ(state.gain(i), gain);
                ASSERT_EQ(state.blocker_count(i), blockers);
            }
            std::size_t newly_broken = 0;
            for (std::int32_t row : violated_rows(rows, state.labels())) {
                newly_broken += before.count(row) == 0 ? 1 : 0;
            }
            std::size_t noted = 0;
            for (const auto& rule : state.broken_rules()) noted += state.is_broken(rule) ? 1 : 0;
            ASSERT_GE(noted, newly_broken);
        }
    }
}

TEST(SearchStateTest, RollingBackRestoresEverything) {
    std::mt19937_64 engine(5);
    const LabelingProblem problem = frustrated_problem(engine, 25);
    const RowSystem rows(problem);
    const SearchModel model(problem, rows);
    const Solution start = start_of(problem, rows);
    SearchState state(model, start.labels);
    for (int k = 0; k < 40; ++k) {
        state.flip(static_cast<Label>(pick(engine, 0, problem.label_count() - 1)));
    }
    state.roll_back();
    EXPECT_EQ(state.value(), start.value);
    EXPECT_TRUE(std::equal(start.labels.begin(), start.labels.end(), state.labels().begin()));
    for (std::int32_t row = 0; row < rows.row_count(); ++row) EXPECT_LE(state.excess(row), 0);
}

TEST(AnnealerTest, NeverLosesItsBestAndKeepsWindowsClosed) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const LabelingProblem problem = curves(seed, 3, 12);
        const RowSystem rows(problem);
        const SearchModel model(problem, rows);
        const Solution start = start_of(problem, rows);
        labeling::Annealer annealer(model, start, seed);
        annealer.allow(1'000'000, {});
        Value last = start.value;
        for (int k = 0; k < 12; ++k) {
            const Solution before = annealer.best();
            const labeling::Chain chain{2.0, 0.1, 3000, k % 2 == 0};
            if (k % 3 == 0) {
                annealer.run_chain(chain);
            } else if (k % 3 == 1) {
                annealer.run_random_window(40, chain);
            } else {
                const auto window = model.proposals().subspan(0, 30);
                annealer.run_window(window, chain);
                for (Label i : model.proposals().subspan(30)) {
                    ASSERT_EQ(annealer.best().labels[i], before.labels[i]);
                }
            }
            ASSERT_TRUE(check_solution(problem, annealer.best()).message.empty());
            ASSERT_GE(annealer.best().value, last);
            last = annealer.best().value;
        }
    }
}

TEST(AnnealerTest, MergingIsAtLeastAsGoodAsEither) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const LabelingProblem problem = curves(seed, 6, 25);
        const RowSystem rows(problem);
        const SearchModel model(problem, rows);
        const Solution start = start_of(problem, rows);
        labeling::Annealer first(model, start, 2 * seed), second(model, start, 2 * seed + 1);
        first.allow(4000, {});
        second.allow(4000, {});
        first.run_chain({2.0, 0.1, 4000, false});
        second.restart({3.0, 0.1, 4000, false});
        const Value most = std::max(first.best().value, second.best().value);
        first.allow(1, {});
        first.merge(second.best());
        EXPECT_GE(first.best().value, most);
        EXPECT_TRUE(check_solution(problem, first.best()).message.empty());
        first.adopt(second.best());
        EXPECT_EQ(first.best().labels, second.best().labels);
    }
}

TEST(RegionSplitterTest, RegionsShareNothing) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 2 == 0 ? curves(seed, 4, 20) : frustrated_problem(engine, 60);
        const RowSystem rows(problem);
        const SearchModel model(problem, rows);
        labeling::RegionSplitter splitter(model);
        labeling::Random random(seed);
        const auto regions = splitter.split(random, 3);
        std::vector<int> region(problem.label_count(), -1);
        std::size_t inside = 0;
        for (std::size_t k = 0; k < regions.size(); ++k) {
            for (Label i : regions[k]) {
                ASSERT_EQ(region[i], -1);
                ASSERT_TRUE(model.is_proposed(i));
                region[i] = static_cast<int>(k);
                ++inside;
            }
        }
        EXPECT_GT(inside, 0u);
        auto expect_apart = [&](Label i, Label j) {
            ASSERT_TRUE(region[i] < 0 || region[j] < 0 || region[i] == region[j]);
        };
        for (const auto& c : problem.conflicts()) expect_apart(c.first, c.second);
        for (const auto& b : problem.bonuses()) expect_apart(b.first, b.second);
        for (const auto& rule : problem.rules()) {
            for (const auto& s : rule.terms) {
                for (const auto& t : rule.terms) expect_apart(s.label, t.label);
            }
        }
    }
}

TEST(SolutionMergerTest, FindsTheBestCombination) {
    std::int64_t gained = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 2 == 0 ? frustrated_problem(engine, 14) : random_problem(engine, 14);
        const auto values = all_values(problem);
        std::vector<std::size_t> feasible;
        for (std::size_t k = 0; k < values.size(); ++k) {
            if (values[k]) feasible.push_back(k);
        }
        if (feasible.empty()) continue;
        auto labels_of = [&](std::size_t index) {
            labeling::SolutionMerger::Labels labels(problem.label_count());
            for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = (index >> i) & 1U;
            return labels;
        };
        const auto last = static_cast<std::int64_t>(feasible.size()) - 1;
        const std::size_t start = feasible[static_cast<std::size_t>(pick(engine, 0, last))];
        // The others need not be feasible.
        std::vector<labeling::SolutionMerger::Labels> others;
        std::size_t varying = 0;
        for (int k = 0; k < 3; ++k) {
            const auto most = static_cast<std::int64_t>(values.size()) - 1;
            const auto other = static_cast<std::size_t>(pick(engine, 0, most));
            others.push_back(labels_of(other));
            varying |= other ^ start;
        }
        Value best = *values[start];
        for (std::size_t k : feasible) {
            if (((k ^ start) & ~varying) == 0) best = std::max(best, *values[k]);
        }
        const RowSystem rows(problem);
        const SolveOptions options;
        labeling::RunControl control(options);
        labeling::SolutionMerger merger(problem, rows, control, seed);
        Solution merged{labels_of(start), *values[start]};
        merger.merge(merged, others);
        ASSERT_TRUE(check_solution(problem, merged).message.empty());
        ASSERT_EQ(merged.value, labeling_value(problem, merged.labels));
        ASSERT_GE(merged.value, *values[start]);
        // Fourteen labels are never too wide.
        EXPECT_EQ(merger.statistics.given_up, 0);
        EXPECT_EQ(merged.value, best);
        gained += merged.value > *values[start] ? 1 : 0;
    }
    EXPECT_GT(gained, 50);
}

TEST(SolutionMergerTest, NarrowsWhatIsTooWideAndLosesNothing) {
    std::int64_t given_up = 0, improved = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const LabelingProblem problem = curves(seed, 8, 20);
        const RowSystem rows(problem);
        Solution best = start_of(problem, rows);
        const SolveOptions options;
        labeling::RunControl control(options);
        labeling::SolutionMerger merger(problem, rows, control, seed);
        for (int k = 0; k < 3; ++k) {
            const Value before = best.value;
            // Every label may vary.
            labeling::SolutionMerger::Labels opposite = best.labels;
            for (auto& label : opposite) label ^= 1;
            merger.merge(best, {{opposite}});
            ASSERT_GE(best.value, before);
            ASSERT_EQ(best.value, labeling_value(problem, best.labels));
            ASSERT_TRUE(check_solution(problem, best).message.empty());
        }
        given_up += merger.statistics.given_up;
        improved += merger.statistics.improved;
    }
    EXPECT_GT(given_up, 0);
    EXPECT_GT(improved, 0);
}

SolveOptions limited(std::int64_t work) {
    SolveOptions options;
    options.work_limit = work;
    return options;
}

TEST(LocalSearchTest, ThreadsDoNotChangeTheAnswer) {
    const auto solver = labeling::make_local_search_solver();
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const LabelingProblem problem = curves(seed, seed % 2 == 0 ? 3 : 12, 25);
        SolveOptions options = limited(1'000'000);
        options.seed = seed;
        const auto alone = solver->solve(problem, options);
        for (int threads : {2, 5}) {
            options.threads = threads;
            const auto together = solver->solve(problem, options);
            ASSERT_TRUE(alone.solution && together.solution);
            EXPECT_EQ(alone.solution->labels, together.solution->labels);
            EXPECT_EQ(alone.work, together.work);
            ASSERT_EQ(alone.trace.size(), together.trace.size());
            for (std::size_t k = 0; k < alone.trace.size(); ++k) {
                EXPECT_EQ(alone.trace[k].value, together.trace[k].value);
                EXPECT_EQ(alone.trace[k].work, together.trace[k].work);
            }
        }
    }
}

TEST(LocalSearchTest, AStopEndsWorkInThreads) {
    const auto solver = labeling::make_local_search_solver();
    const LabelingProblem problem = curves(3, 8, 30);
    SolveOptions options;
    options.threads = 2;
    std::stop_source source;
    options.stop = source.get_token();
    options.on_improvement = [&](const labeling::TracePoint&) { source.request_stop(); };
    const auto result = solver->solve(problem, options);
    EXPECT_EQ(result.stop_reason, labeling::StopReason::Interrupted);
    ASSERT_TRUE(result.solution);
    EXPECT_TRUE(check_solution(problem, *result.solution).message.empty());
}

TEST(LocalSearchTest, EveryTechniqueCanBeSwitchedOff) {
    const auto solver = labeling::make_local_search_solver();
    const LabelingProblem problem = curves(2, 4, 15);
    const auto greedy = labeling::make_greedy_solver()->solve(problem, {});
    for (const char* key : {"reductions", "regions", "windows", "adaptive", "by-worth", "restarts",
                            "recombination", "merging"}) {
        SCOPED_TRACE(key);
        SolveOptions options = limited(300'000);
        options.extra[key] = "off";
        const auto result = solver->solve(problem, options);
        ASSERT_TRUE(result.solution);
        EXPECT_GE(result.solution->value, greedy.solution->value);
        options.extra[key] = "perhaps";
        EXPECT_THROW(solver->solve(problem, options), labeling::InputError);
    }
}

TEST(LocalSearchTest, ReachesTheOptimumOfChainsAndPlantedProblems) {
    const auto solver = labeling::make_local_search_solver();
    int reached = 0, problems = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        labeling::ChainOptions chain;
        chain.seed = seed;
        labeling::PlantedOptions planted;
        planted.seed = seed;
        for (const auto& g : {labeling::chain(chain), labeling::planted(planted)}) {
            const auto result = solver->solve(g.problem, limited(1'000'000));
            ASSERT_TRUE(result.solution && g.optimum);
            ASSERT_LE(result.solution->value, g.optimum->value);
            ++problems;
            reached += result.solution->value == g.optimum->value ? 1 : 0;
        }
    }
    EXPECT_GE(10 * reached, 9 * problems);
}

}  // namespace
}  // namespace labeling_test
