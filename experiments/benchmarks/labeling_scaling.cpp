// Greedy construction, reductions and dynamic programming by problem size. The argument is the
// number of labels; the counters are what the problem has, what came out, and ticks per label.

#include <benchmark/benchmark.h>

#include <map>

#include "labeling/generators.h"
#include "labeling/greedy.h"
#include "labeling/reductions.h"
#include "labeling/solver.h"

namespace {

using labeling::GreedyRule;
using labeling::LabelingProblem;

/// A problem of the family with about so many labels; ten conflicts a label without rules, five
/// with bonuses and rules.
const LabelingProblem& problem(const std::string& family, std::int64_t labels) {
    static std::map<std::pair<std::string, std::int64_t>, LabelingProblem> cache;
    const auto found = cache.find({family, labels});
    if (found != cache.end()) return found->second;
    std::map<std::string, std::string> options{{"labels", std::to_string(labels)}};
    if (family == "unit-disks") options["degree"] = "20";
    if (family == "planted") options = {{"cliques", std::to_string(labels / 5)}};
    auto generated = labeling::generate_problem(family, options);
    return cache.emplace(std::pair(family, labels), std::move(generated.problem)).first->second;
}

void finish(benchmark::State& state, const LabelingProblem& p, std::int64_t work) {
    state.counters["labels"] = static_cast<double>(p.label_count());
    state.counters["conflicts"] = static_cast<double>(p.conflict_count());
    state.counters["ticks/label"] = static_cast<double>(work) / p.label_count();
    state.SetComplexityN(p.label_count());
}

void greedy(benchmark::State& state, const std::string& family, GreedyRule rule) {
    const LabelingProblem& p = problem(family, state.range(0));
    const labeling::RowSystem rows(p);
    const labeling::SolveOptions unlimited;
    labeling::GreedyOptions options;
    options.rule = rule;
    std::int64_t work = 0;
    for (auto _ : state) {
        labeling::RunControl control(unlimited);
        const auto result = greedy_labeling(p, rows, control, options);
        if (!result.solution) return state.SkipWithError("no solution");
        state.counters["value"] = static_cast<double>(result.solution->value);
        work = control.work();
    }
    finish(state, p, work);
}

void reduce(benchmark::State& state, const std::string& family) {
    const LabelingProblem& p = problem(family, state.range(0));
    const labeling::SolveOptions unlimited;
    std::int64_t work = 0;
    for (auto _ : state) {
        labeling::RunControl control(unlimited);
        const auto reduced = reduce_problem(p, control);
        state.counters["left"] = static_cast<double>(reduced.problem().label_count());
        work = control.work();
    }
    finish(state, p, work);
}

/// Reductions, then dynamic programming: chains are narrow.
void prove_chain(benchmark::State& state) {
    const LabelingProblem& p = problem("chain", state.range(0));
    std::int64_t work = 0;
    for (auto _ : state) {
        const auto result = labeling::builtin_solvers().find("branch-and-bound")->solve(p);
        if (result.status != labeling::SolveStatus::Optimal) return state.SkipWithError("open");
        work = result.work;
    }
    finish(state, p, work);
}

void sizes(benchmark::internal::Benchmark* b) {
    b->RangeMultiplier(10)->Range(10'000, 1'000'000)->Unit(benchmark::kMillisecond);
}

}  // namespace

BENCHMARK_CAPTURE(greedy, disks_best, "unit-disks", GreedyRule::Best)->Apply(sizes);
BENCHMARK_CAPTURE(greedy, disks_weight, "unit-disks", GreedyRule::Weight)->Apply(sizes);
BENCHMARK_CAPTURE(greedy, disks_blocked, "unit-disks", GreedyRule::Blocked)->Apply(sizes);
BENCHMARK_CAPTURE(greedy, disks_gain, "unit-disks", GreedyRule::Gain)->Apply(sizes);
BENCHMARK_CAPTURE(greedy, planted_best, "planted", GreedyRule::Best)->Apply(sizes);
BENCHMARK_CAPTURE(greedy, planted_gain, "planted", GreedyRule::Gain)->Apply(sizes);
BENCHMARK_CAPTURE(greedy, planted_curve, "planted", GreedyRule::Curve)->Apply(sizes);
BENCHMARK_CAPTURE(reduce, disks, "unit-disks")->Apply(sizes);
BENCHMARK_CAPTURE(reduce, planted, "planted")->Apply(sizes);
BENCHMARK_CAPTURE(reduce, chain, "chain")->Apply(sizes);
BENCHMARK(prove_chain)->Apply(sizes);

BENCHMARK_MAIN();
