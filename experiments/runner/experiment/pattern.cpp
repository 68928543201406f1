#include "experiment/pattern.h"

#include <fnmatch.h>
#include <glob.h>

#include <algorithm>

namespace experiment {

bool matches(const std::string& pattern, const std::string& name) {
    return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

std::vector<std::filesystem::path> matching_files(const std::string& pattern,
                                                  const std::filesystem::path& folder) {
    const std::filesystem::path absolute = folder / pattern;
    if (pattern.find_first_of("*?[") == std::string::npos) return {absolute};
    std::vector<std::filesystem::path> files;
    glob_t found{};
    if (::glob(absolute.c_str(), GLOB_TILDE, nullptr, &found) == 0) {
        for (std::size_t k = 0; k < found.gl_pathc; ++k) files.emplace_back(found.gl_pathv[k]);
    }
    ::globfree(&found);
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace experiment
