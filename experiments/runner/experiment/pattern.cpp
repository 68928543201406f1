#include "experiment/pattern.h"

#include <fnmatch.h>
#include <glob.h>

#include <algorithm>
#include <string_view>

namespace experiment {

bool matches(const std::string& pattern, const std::string& name) {
    return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

std::vector<std::filesystem::path> matching_files(const std::string& pattern,
                                                  const std::filesystem::path& folder) {
    const std::filesystem::path absolute = folder / pattern;
    if (pattern.find_first_of("*?[") == std::string::npos) return {absolute};
    std::vector<std::filesystem::path> files;
    // The configuration's folder is no pattern, whatever it is called.
    std::string literal;
    const bool is_absolute = std::filesystem::path(pattern).is_absolute();
    for (const char c : is_absolute ? std::string() : folder.string() + "/") {
        if (std::string_view("*?[\\").find(c) != std::string_view::npos) literal += '\\';
        literal += c;
    }
    glob_t found{};
    if (::glob((literal + pattern).c_str(), 0, nullptr, &found) == 0) {
        for (std::size_t k = 0; k < found.gl_pathc; ++k) files.emplace_back(found.gl_pathv[k]);
    }
    ::globfree(&found);
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace experiment
