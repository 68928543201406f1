// Clp's dual simplex behind LpEngine. Clp minimises, so objective, multipliers and reduced costs
// change sign on the way in and out. Scaling is off: coefficients are small integers, and
// multipliers come out as they are. Work areas and factorization are kept between solves. Rows that
// are tight when they leave take as many columns out of the basis as needed, chosen here: Clp's own
// repair loses dual feasibility and goes on with thousands of iterations of the primal simplex.
#include <ClpEventHandler.hpp>
#include <ClpSimplex.hpp>
#include <CoinFactorization.hpp>
#include <algorithm>
#include <cmath>

#include "labeling_mip/mip_solvers.h"

namespace labeling {
namespace {

/// Ends a solve between two iterations; the clock is too slow to be read after each.
class StopHandler final : public ClpEventHandler {
public:
    explicit StopHandler(const std::function<bool()>* stop) : stop_(stop) {}
    int event(Event which) override {
        constexpr int kIterationsPerLook = 16;
        if (which != endOfIteration || !*stop_) return -1;
        if (++iterations_ % kIterationsPerLook != 0) return -1;
        return (*stop_)() ? 0 : -1;
    }
    ClpEventHandler* clone() const override { return new StopHandler(*this); }

private:
    const std::function<bool()>* stop_;
    int iterations_ = 0;
};

class ClpEngine final : public LpEngine {
public:
    ClpEngine() { prepare(); }

    void reset(std::span<const double> objective, std::span<const double> lower,
               std::span<const double> upper) override {
        simplex_ = ClpSimplex();
        prepare();
        simplex_.resize(0, static_cast<int>(objective.size()));
        for (std::size_t c = 0; c < objective.size(); ++c) {
            const int column = static_cast<int>(c);
            simplex_.setObjectiveCoefficient(column, -objective[c]);
            simplex_.setColumnBounds(column, lower[c], upper[c]);
        }
        flush_pending();
    }

    void add_row(std::span<const Entry> entries, double right_hand_side) override {
        for (const Entry& e : entries) {
            pending_columns_.push_back(e.column);
            pending_coefficients_.push_back(e.coefficient);
        }
        pending_starts_.push_back(static_cast<CoinBigIndex>(pending_columns_.size()));
        pending_upper_.push_back(right_hand_side);
        pending_lower_.push_back(-COIN_DBL_MAX);
    }

    void remove_rows(std::span<const std::int32_t> rows) override {
        flush_pending();
        if (rows.empty()) return;
        const bool has_basis = simplex_.statusArray() != nullptr;
        const bool is_any_tight = has_basis && std::any_of(rows.begin(), rows.end(), [&](int r) {
                                      return simplex_.getRowStatus(r) != ClpSimplex::basic;
                                  });
        if (is_any_tight) shrink_basis(rows);
        forget_factorization();
        simplex_.deleteRows(static_cast<int>(rows.size()), rows.data());
    }

    void set_objective(std::int32_t column, double coefficient) override {
        simplex_.setObjectiveCoefficient(column, -coefficient);
    }

    void set_bounds(std::int32_t column, double lower, double upper) override {
        simplex_.setColumnBounds(column, lower, upper);
    }

    std::int32_t row_count() const override {
        return simplex_.numberRows() + static_cast<std::int32_t>(pending_upper_.size());
    }

    Outcome solve(std::int64_t max_iterations) override {
        flush_pending();
        if (simplex_.numberRows() == 0) return solve_without_rows();
        constexpr std::int64_t kMost = 1'000'000'000;
        simplex_.setNumberIterations(0);
        simplex_.setMaximumIterations(static_cast<int>(std::min(max_iterations, kMost)));
        constexpr int kKeepWorkAreas = 1, kReuseFactorization = 2;
        simplex_.dual(0, kKeepWorkAreas | kReuseFactorization);
        iterations_ = simplex_.numberIterations();
        // Status 0 can hide infeasibilities that appear once perturbation is removed.
        if (simplex_.status() == 0 && simplex_.primalFeasible() && simplex_.dualFeasible()) {
            copy_results();
            return Outcome::Optimal;
        }
        switch (simplex_.status()) {
            case 1:
                return Outcome::Infeasible;
            case 3:
            case 5:  // by the handler
                copy_results();
                return Outcome::Stopped;
            default:
                copy_results();
                return Outcome::Failed;
        }
    }

