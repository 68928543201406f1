#pragma once

#include <string>
#include <string_view>

#include "geometry/mesh_io.h"
#include "network/chain_edges.h"
#include "network/written_network.h"

namespace fcn {

// One reader and one writer per exchange format. Readers take the whole (decompressed) content and
// the name that stands in messages, ignore faces and whatever else is no curve, and throw
// InputError "<source>:<line>: ..."; a file with points but without any element that could be a
// curve is an error. Writers print the shortest decimals that read back to the same doubles.

EdgeSoup read_obj_lines(std::string_view content, const std::string& source);
EdgeSoup read_ply_edges(std::string_view content, const std::string& source);
EdgeSoup read_vtp_lines(std::string_view content, const std::string& source);
EdgeSoup read_medit_edges(std::string_view content, const std::string& source);
EdgeSoup read_gmsh_lines(std::string_view content, const std::string& source);
EdgeSoup read_polylines(std::string_view content, const std::string& source);
EdgeSoup read_sharp(std::string_view content, const std::string& source, const Mesh& mesh);
EdgeSoup read_fl(std::string_view content, const std::string& source, const Mesh& mesh);

std::string write_obj_lines(const WrittenNetwork& network);
std::string write_ply_edges(const WrittenNetwork& network);
std::string write_vtp_lines(const WrittenNetwork& network);
std::string write_medit_edges(const WrittenNetwork& network);
std::string write_gmsh_lines(const WrittenNetwork& network);
std::string write_polylines(const WrittenNetwork& network);
/// Throw InputError (naming `target`) where a polyline does not run along edges of the mesh.
std::string write_sharp(const WrittenNetwork& network, const Mesh& mesh, const std::string& target);
std::string write_fl(const WrittenNetwork& network, const Mesh& mesh, const std::string& target);

}  // namespace fcn
