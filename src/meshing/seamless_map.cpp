// The seamless map nearest to a field: a Poisson problem (Bommes, Zimmer, Kobbelt 2009, section 5;
// Kaelberer, Nieser, Polthier 2007, "QuadCover"), over the unknowns that the seams leave free.
#include "meshing/seamless_map.h"

#include <Eigen/SparseCholesky>

namespace fcn {
namespace {

/// Keeps the factorisation away from zero pivots where nothing holds an unknown.
constexpr double kLeastPivot = 1e-10;

}  // namespace

QuadraticEnergy alignment_energy(const MapProblem& problem, const std::vector<double>& stiffness) {
    const int count = static_cast<int>(problem.unknowns.basis.rows());
    QuadraticEnergy energy;
    energy.right = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(18 * problem.shapes.size() + 4 * problem.soft.size());
    for (std::size_t f = 0; f < problem.shapes.size(); ++f) {
        const FaceShape& shape = problem.shapes[f];
        const double weight = shape.area * (stiffness.empty() ? 1 : stiffness[f]);
        const Eigen::Matrix3d local = weight * shape.gradients.transpose() * shape.gradients;
        for (int i = 0; i < 3; ++i) {
            const int one = 2 * problem.cut.copies[f][static_cast<std::size_t>(i)];
            for (int axis = 0; axis < 2; ++axis)
                energy.right[one + axis] += weight * shape.gradients(axis, i);
            for (int j = 0; j < 3; ++j) {
                const int other = 2 * problem.cut.copies[f][static_cast<std::size_t>(j)];
                for (int axis = 0; axis < 2; ++axis)
                    entries.emplace_back(one + axis, other + axis, local(i, j));
            }
        }
    }
    for (const SoftEquality& soft : problem.soft) {
        entries.emplace_back(soft.one, soft.one, soft.weight);
        entries.emplace_back(soft.other, soft.other, soft.weight);
        entries.emplace_back(soft.one, soft.other, -soft.weight);
        entries.emplace_back(soft.other, soft.one, -soft.weight);
    }
    energy.matrix.resize(count, count);
    energy.matrix.setFromTriplets(entries.begin(), entries.end());
    return energy;
}

QuadraticEnergy reduced(const QuadraticEnergy& energy, const MapProblem& problem) {
    const SparseMatrix basis = problem.unknowns.basis;
    const SparseMatrix transposed = basis.transpose();
    const SparseMatrix half = energy.matrix * basis;
    const SparseMatrix full = transposed * half;
    return {full.triangularView<Eigen::Lower>(), transposed * energy.right};
}

Eigen::VectorXd minimum(const QuadraticEnergy& energy, const std::vector<bool>& is_fixed,
                        const Eigen::VectorXd& values) {
    const int count = static_cast<int>(energy.matrix.rows());
    std::vector<int> row(static_cast<std::size_t>(count), -1);
    int moving = 0;
    for (int i = 0; i < count; ++i)
        if (!is_fixed[static_cast<std::size_t>(i)]) row[static_cast<std::size_t>(i)] = moving++;
    Eigen::VectorXd result = values;
    if (moving == 0) return result;
    Eigen::VectorXd right(moving);
    for (int i = 0; i < count; ++i)
        if (row[static_cast<std::size_t>(i)] >= 0)
            right[row[static_cast<std::size_t>(i)]] = energy.right[i];
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(energy.matrix.nonZeros()));
    for (int j = 0; j < count; ++j) {
        const int column = row[static_cast<std::size_t>(j)];
        for (SparseMatrix::InnerIterator it(energy.matrix, j); it; ++it) {
            const int i = row[static_cast<std::size_t>(it.row())];
            if (i >= 0 && column >= 0)
                entries.emplace_back(i, column, it.value());
            else if (i >= 0)
                right[i] -= it.value() * values[j];
            else if (column >= 0)
                right[column] -= it.value() * values[it.row()];
        }
    }
    for (int i = 0; i < moving; ++i) entries.emplace_back(i, i, kLeastPivot);
    SparseMatrix matrix(moving, moving);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<SparseMatrix> solver(matrix);
    if (solver.info() != Eigen::Success) return {};
    const Eigen::VectorXd solution = solver.solve(right);
    if (!solution.allFinite()) return {};
    for (int i = 0; i < count; ++i)
        if (row[static_cast<std::size_t>(i)] >= 0)
            result[i] = solution[row[static_cast<std::size_t>(i)]];
    return result;
}

}  // namespace fcn
