#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace fcn::app {

/// What `run` ends with: per scale the triangles made on the initial and on the adapted network,
/// coverage and conformity; then the solvers side by side.
std::string closing_table(const std::vector<MeshRecord>& meshes, bool has_timings);

}  // namespace fcn::app
