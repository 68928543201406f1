// Integers for a seamless map. The energy over the integers alone is the Schur complement that a
// sparse factorisation holds when they are eliminated last; with it, rounding one integer moves all
// others to their best at once (greedy rounding with a re-solve: Bommes, Zimmer, Kobbelt 2009,
// section 4, without solving again). Rounding takes place in a basis whose vectors are made short
// pair by pair (Gauss's reduction), for the unknowns themselves move half of the map each. That no
// triangle of the layout turns over (Coudert-Osmont et al. 2023) is looked after when each integer
// is chosen and by a local search at the end; they solve an integer program instead.
#include "meshing/quantisation.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Where each unknown goes: the others by approximate minimum degree, then the integers.
std::vector<int> elimination_order(const SparseMatrix& matrix, const std::vector<int>& row_of) {
    int real_count = 0;
    for (const int row : row_of) real_count += row >= 0;
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < matrix.outerSize(); ++j)
        for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) {
            const int a = row_of[at(static_cast<int>(it.row()))], b = row_of[at(j)];
            if (a < 0 || b < 0) continue;
            entries.emplace_back(a, b, 1.0);
            entries.emplace_back(b, a, 1.0);
        }
    SparseMatrix pattern(real_count, real_count);
    pattern.setFromTriplets(entries.begin(), entries.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
    Eigen::AMDOrdering<int>()(pattern, inverse);
    const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order = inverse.inverse();
    std::vector<int> result(row_of.size());
    int last = real_count;
    for (std::size_t i = 0; i < row_of.size(); ++i)
        result[i] = row_of[i] >= 0 ? order.indices()[row_of[i]] : last++;
    return result;
}

double determinant(const Eigen::Vector4d& s) { return s[0] * s[3] - s[1] * s[2]; }

class Rounding {
public:
    Rounding(const IntegerEnergy& energy, const CoarseLayout& layout, int free_count)
        : energy_(energy), count_(static_cast<int>(energy.unknowns.size())) {
        reduce_basis();
        place_triangles(layout, free_count);
    }

