#pragma once

#include "meshing/remeshing_steps.h"

namespace fcn {

/// Interval of curvature-dependent lengths, in L: S for L = 1.2 rmin and ratio 1.5.
inline constexpr double kFinestSizing = 1 / 1.2, kCoarsestSizing = 1.25;

/// Lengths at which edges deviate from the surface by `tolerance` L (> 0), within S. Features keep
/// their lengths. The same on any number of threads.
EdgeTarget target_by_curvature(const Mesh& mesh, double edge_length, double tolerance);

}  // namespace fcn
