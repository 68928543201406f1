// The energy of foldover-free maps (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov 2021,
// "Foldover-free maps in 50 lines of code", equation 3), for a triangle. Theirs knows shape and
// area alone; here a weak pull towards the field keeps the map aligned where neither asks for
// anything. The Hessian is projected by its eigenvalues.
#include "meshing/foldover_energy.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace fcn {
namespace {

constexpr double kAreaWeight = 1, kAlignment = 0.5;

double determinant(const Eigen::Vector4d& a) { return a[0] * a[3] - a[1] * a[2]; }

/// Positive also where the sum would cancel.
double chi_of(double det, double root, double epsilon) {
    return det > 0 ? (det + root) / 2 : epsilon * epsilon / (2 * (root - det));
}

const Eigen::Vector4d& identity() {
    static const Eigen::Vector4d value(1, 0, 0, 1);
    return value;
}

void keep_positive_part(Eigen::Matrix4d& matrix) {
    if (Eigen::LLT<Eigen::Matrix4d>(matrix).info() == Eigen::Success) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(matrix);
    const Eigen::Vector4d values = solver.eigenvalues().cwiseMax(0);
    matrix = solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

double foldover_value(const Eigen::Vector4d& a, double epsilon) {
    const double det = determinant(a);
    const double chi = chi_of(det, std::hypot(epsilon, det), epsilon);
    return (a.squaredNorm() + kAreaWeight * (1 + det * det)) / (2 * chi) +
           kAlignment * (a - identity()).squaredNorm() / 2;
}

FoldoverEnergy foldover_energy(const Eigen::Vector4d& a, double epsilon) {
    const double det = determinant(a);
    const double root = std::hypot(epsilon, det);
    const double chi = chi_of(det, root, epsilon);
    const double slope = chi / root;
    const double bend = epsilon * epsilon / (2 * root * root * root);
    const Eigen::Vector4d cofactor(a[3], -a[2], -a[1], a[0]);
    const double top = a.squaredNorm() + kAreaWeight * (1 + det * det);
    const double by_chi = -top / (2 * chi * chi) * slope;
    const double by_det = kAreaWeight * det / chi + by_chi;

    FoldoverEnergy result;
    result.value = top / (2 * chi) + kAlignment * (a - identity()).squaredNorm() / 2;
    result.gradient = a / chi + by_det * cofactor + kAlignment * (a - identity());

    const double second = kAreaWeight * (1 / chi - 2 * det * slope / (chi * chi)) +
                          top * (slope * slope / (chi * chi * chi) - bend / (2 * chi * chi));
    const Eigen::Matrix4d mixed = a * cofactor.transpose();
    result.hessian = -slope / (chi * chi) * (mixed + mixed.transpose()) +
                     second * cofactor * cofactor.transpose();
    result.hessian.diagonal().array() += 1 / chi + kAlignment;
    result.hessian(0, 3) += by_det;
    result.hessian(3, 0) += by_det;
    result.hessian(1, 2) -= by_det;
    result.hessian(2, 1) -= by_det;
    keep_positive_part(result.hessian);
    return result;
}

}  // namespace fcn