    Quantisation run() {
        Quantisation result;
        result.rounding_steps = round_greedily();
        result.moves = search();
        result.integers = (basis_ * chosen_).array().round();
        const VectorXd off = chosen_ - optimum_;
        result.cost = off.dot(gram_ * off) / 2;
        for (std::size_t t = 0; t < constants_.size(); ++t)
            if (!(determinant(sides(t, chosen_)) > 0.5))
                result.collapsed.push_back(static_cast<int>(t));
        return result;
    }

private:
    /// Makes basis vectors short, each against each other one.
    void reduce_basis() {
        basis_ = MatrixXd::Identity(count_, count_);
        gram_ = energy_.matrix;
        inverse_ = MatrixXd::Identity(count_, count_);
        const int sweeps = count_ > 600 ? 3 : 12;
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            bool is_changed = false;
            for (int i = 0; i < count_; ++i) {
                for (int j = 0; j < count_; ++j) {
                    if (i == j || !(gram_(j, j) > 0)) continue;
                    const double q = std::round(gram_(i, j) / gram_(j, j));
                    if (q == 0) continue;
                    const double fall = 2 * q * gram_(i, j) - q * q * gram_(j, j);
                    if (!(fall > 1e-9 * gram_(i, i))) continue;
                    basis_.col(i) -= q * basis_.col(j);
                    inverse_.row(j) += q * inverse_.row(i);
                    gram_.col(i) -= q * gram_.col(j);
                    gram_.row(i) -= q * gram_.row(j);
                    is_changed = true;
                }
            }
            if (!is_changed) break;
        }
        optimum_ = inverse_ * energy_.optimum;
        chosen_ = optimum_;
    }

    void place_triangles(const CoarseLayout& layout, int free_count) {
        std::vector<int> column(at(free_count), -1);
        for (int i = 0; i < count_; ++i) column[at(energy_.unknowns[at(i)])] = i;
        forms_.resize(4 * static_cast<int>(layout.triangles.size()), count_);
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t t = 0; t < layout.triangles.size(); ++t) {
            Eigen::Vector4d constant = Eigen::Vector4d::Zero();
            for (int k = 0; k < 4; ++k)
                for (const auto& [unknown, coefficient] : layout.triangles[t].forms[at(k)]) {
                    if (column[at(unknown)] >= 0)
                        entries.emplace_back(4 * static_cast<int>(t) + k, column[at(unknown)],
                                             coefficient);
                    else
                        constant[k] += coefficient * layout.free_values[unknown];
                }
            constants_.push_back(constant);
        }
        Eigen::SparseMatrix<double, Eigen::RowMajor> original(forms_.rows(), count_);
        original.setFromTriplets(entries.begin(), entries.end());
        forms_ = (original * basis_).sparseView();
        for (std::size_t t = 0; t < constants_.size(); ++t) {
            const Eigen::Vector4d s = sides(t, optimum_);
            lengths_.push_back(std::max(
                {1.0, s.head<2>().norm(), s.tail<2>().norm(), (s.head<2>() - s.tail<2>()).norm()}));
        }
        touched_slot_.assign(constants_.size(), -1);
        by_vector_ = forms_;
    }

    Eigen::Vector4d sides(std::size_t t, const VectorXd& w) const {
        Eigen::Vector4d result = constants_[t];
        for (int k = 0; k < 4; ++k) result[k] += forms_.row(4 * static_cast<int>(t) + k).dot(w);
        return result;
    }
    /// About how far a triangle is from having an area.
    double violation(std::size_t t, const Eigen::Vector4d& s) const {
        return std::max(0.0, 1 - determinant(s)) / lengths_[t];
    }
    double violation(const VectorXd& w) const {
        double sum = 0;
        for (std::size_t t = 0; t < constants_.size(); ++t) sum += violation(t, sides(t, w));
        return sum;
    }

    int round_greedily() {
        MatrixXd covariance = gram_.ldlt().solve(MatrixXd::Identity(count_, count_));
        std::vector<bool> is_done(at(count_), false);
        VectorXd mean = optimum_;
        for (int step = 0; step < count_; ++step) {
            int best = -1;
            double best_distance = 2;
            for (int i = 0; i < count_; ++i) {
                if (is_done[at(i)]) continue;
                const double distance = std::abs(mean[i] - std::round(mean[i]));
                if (distance < best_distance) {
                    best = i;
                    best_distance = distance;
                }
            }
            const double variance = std::max(covariance(best, best), 1e-300);
            const VectorXd direction = covariance.col(best) / variance;
            const double near = std::round(mean[best]);
            double target = near;
            if (best_distance > 0.02 && !constants_.empty()) {
                const double far = mean[best] > near ? near + 1 : near - 1;
                const VectorXd one = mean + (near - mean[best]) * direction;
                const VectorXd other = mean + (far - mean[best]) * direction;
                const double growth = ((far - mean[best]) * (far - mean[best]) -
                                       (near - mean[best]) * (near - mean[best])) /
                                      (2 * variance);
                if (kTurnedOverCost * (violation(one) - violation(other)) > growth) target = far;
            }
            mean += (target - mean[best]) * direction;
            covariance -= direction * (variance * direction.transpose());
            is_done[at(best)] = true;
            for (int i = 0; i < count_; ++i)
                if (is_done[at(i)]) mean[i] = std::round(mean[i]);
        }
        chosen_ = mean;
        return count_;
    }

    /// A basis vector or the sum of two, forth or back; index -1: none.
    struct Move {
        std::array<int, 2> index{-1, -1}, sign{1, 1};
    };

    /// Breakout local search: the move that lowers cost and weighted violation most among those
    /// that change one triangle turned over; where none does, such triangles gain weight. Then
    /// steps that lower the cost and turn nothing over. Returns the number of moves.
    int search() {
        now_.resize(constants_.size());
        for (std::size_t t = 0; t < now_.size(); ++t) now_[t] = sides(t, chosen_);
        weights_.assign(now_.size(), 1);
        slope_ = gram_ * (chosen_ - optimum_);
        int moves = 0;
        const int most = 40 * count_ + 400;
        std::size_t turn = 0;
        VectorXd best = chosen_;
        std::size_t fewest = now_.size() + 1;
        for (int step = 0; step < most; ++step) {
            std::vector<std::size_t> bad;
            for (std::size_t t = 0; t < now_.size(); ++t)
                if (!(determinant(now_[t]) > 0.5)) bad.push_back(t);
            if (bad.size() < fewest) {
                fewest = bad.size();
                best = chosen_;
            }
            if (bad.empty()) break;
            const Move move = best_move(bad[turn++ % bad.size()]);
            if (move.index[0] >= 0) {
                take(move);
                ++moves;
            } else {
                for (const std::size_t t : bad) weights_[t] += 1;
            }
        }
        if (fewest > 0 || chosen_ != best) {
            chosen_ = best;
            for (std::size_t t = 0; t < now_.size(); ++t) now_[t] = sides(t, chosen_);
            slope_ = gram_ * (chosen_ - optimum_);
        }
        return moves + lower_cost();
    }

    int lower_cost() {
        std::fill(weights_.begin(), weights_.end(), 1e6);
        int moves = 0;
        bool is_changed = true;
        for (int sweep = 0; is_changed && sweep < 20; ++sweep) {
            is_changed = false;
            for (int i = 0; i < count_; ++i)
                for (const int sign : {1, -1}) {
                    const Move move{{i, -1}, {sign, 1}};
                    if (!(change(move) < -1e-9)) continue;
                    take(move);
                    ++moves;
                    is_changed = true;
                }
        }
        return moves;
    }

    Move best_move(std::size_t triangle) {
        std::vector<int> near;
        for (int k = 0; k < 4; ++k)
            for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(
                     forms_, 4 * static_cast<int>(triangle) + k);
                 it; ++it)
                near.push_back(static_cast<int>(it.col()));
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        Move best;
        double lowest = -1e-9;
        const auto consider = [&](const Move& move) {
            const double c = change(move);
            if (c < lowest) {
                lowest = c;
                best = move;
            }
        };
        for (const int i : near)
            for (const int sign : {1, -1}) consider({{i, -1}, {sign, 1}});
        if (best.index[0] >= 0) return best;
        for (std::size_t i = 0; i < near.size(); ++i)
            for (std::size_t j = i + 1; j < near.size(); ++j)
                for (const int one : {1, -1})
                    for (const int other : {1, -1}) consider({{near[i], near[j]}, {one, other}});
        return best;
    }

    /// Fills touched_ with the triangles' sides after a move.
    void touch(const Move& move) {
        touched_.clear();
        for (std::size_t m = 0; m < 2 && move.index[m] >= 0; ++m)
            for (Eigen::SparseMatrix<double>::InnerIterator it(by_vector_, move.index[m]); it;
                 ++it) {
                const int t = static_cast<int>(it.row()) / 4;
                int& slot = touched_slot_[at(t)];
                if (slot < 0) {
                    slot = static_cast<int>(touched_.size());
                    touched_.emplace_back(t, now_[at(t)]);
                }
                touched_[at(slot)].second[static_cast<int>(it.row()) % 4] +=
                    move.sign[m] * it.value();
            }
        for (const auto& [t, sides] : touched_) touched_slot_[at(t)] = -1;
    }

    double change(const Move& move) {
        double result = 0;
        for (std::size_t m = 0; m < 2 && move.index[m] >= 0; ++m)
            result +=
                move.sign[m] * slope_[move.index[m]] + gram_(move.index[m], move.index[m]) / 2;
        if (move.index[1] >= 0)
            result += move.sign[0] * move.sign[1] * gram_(move.index[0], move.index[1]);
        touch(move);
        for (const auto& [t, sides] : touched_)
            result += weights_[at(t)] * (violation(at(t), sides) - violation(at(t), now_[at(t)]));
        return result;
    }

    void take(const Move& move) {
        touch(move);
        for (const auto& [t, sides] : touched_) now_[at(t)] = sides;
        for (std::size_t m = 0; m < 2 && move.index[m] >= 0; ++m) {
            chosen_[move.index[m]] += move.sign[m];
            slope_ += move.sign[m] * gram_.col(move.index[m]);
        }
    }

    /// What a triangle's area too little by one square costs.
    static constexpr double kTurnedOverCost = 1;

    const IntegerEnergy& energy_;
    int count_;
    MatrixXd basis_, inverse_, gram_;
    VectorXd optimum_, chosen_;
    Eigen::SparseMatrix<double, Eigen::RowMajor> forms_;
    Eigen::SparseMatrix<double> by_vector_;
    std::vector<Eigen::Vector4d> constants_;
    std::vector<double> lengths_;  ///< per triangle: its longest side at the optimum
    std::vector<Eigen::Vector4d> now_;
    std::vector<double> weights_;
    VectorXd slope_;
    std::vector<std::pair<int, Eigen::Vector4d>> touched_;
    std::vector<int> touched_slot_;
};

}  // namespace

