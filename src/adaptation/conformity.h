#pragma once

#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "network/network.h"

namespace fcn {

enum class ViolationKind { ShortSegment, LongSegment, CloseNodes, CloseSegments, Angle };
const char* to_string(ViolationKind kind);

/// One violated condition of strict conformity (i)-(iv).
struct Violation {
    ViolationKind kind = ViolationKind::Angle;
    int first = -1;       ///< segment, or node for CloseNodes
    int second = -1;      ///< the other one; -1 for a length violation
    double measured = 0;  ///< length, distance or angle (radians)
    double required = 0;
    Vec3 witness_first = Vec3::Zero();
    Vec3 witness_second = Vec3::Zero();
    bool is_input_forced = false;  ///< between pinned curves of the input; not in the verdict
    bool is_exempt = false;        ///< thin wall; not in the verdict
};

struct ConformityOptions {
    double rmin = 0;
    double ratio = 1.5;
    bool is_quad_target = false;
    bool is_thin_wall_exempt = true;  ///< needs the mesh; without one nothing is exempt
    double tolerance = 1e-6;
};

struct ConformityReport {
    std::vector<Violation> violations;  ///< all, sorted by kind then indices
    std::size_t counted = 0;            ///< neither input-forced nor exempt
    std::size_t input_forced = 0;
    std::size_t exempt = 0;
    std::size_t long_segments = 0;  ///< allowed ones
    /// Largest surface / Euclidean distance ratio between close kept curves (Definition 1(2)):
    /// segments of different arcs without a common node, closer than rmax, no thin wall. Cut off
    /// at 4; 0 when not measured (no mesh) or no close pair.
    double max_distance_ratio = 0;
    std::size_t distance_ratio_pairs = 0;  ///< pairs measured
    std::size_t distance_ratio_over_two = 0;
    bool is_conforming() const { return counted == 0; }
};

/// The independent checker: shares no code with the adaptation (own distances, own angle bounds,
/// own neighbour search, own surface distances, which are exact). Looks at positions, lengths and
/// Pin::Keep only, never at flags such as is_long. Thin wall: the witnesses' closest surface points
/// have normals of dot <= -0.5 (on an edge or vertex the mean of its faces) and a surface distance
/// >= 3 rmin. Deterministic; near-linear in segments plus faces. Throws InputError on options out
/// of range, indices out of range, or arcs without segments.
ConformityReport check_conformity(const FeatureCurveNetwork& network,
                                  const ConformityOptions& options, const Mesh* mesh = nullptr);

}  // namespace fcn
