#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace fcn {

/// Unknowns as linear functions of fewer, free ones: value = basis * free values.
struct EliminatedUnknowns {
    Eigen::SparseMatrix<double, Eigen::RowMajor> basis;  ///< #unknowns x #free
    /// Per free unknown: whether it has to be an integer. When these are integers, so are all
    /// unknowns that have to be, and every such solution comes from one choice of them.
    std::vector<bool> is_integer;
};

/// Homogeneous linear equations with integer coefficients between unknowns some of which have to be
/// integers.
class IntegerElimination {
public:
    struct Term {
        int unknown = 0;
        double coefficient = 0;  ///< an integer
    };

    explicit IntegerElimination(const std::vector<bool>& is_integer);

    /// The sum of the terms is zero. Earlier equations decide which unknowns stay free: the last
    /// real one in an equation goes, or else the last integer with the coefficient 1 or -1.
    void add(const std::vector<Term>& equation);

    EliminatedUnknowns finish();

private:
    using Expression = std::vector<Term>;  ///< by unknown, no zeros
    const Expression& expanded(int unknown);
    Expression expanded(const Expression& terms);
    void replace(int unknown, Expression expression);
    void eliminate_integers(Expression equation);

    std::size_t original_count_;
    std::vector<bool> is_integer_, is_replaced_;
    std::vector<Expression> replacements_;
    std::vector<double> sums_;  ///< scratch: per unknown
};

}  // namespace fcn
