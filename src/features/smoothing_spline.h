#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcn {

/// Points p, one a row, that minimise sum pull_i |p_i - start_i|^2 + weight sum |second
/// differences|^2; an open line keeps its first and last. `pull` > 0, one a point.
Eigen::MatrixX3d smoothing_spline(const Eigen::MatrixX3d& start, const std::vector<double>& pull,
                                  double weight, bool is_cyclic);

}  // namespace fcn
