#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiment/config.h"
#include "experiment/plan.h"

namespace experiment {

/// Makes every problem of a configuration and writes it to FOLDER/problems (meshes of studies to
/// FOLDER/meshes), so that the campaign needs nothing outside its folder. Files are copied,
/// families generated, meshes adapted by the program `scalefcn` (its networks and logs stay in
/// FOLDER/adapted). Deterministic. `tell` is called with a line for each source.
/// Throws InputError: a pattern without a match, an unreadable file, two problems of one name, a
/// mesh that cannot be adapted, a program that is missing.
std::vector<PlannedProblem> make_problems(const CampaignConfig& config,
                                          const std::filesystem::path& folder,
                                          const std::function<void(const std::string&)>& tell);

}  // namespace experiment
