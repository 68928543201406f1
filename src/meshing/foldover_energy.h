#pragma once

#include <Eigen/Core>

namespace fcn {

/// Value and derivatives of a face's energy by its Jacobian (j11, j12, j21, j22).
struct FoldoverEnergy {
    double value = 0;
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    Eigen::Matrix4d hessian = Eigen::Matrix4d::Zero();  ///< positive semidefinite part
};

/// (|J|^2 / 2 + weight (1 + det^2) / 2) / chi + alignment |J - 1|^2 / 2 with
/// chi = (det + sqrt(epsilon^2 + det^2)) / 2: finite for faces turned over too, a barrier for
/// epsilon -> 0.
double foldover_value(const Eigen::Vector4d& jacobian, double epsilon);
FoldoverEnergy foldover_energy(const Eigen::Vector4d& jacobian, double epsilon);

}  // namespace fcn
