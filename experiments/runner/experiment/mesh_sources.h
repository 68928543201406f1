#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/config.h"

namespace experiment {

/// A mesh of a configuration, copied or made.
struct MeshSource {
    std::string name;            ///< without extension
    std::filesystem::path file;  ///< in the campaign's folder
};

/// Meshes that a configuration means: patterns of files relative to `config_folder`, `cgal:NAME`
/// (from the folder SCALEFCN_MESHES or build/meshes, where scripts/fetch_meshes.sh puts those of
/// Debian's libcgal-demo), `model:NAME` (built in; options of `scalefcn model` behind it). Written
/// to FOLDER/meshes. Throws InputError when there is none of that name.
std::vector<MeshSource> mesh_sources(const std::vector<std::string>& patterns,
                                     const std::filesystem::path& config_folder,
                                     const std::filesystem::path& folder);

/// One adaptation whose problems are wanted.
struct AdaptRequest {
    std::string scale, detector, mode, target;
    std::vector<std::string> options;
    /// The first problem does not depend on any solver: one quick round is enough for it.
    bool wants_first_only = false;
};

/// "fandisk_vsa200_2pct_best_tri".
std::string adaptation_name(const std::string& mesh, const AdaptRequest& request);

/// Options of `scalefcn` that a detector such as "vsa 200" means.
std::vector<std::string> detector_words(const std::string& detector);

/// Adapts and returns the saved problems, by iteration. What was adapted before is not adapted
/// again.
std::vector<std::filesystem::path> adapted_problems(const MeshSource& mesh,
                                                    const AdaptRequest& request,
                                                    const std::filesystem::path& folder);

/// Runs a program of this project to its end; what it prints goes to `log`. Throws InputError with
/// its last words when it fails.
void run_own_program(const std::vector<std::string>& words, const std::filesystem::path& log);

}  // namespace experiment
