// Branch and cut on problems that the small-part tree would take otherwise, without heuristics (an
// optimal start would hide a cut that takes the optimum away), with every technique switched off in
// turn; and every row of the relaxation against all feasible labelings.
#include <gtest/gtest.h>

#include <sstream>

#include "labeling/clique_cuts.h"
#include "labeling/formats.h"
#include "labeling/gomory_cuts.h"
#include "labeling/problems.h"
#include "labeling/propagation.h"
#include "labeling/rank_two_cuts.h"
#include "labeling/registry.h"
#include "labeling/term_graph.h"
#include "labeling/triple_cuts.h"
#include "labeling_mip/mip_solvers.h"

namespace labeling_test {
namespace {

using labeling::Cut;
using labeling::Label;
using labeling::SolveOptions;
using labeling::SolveResult;
using labeling::SolveStatus;

using Extras = std::map<std::string, std::string>;

/// Empty when branch and cut with these options finds the enumerated optimum.
std::string failure(const LabelingProblem& problem, const Extras& extras) {
    SolveOptions options;
    options.extra = extras;
    std::ostringstream why;
    try {
        const SolveResult result = every_solver().find("branch-and-bound")->solve(problem, options);
        const auto optimum = enumerate_optimum(problem);
        const auto expected = optimum ? SolveStatus::Optimal : SolveStatus::Infeasible;
        if (result.status != expected) why << "status " << to_string(result.status);
        if (result.solution && optimum && result.solution->value != *optimum) {
            why << " value " << result.solution->value << " instead of " << *optimum;
        }
    } catch (const std::exception& error) {
        why << error.what();
    }
    return why.str();
}

struct Case {
    std::string name;
    Extras extras;
};

class BranchAndCut : public testing::TestWithParam<Case> {
protected:
    Extras extras() const {
        Extras all{
            {"tree-size", "0"}, {"heuristics", "off"}, {"reductions", "off"}, {"treewidth", "off"}};
        for (const auto& [key, value] : GetParam().extras) all[key] = value;
        return all;
    }

    void expect_optimum(const LabelingProblem& problem, std::uint64_t seed) const {
        const std::string why = failure(problem, extras());
        if (why.empty()) return;
        ADD_FAILURE() << GetParam().name << ", seed " << seed << ": " << why << "\n"
                      << shrunk(problem, [&](const LabelingProblem& p) {
                             return p.label_count() > 0 && !failure(p, extras()).empty();
                         });
    }
};

TEST_P(BranchAndCut, AgreesWithEnumerationOnRandomProblems) {
    for (int k = 0; k < 2000; ++k) {
        const std::uint64_t seed = 20000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        expect_optimum(random_problem(engine, 5 + k % 8), seed);
        if (HasFailure()) return;
    }
}

TEST_P(BranchAndCut, AgreesWithEnumerationOnFrustratedProblems) {
    for (int k = 0; k < 600; ++k) {
        const std::uint64_t seed = 25000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        expect_optimum(frustrated_problem(engine, 6 + k % 5), seed);
        if (HasFailure()) return;
    }
}

TEST_P(BranchAndCut, AgreesWithEnumerationOnBundles) {
    for (int k = 0; k < 60; ++k) {
        const std::uint64_t seed = 30000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        BundleOptions options;
        options.curves = 3 + k % 2;
        options.segments = 3;
        options.crossings = 1 + k % 4;
        options.short_percent = 60;
        options.reach = 1 + k % 2;
        options.bonus = k % 3 == 0 ? 20 : 1000;
        expect_optimum(curve_bundle(engine, options), seed);
        if (HasFailure()) return;
    }
}

const Case kCases[] = {
    {"everything", {}},
    {"with_heuristics", {{"heuristics", "on"}}},
    {"with_reductions", {{"reductions", "on"}}},
    {"with_treewidth", {{"treewidth", "on"}}},
    {"without_cliques", {{"clique-cuts", "off"}}},
    {"without_triples", {{"triple-cuts", "off"}}},
    {"without_rank_two", {{"rank-two-cuts", "off"}}},
    {"without_gomory", {{"gomory-cuts", "off"}}},
    {"without_cliques_and_triples", {{"clique-cuts", "off"}, {"triple-cuts", "off"}}},
    {"without_cuts", {{"clique-cuts", "off"}, {"triple-cuts", "off"}, {"gomory-cuts", "off"}}},
    {"without_fixing", {{"fixing", "off"}}},
    {"without_restarts", {{"restarts", "off"}}},
    {"without_strong_branching", {{"strong-branching", "off"}}},
    {"late_bonuses", {{"many-bonuses", "0"}}},
    {"late_bonuses_without_cuts",
     {{"many-bonuses", "0"}, {"clique-cuts", "off"}, {"triple-cuts", "off"}}},
    {"without_late_bonuses", {{"late-bonuses", "off"}}},
    {"one_lane", {{"tree-lanes", "1"}}},
    {"five_lanes_without_cuts",
     {{"tree-lanes", "5"}, {"clique-cuts", "off"}, {"triple-cuts", "off"}, {"gomory-cuts", "off"}}},
};

INSTANTIATE_TEST_SUITE_P(EveryTechnique, BranchAndCut, testing::ValuesIn(kCases),
                         [](const auto& param) { return param.param.name; });

/// Sum of a statistic over frustrated problems of the sizes that the tests above use.
double total(const std::string& key, Extras extras) {
    SolveOptions options;
    extras["tree-size"] = "0";
    extras["heuristics"] = "off";
    extras["reductions"] = "off";
    extras["treewidth"] = "off";
    options.extra = extras;
    double sum = 0;
    for (int k = 0; k < 600; ++k) {
        std::mt19937_64 engine(25000 + static_cast<std::uint64_t>(k));
        const LabelingProblem problem = frustrated_problem(engine, 6 + k % 5);
        sum += every_solver().find("branch-and-bound")->solve(problem, options).statistics.at(key);
    }
    return sum;
}

TEST(BranchAndCutTree, IsReachedByFrustratedProblems) {
    EXPECT_GT(
        total("nodes", {{"clique-cuts", "off"}, {"triple-cuts", "off"}, {"gomory-cuts", "off"}}),
        300);
    EXPECT_GT(total("gomory-cuts", {{"clique-cuts", "off"}, {"triple-cuts", "off"}}), 150);
    EXPECT_GT(total("clique-cuts", {}), 50);
    EXPECT_GT(total("triple-cuts", {}), 50);
}

/// Feasible labelings, each with its bonus columns behind the labels.
std::vector<std::vector<double>> feasible_points(const LabelingProblem& problem) {
    std::vector<std::vector<double>> points;
    labeling::Solution solution;
    for (std::uint32_t set = 0; set < (std::uint32_t{1} << problem.label_count()); ++set) {
        solution.labels.clear();
        for (Label i = 0; i < problem.label_count(); ++i) {
            solution.labels.push_back((set >> i) & 1U);
        }
        if (!check_solution(problem, solution).is_feasible) continue;
        std::vector<double> point(solution.labels.begin(), solution.labels.end());
        for (const auto& b : problem.bonuses()) point.push_back(point[b.first] * point[b.second]);
        points.push_back(std::move(point));
    }
    return points;
}

/// Rounds of cuts as at the root, but without fixing by bounds, so that every row must hold for
/// every feasible point. Counts of cuts by kind are added up.
class CutRounds {
public:
    explicit CutRounds(const LabelingProblem& problem,
                       std::size_t most_edges = labeling::TermGraph::kMostEdges)
        : problem_(problem), points_(feasible_points(problem)), most_edges_(most_edges) {}

