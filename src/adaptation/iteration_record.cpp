#include "adaptation/iteration_record.h"

#include <limits>

namespace fcn {

const char* to_string(AdaptationStatus status) {
    switch (status) {
        case AdaptationStatus::Converged:
            return "converged";
        case AdaptationStatus::IterationLimit:
            return "iteration limit";
        case AdaptationStatus::SolverFailed:
            return "solver failed";
        case AdaptationStatus::Interrupted:
            return "interrupted";
    }
    return "unknown";
}

void record_counts(IterationReport& iteration, const NetworkGraph& graph,
                   const ConflictResult& conflicts) {
    iteration.segments = graph.graph.segments.size();
    for (const GraphSegment& segment : graph.graph.segments) {
        iteration.short_segments += segment.is_short;
        iteration.long_segments += segment.is_long;
    }
    for (std::size_t v = 0; v < graph.graph.nodes.size(); ++v) {
        iteration.extraordinary_nodes +=
            graph.graph.nodes[v].is_extraordinary && !graph.graph.incident[v].empty();
    }
    for (const Conflict& conflict : conflicts.conflicts) {
        iteration.angle_conflicts += conflict.kind == ConflictKind::Angle;
        iteration.distance_conflicts += conflict.kind == ConflictKind::Distance;
        iteration.crossing_conflicts += conflict.kind == ConflictKind::Crossing;
        iteration.node_conflicts += conflict.kind == ConflictKind::Nodes;
    }
    iteration.vertex_conflicts = conflicts.vertex_conflicts.size();
    iteration.exempt_pairs = conflicts.exempt.size();
}

void record_solve(IterationReport& iteration, const labeling::LabelingProblem& problem,
                  const labeling::SolveResult& result, const labeling::Solution& solution,
                  int labels) {
    const double units = problem.units_per_one();
    iteration.labels = static_cast<std::size_t>(labels);
    iteration.conflicts = problem.conflict_count();
    iteration.bonuses = problem.bonus_count();
    iteration.rules = problem.rule_count();
    const auto components = result.statistics.find("components");
    if (components != result.statistics.end()) {
        iteration.components = static_cast<std::size_t>(components->second);
    }
    iteration.status = result.status;
    iteration.stop_reason = result.stop_reason;
    iteration.value = static_cast<double>(solution.value) / units;
    iteration.bound = result.bound ? static_cast<double>(*result.bound) / units
                                   : std::numeric_limits<double>::quiet_NaN();
    iteration.units_per_one = units;
}

}  // namespace fcn
