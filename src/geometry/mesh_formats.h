#pragma once

#include <string>
#include <string_view>

#include "geometry/polygon_soup.h"

namespace fcn {

// One reader and one writer per format. Readers take the whole (decompressed) content and the name
// that stands in messages; they check counts against the bytes that follow before setting memory
// aside, and throw InputError "<source>:<line>: ...". Writers print the shortest decimals that
// read back to the same doubles.

PolygonSoup read_off(std::string_view content, const std::string& source);
PolygonSoup read_obj(std::string_view content, const std::string& source);
PolygonSoup read_ply(std::string_view content, const std::string& source);
PolygonSoup read_stl_text(std::string_view content, const std::string& source);
PolygonSoup read_stl_binary(std::string_view content, const std::string& source);
PolygonSoup read_medit(std::string_view content, const std::string& source);
PolygonSoup read_gmsh(std::string_view content, const std::string& source);

std::string write_off(const LoadedMesh& mesh);
std::string write_obj(const LoadedMesh& mesh);
std::string write_ply(const LoadedMesh& mesh);
std::string write_stl(const LoadedMesh& mesh);
std::string write_medit(const LoadedMesh& mesh);
std::string write_gmsh(const LoadedMesh& mesh);
std::string write_vtp(const LoadedMesh& mesh);  ///< not read

/// The faces ordered by label, ties by index; all faces in order when there are no labels.
std::vector<int> faces_by_label(const LoadedMesh& mesh);
int label_of(const LoadedMesh& mesh, int face);
/// The label's name, or "label_<n>"; without line breaks.
std::string label_name(const LoadedMesh& mesh, int label);

}  // namespace fcn
