// What the tables count, on campaigns whose numbers can be computed by hand.
#include "experiment/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "experiment/ablation.h"
#include "experiment/compare.h"
#include "experiment/plot_data.h"
#include "experiment/study_comparison.h"
#include "experiments/synthetic_campaign.h"
#include "labeling_mip/external_process.h"

namespace experiment {
namespace {

using test::CampaignBuilder;

TEST(CrossCheck, BoundBelowACheckedValueIsAContradictionThatNamesBothRuns) {
    CampaignBuilder b;
    const auto p = b.problem("p");
    b.feasible(p, b.solver("finder"), 100, {}, 1);
    b.feasible(p, b.solver("liar"), 90, 95, 1);
    const CrossCheck check = cross_check(b.runs);
    ASSERT_EQ(check.contradictions.size(), 1u);
    const std::string& text = check.contradictions[0].text;
    EXPECT_NE(text.find("liar on p"), std::string::npos) << text;
    EXPECT_NE(text.find("finder on p"), std::string::npos) << text;
    EXPECT_NE(text.find("95"), std::string::npos) << text;
    EXPECT_NE(text.find("100"), std::string::npos) << text;
}

TEST(CrossCheck, OptimalityAndInfeasibilityAreClaimsToo) {
    CampaignBuilder b;
    const auto p = b.problem("p");
    b.feasible(p, b.solver("finder"), 100, {}, 1);
    b.optimal(p, b.solver("optimist"), 99, 1);
    b.run(p, b.solver("denier"), Outcome::Infeasible, 1);
    EXPECT_EQ(cross_check(b.runs).contradictions.size(), 2u);
}

TEST(CrossCheck, OptimalWithinAGapClaimsItsBoundAlone) {
    CampaignBuilder b;
    const auto p = b.problem("p");
    b.feasible(p, b.solver("finder"), 100, {}, 1);
    const auto s = b.solver("one percent");
    b.runs.plan.solvers[s].limits.gap = 0.02;
    b.optimal(p, s, 99, 1).bound = 100;
    EXPECT_TRUE(cross_check(b.runs).contradictions.empty());
    EXPECT_TRUE(compare_solvers(b.runs).cells[s][p].is_proven);
    // Without a bound it claims what the gap allows, and no less.
    b.runs.records.back()->bound.reset();
    EXPECT_TRUE(cross_check(b.runs).contradictions.empty());
    EXPECT_TRUE(compare_solvers(b.runs).cells[s][p].is_proven);
    b.runs.records.back()->value = 98;
    b.runs.plan.solvers[s].limits.gap = 0.01;
    ASSERT_EQ(cross_check(b.runs).contradictions.size(), 1u);
}

TEST(CrossCheck, KnownOptimaBindBothWays) {
    CampaignBuilder b;
    const auto p = b.problem("p"), q = b.problem("q"), r = b.problem("r");
    for (const auto k : {p, q, r}) b.runs.plan.problems[k].optimum = 50;
    const auto s = b.solver("s");
    b.feasible(p, s, 51, {}, 1);  // above the optimum
    b.feasible(q, s, 40, 49, 1);  // bound below it
    b.optimal(r, s, 50, 1);       // true
    const CrossCheck check = cross_check(b.runs);
    ASSERT_EQ(check.contradictions.size(), 2u);
    EXPECT_EQ(check.contradictions[0].problem, p);
    EXPECT_EQ(check.contradictions[1].problem, q);
}

TEST(CrossCheck, WrongRunsAreListedAndTheirBoundsNotUsed) {
    CampaignBuilder b;
    const auto p = b.problem("p");
    b.optimal(p, b.solver("honest"), 100, 1);
    Record& wrong = b.run(p, b.solver("liar"), Outcome::Wrong, 1);
    wrong.value = 40;
    wrong.bound = 10;
    const CrossCheck check = cross_check(b.runs);
    EXPECT_TRUE(check.contradictions.empty());
    ASSERT_EQ(check.wrong_jobs.size(), 1u);
    EXPECT_EQ(check.problems[p].best_bound, 100);
}

TEST(CrossCheck, EqualContentIsOneProblemWhateverItsName) {
    CampaignBuilder b;
    const auto p = b.problem("p"), q = b.problem("q");
    b.runs.plan.problems[q].hash = b.runs.plan.problems[p].hash;
    b.feasible(p, b.solver("finder"), 100, {}, 1);
    b.feasible(q, b.solver("liar"), 90, 95, 1);
    EXPECT_EQ(cross_check(b.runs).contradictions.size(), 1u);
    EXPECT_EQ(cross_check(b.runs).problems[q].best_value, 100);
}

TEST(Comparison, MeansByHand) {
    CampaignBuilder b;
    const auto s = b.solver("s", 10);
    b.runs.plan.report.shift_seconds = 1;
    b.optimal(b.problem("p"), s, 100, 3);
    b.run(b.problem("q"), s, Outcome::Timeout, 12);
    const SolverSummary summary = compare_solvers(b.runs).solvers[s];
    EXPECT_EQ(summary.proven, 1u);
    EXPECT_DOUBLE_EQ(summary.par10.estimate, (3 + 10 * 10) / 2.0);
    EXPECT_DOUBLE_EQ(summary.time.estimate, std::sqrt(4.0 * 11.0) - 1);
    EXPECT_EQ(summary.runs_over_limit, 1u);
}

TEST(Comparison, EveryFailureCountsAtTheLimit) {
    for (const Outcome outcome : {Outcome::Timeout, Outcome::Crash, Outcome::OutOfMemory,
                                  Outcome::DiskFull, Outcome::Wrong, Outcome::NoSolution}) {
        CampaignBuilder b;
        const auto s = b.solver("s", 10);
        const auto p = b.problem("p");
        b.run(p, s, outcome, 0.5);
        const Cell cell = compare_solvers(b.runs).cells[s][p];
        EXPECT_DOUBLE_EQ(cell.counted, 10) << to_string(outcome);
        EXPECT_DOUBLE_EQ(cell.par10, 100) << to_string(outcome);
        EXPECT_FALSE(cell.value) << to_string(outcome);
    }
}

TEST(Comparison, NotApplicableAndMissingAreNoZeros) {
    CampaignBuilder b;
    const auto able = b.solver("able"), unable = b.solver("unable"), absent = b.solver("absent");
    const auto p = b.problem("p"), q = b.problem("q");
    for (const auto k : {p, q}) b.optimal(k, able, 100, 2);
    b.optimal(p, unable, 100, 4);
    b.run(q, unable, Outcome::NotApplicable, 0.01);
    for (const auto k : {p, q}) b.run(k, absent, Outcome::Missing, 0);
    const Comparison comparison = compare_solvers(b.runs);
    const SolverSummary& of_unable = comparison.solvers[unable];
    EXPECT_EQ(of_unable.taken, 1u);
    EXPECT_EQ(of_unable.not_applicable, 1u);
    EXPECT_NEAR(of_unable.time.estimate, 4, 1e-9);
    EXPECT_DOUBLE_EQ(of_unable.par10.estimate, 4);
    EXPECT_DOUBLE_EQ(of_unable.gap_to_best.estimate, 0);
    EXPECT_EQ(comparison.solvers[absent].taken, 0u);
    EXPECT_TRUE(std::isnan(comparison.solvers[absent].time.estimate));
    const PairComparison pair = compare_pair(b.runs, comparison, able, unable);
    EXPECT_EQ(pair.common, 1u);
    EXPECT_NEAR(pair.time_ratio.estimate, 2, 1e-12);
    EXPECT_EQ(compare_pair(b.runs, comparison, able, absent).common, 0u);
}

TEST(Comparison, MediansOverSeedsOfAProblem) {
    CampaignBuilder b;
    const auto s = b.solver("s");
    const auto p = b.problem("p");
    b.optimal(p, s, 100, 1, 1);
    b.optimal(p, s, 100, 5, 2);
    b.feasible(p, s, 80, 130, 10, 3);
    const Comparison comparison = compare_solvers(b.runs);
    const Cell& cell = comparison.cells[s][p];
    EXPECT_TRUE(cell.is_proven);
    EXPECT_DOUBLE_EQ(cell.counted, 5);
    EXPECT_EQ(cell.value, 100);
    EXPECT_EQ(comparison.solvers[s].proven, 1u);
}

TEST(Comparison, AMinorityOfProofsIsNone) {
    CampaignBuilder b;
    const auto s = b.solver("s");
    const auto p = b.problem("p");
    b.optimal(p, s, 100, 1, 1);
    b.feasible(p, s, 80, 130, 10, 2);
    b.run(p, s, Outcome::NoSolution, 10, 3);
    const Cell cell = compare_solvers(b.runs).cells[s][p];
    EXPECT_FALSE(cell.is_proven);
    EXPECT_DOUBLE_EQ(cell.counted, 10);
    EXPECT_EQ(cell.value, 80);
    EXPECT_DOUBLE_EQ(cell.gap_to_best, 0.2);
}

TEST(Comparison, SpreadIsOfProvenRunsOfTheSameProblem) {
    CampaignBuilder b;
    const auto s = b.solver("s");
    const auto p = b.problem("p"), q = b.problem("q"), r = b.problem("r");
    b.optimal(p, s, 100, 1, 1);
    b.optimal(p, s, 100, 4, 2);
    b.optimal(q, s, 100, 9, 1);  // one run has none
    b.optimal(r, s, 100, 1, 1);
    b.feasible(r, s, 90, 110, 10, 2);  // nor has one without a proof
    EXPECT_DOUBLE_EQ(compare_solvers(b.runs).solvers[s].spread, 4);
}

TEST(Comparison, RunsNotMadeAreLeftOut) {
    CampaignBuilder b;
    const auto s = b.solver("s");
    const auto p = b.problem("p"), q = b.problem("q");
    b.optimal(p, s, 100, 1);
    b.job(p, s, 2);
    b.job(q, s);
    const SolverSummary summary = compare_solvers(b.runs).solvers[s];
    EXPECT_EQ(summary.taken, 1u);
    EXPECT_EQ(summary.not_run, 1u);
    EXPECT_EQ(summary.runs_made, 1u);
    EXPECT_EQ(summary.runs_planned, 3u);
}

TEST(Comparison, VirtualBestIsTheFastestOfEach) {
    const CampaignRuns runs = test::whole_campaign(3);
    const Comparison comparison = compare_solvers(runs);
    std::size_t fastest = 0;
    for (std::size_t s = 0; s < runs.plan.solvers.size(); ++s) {
        if (!runs.plan.solvers[s].start.empty()) continue;
        fastest += comparison.solvers[s].fastest;
        if (!comparison.solvers[s].is_exact || comparison.solvers[s].not_applicable > 0) continue;
        EXPECT_LE(comparison.virtual_best.time.estimate, comparison.solvers[s].time.estimate);
        EXPECT_LE(comparison.virtual_best.par10.estimate, comparison.solvers[s].par10.estimate);
        EXPECT_GE(comparison.virtual_best.proven, comparison.solvers[s].proven);
    }
    EXPECT_EQ(fastest, comparison.virtual_best.proven);
}

TEST(Comparison, OnlyThoseWhoClaimBoundsAreExact) {
    const CampaignRuns runs = test::whole_campaign(3);
    const Comparison comparison = compare_solvers(runs);
    for (std::size_t s = 0; s < runs.plan.solvers.size(); ++s) {
        const std::string& name = runs.plan.solvers[s].name;
        EXPECT_EQ(comparison.solvers[s].is_exact, name != "search" && name != "glpk") << name;
    }
}

TEST(Comparison, ClockAndThreadsDecideWhatASecondIs) {
    CampaignBuilder b;
    const auto s = b.solver("s", 10);
    b.runs.plan.solvers[s].threads = 4;
    const auto p = b.problem("p"), q = b.problem("q");
    b.optimal(p, s, 100, 3);
    b.run(q, s, Outcome::Timeout, 30);
    EXPECT_DOUBLE_EQ(compare_solvers(b.runs).cells[s][p].counted, 3);
    EXPECT_DOUBLE_EQ(compare_solvers(b.runs).cells[s][q].counted, 40);
    b.runs.plan.report.clock = "wall";
    EXPECT_DOUBLE_EQ(compare_solvers(b.runs).cells[s][p].counted, 6);
    EXPECT_DOUBLE_EQ(compare_solvers(b.runs).cells[s][q].counted, 10);
}

TEST(Comparison, WithoutATimeLimitTheLargestTimeCounts) {
    CampaignBuilder b;
    const auto s = b.solver("s", 0);
    b.runs.plan.solvers[s].limits.ticks = 1000;
    const auto p = b.problem("p"), q = b.problem("q");
    b.optimal(p, s, 100, 7);
    b.feasible(q, s, 50, 60, 2);
    const Comparison comparison = compare_solvers(b.runs);
    EXPECT_TRUE(comparison.uses_largest_time);
    EXPECT_DOUBLE_EQ(comparison.cells[s][q].counted, 7);
    EXPECT_DOUBLE_EQ(comparison.cells[s][q].par10, 70);
}

TEST(Comparison, RatiosHaveAFloor) {
    CampaignBuilder b;
    const auto a = b.solver("a"), c = b.solver("c");
    b.runs.plan.report.floor_seconds = 0.5;
    const auto p = b.problem("p");
    b.optimal(p, a, 100, 0.001);
    b.optimal(p, c, 100, 0.4);
    const PairComparison pair = compare_pair(b.runs, compare_solvers(b.runs), a, c);
    EXPECT_DOUBLE_EQ(pair.time_ratio.estimate, 1);
    EXPECT_EQ(pair.ties, 1u);
}

TEST(Comparison, PairsAreAntisymmetric) {
    const CampaignRuns runs = test::whole_campaign(5);
    const Comparison comparison = compare_solvers(runs);
    for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const PairComparison x = compare_pair(runs, comparison, a, b);
            const PairComparison y = compare_pair(runs, comparison, b, a);
            EXPECT_EQ(x.common, y.common);
            EXPECT_EQ(x.only_a, y.only_b);
            EXPECT_EQ(x.faster_a, y.faster_b);
            EXPECT_EQ(x.better_b, y.better_a);
            EXPECT_EQ(x.better_a + x.better_b + x.equal, x.common);
            EXPECT_NEAR(x.gap_difference.estimate, -y.gap_difference.estimate, 1e-12);
            if (std::isnan(x.time_ratio.estimate)) continue;
            EXPECT_NEAR(x.time_ratio.estimate * y.time_ratio.estimate, 1, 1e-9);
        }
    }
}