    std::int64_t iterations() const override { return iterations_; }
    void stop_when(std::function<bool()> stop) override { stop_ = std::move(stop); }
    std::span<const double> columns() const override {
        return {simplex_.primalColumnSolution(),
                static_cast<std::size_t>(simplex_.numberColumns())};
    }
    std::span<const double> activities() const override {
        return {simplex_.primalRowSolution(), static_cast<std::size_t>(simplex_.numberRows())};
    }
    std::span<const double> multipliers() const override { return multipliers_; }
    std::span<const double> reduced_costs() const override { return reduced_costs_; }

    std::vector<double> infeasibility_ray() override {
        const std::unique_ptr<double[]> ray(simplex_.infeasibilityRay());
        if (!ray) return {};
        return {ray.get(), ray.get() + simplex_.numberRows()};
    }

    Basis basis() const override {
        const int columns = simplex_.numberColumns(), rows = simplex_.numberRows();
        Basis basis(columns + rows);
        for (int c = 0; c < columns; ++c) basis[c] = translate(simplex_.getColumnStatus(c));
        for (int r = 0; r < rows; ++r) basis[columns + r] = translate(simplex_.getRowStatus(r));
        return basis;
    }

    void set_basis(const Basis& basis) override {
        flush_pending();
        if (simplex_.statusArray() == nullptr) simplex_.createStatus();
        forget_factorization();
        const int columns = simplex_.numberColumns(), rows = simplex_.numberRows();
        for (int c = 0; c < columns; ++c) simplex_.setColumnStatus(c, translate(basis[c]));
        for (int r = 0; r < rows; ++r) {
            const auto at = static_cast<std::size_t>(columns + r);
            simplex_.setRowStatus(r, at < basis.size() ? translate(basis[at]) : ClpSimplex::basic);
        }
    }

    std::vector<std::vector<double>> inverse_rows(std::span<const std::int32_t> wanted) override {
        const int columns = simplex_.numberColumns(), rows = simplex_.numberRows();
        std::vector<std::vector<double>> result(wanted.size());
        if (simplex_.pivotVariable() == nullptr || simplex_.rowArray(1) == nullptr) return result;
        std::vector<int> position(columns, -1);
        for (int r = 0; r < rows; ++r) {
            const int variable = simplex_.pivotVariable()[r];
            if (variable >= 0 && variable < columns) position[variable] = r;
        }
        for (std::size_t k = 0; k < wanted.size(); ++k) {
            if (position[wanted[k]] < 0) continue;
            result[k].assign(rows, 0.0);
            simplex_.getBInvRow(position[wanted[k]], result[k].data());
        }
        return result;
    }

private:
    void prepare() {
        simplex_.setLogLevel(0);
        simplex_.scaling(0);
        // A basis few pivots old is not factorized anew when it looks optimal, and checks of
        // optimality are fewer: what is wrong after that shows in the exact bound.
        constexpr int kRayAlways = 32, kKeepFewPivots = 2048, kFewChecks = 4096;
        simplex_.setSpecialOptions(simplex_.specialOptions() | kRayAlways | kKeepFewPivots |
                                   kFewChecks);
        const StopHandler handler(&stop_);
        simplex_.passInEventHandler(&handler);
    }

    /// Clp sees changed bounds itself, but not a changed basis.
    void forget_factorization() { simplex_.setWhatsChanged(0); }

    static BasisStatus translate(ClpSimplex::Status status) {
        switch (status) {
            case ClpSimplex::basic:
                return BasisStatus::Basic;
            case ClpSimplex::atUpperBound:
                return BasisStatus::AtUpper;
            case ClpSimplex::atLowerBound:
            case ClpSimplex::isFixed:
                return BasisStatus::AtLower;
            default:
                return BasisStatus::Free;
        }
    }
    static ClpSimplex::Status translate(BasisStatus status) {
        switch (status) {
            case BasisStatus::Basic:
                return ClpSimplex::basic;
            case BasisStatus::AtUpper:
                return ClpSimplex::atUpperBound;
            case BasisStatus::AtLower:
                return ClpSimplex::atLowerBound;
            default:
                return ClpSimplex::superBasic;
        }
    }

    void flush_pending() {
        if (!pending_upper_.empty()) {
            forget_factorization();
            simplex_.addRows(static_cast<int>(pending_upper_.size()), pending_lower_.data(),
                             pending_upper_.data(), pending_starts_.data(), pending_columns_.data(),
                             pending_coefficients_.data());
        }
        pending_lower_.clear();
        pending_upper_.clear();
        pending_columns_.clear();
        pending_coefficients_.clear();
        pending_starts_.assign(1, 0);
    }

