#pragma once

#include "app/json_summary.h"
#include "meshing/measure.h"
#include "meshing/quad_comparison.h"
#include "meshing/quad_quality.h"
#include "meshing/remesh_quads.h"

namespace fcn::app {

Json quad_quality_json(const QuadQuality& quality);
Json alignment_json(const QuadAlignment& alignment);
/// Tries at a field: edge length, size, and where and why each ended.
Json attempts_json(const std::vector<QuadAttempt>& attempts, bool has_timings);
/// How quads were made, without measures: tier, reason, edge length, ...
Json quad_result_json(const QuadResult& result, bool has_timings);
/// The same with measures.
Json quad_record_json(const QuadRecord& quads, bool has_timings);
/// One way to quads: its name, and as above or why there are none.
Json quad_comparison_json(const QuadComparisonRow& row, bool has_timings);
std::string to_string(QuadTier tier);

/// One line: counts, scaled Jacobians, irregular vertices, inverted corners.
std::string quad_quality_text(const QuadQuality& quality);

}  // namespace fcn::app
