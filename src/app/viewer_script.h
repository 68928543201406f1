#pragma once

#include <string>

namespace fcn::app {

/// The 3D viewer's JavaScript, which scripts/setup_viewer.sh makes; empty if there is none. Looked
/// for in: the file that SCALEFCN_VIEWER names (InputError if it cannot be read; empty: none), the
/// installed program's share/scalefcn, the build folder that holds the program's own.
std::string find_viewer_script();

}  // namespace fcn::app
