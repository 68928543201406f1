#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// What reading had to mend, so that the result is an oriented 2-manifold.
struct RepairReport {
    std::size_t welded_vertex_count = 0;         ///< equal positions merged
    std::size_t degenerate_face_count = 0;       ///< without area: dropped or flipped away
    std::size_t duplicate_face_count = 0;        ///< dropped
    std::size_t unreferenced_vertex_count = 0;   ///< dropped
    std::size_t reoriented_face_count = 0;       ///< flipped to agree with their component
    std::size_t split_edge_count = 0;            ///< non-manifold edges cut apart
    std::size_t split_vertex_count = 0;          ///< non-manifold vertices duplicated
    std::size_t triangulated_polygon_count = 0;  ///< polygons of more than three corners
    bool is_clean() const;
    /// One line per kind of repair, empty when clean.
    std::vector<std::string> messages() const;
};

/// A mesh as read: labels partition the faces (OBJ groups and materials, STL solids, PLY integer
/// face property, Medit refs, gmsh physical groups).
struct LoadedMesh {
    Mesh mesh;
    std::vector<int> face_labels;          ///< per face; empty when the file has none
    std::vector<std::string> label_names;  ///< by label; may be shorter than the largest label
    /// Curves along edges, as vertices in order; a closed one repeats its first. Written where the
    /// format has a place for them, never read.
    std::vector<std::vector<int>> curves;
    RepairReport repairs;
    std::string name;        ///< file name without folder and extension
    std::string units;       ///< as the file states ("mm"), usually empty
    std::uint64_t hash = 0;  ///< FNV-1a over positions and faces after repair
};

struct ReadOptions {
    /// Vertices closer than this times the bounding-box diagonal are welded; 0 = exactly equal.
    double weld_tolerance = 0.0;
    bool is_repairing = true;  ///< false: throw instead of repairing
};

/// Reads OFF, OBJ, PLY, STL (text, binary), Medit .mesh, gmsh .msh (2.2, 4.1 text), each
/// optionally gzip-compressed; decides by content first, then by extension. "-" is standard input.
/// Throws InputError with file, line and value.
LoadedMesh read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});
LoadedMesh read_mesh(std::istream& in, const std::string& name, const ReadOptions& options = {});

/// Writes by extension (.off .obj .ply .stl .mesh .msh .vtp, and .gz of each) to a temporary name,
/// then renames. Labels and curves are written where the format has a place for them. .sharp and
/// .fl hold the curves alone, as edges and vertices of the mesh.
void write_mesh(const std::filesystem::path& path, const LoadedMesh& mesh);

/// Writes `content` to `path` through a temporary file in the same folder and a rename, so that
/// a killed run leaves no half file. Compresses when the name ends in .gz.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// The whole file, decompressed when gzip. Throws InputError.
std::string read_file(const std::filesystem::path& path);

/// Makes the oriented 2-manifold from a triangle soup; used by the readers and by importers.
LoadedMesh mesh_from_soup(const std::vector<Vec3>& points,
                          const std::vector<std::array<int, 3>>& triangles,
                          const std::vector<int>& labels = {}, const ReadOptions& options = {});

}  // namespace fcn
