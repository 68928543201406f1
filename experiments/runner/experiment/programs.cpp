#include "experiment/programs.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>

#include "experiment/hash.h"
#include "labeling_mip/external_process.h"

namespace experiment {
namespace {

std::string python(const char* variable, const char* environment) {
    const char* chosen = std::getenv(variable);
    if (chosen != nullptr && *chosen != '\0') return chosen;
    const std::string prepared =
        std::string(EXPERIMENT_SOURCE_DIR) + "/build/" + environment + "/bin/python";
    return ::access(prepared.c_str(), X_OK) == 0 ? prepared : "python3";
}

}  // namespace

std::filesystem::path own_program(const std::string& name) {
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    if (!error) {
        const auto beside = self.parent_path() / name;
        if (!labeling::find_program(beside.string()).empty()) return beside;
    }
    const auto found = labeling::find_program(name);
    return found.empty() ? std::filesystem::path(name) : found;
}

std::string program_hash(const std::string& name) {
    static std::map<std::string, std::string> hashes;
    const auto [it, is_new] = hashes.emplace(name, "");
    if (is_new) {
        std::ifstream in(own_program(name), std::ios::binary);
        it->second = content_hash(std::string(std::istreambuf_iterator<char>(in), {}));
    }
    return it->second;
}

std::string python_for_solvers() { return python("LABELING_PYTHON", "solvers-venv"); }

std::string python_for_plots() { return python("SCALEFCN_PYTHON", "experiments-venv"); }

std::filesystem::path source_folder() { return EXPERIMENT_SOURCE_DIR; }

}  // namespace experiment
