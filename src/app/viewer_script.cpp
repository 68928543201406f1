#include "app/viewer_script.h"

#include <cstdlib>
#include <filesystem>

#include "geometry/mesh_io.h"

namespace fcn::app {

std::string find_viewer_script() {
    namespace fs = std::filesystem;
    if (const char* named = std::getenv("SCALEFCN_VIEWER"))
        return *named == 0 ? std::string() : read_file(named);
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    if (error) return {};
    for (const fs::path& path :
         {folder / "../share/scalefcn/viewer.js", folder / "../../viewer/viewer.js"})
        if (fs::is_regular_file(path, error)) return read_file(path);
    return {};
}

}  // namespace fcn::app
