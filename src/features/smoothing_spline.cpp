#include "features/smoothing_spline.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace fcn {

Eigen::MatrixX3d smoothing_spline(const Eigen::MatrixX3d& start, const std::vector<double>& pull,
                                  double weight, bool is_cyclic) {
    const auto size = static_cast<int>(start.rows());
    std::vector<Eigen::Triplet<double>> entries;
    const auto is_held = [&](int i) { return !is_cyclic && (i == 0 || i == size - 1); };
    Eigen::MatrixX3d right = start;
    for (int i = 0; i < size; ++i) {
        entries.emplace_back(i, i, pull[i]);
        right.row(i) *= pull[i];
    }
    for (int center = 0; center < size; ++center) {
        if (is_held(center)) continue;
        const int index[3] = {(center + size - 1) % size, center, (center + 1) % size};
        const double factor[3] = {1, -2, 1};
        for (int i = 0; i < 3; ++i) {
            if (is_held(index[i])) continue;
            for (int k = 0; k < 3; ++k) {
                const double value = weight * factor[i] * factor[k];
                if (is_held(index[k])) {
                    right.row(index[i]) -= value * start.row(index[k]);
                } else {
                    entries.emplace_back(index[i], index[k], value);
                }
            }
        }
    }
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    return solver.solve(right);
}

}  // namespace fcn
