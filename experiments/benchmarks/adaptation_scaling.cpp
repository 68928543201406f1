// Conflict detection and resampling against size: parallel polylines on a plane whose spacing is
// drawn between 0.3 and 2 rmin, 10^3 to 10^6 segments. Google Benchmark prints the fitted exponent
// (complexity) beside the times; counters give conflicts and samples.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "adaptation/conflicts.h"
#include "adaptation/resampling.h"

namespace {

/// Integer noise in [0, 1), the same on every machine.
double noise(std::uint64_t k) {
    k ^= k >> 33;
    k *= 0xff51afd7ed558ccdull;
    k ^= k >> 33;
    k *= 0xc4ceb9fe1a85ec53ull;
    k ^= k >> 33;
    return static_cast<double>(k >> 11) * 0x1.0p-53;
}

/// `count` segments of length 1.2 in wavy lines of up to 1000 segments.
fcn::SegmentGraph wavy_lines(int count) {
    fcn::SegmentGraph graph;
    const int per_line = std::min(1000, static_cast<int>(std::sqrt(count)));
    double y = 0;
    for (int line = 0; static_cast<int>(graph.segments.size()) < count; ++line) {
        y += 0.3 + 1.7 * noise(line);
        for (int k = 0; k <= per_line; ++k) {
            graph.nodes.emplace_back();
            graph.nodes.back().position = {1.2 * k, y + 0.2 * std::sin(0.3 * k + line), 0};
            if (k == 0) continue;
            graph.segments.emplace_back();
            const int node = static_cast<int>(graph.nodes.size()) - 1;
            graph.segments.back().nodes = {node - 1, node};
        }
    }
    graph.connect();
    return graph;
}

void detect_conflicts(benchmark::State& state) {
    const fcn::SegmentGraph graph = wavy_lines(static_cast<int>(state.range(0)));
    const fcn::ScaleInterval scale = fcn::make_scale(1.0);
    fcn::ConflictOptions options;
    options.mode = state.range(1) == 0 ? fcn::AdaptationMode::Best : fcn::AdaptationMode::Paper;
    std::size_t conflicts = 0;
    for (auto _ : state) conflicts = fcn::detect_conflicts(graph, scale, options).conflicts.size();
    state.counters["conflicts"] = static_cast<double>(conflicts);
    state.SetComplexityN(state.range(0));
}

void resample_open_arc(benchmark::State& state) {
    const fcn::ScaleInterval scale = fcn::make_scale(1.0);
    std::vector<fcn::Vec3> samples;
    const auto segments = static_cast<double>(state.range(0));
    for (double x = 0; x < 1.2 * segments; x += 0.02) {
        samples.emplace_back(x, 0.2 * std::sin(0.3 * x), 0.05 * std::sin(1.7 * x));
    }
    std::size_t chain = 0;
    for (auto _ : state) chain = fcn::resample_arc(samples, false, scale).chain.size();
    state.counters["samples"] = static_cast<double>(samples.size());
    state.counters["segments"] = static_cast<double>(chain) - 1;
    state.SetComplexityN(state.range(0));
}

}  // namespace

BENCHMARK(detect_conflicts)
    ->ArgsProduct({{1000, 10000, 100000, 1000000}, {0}})
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK(detect_conflicts)
    ->Name("detect_conflicts_paper")
    ->ArgsProduct({{1000, 10000, 100000, 1000000}, {1}})
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK(resample_open_arc)
    ->RangeMultiplier(10)
    ->Range(1000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

BENCHMARK_MAIN();
