#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace fcn::app {

/// Throws UsageError for a name that remesher_names() does not list.
void check_baselines(const std::vector<std::string>& names);

/// Other ways to a mesh of this scale, for the 3D view to set beside the remesh; a way that fails
/// becomes a warning of the record.
void add_baselines(ScaleRecord& scale, const MeshRecord& record, double ratio,
                   const std::vector<std::string>& names);

}  // namespace fcn::app
