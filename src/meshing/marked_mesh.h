#pragma once

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

}  // namespace fcn
