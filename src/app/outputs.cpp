#include "app/outputs.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "app/command.h"
#include "app/inputs.h"
#include "meshing/quad_files.h"

namespace fcn::app {
namespace {

bool has_format(const std::string& path, OutputKind kind) {
    if (kind == OutputKind::Mesh) return has_mesh_extension(path);
    if (kind == OutputKind::MeshWithCurves) return has_mesh_output_extension(path);
    if (kind == OutputKind::Quads) return has_quad_extension(path);
    return kind == OutputKind::Other || has_network_extension(path);
}

void print_all(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

/// A folder that goes away with the scope; the mesh writer only knows files.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "scalefcn-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw std::filesystem::filesystem_error(
                "cannot make a temporary folder", name,
                std::error_code(errno, std::generic_category()));
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace

void prepare_output(const std::string& path, OutputKind kind, const CommonArguments& common) {
    if (path == "-") {
        if (common.is_json)
            throw UsageError("-o - and --json both want standard output: name a file after -o");
        return;
    }
    if (!has_format(path, kind))
        throw UsageError(fmt::format("{}: no {} format goes by this name (known: {})", path,
                                     kind == OutputKind::Network ? "network" : "mesh",
                                     kind == OutputKind::Network ? network_extensions()
                                     : kind == OutputKind::Quads ? quad_extensions()
                                     : kind == OutputKind::Mesh  ? mesh_extensions()
                                                                 : mesh_output_extensions()));
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder);
}

void save_text(const std::string& path, const std::string& text) {
    if (path == "-") return print_all(text);
    write_file_atomically(path, text);
}

void save_mesh(const std::string& path, const LoadedMesh& mesh) {
    if (path == "-") {
        const ScratchFolder scratch;
        write_mesh(scratch.path() / "mesh.off", mesh);
        return print_all(read_file(scratch.path() / "mesh.off"));
    }
    write_mesh(path, mesh);
}

void save_quads(const std::string& path, const QuadMesh& mesh) {
    if (path == "-") return print_all(quads_to_text(mesh, "off"));
    write_quads(path, mesh);
}

void save_network(const std::string& path, const FeatureCurveNetwork& network,
                  const LoadedMesh* mesh) {
    save_network(path, network,
                 network.segments.empty() ? NetworkDetail::DenseArcs : NetworkDetail::Segments,
                 mesh);
}

void save_network(const std::string& path, const FeatureCurveNetwork& network, NetworkDetail detail,
                  const LoadedMesh* mesh) {
    if (path == "-") return print_all(network_to_json(network));
    write_network(path, network, detail, mesh);
}

}  // namespace fcn::app
