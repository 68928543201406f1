#pragma once

#include "meshing/map_problem.h"

namespace fcn {

struct UntanglingOptions {
    int iterations = 60;  ///< Newton steps at most, a level
    int rings = 3;        ///< of faces around those turned over that move at first; then all
};

struct UntanglingResult {
    Eigen::VectorXd values;                               ///< of the free unknowns
    std::size_t turned_over_before = 0, turned_over = 0;  ///< faces
    int iterations = 0;                                   ///< Newton steps
};

/// Determinant of the map's Jacobian per face, 1 where area is kept.
std::vector<double> map_determinants(const MapProblem& problem, const Eigen::VectorXd& values);

/// Moves free unknowns, but fixed ones, until no face is turned over or the steps are used up.
UntanglingResult untangle(const MapProblem& problem, const Eigen::VectorXd& values,
                          const std::vector<bool>& is_fixed, const UntanglingOptions& options = {});

}  // namespace fcn
