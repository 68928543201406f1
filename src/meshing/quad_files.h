#pragma once

#include <filesystem>
#include <optional>

#include "meshing/quad_mesh.h"

namespace fcn {

/// Writes by extension, .obj .off .vtu (and .gz of each), to a temporary name, then renames. OBJ
/// and VTU hold the features as lines; OBJ labels as groups, VTU as cell data. Throws InputError.
void write_quads(const std::filesystem::path& path, const QuadMesh& mesh);

bool has_quad_extension(const std::filesystem::path& path);
std::string quad_extensions();  ///< for messages

/// The text that is written: "obj", "off", "vtu".
std::string quads_to_text(const QuadMesh& mesh, const std::string& format);

/// The quads of any mesh file that read_mesh knows; none if one of its faces is not a quad.
/// Features are not read. Throws InputError on bad files.
std::optional<QuadMesh> read_quads(const std::filesystem::path& path);

}  // namespace fcn
