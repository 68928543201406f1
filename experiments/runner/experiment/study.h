#pragma once

#include <filesystem>
#include <string>

namespace experiment {

/// What a network is worth for the mesh that is built on it.
struct StudyRequest {
    std::filesystem::path mesh;
    std::string scale, detector, mode, target, options;
    std::string solver;
    std::string seed, work, gap;  ///< empty: not given
};

/// Adapts, remeshes and measures with the program `scalefcn`, in the current folder. Writes one
/// line for each kept segment (its end points, ordered; equal text means the same segment) to
/// `segments` and a result as labeling-solve writes it to `result`, whose statistics are the
/// measures. Throws InputError when scalefcn fails.
void run_study(const StudyRequest& request, const std::filesystem::path& segments,
               const std::filesystem::path& result);

}  // namespace experiment
