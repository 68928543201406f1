// Untangling: Newton's method on the foldover-free energy (foldover_energy.h) over the unknowns
// that the seams leave free, so that every iterate is seamless. The source (Garanzha et al. 2021)
// moves all vertices with L-BFGS; here only the surroundings of what is turned over move at first,
// for maps of fields are sound nearly everywhere, and everything only if that is not enough.
#include "meshing/untangling.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "meshing/foldover_energy.h"

namespace fcn {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr double kLeastDeterminant = 1e-6;  ///< faces below count as turned over
constexpr int kLocalRows = 6;               ///< unknowns in more rows than that are not local

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Eigen::Vector4d jacobian(const FaceShape& shape, const std::array<Vec2, 3>& uv) {
    Eigen::Matrix2d j = Eigen::Matrix2d::Zero();
    for (int i = 0; i < 3; ++i) j += uv[at(i)] * shape.gradients.col(i).transpose();
    return {j(0, 0), j(0, 1), j(1, 0), j(1, 1)};
}

/// Some of the free unknowns and the faces that they move.
class MovingPart {
public:
    MovingPart(const MapProblem& problem, const std::vector<bool>& is_moving) : problem_(problem) {
        const auto& basis = problem.unknowns.basis;
        std::vector<int> column(is_moving.size(), -1);
        for (std::size_t i = 0; i < is_moving.size(); ++i) {
            if (!is_moving[i]) continue;
            column[i] = static_cast<int>(unknowns_.size());
            unknowns_.push_back(static_cast<int>(i));
        }
        std::vector<std::uint8_t> is_row_moving(at(static_cast<int>(basis.rows())), 0);
        for (int row = 0; row < 2 * problem.cut.copy_count; ++row)
            for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(basis, row); it;
                 ++it)
                if (is_moving[at(static_cast<int>(it.col()))]) is_row_moving[at(row)] = 1;
        std::vector<int> slot(at(problem.cut.copy_count), -1);
        for (std::size_t f = 0; f < problem.shapes.size(); ++f) {
            const auto& copies = problem.cut.copies[f];
            const bool is_in = std::any_of(copies.begin(), copies.end(), [&](int copy) {
                return is_row_moving[at(2 * copy)] || is_row_moving[at(2 * copy + 1)];
            });
            if (!is_in) continue;
            faces_.push_back(static_cast<int>(f));
            std::array<int, 3> slots{};
            for (std::size_t i = 0; i < 3; ++i) {
                int& s = slot[at(copies[i])];
                if (s < 0) {
                    s = static_cast<int>(copies_.size());
                    copies_.push_back(copies[i]);
                }
                slots[i] = s;
            }
            slots_.push_back(slots);
        }
        make_basis(column);
        make_pattern();
    }

    bool is_empty() const { return unknowns_.empty() || faces_.empty(); }
    const std::vector<int>& unknowns() const { return unknowns_; }

    /// Coordinates of the copies, u and v.
    Eigen::VectorXd coordinates(const Eigen::VectorXd& free) const {
        Eigen::VectorXd result(2 * static_cast<int>(copies_.size()));
        const auto& basis = problem_.unknowns.basis;
        for (std::size_t c = 0; c < copies_.size(); ++c)
            for (int axis = 0; axis < 2; ++axis)
                result[2 * static_cast<int>(c) + axis] = basis.row(2 * copies_[c] + axis).dot(free);
        return result;
    }
    Eigen::VectorXd moved(const Eigen::VectorXd& step) const { return basis_ * step; }

