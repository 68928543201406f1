#pragma once

#include "report/html.h"
#include "report/report.h"

namespace fcn {

/// What a mesh engineer reads: triangles on the initial and on the adapted network.
HtmlTable engineer_table();
/// The rows of one mesh in it.
void add_engineer_rows(const MeshRecord& mesh, HtmlTable& table);

/// Every way to a mesh of this scale that was taken, measured alike; distances in percent of
/// `diagonal`.
HtmlTable ways_table(const ScaleRecord& scale, double diagonal);

/// The quads of this scale; distances in percent of `diagonal`.
HtmlTable quad_table(const QuadRecord& quads, double diagonal);

/// Every solver on every problem of one scale, side by side.
HtmlTable solver_table(const ScaleRecord& scale, bool has_timings);

/// Conflicts, labels and what became of them, per iteration.
HtmlTable iteration_table(const ScaleRecord& scale, bool has_timings);

/// Dropped pieces by reason: count, length, weight.
HtmlTable reason_table(const FeatureCurveNetwork& network);

/// The heaviest dropped pieces and what was kept against them.
HtmlTable heaviest_drops_table(const FeatureCurveNetwork& network, std::size_t count);

/// Violations of strict conformity, those in the verdict first, at most `count`.
HtmlTable violation_table(const ConformityReport& report, std::size_t count);

}  // namespace fcn
