#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace experiment {

/// Shell patterns of a whole name: * ? [a-z].
bool matches(const std::string& pattern, const std::string& name);

/// Files that a pattern means, sorted; patterns are relative to `folder`. A pattern without a
/// wildcard names one file, whether it exists or not. Empty when nothing matches.
std::vector<std::filesystem::path> matching_files(const std::string& pattern,
                                                  const std::filesystem::path& folder);

}  // namespace experiment
