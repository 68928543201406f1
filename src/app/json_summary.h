#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/common_arguments.h"
#include "labeling/solver.h"
#include "report/report.h"

namespace fcn::app {

/// Keys stay in the order in which they are documented (docs/command-line.md).
using Json = nlohmann::ordered_json;

Json mesh_json(const LoadedMesh& mesh);
Json network_json(const FeatureCurveNetwork& network);
Json adaptation_json(const AdaptationResult& result, const FeatureCurveNetwork& initial,
                     bool has_timings);
/// Counts and verdict; `is_detailed` adds every violation.
Json conformity_json(const ConformityReport& report, bool is_detailed);
/// `target` > 0 adds the target edge length and the shortest edge relative to it.
Json quality_json(const TriangleQuality& quality, double target = 0);
Json normals_json(const NormalDeviation& normals);
Json feature_deviation_json(const FeatureDeviation& features);
/// One way to a mesh: its name, and its measures or why there is no mesh.
Json comparison_json(const ComparisonRow& row, double edge_length, bool has_timings);
Json solver_comparisons_json(const std::vector<SolverComparison>& solvers, bool has_timings);
Json solve_result_json(const labeling::LabelingProblem& problem,
                       const labeling::SolveResult& result, bool has_timings);

void print_json(const Json& json);

}  // namespace fcn::app
