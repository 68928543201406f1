#include "app/inputs.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iostream>
#include <iterator>
#include <string_view>

#include "app/interrupt.h"
#include "geometry/errors.h"
#include "labeling/formats.h"
#include "network/network_io.h"

namespace fcn::app {
namespace {

constexpr std::array<std::string_view, 6> kMeshExtensions{".off", ".obj",  ".ply",
                                                          ".stl", ".mesh", ".msh"};
/// Written with the curves along a mesh's edges, or of these alone; not read as meshes.
constexpr std::array<std::string_view, 3> kCurveExtensions{".vtp", ".sharp", ".fl"};
constexpr std::array<std::string_view, 9> kNetworkExtensions{
    ".fcn.json", ".obj", ".ply", ".vtp", ".mesh", ".msh", ".sharp", ".fl", ".polylines.txt"};
constexpr std::array<std::string_view, 6> kProblemExtensions{".lab", ".mps", ".lp",
                                                             ".opb", ".cfn", ".graph"};

template <std::size_t size>
bool is_one_of(const std::string& extension, const std::array<std::string_view, size>& extensions) {
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

std::vector<std::string> meshes_in(const std::filesystem::path& folder) {
    std::vector<std::string> meshes;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.is_regular_file() && has_mesh_extension(entry.path()))
            meshes.push_back(entry.path().string());
    std::sort(meshes.begin(), meshes.end());
    if (meshes.empty())
        throw InputError(fmt::format("{}: no mesh file in this directory ({}, or .gz of them)",
                                     folder.string(), mesh_extensions()));
    return meshes;
}

}  // namespace

std::string read_text(const std::string& path) {
    if (path != "-") return read_file(path);
    return {std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
}

LoadedMesh load_mesh(const std::string& path, const MeshArguments& arguments,
                     const CommonArguments& common) {
    LoadedMesh mesh = read_mesh(path, arguments.read_options());
    for (const std::string& message : mesh.repairs.messages())
        print_note(common, fmt::format("{}: {}", path, message));
    return mesh;
}

FeatureCurveNetwork load_network(const std::string& path, const Mesh* mesh) {
    if (path == "-") return network_from_json(read_text(path), "standard input");
    return read_network(path, mesh);
}

FeatureCurveNetwork read_network_for_mesh(const std::string& path, const LoadedMesh& mesh) {
    FeatureCurveNetwork network = load_network(path, &mesh.mesh);
    if (network.mesh_hash != 0 && network.mesh_hash != mesh.hash)
        throw InputError(fmt::format("{}: this network was made for another mesh ('{}'), not '{}'",
                                     path, network.mesh_name, mesh.name));
    const std::vector<std::string> problems = validate(network, mesh.mesh);
    if (!problems.empty())
        throw InputError(
            fmt::format("{}: the network does not fit the mesh: {}", path, problems.front()));
    network.mesh_name = mesh.name;
    network.mesh_hash = mesh.hash;
    network.diagonal = bounding_box(mesh.mesh).diagonal();
    return network;
}

labeling::LabelingProblem load_problem(const std::string& path) {
    const NothingToFinish reading;
    if (path != "-") return labeling::read_problem(path);
    return labeling::parse_problem(read_text(path), labeling::ProblemFormat::Lab, "standard input");
}

bool is_lossless_network(const std::string& path) {
    return path == "-" || plain_extension(path) == ".json";
}

std::vector<std::string> expand_mesh_inputs(const std::vector<std::string>& inputs) {
    std::vector<std::string> meshes;
    for (const std::string& input : inputs) {
        if (input != "-" && !std::filesystem::exists(input))
            throw InputError(fmt::format("{}: no such file or directory", input));
        if (input != "-" && std::filesystem::is_directory(input)) {
            const std::vector<std::string> found = meshes_in(input);
            meshes.insert(meshes.end(), found.begin(), found.end());
        } else {
            meshes.push_back(input);
        }
    }
    return meshes;
}

std::string plain_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    if (extension == ".gz") extension = path.stem().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

bool has_mesh_extension(const std::filesystem::path& path) {
    return is_one_of(plain_extension(path), kMeshExtensions);
}

bool has_mesh_output_extension(const std::filesystem::path& path) {
    return has_mesh_extension(path) || is_one_of(plain_extension(path), kCurveExtensions);
}

bool holds_curves_alone(const std::filesystem::path& path) {
    return is_one_of(plain_extension(path), std::array<std::string_view, 2>{".sharp", ".fl"});
}

bool has_network_extension(const std::filesystem::path& path) {
    std::string name = path.filename().string();
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    return std::any_of(kNetworkExtensions.begin(), kNetworkExtensions.end(),
                       [&](std::string_view extension) { return name.ends_with(extension); });
}

std::string mesh_extensions() { return fmt::format("{}", fmt::join(kMeshExtensions, " ")); }

std::string mesh_output_extensions() {
    return fmt::format("{} {}", mesh_extensions(), fmt::join(kCurveExtensions, " "));
}

std::string network_extensions() { return fmt::format("{}", fmt::join(kNetworkExtensions, " ")); }

bool has_problem_extension(const std::filesystem::path& path) {
    return is_one_of(plain_extension(path), kProblemExtensions);
}

}  // namespace fcn::app