TEST(Ablation, OneOptionFromTheFirstOfItsKind) {
    CampaignBuilder b;
    const auto with = [&](const char* name, std::map<std::string, std::string> options) {
        const auto s = b.solver(name);
        b.runs.plan.solvers[s].solver = "bb";
        b.runs.plan.solvers[s].options = std::move(options);
        return s;
    };
    const auto parent = with("bb", {{"cuts", "1"}});
    const auto off = with("no cuts", {{"cuts", "0"}});
    with("two changes", {{"cuts", "0"}, {"probing", "0"}});
    const auto without = with("bare", {});
    const auto named = with("bb:named", {{"cuts", "0"}, {"probing", "0"}});
    b.solver("other");
    const auto found = find_ablations(b.runs.plan);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].variant, off);
    EXPECT_EQ(found[0].change, "cuts=0");
    EXPECT_EQ(found[1].variant, without);
    EXPECT_EQ(found[1].change, "without cuts");
    EXPECT_EQ(found[2].variant, named);
    EXPECT_EQ(found[2].change, "named");
    for (const Ablation& ablation : found) EXPECT_EQ(ablation.parent, parent);
}

TEST(Scaling, ExponentOfExactSolversOverProvenProblems) {
    CampaignBuilder b;
    const auto s = b.solver("s", 100);
    for (const int labels : {100, 200, 400, 800}) {
        const auto p = b.problem("p" + std::to_string(labels), "mesh", labels);
        b.optimal(p, s, 100, 1e-5 * labels * labels);
    }
    b.feasible(b.problem("open", "mesh", 1000000), s, 50, 60, 100);
    const auto found = scalings(b.runs, compare_solvers(b.runs));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].points.size(), 4u);
    ASSERT_TRUE(found[0].law);
    EXPECT_NEAR(found[0].law->exponent, 2, 1e-9);
}

