#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/common_arguments.h"
#include "geometry/mesh_io.h"
#include "labeling/problem.h"
#include "network/network.h"

namespace fcn::app {

/// A whole text file, decompressed when gzip; "-" is standard input.
std::string read_text(const std::string& path);

/// Reads a mesh and prints what had to be repaired as a note.
LoadedMesh load_mesh(const std::string& path, const MeshArguments& arguments,
                     const CommonArguments& common);

/// "-" is standard input, as JSON.
FeatureCurveNetwork load_network(const std::string& path, const Mesh* mesh = nullptr);

/// Also InputError when the network was made for another mesh, or does not fit this one.
FeatureCurveNetwork read_network_for_mesh(const std::string& path, const LoadedMesh& mesh);

/// By extension; "-" is standard input, in the .lab format.
labeling::LabelingProblem load_problem(const std::string& path);

/// True for a file that stores kinds and pins, so that boundaries in it have been decided on.
bool is_lossless_network(const std::string& path);

/// Files as given; a directory stands for the mesh files in it, by name. InputError when a path
/// does not exist or a directory holds no mesh.
std::vector<std::string> expand_mesh_inputs(const std::vector<std::string>& inputs);

bool has_mesh_extension(const std::filesystem::path& path);
/// Also those that hold the curves along a mesh's edges: .vtp, .sharp, .fl.
bool has_mesh_output_extension(const std::filesystem::path& path);
bool holds_curves_alone(const std::filesystem::path& path);  ///< .sharp, .fl
bool has_network_extension(const std::filesystem::path& path);
bool has_problem_extension(const std::filesystem::path& path);
/// For messages: ".off .obj ...".
std::string mesh_extensions();
std::string mesh_output_extensions();
std::string network_extensions();

/// The extension without a final ".gz", lower case: ".off", ".json".
std::string plain_extension(const std::filesystem::path& path);

}  // namespace fcn::app
