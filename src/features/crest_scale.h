#pragma once

#include "features/local_fit.h"

namespace fcn {

/// The smallest radius, in local edge lengths, at which the curvature derivatives of the mesh stand
/// out from their errors: 3 on a clean mesh, up to 20 on a noisy one. Looks at some thousand
/// vertices. Deterministic.
double choose_rings(const LocalFitter& fitter, int vertex_count, int threads);

}  // namespace fcn
