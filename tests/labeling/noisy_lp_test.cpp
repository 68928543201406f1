// Branch and cut on top of an LP solver that lies: multipliers and values are disturbed, some
// solves claim to be infeasible or to have failed. The answers must be exact all the same.
#include <gtest/gtest.h>

#include "labeling/exact_search.h"
#include "labeling/problems.h"
#include "labeling_mip/mip_solvers.h"

namespace labeling_test {
namespace {

using labeling::LpEngine;

class NoisyEngine final : public LpEngine {
public:
    NoisyEngine(std::unique_ptr<LpEngine> engine, double noise, std::uint64_t seed)
        : engine_(std::move(engine)), noise_(noise), random_(seed) {}

    void reset(std::span<const double> objective, std::span<const double> lower,
               std::span<const double> upper) override {
        engine_->reset(objective, lower, upper);
    }
    void add_row(std::span<const Entry> entries, double right_hand_side) override {
        engine_->add_row(entries, right_hand_side);
    }
    void remove_rows(std::span<const std::int32_t> rows) override { engine_->remove_rows(rows); }
    void set_objective(std::int32_t column, double coefficient) override {
        engine_->set_objective(column, coefficient);
    }
    void set_bounds(std::int32_t column, double lower, double upper) override {
        engine_->set_bounds(column, lower, upper);
    }
    std::int32_t row_count() const override { return engine_->row_count(); }

    Outcome solve(std::int64_t max_iterations) override {
        Outcome outcome = engine_->solve(max_iterations);
        columns_ = disturbed(engine_->columns());
        activities_ = disturbed(engine_->activities());
        multipliers_ = disturbed(engine_->multipliers());
        reduced_costs_ = disturbed(engine_->reduced_costs());
        const std::int64_t lie = pick(random_, 0, 29);
        if (lie == 0) outcome = Outcome::Infeasible;
        if (lie == 1) outcome = Outcome::Failed;
        if (lie == 2 && outcome == Outcome::Infeasible) outcome = Outcome::Failed;
        return outcome;
    }
    std::int64_t iterations() const override { return engine_->iterations(); }
    std::span<const double> columns() const override { return columns_; }
    std::span<const double> activities() const override { return activities_; }
    std::span<const double> multipliers() const override { return multipliers_; }
    std::span<const double> reduced_costs() const override { return reduced_costs_; }

    std::vector<double> infeasibility_ray() override {
        std::vector<double> ray = disturbed(engine_->infeasibility_ray());
        if (ray.empty()) ray.assign(static_cast<std::size_t>(row_count()), 1.0);
        return ray;
    }
    Basis basis() const override { return engine_->basis(); }
    void set_basis(const Basis& basis) override { engine_->set_basis(basis); }
    std::vector<std::vector<double>> inverse_rows(std::span<const std::int32_t> columns) override {
        auto rows = engine_->inverse_rows(columns);
        for (auto& row : rows) row = disturbed(row);
        return rows;
    }

private:
    std::vector<double> disturbed(std::span<const double> numbers) {
        std::vector<double> noisy(numbers.begin(), numbers.end());
        for (double& number : noisy) {
            const auto draw = static_cast<double>(pick(random_, -1000, 1000)) / 1000;
            number += noise_ * draw * (1 + std::abs(number));
        }
        return noisy;
    }

    std::unique_ptr<LpEngine> engine_;
    double noise_;
    std::mt19937_64 random_;
    std::vector<double> columns_, activities_, multipliers_, reduced_costs_;
};

class NoisyLp : public testing::TestWithParam<double> {};

TEST_P(NoisyLp, LeavesTheOptimumAlone) {
    for (int k = 0; k < 400; ++k) {
        const std::uint64_t seed = 60000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            k % 3 == 0 ? random_problem(engine, 10) : frustrated_problem(engine, 6 + k % 5);
        const auto factory = [seed] {
            return std::make_unique<NoisyEngine>(labeling::clp_factory()(), GetParam(), seed);
        };
        labeling::SolveOptions options;
        options.extra = {{"tree-size", "0"}, {"heuristics", "off"}};
        const auto result =
            labeling::make_branch_and_bound_solver(factory)->solve(problem, options);
        const auto optimum = enumerate_optimum(problem);
        ASSERT_EQ(result.status,
                  optimum ? labeling::SolveStatus::Optimal : labeling::SolveStatus::Infeasible)
            << "seed " << seed;
        if (optimum) {
            ASSERT_EQ(result.solution->value, *optimum) << "seed " << seed;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(SmallAndLarge, NoisyLp, testing::Values(1e-9, 1e-4, 0.05, 1.0),
                         [](const auto& param) { return "noise_" + std::to_string(param.index); });

}  // namespace
}  // namespace labeling_test
