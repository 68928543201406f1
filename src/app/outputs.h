#pragma once

#include <string>

#include "app/common_arguments.h"
#include "geometry/mesh_io.h"
#include "network/network_io.h"

namespace fcn::app {

/// UsageError when standard output is asked to carry both a file and --json.
void check_standard_output(const std::string& path, const CommonArguments& common);

/// Atomic; makes missing folders; "-" is standard output.
void save_text(const std::string& path, const std::string& text);
/// By extension, "-" as OFF on standard output.
void save_mesh(const std::string& path, const LoadedMesh& mesh);
/// By extension, "-" as JSON on standard output. Without `detail`: segments where there are any.
void save_network(const std::string& path, const FeatureCurveNetwork& network,
                  const LoadedMesh* mesh = nullptr);
void save_network(const std::string& path, const FeatureCurveNetwork& network, NetworkDetail detail,
                  const LoadedMesh* mesh);

}  // namespace fcn::app
