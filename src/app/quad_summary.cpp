#include "app/quad_summary.h"

#include <fmt/core.h>

namespace fcn::app {

std::string to_string(QuadTier tier) { return tier == QuadTier::Field ? "field" : "pairing"; }

Json quad_quality_json(const QuadQuality& quality) {
    return {{"vertices", quality.vertices},
            {"faces", quality.faces},
            {"mean_scaled_jacobian", quality.mean_scaled_jacobian},
            {"min_scaled_jacobian", quality.min_scaled_jacobian},
            {"inverted_corners", quality.inverted_corners},
            {"inner_vertices", quality.inner_vertices},
            {"share_irregular", quality.share_irregular},
            {"close_singularities", quality.close_singularities},
            {"min_edge", quality.min_edge},
            {"mean_edge", quality.mean_edge},
            {"max_edge", quality.max_edge}};
}

Json alignment_json(const QuadAlignment& alignment) {
    return {{"mean_degrees", alignment.mean_degrees},
            {"max_degrees", alignment.max_degrees},
            {"share_over_10_degrees", alignment.share_over_10},
            {"samples", alignment.samples}};
}

Json attempts_json(const std::vector<QuadAttempt>& attempts, bool has_timings) {
    Json json = Json::array();
    for (const QuadAttempt& attempt : attempts) {
        json.push_back({{"edge_length", attempt.edge_length},
                        {"triangles", attempt.triangles},
                        {"singularities", attempt.singularities},
                        {"step", attempt.step},
                        {"reason", attempt.reason}});
        if (has_timings)
            json.back()["seconds"] = {{"domain", attempt.domain},
                                      {"field", attempt.field},
                                      {"map", attempt.map},
                                      {"extraction", attempt.extraction},
                                      {"smoothing", attempt.smoothing}};
    }
    return json;
}

Json quad_result_json(const QuadResult& result, bool has_timings) {
    Json json{{"tier", to_string(result.tier)},
              {"reason", result.reason},
              {"edge_length", result.edge_length},
              {"feature_edges", result.mesh.feature_edges.size()},
              {"broken_segments", result.broken_segments},
              {"warnings", result.warnings},
              {"attempts", attempts_json(result.attempts, has_timings)}};
    if (has_timings) json["seconds"] = result.seconds;
    return json;
}

namespace {

void add_measures(Json& json, const QuadQuality& quality, const MeshDistance& distance,
                  const QuadAlignment& alignment) {
    json["quads"] = quad_quality_json(quality);
    json["distance"] = {{"hausdorff", distance.hausdorff},
                        {"mean_forward", distance.mean_forward},
                        {"mean_backward", distance.mean_backward},
                        {"samples", distance.samples},
                        {"reference_diagonal", distance.diagonal}};
    json["alignment"] = alignment_json(alignment);
}

}  // namespace

Json quad_record_json(const QuadRecord& quads, bool has_timings) {
    Json json = quad_result_json(quads.result, has_timings);
    add_measures(json, quads.quality, quads.distance, quads.alignment);
    return json;
}

Json quad_comparison_json(const QuadComparisonRow& row, bool has_timings) {
    Json json{{"way", row.name}};
    if (!row.failure.empty()) {
        json["failure"] = row.failure;
        return json;
    }
    json.update(quad_result_json(row.result, has_timings));
    add_measures(json, row.quality, row.distance, row.alignment);
    if (has_timings) json["cpu_seconds"] = row.cpu_seconds;
    return json;
}

std::string quad_quality_text(const QuadQuality& quality) {
    return fmt::format(
        "{} vertices, {} quads; scaled Jacobian {:.3f} on the average, {:.3f} at least; {:.2f} % "
        "of "
        "inner vertices irregular, {} inverted corners",
        quality.vertices, quality.faces, quality.mean_scaled_jacobian, quality.min_scaled_jacobian,
        100 * quality.share_irregular, quality.inverted_corners);
}

}  // namespace fcn::app
