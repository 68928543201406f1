// Every family of reductions alone, and all together, against enumeration of the original and of
// the reduced problem: the optimum differs by the offset, and every labeling of the reduced problem
// is lifted to a feasible one that is worth no less.
#include "labeling/reductions.h"

#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "labeling/errors.h"
#include "labeling/problems.h"
#include "labeling/solver.h"

namespace labeling_test {
namespace {

using labeling::Label;
using labeling::ReducedProblem;
using labeling::ReductionOptions;
using labeling::ReductionStatistics;
using labeling::RunControl;
using labeling::Solution;
using labeling::SolveOptions;

struct Case {
    const char* name;
    ReductionOptions options;
    std::int64_t ReductionStatistics::*steps;
};

ReductionOptions only(bool ReductionOptions::*family) {
    ReductionOptions options{false, false, false, false, false, false, false};
    if (family != nullptr) options.*family = true;
    return options;
}

const std::array kCases{
    Case{"rules", only(&ReductionOptions::rules), &ReductionStatistics::rule_steps},
    Case{"dual_fixing", only(&ReductionOptions::dual_fixing), &ReductionStatistics::dual_steps},
    Case{"neighbourhoods", only(&ReductionOptions::neighbourhoods),
         &ReductionStatistics::neighbourhood_steps},
    Case{"domination", only(&ReductionOptions::domination), &ReductionStatistics::domination_steps},
    Case{"linked_labels", only(&ReductionOptions::linked_labels), &ReductionStatistics::link_steps},
    Case{"cliques", only(&ReductionOptions::cliques), &ReductionStatistics::clique_steps},
    Case{"folding", only(&ReductionOptions::folding), &ReductionStatistics::folding_steps},
    Case{"propagation_alone", only(nullptr), &ReductionStatistics::labels},
    Case{"all", {}, &ReductionStatistics::labels},
};

/// Conflicts and bonuses as in a sparse graph; rules, if any, of the kinds that curves have.
LabelingProblem sparse_problem(std::mt19937_64& engine, int most_labels) {
    labeling::ProblemBuilder builder;
    const auto n = static_cast<Label>(pick(engine, 2, most_labels));
    const bool has_zeros = pick(engine, 0, 1) == 0;
    for (Label i = 0; i < n; ++i) builder.add_label(pick(engine, has_zeros ? 0 : 1, 12));
    const auto other = [&](Label i) {
        const auto j = static_cast<Label>(pick(engine, 0, n - 2));
        return j < i ? j : j + 1;
    };
    for (std::int64_t k = pick(engine, 0, 2 * n); k > 0; --k) {
        const auto i = static_cast<Label>(pick(engine, 0, n - 1));
        builder.add_conflict(i, other(i));
    }
    const Value bonus = pick(engine, 0, 1) == 0 ? 4 : 30;
    for (std::int64_t k = pick(engine, -n, n); k > 0; --k) {
        const auto i = static_cast<Label>(pick(engine, 0, n - 1));
        builder.add_bonus(i, other(i), pick(engine, 1, bonus));
    }
    for (std::int64_t k = n > 3 ? pick(engine, -n, n / 2) : 0; k > 0; --k) {
        const auto i = static_cast<Label>(pick(engine, 0, n - 1));
        const Label a = other(i), b = other(i);
        if (pick(engine, 0, 1) == 0) {
            builder.add_rule({labeling::Relation::LessEqual, 0, {{1, i}, {-1, a}, {-1, b}}});
        } else {
            builder.add_rule({labeling::Relation::LessEqual, 2, {{1, i}, {1, a}, {1, b}}});
        }
    }
    return builder.build();
}

LabelingProblem some_problem(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    switch (seed % 4) {
        case 0:
            return random_problem(engine, 8);
        case 1:
            return frustrated_problem(engine, static_cast<int>(pick(engine, 4, 6)));
        default:
            return sparse_problem(engine, 9);
    }
}

/// Calls `visit` with every feasible labeling and its value.
template <class Visit>
void for_each_labeling(const LabelingProblem& problem, Visit visit) {
    Solution solution;
    solution.labels.resize(problem.label_count());
    for (std::uint32_t set = 0; set < std::uint32_t{1} << problem.label_count(); ++set) {
        for (Label i = 0; i < problem.label_count(); ++i) solution.labels[i] = set >> i & 1U;
        const auto check = check_solution(problem, solution);
        if (!check.is_feasible) continue;
        solution.value = check.value;
        visit(solution);
    }
}

/// Empty when all is well; what has been done is added to `total` (may be null).
std::string failure(const LabelingProblem& problem, const ReductionOptions& options,
                    ReductionStatistics* total, std::int64_t ReductionStatistics::*steps) {
    std::ostringstream why;
    const SolveOptions unlimited;
    RunControl control(unlimited);
    const ReducedProblem reduced = reduce_problem(problem, control, options);
    if (total != nullptr) total->*steps += reduced.statistics().*steps;
    const std::optional<Value> optimum = enumerate_optimum(problem);
    if (reduced.is_infeasible()) return optimum ? "called infeasible" : "";
    std::optional<Value> best, best_lifted;
    for_each_labeling(reduced.problem(), [&](const Solution& solution) {
        const Solution lifted = reduced.lift(problem, solution);
        const auto check = check_solution(problem, lifted);
        if (!check.message.empty()) why << "lifted: " << check.message << "; ";
        if (lifted.value < solution.value + reduced.offset()) why << "lifting lost value; ";
        if (!best || solution.value > *best) {
            best = solution.value;
            best_lifted = lifted.value;
        }
    });
    if (best.has_value() != optimum.has_value()) why << "feasibility differs; ";
    if (best && optimum && *best + reduced.offset() != *optimum) {
        why << "optimum " << *best << " + " << reduced.offset() << ", not " << *optimum << "; ";
    }
    if (best_lifted && optimum && *best_lifted != *optimum) why << "the lifted best is not; ";
    return why.str();
}

class Reductions : public testing::TestWithParam<Case> {
protected:
    void expect_equivalent(const LabelingProblem& problem, std::uint64_t seed) {
        const std::string why = outcome(problem, &total_);
        if (why.empty()) return;
        ADD_FAILURE() << GetParam().name << ", seed " << seed << ": " << why << "\n"
                      << shrunk(problem, [&](const LabelingProblem& p) {
                             return !outcome(p, nullptr).empty();
                         });
    }

