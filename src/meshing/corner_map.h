#pragma once

#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

using Vec2 = Eigen::Vector2d;

/// A map of a mesh to the plane, cut open anywhere: per face the images of its corners, in the
/// order of face_vertices(). Unit squares of the plane's grid become quads.
struct CornerMap {
    std::vector<std::array<Vec2, 3>> uv;
};

/// Turns a vector counter-clockwise by `turns` right angles; exact.
Vec2 turned(const Vec2& vector, int turns);

/// How the map goes on across an edge: uv there = turned(uv here, turns) + translation.
struct MapTransition {
    int turns = 0;  ///< 0 .. 3
    Vec2 translation = Vec2::Zero();
};

/// Of the two ends of a halfedge, origin first.
std::array<Vec2, 2> edge_image(const Mesh& mesh, const CornerMap& map, HalfedgeHandle halfedge);

/// From the face of an inner halfedge to the opposite one: the turns that fit the edge's images
/// best, the translation from its origin. Exact where the map is seamless in floating point. With
/// the turns of a cross field (cross_field.h) these are minus those of the halfedge.
MapTransition map_transition(const Mesh& mesh, const CornerMap& map, HalfedgeHandle halfedge);

/// Twice the signed area of a face's image: its sign, -1, 0 or 1, exact for coordinates whose
/// differences are exact (as those of a quantised map are).
int image_orientation(const std::array<Vec2, 3>& uv);

struct CornerMapFaults {
    std::size_t turned_over_faces = 0;   ///< image of area <= 0
    std::size_t open_edges = 0;          ///< inner edges whose sides no transition joins exactly
    std::size_t fractional_edges = 0;    ///< inner edges whose translation is not of integers
    std::size_t free_boundary = 0;       ///< boundary edges that lie on no grid line
    std::size_t fractional_corners = 0;  ///< singular or boundary corners not at grid points
    bool is_none() const {
        return turned_over_faces + open_edges + fractional_edges + free_boundary +
                   fractional_corners ==
               0;
    }
    /// One line; empty: none.
    std::string message() const;
};

/// What keeps a map from being one that quads can be read from, all decided exactly.
CornerMapFaults corner_map_faults(const Mesh& mesh, const CornerMap& map);

/// Right angles around a vertex in the map, rounded: 4 at a regular inner vertex, 2 at a regular
/// boundary vertex, 1 or 3 at a corner.
int quarters_around(const Mesh& mesh, const CornerMap& map, VertexHandle vertex);

}  // namespace fcn
