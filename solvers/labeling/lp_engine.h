#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace labeling {

/// What branch-and-cut needs of a linear-programming code: maximise over columns in [lower, upper]
/// subject to rows  sum <= right_hand_side. Floating point: callers recompute every bound they rely
/// on in integers from the multipliers. Implementations must be deterministic.
class LpEngine {
public:
    struct Entry {
        std::int32_t column = 0;
        double coefficient = 0;
    };
    enum class Outcome { Optimal, Infeasible, Stopped, Failed };
    enum class BasisStatus : std::uint8_t { AtLower, AtUpper, Basic, Free };
    /// One status per column, then one per row.
    using Basis = std::vector<BasisStatus>;

    virtual ~LpEngine() = default;

    /// Drops everything; columns get objective and bounds.
    virtual void reset(std::span<const double> objective, std::span<const double> lower,
                       std::span<const double> upper) = 0;
    virtual void add_row(std::span<const Entry> entries, double right_hand_side) = 0;
    /// Indices ascending; later rows move up.
    virtual void remove_rows(std::span<const std::int32_t> rows) = 0;
    virtual void set_objective(std::int32_t column, double coefficient) = 0;
    virtual void set_bounds(std::int32_t column, double lower, double upper) = 0;
    virtual std::int32_t row_count() const = 0;

    /// Dual simplex from the current basis; stops after `max_iterations`.
    virtual Outcome solve(std::int64_t max_iterations) = 0;
    virtual std::int64_t iterations() const = 0;  ///< of the last solve()
    /// Asked every few iterations of solve(); true ends it with Stopped. Empty: never.
    virtual void stop_when(std::function<bool()>) {}
    virtual std::span<const double> columns() const = 0;
    virtual std::span<const double> activities() const = 0;
    /// >= 0 for a binding row of an optimal basis.
    virtual std::span<const double> multipliers() const = 0;
    virtual std::span<const double> reduced_costs() const = 0;

    /// After Infeasible: one number per row, up to sign and scale multipliers of a contradiction;
    /// empty when the solver has none.
    virtual std::vector<double> infeasibility_ray() = 0;

    virtual Basis basis() const = 0;
    virtual void set_basis(const Basis& basis) = 0;

    /// Row of the basis inverse for each basic structural column in `columns` (one vector over rows
    /// each; empty when not available). Only after an optimal solve().
    virtual std::vector<std::vector<double>> inverse_rows(
        std::span<const std::int32_t> columns) = 0;
};

using LpFactory = std::function<std::unique_ptr<LpEngine>()>;

}  // namespace labeling
