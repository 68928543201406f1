#pragma once

#include <array>

#include "geometry/mesh.h"

namespace fcn {

/// Positions around an edge with two faces: its ends a, b, and the corners c, d across from it; the
/// faces are abc and bad.
inline std::array<Vec3, 4> edge_corners(const Mesh& mesh, EdgeHandle edge) {
    const HalfedgeHandle h = mesh.halfedge_handle(edge, 0), o = mesh.halfedge_handle(edge, 1);
    const auto point_at_end = [&](HalfedgeHandle halfedge) {
        return mesh.point(mesh.to_vertex_handle(halfedge));
    };
    return {point_at_end(o), point_at_end(h), point_at_end(mesh.next_halfedge_handle(h)),
            point_at_end(mesh.next_halfedge_handle(o))};
}

}  // namespace fcn