    static std::string outcome(const LabelingProblem& problem, ReductionStatistics* total) {
        try {
            return failure(problem, GetParam().options, total, GetParam().steps);
        } catch (const std::exception& error) {
            return std::string("exception: ") + error.what();
        }
    }
    ReductionStatistics total_;
};

TEST_P(Reductions, KeepTheOptimumOfSmallProblems) {
    constexpr std::uint64_t kProblems = 11000;
    for (std::uint64_t seed = 1; seed <= kProblems && !HasFailure(); ++seed) {
        expect_equivalent(some_problem(seed), seed);
    }
    // The family has done something worth testing.
    EXPECT_GT(total_.*GetParam().steps, 300);
}

TEST_P(Reductions, KeepTheOptimumOfSmallBundles) {
    for (std::uint64_t seed = 1; seed <= 150 && !HasFailure(); ++seed) {
        std::mt19937_64 engine(seed);
        BundleOptions options;
        options.curves = 3;
        options.segments = 3;
        options.crossings = static_cast<int>(seed % 3);
        options.short_percent = 50;
        options.bonus = seed % 2 == 0 ? 20 : 1000;
        expect_equivalent(curve_bundle(engine, options), seed);
    }
}

INSTANTIATE_TEST_SUITE_P(EveryFamily, Reductions, testing::ValuesIn(kCases),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace labeling_test
