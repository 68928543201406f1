#pragma once

#include <filesystem>
#include <string>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// Reads by name and content: .fcn.json, .obj (l), .ply (element edge), .polylines.txt, .vtp,
/// .mesh (Edges), .msh (lines), .sharp, .fl; gzip allowed. Formats whose entries are indices of
/// mesh vertices (.sharp, .fl) need the mesh. Arcs are chained from edges at nodes of valence 2.
/// With a mesh every sample is projected to its closest surface point. Throws InputError.
FeatureCurveNetwork read_network(const std::filesystem::path& path, const Mesh* mesh = nullptr);

/// The same from content in memory (decompressed); `name` decides the format as a path would.
FeatureCurveNetwork network_from_content(const std::string& content,
                                         const std::filesystem::path& name,
                                         const Mesh* mesh = nullptr);

enum class NetworkDetail { DenseArcs, Segments };

/// Writes by name; JSON is lossless and always whole, every other format takes `detail`:
/// Segments (default where the network has any) or the dense polylines.
/// .sharp and .fl require that the written polyline runs along mesh edges (throws InputError).
void write_network(const std::filesystem::path& path, const FeatureCurveNetwork& network,
                   NetworkDetail detail, const LoadedMesh* mesh = nullptr);

std::string network_to_json(const FeatureCurveNetwork& network);
FeatureCurveNetwork network_from_json(const std::string& text, const std::string& file_name);

}  // namespace fcn
