#pragma once

#include <Eigen/SparseCore>

#include "meshing/map_problem.h"

namespace fcn {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Half x' matrix x - right' x: how far the map is from an isometry along the field, over the free
/// unknowns; the matrix has its lower triangle only.
struct QuadraticEnergy {
    SparseMatrix matrix;
    Eigen::VectorXd right;
};

/// Sum over faces of stiffness area |J - 1|^2 plus soft alignments, over all unknowns; without
/// stiffness 1 everywhere.
QuadraticEnergy alignment_energy(const MapProblem& problem,
                                 const std::vector<double>& stiffness = {});
/// The same over the free ones.
QuadraticEnergy reduced(const QuadraticEnergy& energy, const MapProblem& problem);

/// The least energy when some unknowns keep their values. Returns all; empty: not solvable.
Eigen::VectorXd minimum(const QuadraticEnergy& energy, const std::vector<bool>& is_fixed,
                        const Eigen::VectorXd& values);

}  // namespace fcn
