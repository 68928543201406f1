#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace fcn::app {

/// Throws UsageError for a name that remesher_names() does not list.
void check_baselines(const std::vector<std::string>& names);

/// The triangle meshes of a scale, each measured: on the adapted network, on the initial one beside
/// it on `threads` threads, and by the ways of these names. A way that fails becomes a warning of
/// the record. After Ctrl-C those that are left are not made.
void add_remeshes(ScaleRecord& scale, const MeshRecord& record, const ReferenceSurface& reference,
                  double ratio, const std::vector<std::string>& names, int threads);

}  // namespace fcn::app
