#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh_io.h"

namespace fcn {

/// Knobs of the built-in parametric models. All lengths in mesh units; every model fits roughly
/// into a unit box.
struct ModelOptions {
    double resolution = 0.02;  ///< target mesh edge length, > 0
    double spacing = 0.05;     ///< distance between neighbouring features, > 0
    int count = 8;             ///< ribs, steps, teeth, petals; >= 3 where it makes sense
    double noise = 0.0;        ///< standard deviation / resolution, >= 0 (noisy-plane default 0.2)
    std::uint64_t seed = 1;
};

struct ModelInfo {
    std::string name;
    std::string description;  ///< one line
};

/// skyscraper, ribs, holes, steps, gear, octaflower, thin-wall, noisy-plane (and box, cylinder,
/// torus, superellipse-torus, sphere for tests).
std::vector<ModelInfo> model_list();

/// Throws InputError on an unknown name (listing the known) or an option out of range.
LoadedMesh make_model(std::string_view name, const ModelOptions& options = {});

}  // namespace fcn