    /// Leaves as many basic as rows stay. Rows without a multiplier do not enter into the equations
    /// of the multipliers, so these stay what they are whichever independent columns are kept: the
    /// pivots of a factorization of the rows that stay, filled up with empty ones to be square.
    void shrink_basis(std::span<const std::int32_t> removed) {
        const int columns = simplex_.numberColumns(), rows = simplex_.numberRows();
        CoinPackedMatrix matrix(*simplex_.matrix());
        matrix.deleteRows(static_cast<int>(removed.size()), removed.data());
        matrix.setDimensions(rows, columns);
        std::vector<int> kept, row_pivots(rows, -1), column_pivots(columns, -1);
        auto next = removed.begin();
        for (int r = 0; r < rows; ++r) {
            if (next != removed.end() && *next == r) {
                ++next;
                continue;
            }
            if (simplex_.getRowStatus(r) == ClpSimplex::basic) row_pivots[kept.size()] = 0;
            kept.push_back(r);
        }
        for (int c = 0; c < columns; ++c) {
            if (simplex_.getColumnStatus(c) == ClpSimplex::basic) column_pivots[c] = 0;
        }
        constexpr int kDone = 0, kSingular = -1;
        CoinFactorization factorization;
        const int status = factorization.factorize(matrix, row_pivots.data(), column_pivots.data());
        if (status == kDone || status == kSingular) keep_pivots(kept, row_pivots, column_pivots);
    }

    /// Basic without a pivot becomes nonbasic, and a row without a pivot gets its slack.
    void keep_pivots(const std::vector<int>& kept, const std::vector<int>& row_pivots,
                     const std::vector<int>& column_pivots) {
        std::vector<std::uint8_t> is_pivot(row_pivots.size(), 0);
        for (int pivot : row_pivots) {
            if (pivot >= 0) is_pivot[pivot] = 1;
        }
        for (int c = 0; c < simplex_.numberColumns(); ++c) {
            if (column_pivots[c] >= 0) {
                is_pivot[column_pivots[c]] = 1;
            } else if (simplex_.getColumnStatus(c) == ClpSimplex::basic) {
                const double middle = (simplex_.getColLower()[c] + simplex_.getColUpper()[c]) / 2;
                const bool is_up = simplex_.primalColumnSolution()[c] > middle;
                simplex_.setColumnStatus(
                    c, is_up ? ClpSimplex::atUpperBound : ClpSimplex::atLowerBound);
            }
        }
        for (std::size_t k = 0; k < kept.size(); ++k) {
            const bool was_basic = simplex_.getRowStatus(kept[k]) == ClpSimplex::basic;
            if (was_basic && row_pivots[k] < 0) {
                simplex_.setRowStatus(kept[k], ClpSimplex::atUpperBound);
            }
            if (is_pivot[k] == 0) simplex_.setRowStatus(kept[k], ClpSimplex::basic);
        }
    }

    /// Clp crashes on a problem without rows when it is asked to keep its factorization.
    Outcome solve_without_rows() {
        if (simplex_.statusArray() == nullptr) simplex_.createStatus();
        for (int c = 0; c < simplex_.numberColumns(); ++c) {
            const bool is_up = simplex_.getObjCoefficients()[c] < 0;
            simplex_.primalColumnSolution()[c] =
                is_up ? simplex_.getColUpper()[c] : simplex_.getColLower()[c];
            simplex_.dualColumnSolution()[c] = simplex_.getObjCoefficients()[c];
            simplex_.setColumnStatus(c,
                                     is_up ? ClpSimplex::atUpperBound : ClpSimplex::atLowerBound);
        }
        iterations_ = 0;
        copy_results();
        return Outcome::Optimal;
    }

    void copy_results() {
        const int columns = simplex_.numberColumns(), rows = simplex_.numberRows();
        multipliers_.resize(rows);
        reduced_costs_.resize(columns);
        for (int r = 0; r < rows; ++r) multipliers_[r] = -simplex_.dualRowSolution()[r];
        for (int c = 0; c < columns; ++c) reduced_costs_[c] = -simplex_.dualColumnSolution()[c];
    }

    std::function<bool()> stop_;
    ClpSimplex simplex_;
    std::vector<int> pending_columns_;
    std::vector<double> pending_coefficients_, pending_lower_, pending_upper_;
    std::vector<CoinBigIndex> pending_starts_{0};
    std::vector<double> multipliers_, reduced_costs_;
    std::int64_t iterations_ = 0;
};

}  // namespace

LpFactory clp_factory() {
    return [] { return std::make_unique<ClpEngine>(); };
}

}  // namespace labeling
