#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "labeling/problem.h"
#include "labeling/shrink.h"
#include "labeling/solution.h"

namespace labeling_test {

using labeling::LabelingProblem;
using labeling::Value;

/// Uniform integer in [low, high], the same on every platform.
std::int64_t pick(std::mt19937_64& engine, std::int64_t low, std::int64_t high);

/// Any small problem: conflicts, bonuses and rules of every kind and sign; often infeasible.
LabelingProblem random_problem(std::mt19937_64& engine, int most_labels);

/// A small problem whose linear relaxation is far from integral: many conflicts and bonuses of
/// nearly equal worth, triples b_i + b_j + b_k <= 2 and stars with a keep-label. Always feasible.
LabelingProblem frustrated_problem(std::mt19937_64& engine, int labels);

struct BundleOptions {
    int curves = 6;
    int segments = 8;        ///< per curve
    int crossings = 3;       ///< extraordinary nodes joining neighbouring curves
    int short_percent = 20;  ///< segments with a support rule
    int reach = 1;           ///< conflicts reach over so many neighbouring curves
    Value bonus = 1000;      ///< largest bonus along a curve
};

/// Parallel curves with bonuses along them and conflicts between neighbours, joined at nodes with
/// keep-labels and valence rules; short segments with support and inherited-conflict rules.
LabelingProblem curve_bundle(std::mt19937_64& engine, const BundleOptions& options);

/// A best of all 2^n labelings by plain evaluation; nullopt when none is feasible.
std::optional<labeling::Solution> enumerate_best(const LabelingProblem& problem);

/// Best value over all 2^n labelings by plain evaluation; nullopt when none is feasible.
std::optional<Value> enumerate_optimum(const LabelingProblem& problem);

/// Values of all labelings, infeasible ones as nullopt; label i is bit i of the index.
std::vector<std::optional<Value>> all_values(const LabelingProblem& problem);

/// The same problem with label i renamed to order[i].
LabelingProblem permuted(const LabelingProblem& problem, const std::vector<labeling::Label>& order);

}  // namespace labeling_test
