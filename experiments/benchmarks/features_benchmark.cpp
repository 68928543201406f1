// The feature detectors by mesh size. The argument is the number of faces aimed at; the counters
// are the faces there are, and what came out.

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "features/features.h"
#include "features/wire.h"
#include "geometry/models.h"

namespace {

/// The built-in model `name` with about `face_count` faces.
const fcn::LoadedMesh& model(const std::string& name, std::int64_t face_count) {
    static std::map<std::pair<std::string, std::int64_t>, fcn::LoadedMesh> cache;
    const auto found = cache.find({name, face_count});
    if (found != cache.end()) return found->second;
    fcn::ModelOptions options;
    const double faces = static_cast<double>(fcn::make_model(name, options).mesh.n_faces());
    options.resolution *= std::sqrt(faces / static_cast<double>(face_count));
    return cache.emplace(std::pair(name, face_count), fcn::make_model(name, options)).first->second;
}

void finish(benchmark::State& state, const fcn::LoadedMesh& mesh, std::size_t arc_count) {
    state.counters["faces"] = static_cast<double>(mesh.mesh.n_faces());
    state.counters["arcs"] = static_cast<double>(arc_count);
    state.SetComplexityN(static_cast<std::int64_t>(mesh.mesh.n_faces()));
}

void detect_sharp(benchmark::State& state) {
    const fcn::LoadedMesh& mesh = model("gear", state.range(0));
    std::size_t arc_count = 0;
    for (auto _ : state) arc_count = fcn::detect_sharp(mesh).arcs.size();
    finish(state, mesh, arc_count);
}

void detect_sharp_noisy(benchmark::State& state) {
    const fcn::LoadedMesh& mesh = model("noisy-plane", state.range(0));
    std::size_t arc_count = 0;
    for (auto _ : state) arc_count = fcn::detect_sharp(mesh).arcs.size();
    finish(state, mesh, arc_count);
}

void segment_vsa(benchmark::State& state) {
    const fcn::LoadedMesh& mesh = model("octaflower", state.range(0));
    fcn::VsaResult result;
    for (auto _ : state) result = fcn::segment_vsa(mesh.mesh);
    finish(state, mesh, 0);
    state.counters["error"] = result.error;
}

void detect_vsa(benchmark::State& state) {
    const fcn::LoadedMesh& mesh = model("octaflower", state.range(0));
    std::size_t arc_count = 0;
    for (auto _ : state) arc_count = fcn::detect_vsa(mesh).arcs.size();
    finish(state, mesh, arc_count);
}

/// Range 1: the number of wires, each across most of the mesh. One wire has to pay for the metric
/// of the whole mesh, ten share it.
void detect_wires(benchmark::State& state) {
    const fcn::LoadedMesh& mesh = model("gear", state.range(0));
    const auto count = static_cast<std::int64_t>(mesh.mesh.n_vertices());
    std::vector<fcn::WireRequest> wires(static_cast<std::size_t>(state.range(1)));
    for (std::size_t w = 0; w < wires.size(); ++w) {
        const std::int64_t first = static_cast<std::int64_t>(w) * count / 11;
        wires[w].vertices = {static_cast<int>(first),
                             static_cast<int>((first + count / 2) % count)};
    }
    std::size_t arc_count = 0;
    for (auto _ : state) arc_count = fcn::detect_wires(mesh, wires).arcs.size();
    finish(state, mesh, arc_count);
}

}  // namespace

BENCHMARK(detect_sharp)
    ->RangeMultiplier(4)
    ->Range(4096, 1 << 20)
    ->Complexity()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(detect_sharp_noisy)
    ->RangeMultiplier(4)
    ->Range(4096, 1 << 20)
    ->Complexity()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(segment_vsa)
    ->RangeMultiplier(4)
    ->Range(4096, 1 << 20)
    ->Complexity()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(detect_vsa)
    ->RangeMultiplier(4)
    ->Range(4096, 1 << 20)
    ->Complexity()
    ->Unit(benchmark::kMillisecond);

BENCHMARK(detect_wires)
    ->ArgsProduct({{100000, 400000, 1000000}, {1, 10}})
    ->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
