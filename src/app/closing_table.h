#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace fcn::app {

/// What `run` says of a mesh at the end: per scale the triangles made on the initial and on the
/// adapted network, coverage and conformity; then the solvers side by side.
std::string closing_table(const MeshRecord& mesh, bool has_timings);

}  // namespace fcn::app
