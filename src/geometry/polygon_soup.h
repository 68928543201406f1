#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/mesh_io.h"

namespace fcn {

/// What a mesh file says, before any judgement: points and polygons that index them.
struct PolygonSoup {
    std::vector<Vec3> points;
    std::vector<std::size_t> corner_begin{0};  ///< per polygon its first corner, and the end
    std::vector<int> corners;                  ///< point indices
    std::vector<int> labels;                   ///< per polygon, or empty
    std::vector<std::string> label_names;
    std::string units;
    /// The format has no shared points (STL): welding equal ones is reading, not repair.
    bool is_unconnected = false;
    /// Relative rounding error of the coordinates.
    double precision = 0x1p-51;

    std::size_t polygon_count() const { return corner_begin.size() - 1; }
    void close_polygon() { corner_begin.push_back(corners.size()); }
};

/// What a mesh file says, as read_mesh reads it before any repair. Throws InputError.
PolygonSoup read_polygons(const std::filesystem::path& path);

/// Triangles with one label each (or none), every index valid.
struct TriangleSoup {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> labels;
};

/// Cuts polygons into triangles: quads along the better diagonal, larger ones by ear clipping in
/// their mean plane, best ear first; O(n^2) for a polygon of n corners. Polygons of fewer than
/// three corners are counted as degenerate and dropped.
TriangleSoup triangulate(PolygonSoup&& soup, const std::string& source, RepairReport& report);

/// Merges points closer than `distance` (0: equal) to the one of lowest index; returns per point
/// the point that stands for it. O(n) expected.
std::vector<int> weld_map(const std::vector<Vec3>& points, double distance);

/// Oriented 2-manifold connectivity. Halfedge 3 f + c runs from corner c of triangle f to the next
/// corner; `partner` is the halfedge on the other side, -1 at a boundary.
struct ManifoldSoup {
    TriangleSoup soup;
    std::vector<int> partner;
};

/// Pairs faces across edges, orients them, cuts non-manifold edges and vertices apart. Expects
/// triangles with three different indices and no duplicates. O(n log valence).
ManifoldSoup make_manifold(TriangleSoup soup, RepairReport& report);

/// Builds the mesh; vertices and faces keep their indices, corner 0 starts each face.
Mesh build_mesh(const ManifoldSoup& manifold);

/// Flips the longest edge of every face without area (height below the rounding error of its
/// coordinates). Returns the faces that could not be mended that way.
std::vector<int> flip_zero_area_faces(Mesh& mesh, std::vector<int>& labels, double precision,
                                      RepairReport& report);

/// All of the above: polygon soup to oriented 2-manifold. `source` names the input in messages.
LoadedMesh mesh_from_polygons(PolygonSoup&& soup, const std::string& source,
                              const ReadOptions& options);

}  // namespace fcn