TEST(Scaling, RunsThatALimitEndedSayNothingOfOthers) {
    CampaignBuilder b;
    const auto search = b.solver("search"), greedy = b.solver("greedy");
    for (const int labels : {100, 200, 400}) {
        const auto p = b.problem("p" + std::to_string(labels), "mesh", labels);
        b.feasible(p, search, 100, {}, 3);
        b.feasible(p, greedy, 90, {}, 0.001 * labels).stop_reason = "finished";
    }
    const auto found = scalings(b.runs, compare_solvers(b.runs));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].solver, greedy);
    EXPECT_NEAR(found[0].law->exponent, 1, 1e-9);
}

TEST(Study, ChangedSegments) {
    EXPECT_DOUBLE_EQ(changed_share({"a", "b", "c"}, {"c", "b", "a"}), 0);
    EXPECT_DOUBLE_EQ(changed_share({"a", "b"}, {"b", "c"}), 1 - 1 / 3.0);
    EXPECT_DOUBLE_EQ(changed_share({"a", "a"}, {"a"}), 0.5);
    EXPECT_DOUBLE_EQ(changed_share({}, {}), 0);
    EXPECT_DOUBLE_EQ(changed_share({}, {"a"}), 1);
}

TEST(Study, DifferencesAreOnTheSameMesh) {
    CampaignBuilder b;
    for (const char* name : {"best", "middling", "poor"}) b.solver(name);
    test::add_study(b.runs, 1);
    const labeling::ScratchFolder scratch;
    std::filesystem::create_directories(scratch.path() / "segments");
    for (const Job& job : b.runs.plan.jobs) {
        std::ofstream file(scratch.path() / "segments" / (job.key + ".txt"));
        file << "0 0 1 1\n" << (job.solver == 2 ? "2 2 3 3\n" : "1 1 2 2\n");
    }
    const StudyComparison study = compare_studies(b.runs, scratch.path());
    ASSERT_EQ(study.entries.size(), b.runs.plan.jobs.size());
    ASSERT_EQ(study.measures.front().key, "coverage");
    ASSERT_EQ(study.measures.back().key, "changed_segments");
    // The level of a mesh is random; what a solver loses of it is a hundredth a step.
    EXPECT_NEAR(study_difference(b.runs, study, 1, 0).estimate, -1, 1e-9);
    EXPECT_NEAR(study_difference(b.runs, study, 2, 0).estimate, -2, 1e-9);
    const std::size_t changed = study.measures.size() - 1;
    EXPECT_NEAR(study_mean(b.runs, study, 1, changed).estimate, 0, 1e-9);
    EXPECT_NEAR(study_mean(b.runs, study, 2, changed).estimate, 100 * (1 - 1 / 3.0), 1e-9);
    EXPECT_TRUE(cross_check(b.runs).contradictions.empty());
}

