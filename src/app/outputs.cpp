#include "app/outputs.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "app/command.h"

namespace fcn::app {
namespace {

void make_parent_folder(const std::filesystem::path& path) {
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
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

void check_standard_output(const std::string& path, const CommonArguments& common) {
    if (path == "-" && common.is_json)
        throw UsageError("-o - and --json both want standard output: name a file after -o");
}

void save_text(const std::string& path, const std::string& text) {
    if (path == "-") return print_all(text);
    make_parent_folder(path);
    write_file_atomically(path, text);
}

void save_mesh(const std::string& path, const LoadedMesh& mesh) {
    if (path == "-") {
        const ScratchFolder scratch;
        write_mesh(scratch.path() / "mesh.off", mesh);
        return print_all(read_file(scratch.path() / "mesh.off"));
    }
    make_parent_folder(path);
    write_mesh(path, mesh);
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
    make_parent_folder(path);
    write_network(path, network, detail, mesh);
}

}  // namespace fcn::app
