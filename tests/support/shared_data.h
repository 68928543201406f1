#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace fcn::testing {

/// Folder with the meshes and instances that tests may use if present: `data` under
/// $SCALEFCN_SHARED, or `shared/data` beside the source folder or beside one of its parents.
inline std::optional<std::filesystem::path> shared_data() {
    namespace fs = std::filesystem;
    std::error_code error;
    if (const char* named = std::getenv("SCALEFCN_SHARED"); named != nullptr && *named != '\0') {
        const fs::path base(named);
        if (fs::is_directory(base / "data", error)) return base / "data";
        if (fs::is_directory(base, error)) return base;
    }
    fs::path folder = fs::absolute(SCALEFCN_SOURCE_DIR, error);
    for (; folder.has_relative_path(); folder = folder.parent_path()) {
        const fs::path candidate = folder.parent_path() / "shared" / "data";
        if (fs::is_directory(candidate, error)) return candidate;
    }
    return std::nullopt;
}

}  // namespace fcn::testing