    struct Measure {
        double energy = 0, least = 0;
        std::size_t turned_over = 0;
    };
    Measure measure(const Eigen::VectorXd& x, double epsilon) const {
        Measure result;
        result.least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < faces_.size(); ++k) {
            const Eigen::Vector4d j = jacobian(shape(k), corners(x, k));
            const double det = j[0] * j[3] - j[1] * j[2];
            result.least = std::min(result.least, det);
            if (!(det > kLeastDeterminant)) ++result.turned_over;
            if (epsilon > 0) result.energy += shape(k).area * foldover_value(j, epsilon);
        }
        return result;
    }

    /// Newton's direction for the moving unknowns; empty: none.
    Eigen::VectorXd direction(const Eigen::VectorXd& x, double epsilon, double& slope) {
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
        std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), 0.0);
        for (std::size_t k = 0; k < faces_.size(); ++k) {
            const FoldoverEnergy face = foldover_energy(jacobian(shape(k), corners(x, k)), epsilon);
            Eigen::Matrix<double, 4, 6> by_corner = Eigen::Matrix<double, 4, 6>::Zero();
            for (int i = 0; i < 3; ++i) {
                by_corner.block<2, 1>(0, 2 * i) = shape(k).gradients.col(i);
                by_corner.block<2, 1>(2, 2 * i + 1) = shape(k).gradients.col(i);
            }
            const Eigen::Matrix<double, 6, 1> local_gradient =
                shape(k).area * by_corner.transpose() * face.gradient;
            const Eigen::Matrix<double, 6, 6> local =
                shape(k).area * by_corner.transpose() * face.hessian * by_corner;
            for (int i = 0; i < 6; ++i) {
                gradient[2 * slots_[k][at(i / 2)] + i % 2] += local_gradient[i];
                for (int j = 0; j < 6; ++j)
                    matrix_.valuePtr()[places_[36 * k + at(6 * i + j)]] += local(i, j);
            }
        }
        const Eigen::VectorXd right = -(transposed_ * gradient);
        const SparseMatrix half = matrix_ * basis_;
        SparseMatrix full = transposed_ * half;
        for (int i = 0; i < full.rows(); ++i) full.coeffRef(i, i) *= 1 + 1e-9;
        if (!is_analysed_) solver_.analyzePattern(full);
        is_analysed_ = true;
        solver_.factorize(full);
        if (solver_.info() != Eigen::Success) return {};
        Eigen::VectorXd result = solver_.solve(right);
        slope = -result.dot(right);
        if (!result.allFinite() || !(slope < 0)) return {};
        return result;
    }

private:
    const FaceShape& shape(std::size_t k) const { return problem_.shapes[at(faces_[k])]; }
    std::array<Vec2, 3> corners(const Eigen::VectorXd& x, std::size_t k) const {
        std::array<Vec2, 3> uv;
        for (std::size_t i = 0; i < 3; ++i) uv[i] = x.segment<2>(2 * slots_[k][i]);
        return uv;
    }

    void make_basis(const std::vector<int>& column) {
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t c = 0; c < copies_.size(); ++c) {
            for (int axis = 0; axis < 2; ++axis) {
                const int row = 2 * static_cast<int>(c) + axis;
                for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(
                         problem_.unknowns.basis, 2 * copies_[c] + axis);
                     it; ++it) {
                    const int to = column[at(static_cast<int>(it.col()))];
                    if (to >= 0) entries.emplace_back(row, to, it.value());
                }
            }
        }
        basis_.resize(2 * static_cast<int>(copies_.size()), static_cast<int>(unknowns_.size()));
        basis_.setFromTriplets(entries.begin(), entries.end());
        transposed_ = basis_.transpose();
    }

    /// The full matrix over the coordinates and where each face's entries are in it.
    void make_pattern() {
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(36 * faces_.size());
        const auto index = [&](std::size_t k, int i) { return 2 * slots_[k][at(i / 2)] + i % 2; };
        for (std::size_t k = 0; k < faces_.size(); ++k)
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j) entries.emplace_back(index(k, i), index(k, j), 1.0);
        const int size = 2 * static_cast<int>(copies_.size());
        matrix_.resize(size, size);
        matrix_.setFromTriplets(entries.begin(), entries.end());
        places_.reserve(entries.size());
        for (const auto& entry : entries) {
            const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col()];
            const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col() + 1];
            places_.push_back(static_cast<int>(std::lower_bound(begin, end, entry.row()) -
                                               matrix_.innerIndexPtr()));
        }
    }

    const MapProblem& problem_;
    std::vector<int> unknowns_, faces_, copies_;
    std::vector<std::array<int, 3>> slots_;  ///< per face: its corners' copies
    SparseMatrix basis_, transposed_, matrix_;
    std::vector<int> places_;
    Eigen::SimplicialLDLT<SparseMatrix> solver_;
    bool is_analysed_ = false;
};

/// The next epsilon (Garanzha et al., section 3): smaller the faster the energy falls.
double next_epsilon(double epsilon, double least, double sigma) {
    if (least >= 0) return (1 - sigma) * epsilon;
    const double root = std::hypot(least, epsilon);
    return (1 - sigma * root / (std::abs(least) + root)) * epsilon;
}

