// Fuzz target for every network reader. The first byte chooses the file name, and so the format,
// and whether a mesh comes with it; the rest is the file. Only InputError may escape a reader, and
// what it accepts must survive our own format.

#include "fuzz/network_fuzz.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "geometry/errors.h"
#include "network/network_io.h"
#include "network/sample_networks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    static const fcn::LoadedMesh mesh = fcn::testing::cube_mesh(2);
    const std::size_t choice = data[0] % (2 * fcn::testing::kFuzzedNames.size());
    const std::string content(reinterpret_cast<const char*>(data) + 1, size - 1);
    fcn::FeatureCurveNetwork network;
    try {
        network = fcn::network_from_content(content, fcn::testing::kFuzzedNames[choice / 2],
                                            choice % 2 == 1 ? &mesh.mesh : nullptr);
    } catch (const fcn::InputError&) {
        return 0;
    }
    const std::string text = fcn::network_to_json(network);
    if (fcn::network_to_json(fcn::network_from_json(text, "again")) != text) std::abort();
    fcn::find_curves(network);
    const std::vector<std::string> problems = fcn::validate(fcn::merge_regular_nodes(network));
    if (!problems.empty()) {
        std::fprintf(stderr, "merged: %s\n", problems.front().c_str());
        std::abort();
    }
    return 0;
}
