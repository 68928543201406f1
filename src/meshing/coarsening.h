#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// What a mesh edge is part of.
enum class EdgeRole : std::uint8_t { Free, Border, Feature };

/// A triangle mesh whose curves are marked: features, and borders (mesh boundary, label borders).
struct MarkedMesh {
    Mesh mesh;
    std::vector<EdgeRole> edge_role;    ///< per edge
    std::vector<bool> is_fixed_vertex;  ///< per vertex: neither moves nor vanishes
    std::vector<int> face_label;        ///< per face; borders of labels are marked edges
    std::vector<int> station_vertex;    ///< carried along: vertices of the stations, -1: none
};

struct CoarseningOptions {
    double edge_length = 0;  ///< target L, > 0
    /// Edges below 4/5 L are collapsed, if that makes none longer than 4/3 L.
    int max_rounds = 12;
};

/// Collapses short edges and flips bad ones so that marked chains between fixed vertices become
/// single edges wherever no face turns over; splits marked edges longer than 4/3 L. Chains of
/// features and borders keep their vertices' places; no vertex moves. Deterministic.
MarkedMesh coarsen(const MarkedMesh& input, const CoarseningOptions& options);

}  // namespace fcn
