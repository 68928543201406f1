// The quick bound against enumeration, and where a clique cover is the optimum by construction.
#include <gtest/gtest.h>

#include "labeling/problems.h"
#include "labeling/quick_clique_bound.h"
#include "labeling/run_control.h"
#include "labeling/subproblem.h"

namespace labeling_test {
namespace {

using labeling::Label;
using labeling::quick_clique_bound;
using labeling::RunControl;
using labeling::SolveOptions;

Value bound_of(const LabelingProblem& problem) {
    RunControl control{SolveOptions{}};
    return quick_clique_bound(problem, control);
}

TEST(QuickCliqueBound, LiesBetweenTheOptimumAndTheSumOfGains) {
    int cases = 0;
    for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 2 == 0 ? random_problem(engine, 9) : frustrated_problem(engine, 9);
        const Value bound = bound_of(problem);
        EXPECT_LE(bound, labeling::sum_of_gains(problem)) << "seed " << seed;
        const auto optimum = enumerate_optimum(problem);
        if (!optimum) continue;
        ++cases;
        ASSERT_GE(bound, *optimum) << "seed " << seed;
    }
    EXPECT_GT(cases, 2000);
}

/// Groups of labels in which all pairs conflict: one of each counts.
TEST(QuickCliqueBound, IsTheOptimumOfSeparateCliques) {
    labeling::ProblemBuilder builder;
    Value optimum = 0;
    std::mt19937_64 engine(7);
    for (int group = 0; group < 200; ++group) {
        const auto size = static_cast<Label>(pick(engine, 1, 12));
        Value best = 0;
        const Label first = builder.label_count();
        for (Label k = 0; k < size; ++k) {
            const Value weight = pick(engine, -20, 100);
            builder.add_label(weight);
            best = std::max(best, weight);
            for (Label j = first; j < first + k; ++j) builder.add_conflict(j, first + k);
        }
        optimum += best;
    }
    EXPECT_EQ(bound_of(builder.build()), optimum);
}

TEST(QuickCliqueBound, CountsWhatIsLeftInFullOnceStopped) {
    std::mt19937_64 engine(3);
    const LabelingProblem problem = frustrated_problem(engine, 12);
    std::stop_source source;
    source.request_stop();
    SolveOptions options;
    options.stop = source.get_token();
    RunControl control(options);
    control.check();
    ASSERT_TRUE(control.is_over());
    EXPECT_EQ(quick_clique_bound(problem, control), labeling::sum_of_gains(problem));
}

}  // namespace
}  // namespace labeling_test