TEST(Compare, ACampaignAgainstItself) {
    const CampaignRuns runs = test::whole_campaign(9);
    const CampaignChange change = compare_campaigns(runs, runs);
    EXPECT_FALSE(change.has_regression);
    ASSERT_FALSE(change.solvers.empty());
    for (const SolverChange& solver : change.solvers) {
        EXPECT_EQ(solver.better + solver.worse, 0u);
        EXPECT_TRUE(solver.lost_proofs.empty());
        if (solver.time_ratio.is_known) {
            EXPECT_DOUBLE_EQ(solver.time_ratio.estimate, 1);
        }
    }
}

CampaignRuns scaled(double factor, int groups, int slower_groups) {
    CampaignBuilder b;
    const auto s = b.solver("s", 1000);
    for (int g = 0; g < groups; ++g) {
        for (int k = 0; k < 3; ++k) {
            const std::string group = "mesh" + std::to_string(g);
            const auto p = b.problem(group + "_" + std::to_string(k), group);
            b.optimal(p, s, 100, (1 + k) * (g < slower_groups ? factor : 1));
        }
    }
    return b.runs;
}

TEST(Compare, SlowerEverywhereIsARegression) {
    const CampaignChange change = compare_campaigns(scaled(1, 6, 6), scaled(1.5, 6, 6));
    ASSERT_EQ(change.solvers.size(), 1u);
    EXPECT_TRUE(change.has_regression);
    EXPECT_TRUE(change.solvers[0].is_slower);
    EXPECT_NEAR(change.solvers[0].time_ratio.estimate, 1.5, 1e-9);
    EXPECT_TRUE(to_json(change).at("has_regression").get<bool>());
    EXPECT_NE(to_text(change).find("REGRESSION"), std::string::npos);
}

