#pragma once

#include <vector>

#include "meshing/remesh_quads.h"
#include "report/drawn_curves.h"

namespace fcn {

/// A field as short crosses, two straight lines each, on faces about `spacing` > 0 apart, at most
/// `most` > 0 crosses (then they are farther apart, and longer). Deterministic.
std::vector<Polyline> field_crosses(const QuadField& field, double spacing, std::size_t most);

}  // namespace fcn
