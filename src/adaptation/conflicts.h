#pragma once

#include <functional>
#include <vector>

#include "adaptation/adaptation.h"
#include "adaptation/scale.h"
#include "adaptation/segment_graph.h"

namespace fcn {

enum class ConflictKind {
    Angle,     ///< adjacent segments enclose an infeasible angle
    Distance,  ///< non-adjacent: paper (c) and (d) both fail; best mode closer than h
    Crossing,  ///< paper mode: closest points interior to both and closer than h
    Nodes      ///< best mode: two distinct nodes closer than rmin
};

/// "angle", "distance", "crossing", "nodes".
const char* to_string(ConflictKind kind);

/// Two segments of which at most one can be kept; first < second.
struct Conflict {
    ConflictKind kind = ConflictKind::Angle;
    int first = -1, second = -1;
    Vec3 witness_first = Vec3::Zero(), witness_second = Vec3::Zero();
    double distance = 0;  ///< between the witnesses
    double angle = 0;     ///< radians, Angle only
};

/// Two extraordinary nodes closer than rmin; first < second.
struct VertexConflict {
    int first = -1, second = -1;
    double distance = 0;
};

struct ExemptPair {
    int first = -1, second = -1;  ///< segments
    double distance = 0;
};

struct ConflictOptions {
    AdaptationMode mode = AdaptationMode::Best;
    /// Says of two points on the surface, closer than rmin in space, whether a thin wall parts
    /// them (opposite normals and far along the surface). Empty = never. Must be thread-safe.
    std::function<bool(const Vec3&, const Vec3&)> is_thin_wall;
    int threads = 1;
};

struct ConflictResult {
    std::vector<Conflict> conflicts;               ///< constraints, sorted by (first, second)
    std::vector<Conflict> input_forced;            ///< between two pinned segments: not constraints
    std::vector<VertexConflict> vertex_conflicts;  ///< sorted; pairs that pins force are left out
    std::vector<ExemptPair> exempt;                ///< sorted
};

/// Every pair of segments and of extraordinary nodes that cannot coexist at the scale (paper
/// sections 4.2 and 5.2.2; best mode: strict conformity). Adjacent = sharing a node, or meeting
/// two nodes of one cluster of short segments that are closer than rmin. O(n) for bounded density.
ConflictResult detect_conflicts(const SegmentGraph& graph, const ScaleInterval& scale,
                                const ConflictOptions& options = {});

struct SegmentDistance {
    double distance = 0;
    double s = 0, t = 0;  ///< parameters of the closest points, [0, 1]
};
SegmentDistance segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

}  // namespace fcn
