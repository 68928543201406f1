#pragma once

#include "meshing/map_problem.h"

namespace fcn {

struct UntanglingOptions {
    int iterations = 60;  ///< Newton steps at most, a level
    int rings = 3;        ///< of faces around those turned over that move at first; then 4 times
    bool is_all_moving = true;  ///< in the end, if that is not enough
};

struct UntanglingResult {
    Eigen::VectorXd values;                               ///< of the free unknowns
    std::size_t turned_over_before = 0, turned_over = 0;  ///< faces
    int iterations = 0;                                   ///< Newton steps
};

/// Determinant of the map's Jacobian per face, 1 where area is kept.
std::vector<double> map_determinants(const MapProblem& problem, const Eigen::VectorXd& values);

/// Newton steps over everything that is not fixed, for a map without faces turned over: stretch is
/// spread. Faces stay as they are oriented.
UntanglingResult relax(const MapProblem& problem, const Eigen::VectorXd& values,
                       const std::vector<bool>& is_fixed, int iterations);

/// Moves free unknowns, but fixed ones, until no face is turned over or the steps are used up.
UntanglingResult untangle(const MapProblem& problem, const Eigen::VectorXd& values,
                          const std::vector<bool>& is_fixed, const UntanglingOptions& options = {});

}  // namespace fcn
