#pragma once

#include <vector>

#include "features/crest_lines.h"
#include "features/local_fit.h"

namespace fcn {

/// Joins loose ends of lines that continue each other over a gap of at most `reach` local edge
/// lengths, and no longer than either line: both leave towards the other within 45 degrees, on one
/// side of the surface, and the surface between them is connected. Nearest ends first; each end
/// joins once. The bridges follow the surface, their points carry the mean of what both ends
/// measured. Deterministic.
void bridge_gaps(const MeshArrays& arrays, const LocalFitter& fitter, double reach,
                 CrestGraph& graph);

/// Leads loose ends on to the nearest barrier vertex within `reach` local edge lengths and 45
/// degrees of their direction. The last point of such a bridge lies on that vertex.
void meet_barriers(const MeshArrays& arrays, const LocalFitter& fitter, double reach,
                   CrestGraph& graph);

}  // namespace fcn