TEST(Compare, FasterLittleSlowerOrSlowerOnOneMeshIsNone) {
    EXPECT_TRUE(compare_campaigns(scaled(1.5, 6, 6), scaled(1, 6, 6)).solvers[0].is_faster);
    EXPECT_FALSE(compare_campaigns(scaled(1, 6, 6), scaled(1.03, 6, 6)).has_regression);
    EXPECT_FALSE(compare_campaigns(scaled(1, 6, 1), scaled(1.5, 6, 1)).has_regression);
    EXPECT_FALSE(compare_campaigns(scaled(1, 1, 1), scaled(9, 1, 1)).has_regression);
}

TEST(Compare, LostProofsWorseValuesAndWrongRuns) {
    const auto make = [](bool is_worse) {
        CampaignBuilder b;
        const auto s = b.solver("s");
        for (int g = 0; g < 6; ++g) {
            const std::string name = "mesh" + std::to_string(g);
            const auto p = b.problem(name, name);
            if (is_worse) {
                b.feasible(p, s, 95, 120, 1);
            } else {
                b.optimal(p, s, 100, 1);
            }
        }
        if (is_worse) b.run(b.problem("x", "x"), s, Outcome::Wrong, 1);
        return b.runs;
    };
    const CampaignChange change = compare_campaigns(make(false), make(true));
    ASSERT_EQ(change.solvers.size(), 1u);
    const SolverChange& solver = change.solvers[0];
    EXPECT_EQ(solver.lost_proofs.size(), 6u);
    EXPECT_EQ(solver.worse_values.size(), 6u);
    EXPECT_TRUE(solver.loses_proofs && solver.is_worse && solver.is_more_wrong);
    EXPECT_NEAR(solver.value_change.estimate, -0.05, 1e-12);
    EXPECT_FALSE(compare_campaigns(make(true), make(false)).has_regression);
}

TEST(Compare, ProblemsAreFoundByTheirContent) {
    CampaignRuns before = scaled(1, 3, 3), after = scaled(1, 3, 3);
    for (PlannedProblem& problem : after.plan.problems) problem.name = "renamed_" + problem.name;
    EXPECT_EQ(compare_campaigns(before, after).solvers[0].problems, 9u);
    for (PlannedProblem& problem : after.plan.problems) problem.hash += "x";
    const CampaignChange none = compare_campaigns(before, after);
    EXPECT_TRUE(none.solvers.empty());
    EXPECT_FALSE(none.notes.empty());
}

}  // namespace
}  // namespace experiment
