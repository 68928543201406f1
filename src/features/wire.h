#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// A user's curve: on the surface through seeds, in their order.
struct WireRequest {
    std::vector<Vec3> points;   ///< near the surface; empty if vertices are given
    std::vector<int> vertices;  ///< of the mesh, from 0
    bool is_closed = false;
    bool is_pinned = false;
    std::string place;  ///< for messages: "seeds.json: /wires/3"
};

struct WireOptions {
    /// Width of the features that attract a wire; mesh units, 0 = 2% of the diagonal.
    double length = 0;
    double attraction = 5;       ///< 0 = shortest paths on the surface
    double max_anisotropy = 15;  ///< how much cheaper a step along a feature can be, >= 1
    /// Seeds farther from the surface than this share of the diagonal are refused.
    double farthest_seed = 0.01;
    /// Seeds given as points move onto a feature this close, as share of the diagonal; 0 = none.
    double snap = 0.005;
    int threads = 1;
};

/// {"wires":[{"points":[[x,y,z],...] | "vertices":[...],"closed":false,"pin":false}]}. Throws
/// InputError, with file and place, on anything else.
std::vector<WireRequest> read_wires(const std::string& text, const std::string& file_name);

/// Live-wires (Zhuang, Zou, Carr, Ju 2014): cheapest paths between consecutive seeds in a metric
/// in which steps along creases and ridges are cheap. Wires that cross or join get junctions, and
/// stretches that they share become one. Pinned ones have Pin::Keep. Throws InputError on seeds
/// that are off the mesh, equal, too few (2; closed: 3), or on different components.
FeatureCurveNetwork detect_wires(const LoadedMesh& mesh, const std::vector<WireRequest>& wires,
                                 const WireOptions& options = {});

struct WireLinkOptions {
    double reach = 0.15;          ///< longest distance between linked ends, in diagonals
    double min_length = 0.02;     ///< of the connected curves that an end belongs to, in diagonals
    double max_cost = 0.5;        ///< per length of the link; 1 = nothing attracts it
    double max_turning = 0.7854;  ///< radians, between an end's direction and the other end
};

/// Wires without seeds: links between the loose ends of a network that run along features. Links
/// that close a loop go first, then those of least cost per length; each end is used once.
FeatureCurveNetwork link_loose_ends(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                                    const WireOptions& options = {},
                                    const WireLinkOptions& links = {});

}  // namespace fcn