IntegerEnergy integer_energy(const QuadraticEnergy& energy, const std::vector<bool>& is_integer) {
    IntegerEnergy result;
    std::vector<int> row_of(is_integer.size(), -1);
    int real_count = 0;
    for (std::size_t i = 0; i < is_integer.size(); ++i) {
        if (is_integer[i])
            result.unknowns.push_back(static_cast<int>(i));
        else
            row_of[i] = real_count++;
    }
    if (result.unknowns.empty()) return result;
    const std::vector<int> order = elimination_order(energy.matrix, row_of);
    const int size = static_cast<int>(is_integer.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < size; ++j)
        for (SparseMatrix::InnerIterator it(energy.matrix, j); it; ++it) {
            const int a = order[at(static_cast<int>(it.row()))], b = order[at(j)];
            entries.emplace_back(std::max(a, b), std::min(a, b), it.value());
        }
    for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1e-10);
    SparseMatrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    VectorXd right(size);
    for (int i = 0; i < size; ++i) right[order[at(i)]] = energy.right[i];
    using Solver = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;
    const Solver solver(matrix);
    const int count = static_cast<int>(result.unknowns.size());
    if (solver.info() != Eigen::Success) return {};
    const VectorXd solution = solver.solve(right);
    if (!solution.allFinite()) return {};
    result.optimum = solution.tail(count);
    MatrixXd factor = MatrixXd::Identity(count, count);
    const SparseMatrix& lower = solver.matrixL().nestedExpression();
    for (int j = real_count; j < size; ++j)
        for (SparseMatrix::InnerIterator it(lower, j); it; ++it)
            if (it.row() > j) factor(it.row() - real_count, j - real_count) = it.value();
    result.matrix = factor * solver.vectorD().tail(count).asDiagonal() * factor.transpose();
    return result;
}

Quantisation quantise(const IntegerEnergy& energy, const CoarseLayout& layout) {
    if (energy.unknowns.empty()) return {};
    return Rounding(energy, layout, static_cast<int>(layout.free_values.size())).run();
}

}  // namespace fcn
