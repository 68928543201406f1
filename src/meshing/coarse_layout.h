#pragma once

#include <vector>

#include "meshing/map_problem.h"

namespace fcn {

/// A linear function of the free unknowns.
using LinearForm = std::vector<std::pair<int, double>>;

/// A straight triangle between vertices that become grid points: its sides from the first corner
/// to the second (u, v) and to the third. While no triangle's area turns negative there is a map
/// without folds for the same integers.
struct LayoutTriangle {
    std::array<LinearForm, 4> forms;
    int tip = -1;  ///< vertex of the mesh at the corner across from the longest side
};

struct CoarseLayout {
    std::vector<LayoutTriangle> triangles;
    std::size_t vertex_count = 0;
    Eigen::VectorXd free_values;  ///< of the seamless map
};

/// Straight triangles between the vertices of a seamless map without folds that have to become
/// grid points.
CoarseLayout make_coarse_layout(const Mesh& mesh, const MapProblem& problem,
                                const Eigen::VectorXd& free_values);

}  // namespace fcn