/// Newton steps; returns their number.
int descend(MovingPart& part, Eigen::VectorXd& free, int iterations) {
    Eigen::VectorXd x = part.coordinates(free);
    double least = part.measure(x, 0).least;
    double epsilon = std::sqrt(1e-6 + 0.04 * std::min(0.0, least) * std::min(0.0, least));
    int steps = 0, polishing = 0;
    while (steps < iterations) {
        const auto before = part.measure(x, epsilon);
        double slope = 0;
        const Eigen::VectorXd direction = part.direction(x, epsilon, slope);
        if (direction.size() == 0) break;
        const Eigen::VectorXd move = part.moved(direction);
        double length = 1;
        MovingPart::Measure after;
        bool is_lower = false;
        for (int i = 0; i < 30 && !is_lower; ++i, length /= 2) {
            after = part.measure(x + length * move, epsilon);
            is_lower = std::isfinite(after.energy) &&
                       after.energy <= before.energy + 1e-4 * length * slope;
            if (is_lower) break;
        }
        ++steps;
        if (is_lower) {
            x += length * move;
            const auto& unknowns = part.unknowns();
            for (std::size_t i = 0; i < unknowns.size(); ++i)
                free[unknowns[i]] += length * direction[static_cast<int>(i)];
            least = after.least;
        }
        const double fall = is_lower ? 1 - after.energy / before.energy : 0;
        if (least > kLeastDeterminant && (++polishing > 6 || fall < 1e-3)) break;
        if (!is_lower && epsilon < 1e-9) break;
        epsilon = std::max(1e-10, next_epsilon(epsilon, least, std::max(0.1, fall)));
    }
    return steps;
}

/// Unknowns near faces turned over, within so many rings; the others if `rings` < 0.
std::vector<bool> moving_unknowns(const MapProblem& problem, const std::vector<double>& dets,
                                  const std::vector<bool>& is_fixed, int rings) {
    const auto& basis = problem.unknowns.basis;
    std::vector<bool> result(is_fixed.size(), false);
    if (rings < 0) {
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = !is_fixed[i];
        return result;
    }
    std::vector<int> row_count(is_fixed.size(), 0);
    for (int row = 0; row < basis.rows(); ++row)
        for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(basis, row); it; ++it)
            ++row_count[at(static_cast<int>(it.col()))];
    std::vector<std::uint8_t> is_near(at(problem.cut.vertex_count), 0);
    for (std::size_t f = 0; f < dets.size(); ++f)
        if (!(dets[f] > kLeastDeterminant))
            for (const int vertex : problem.cut.corners[f]) is_near[at(vertex)] = 1;
    for (int ring = 0; ring < rings; ++ring) {
        const auto before = is_near;
        for (const auto& corners : problem.cut.corners)
            if (std::any_of(corners.begin(), corners.end(), [&](int v) { return before[at(v)]; }))
                for (const int vertex : corners) is_near[at(vertex)] = 1;
    }
    for (std::size_t f = 0; f < dets.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (!is_near[at(problem.cut.corners[f][i])]) continue;
            for (int axis = 0; axis < 2; ++axis) {
                const int row = 2 * problem.cut.copies[f][i] + axis;
                for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(basis, row); it;
                     ++it) {
                    const std::size_t j = at(static_cast<int>(it.col()));
                    if (!is_fixed[j] && row_count[j] <= kLocalRows) result[j] = true;
                }
            }
        }
    }
    return result;
}

std::size_t count_turned_over(const std::vector<double>& dets) {
    return static_cast<std::size_t>(std::count_if(
        dets.begin(), dets.end(), [](double det) { return !(det > kLeastDeterminant); }));
}

}  // namespace

std::vector<double> map_determinants(const MapProblem& problem, const Eigen::VectorXd& values) {
    const CornerMap map = corner_map(problem, problem.unknowns.basis * values);
    std::vector<double> result;
    for (std::size_t f = 0; f < problem.shapes.size(); ++f) {
        const Eigen::Vector4d j = jacobian(problem.shapes[f], map.uv[f]);
        result.push_back(j[0] * j[3] - j[1] * j[2]);
    }
    return result;
}

UntanglingResult relax(const MapProblem& problem, const Eigen::VectorXd& values,
                       const std::vector<bool>& is_fixed, int iterations) {
    UntanglingResult result;
    result.values = values;
    MovingPart part(problem, moving_unknowns(problem, {}, is_fixed, -1));
    if (!part.is_empty()) result.iterations = descend(part, result.values, iterations);
    result.turned_over = count_turned_over(map_determinants(problem, result.values));
    return result;
}

UntanglingResult untangle(const MapProblem& problem, const Eigen::VectorXd& values,
                          const std::vector<bool>& is_fixed, const UntanglingOptions& options) {
    UntanglingResult result;
    result.values = values;
    std::vector<double> dets = map_determinants(problem, values);
    result.turned_over_before = result.turned_over = count_turned_over(dets);
    for (const int rings : {options.rings, 4 * options.rings, -1}) {
        if (result.turned_over == 0 || (rings < 0 && !options.is_all_moving)) break;
        MovingPart part(problem, moving_unknowns(problem, dets, is_fixed, rings));
        if (part.is_empty()) continue;
        result.iterations += descend(part, result.values, options.iterations);
        dets = map_determinants(problem, result.values);
        result.turned_over = count_turned_over(dets);
    }
    return result;
}

}  // namespace fcn
