#pragma once

#include <string>

#include "app/common_arguments.h"
#include "geometry/mesh_io.h"
#include "meshing/quad_mesh.h"
#include "network/network_io.h"

namespace fcn::app {

/// What can be known before the work begins: UsageError when standard output is to carry both the
/// file and --json, or when no format goes by this name. Makes the folder it will lie in.
enum class OutputKind { Mesh, MeshWithCurves, Quads, Network, Other };
void prepare_output(const std::string& path, OutputKind kind, const CommonArguments& common);

/// Atomic; "-" is standard output.
void save_text(const std::string& path, const std::string& text);
/// By extension, "-" as OFF on standard output.
void save_mesh(const std::string& path, const LoadedMesh& mesh);
/// By extension, "-" as OFF on standard output.
void save_quads(const std::string& path, const QuadMesh& mesh);
/// By extension, "-" as JSON on standard output. Without `detail`: segments where there are any.
void save_network(const std::string& path, const FeatureCurveNetwork& network,
                  const LoadedMesh* mesh = nullptr);
void save_network(const std::string& path, const FeatureCurveNetwork& network, NetworkDetail detail,
                  const LoadedMesh* mesh);

}  // namespace fcn::app