    void run() {
        const labeling::RowSystem rows(problem_);
        labeling::Propagator propagator(problem_, rows);
        if (!propagator.propagate_all()) return;
        const labeling::TermGraph graph(problem_, propagator, nullptr, most_edges_);
        labeling::Relaxation relaxation(problem_, labeling::clp_factory());
        labeling::CliqueSeparator cliques(problem_, graph);
        labeling::TripleSeparator triples(problem_, rows, graph);
        labeling::RankTwoSeparator rank_two(problem_, rows, graph);
        SolveOptions options;
        labeling::RunControl control(options);
        add(relaxation, labeling::initial_clique_cuts(problem_, graph, control), "initial");
        for (int round = 0; round < 12; ++round) {
            using Outcome = labeling::LpEngine::Outcome;
            if (relaxation.solve(control, 1 << 20) != Outcome::Optimal) return;
            check_bound(relaxation.bound());
            const std::vector<double> x(relaxation.x().begin(), relaxation.x().end());
            if (add_violated_rules(relaxation, rows, x)) continue;
            std::int64_t work = 0;
            const auto gomory = labeling::gomory_cuts(relaxation, {}, work);
            add(relaxation, cliques.separate(x), "clique");
            add(relaxation, triples.separate(x, cliques, propagator), "triple");
            add(relaxation, rank_two.separate(x), "rank two");
            add(relaxation, gomory, "gomory");
        }
    }

    std::map<std::string, int> counts;

private:
    static bool add_violated_rules(labeling::Relaxation& relaxation,
                                   const labeling::RowSystem& rows, const std::vector<double>& x) {
        bool is_any = false;
        for (std::int32_t r = 0; r < rows.row_count(); ++r) {
            Cut cut;
            cut.right_hand_side = rows.right_hand_side(r);
            for (const labeling::Term& t : rows.terms(r)) {
                cut.entries.push_back({t.label, t.coefficient});
            }
            const bool is_violated =
                cut.activity(x) > static_cast<double>(cut.right_hand_side) + 1e-6;
            is_any = (is_violated && relaxation.add(std::move(cut))) || is_any;
        }
        return is_any;
    }

    void add(labeling::Relaxation& relaxation, std::vector<Cut> cuts, const std::string& kind) {
        for (Cut& cut : cuts) {
            for (const auto& point : points_) {
                EXPECT_LE(cut.activity(point), static_cast<double>(cut.right_hand_side)) << kind;
            }
            counts[kind] += relaxation.add(std::move(cut)) ? 1 : 0;
        }
    }

    void check_bound(Value bound) const {
        const auto optimum = enumerate_optimum(problem_);
        if (optimum) {
            EXPECT_GE(bound, *optimum);
        }
    }

    const LabelingProblem& problem_;
    const std::vector<std::vector<double>> points_;
    const std::size_t most_edges_;
};

TEST(Cuts, HoldForEveryFeasibleLabeling) {
    std::map<std::string, int> counts;
    for (int k = 0; k < 1500; ++k) {
        const std::uint64_t seed = 40000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            k % 3 == 0 ? random_problem(engine, 10) : frustrated_problem(engine, 7 + k % 4);
        // Without edges between bonuses every other time, as on problems with very many.
        CutRounds rounds(problem, k % 2 == 0 ? 0 : labeling::TermGraph::kMostEdges);
        rounds.run();
        if (HasFailure()) {
            FAIL() << "seed " << seed << "\n"
                   << labeling::format_problem(problem, labeling::ProblemFormat::Lab);
        }
        for (const auto& [kind, count] : rounds.counts) counts[kind] += count;
    }
    // The test means nothing for a kind of cut that never shows up.
    for (const char* kind : {"initial", "clique", "triple", "rank two", "gomory"}) {
        EXPECT_GT(counts[kind], 50) << kind;
        RecordProperty(kind, counts[kind]);
    }
}

}  // namespace
}  // namespace labeling_test
