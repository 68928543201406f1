#include "app/json_summary.h"

#include <fmt/core.h>

#include <numbers>

namespace fcn::app {
namespace {

Json point_json(const Vec3& point) { return Json::array({point.x(), point.y(), point.z()}); }

Json iteration_json(const IterationReport& iteration, bool has_timings) {
    Json json{{"iteration", iteration.iteration},
              {"segments", iteration.segments},
              {"short_segments", iteration.short_segments},
              {"long_segments", iteration.long_segments},
              {"extraordinary_nodes", iteration.extraordinary_nodes},
              {"angle_conflicts", iteration.angle_conflicts},
              {"distance_conflicts", iteration.distance_conflicts},
              {"crossing_conflicts", iteration.crossing_conflicts},
              {"node_conflicts", iteration.node_conflicts},
              {"vertex_conflicts", iteration.vertex_conflicts},
              {"exempt_pairs", iteration.exempt_pairs},
              {"labels", iteration.labels},
              {"conflicts", iteration.conflicts},
              {"bonuses", iteration.bonuses},
              {"rules", iteration.rules},
              {"components", iteration.components},
              {"kept", iteration.kept},
              {"dropped", iteration.dropped},
              {"collapsed", iteration.collapsed},
              {"status", labeling::to_string(iteration.status)},
              {"stop_reason", labeling::to_string(iteration.stop_reason)},
              {"value", iteration.value},
              {"bound", iteration.bound},
              {"units_per_one", iteration.units_per_one}};
    if (has_timings) json["seconds"] = iteration.seconds;
    return json;
}

Json violation_json(const Violation& violation) {
    const bool is_angle = violation.kind == ViolationKind::Angle;
    const double unit = is_angle ? 180 / std::numbers::pi : 1.0;
    const char* suffix = is_angle ? "_degrees" : "";
    return {{"kind", to_string(violation.kind)},
            {"first", violation.first},
            {"second", violation.second},
            {fmt::format("measured{}", suffix), violation.measured * unit},
            {fmt::format("required{}", suffix), violation.required * unit},
            {"witness_first", point_json(violation.witness_first)},
            {"witness_second", point_json(violation.witness_second)},
            {"input_forced", violation.is_input_forced},
            {"exempt", violation.is_exempt}};
}

}  // namespace

Json mesh_json(const LoadedMesh& mesh) {
    return {{"name", mesh.name},
            {"vertices", mesh.mesh.n_vertices()},
            {"faces", mesh.mesh.n_faces()},
            {"diagonal", bounding_box(mesh.mesh).diagonal()},
            {"repairs", mesh.repairs.messages()}};
}

Json network_json(const FeatureCurveNetwork& network) {
    return {{"nodes", network.nodes.size()},
            {"arcs", network.arcs.size()},
            {"segments", network.segments.size()},
            {"curves", network.curves.size()},
            {"orbits", network.orbits.size()},
            {"length", network.total_length()},
            {"notes", network.notes}};
}

Json adaptation_json(const AdaptationResult& result, const FeatureCurveNetwork& initial,
                     bool has_timings) {
    const AdaptationReport& report = result.report;
    Json json{{"status", to_string(report.status)}, {"optimal", report.is_optimal}};
    // The first problem is where the choice is made; later ones tidy up after collapses.
    if (!report.iterations.empty()) {
        json["value"] = report.iterations.front().value;
        json["bound"] = report.iterations.front().bound;
    } else {
        json["value"] = nullptr;
        json["bound"] = nullptr;
    }
    json["initial_arcs"] = initial.arcs.size();
    json["arcs"] = result.network.arcs.size();
    json["nodes"] = result.network.nodes.size();
    json["segments"] = result.network.segments.size();
    json["dropped_pieces"] = result.network.dropped.size();
    json["initial_length"] = report.initial_length;
    json["final_length"] = report.final_length;
    json["coverage"] = report.coverage;
    json["iterations"] = Json::array();
    for (const IterationReport& iteration : report.iterations)
        json["iterations"].push_back(iteration_json(iteration, has_timings));
    json["exempt_pairs"] = Json::array();
    for (const ThinWallPair& pair : report.exempt)
        json["exempt_pairs"].push_back(
            {{"first", pair.first}, {"second", pair.second}, {"distance", pair.distance}});
    json["warnings"] = report.warnings;
    if (has_timings) json["seconds"] = report.seconds;
    return json;
}

Json conformity_json(const ConformityReport& report, bool is_detailed) {
    Json json{{"conforming", report.is_conforming()},
              {"violations", report.counted},
              {"input_forced", report.input_forced},
              {"exempt", report.exempt},
              {"long_segments", report.long_segments},
              {"max_distance_ratio", report.max_distance_ratio},
              {"distance_ratio_pairs", report.distance_ratio_pairs},
              {"distance_ratio_over_two", report.distance_ratio_over_two}};
    if (!is_detailed) return json;
    json["details"] = Json::array();
    for (const Violation& violation : report.violations)
        json["details"].push_back(violation_json(violation));
    return json;
}

Json quality_json(const TriangleQuality& quality, double target) {
    Json json{{"vertices", quality.vertices},
              {"faces", quality.faces},
              {"min_angle_degrees", quality.min_angle_degrees},
              {"mean_min_angle_degrees", quality.mean_min_angle_degrees},
              {"share_under_15_degrees", quality.share_under_15},
              {"share_under_30_degrees", quality.share_under_30},
              {"min_edge", quality.min_edge},
              {"mean_edge", quality.mean_edge},
              {"max_edge", quality.max_edge},
              {"min_radius_ratio", quality.min_radius_ratio},
              {"mean_radius_ratio", quality.mean_radius_ratio},
              {"share_regular", quality.share_regular},
              {"min_valence", quality.min_valence},
              {"max_valence", quality.max_valence}};
    if (target > 0) {
        json["target_edge"] = target;
        json["min_edge_over_target"] = quality.min_edge / target;
    }
    return json;
}

Json normals_json(const NormalDeviation& normals) {
    return {{"mean_degrees", normals.mean_degrees}, {"rms_degrees", normals.rms_degrees}};
}

Json feature_deviation_json(const FeatureDeviation& features) {
    return {{"max", features.max},
            {"mean", features.mean},
            {"max_node", features.max_node},
            {"mean_node", features.mean_node},
            {"samples", features.samples}};
}

Json comparison_json(const ComparisonRow& row, double edge_length, bool has_timings) {
    Json json{{"way", row.name}};
    if (!row.failure.empty()) {
        json["failure"] = row.failure;
        return json;
    }
    json["triangles"] = quality_json(row.quality, edge_length);
    json["edges"] = {
        {"below", row.edges.below}, {"inside", row.edges.inside}, {"above", row.edges.above}};
    json["distance"] = {{"hausdorff", row.distance.hausdorff},
                        {"mean_forward", row.distance.mean_forward},
                        {"mean_backward", row.distance.mean_backward},
                        {"samples", row.distance.samples},
                        {"reference_diagonal", row.distance.diagonal}};
    json["normals"] = normals_json(row.normals);
    json["features"] = feature_deviation_json(row.features);
    json["broken_segments"] = row.broken_segments;
    json["forced_faces"] = row.forced_faces;
    json["self_intersections"] = row.self_intersections;
    json["warnings"] = row.warnings;
    if (has_timings) json["cpu_seconds"] = row.cpu_seconds;
    return json;
}

Json solver_comparisons_json(const std::vector<SolverComparison>& solvers, bool has_timings) {
    Json list = Json::array();
    for (const SolverComparison& row : solvers) {
        Json json{{"problem", row.problem}, {"solver", row.solver}, {"status", row.status},
                  {"value", row.value},     {"bound", row.bound},   {"gap", row.gap}};
        if (has_timings) json["seconds"] = row.seconds;
        list.push_back(std::move(json));
    }
    return list;
}

Json solve_result_json(const labeling::LabelingProblem& problem,
                       const labeling::SolveResult& result, bool has_timings) {
    const auto or_null = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
    Json json{{"labels", problem.label_count()},
              {"conflicts", problem.conflict_count()},
              {"bonuses", problem.bonus_count()},
              {"rules", problem.rule_count()},
              {"units_per_one", problem.units_per_one()},
              {"solver", result.solver},
              {"status", labeling::to_string(result.status)},
              {"stop_reason", labeling::to_string(result.stop_reason)},
              {"value", result.solution ? Json(result.solution->value) : Json(nullptr)},
              {"bound", or_null(result.bound)},
              {"gap", or_null(result.relative_gap())},
              {"work", result.work},
              {"message", result.message}};
    if (!has_timings) return json;
    json["seconds"] = result.seconds;
    json["statistics"] = result.statistics;
    json["trace"] = Json::array();
    for (const labeling::TracePoint& point : result.trace)
        json["trace"].push_back({{"seconds", point.seconds},
                                 {"work", point.work},
                                 {"value", or_null(point.value)},
                                 {"bound", or_null(point.bound)}});
    return json;
}

void print_json(const Json& json) { fmt::print("{}\n", json.dump(2)); }

}  // namespace fcn::app
