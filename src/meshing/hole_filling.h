#pragma once

#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// A mesh whose short boundary loops are closed; the input's vertices and faces keep their numbers.
struct FilledMesh {
    LoadedMesh mesh;
    std::vector<Vec3> holes;             ///< middles of what was closed
    std::vector<bool> is_filled_vertex;  ///< per vertex: of such a loop, or inside it
};

/// Closes boundary loops shorter than `length`, mesh units, unless a component is little more than
/// such a loop. Deterministic.
FilledMesh fill_short_loops(const LoadedMesh& input, double length);

/// Boundary arcs of a network that run along filled loops are left out; nodes stay.
/// `segments` and `arcs`: numbers in the network of what is left.
struct KeptNetwork {
    FeatureCurveNetwork network;
    std::vector<int> arcs, segments;
};
KeptNetwork without_filled_loops(const FeatureCurveNetwork& network, const FilledMesh& filled);

}  // namespace fcn
