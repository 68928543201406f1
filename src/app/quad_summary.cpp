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

Json quad_result_json(const QuadResult& result, bool has_timings) {
    Json json{{"tier", to_string(result.tier)},
              {"reason", result.reason},
              {"edge_length", result.edge_length},
              {"feature_edges", result.mesh.feature_edges.size()},
              {"broken_segments", result.broken_segments},
              {"warnings", result.warnings}};
    if (has_timings) json["seconds"] = result.seconds;
    return json;
}

Json quad_record_json(const QuadRecord& quads, bool has_timings) {
    Json json = quad_result_json(quads.result, has_timings);
    json["quads"] = quad_quality_json(quads.quality);
    json["distance"] = {{"hausdorff", quads.distance.hausdorff},
                        {"mean_forward", quads.distance.mean_forward},
                        {"mean_backward", quads.distance.mean_backward},
                        {"samples", quads.distance.samples},
                        {"reference_diagonal", quads.distance.diagonal}};
    json["alignment"] = alignment_json(quads.alignment);
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
