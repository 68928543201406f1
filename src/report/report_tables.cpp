#include "report/report_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace fcn {
namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBlockersShown = 8;

using Row = std::vector<std::string>;

std::string count_text(std::size_t count) { return std::to_string(count); }

Row quality_cells(const TriangleQuality& quality, double edge_length, bool is_known) {
    if (!is_known) return Row(5, format_number(kUnknown, 0));
    return {count_text(quality.faces), format_number(quality.min_angle_degrees, 1) + "\u00b0",
            format_percent(quality.share_under_15, 2), format_percent(quality.share_under_30, 2),
            format_number(quality.min_edge / edge_length, 2)};
}

std::string conforming_text(const ScaleRecord& scale) {
    if (scale.conformity.is_conforming()) return "yes";
    return "no (" + count_text(scale.conformity.counted) + ")";
}

double length_of(const std::vector<Vec3>& polyline) {
    double length = 0;
    for (std::size_t i = 1; i < polyline.size(); ++i)
        length += (polyline[i] - polyline[i - 1]).norm();
    return length;
}

/// "12 (distance, arc 47)"
std::string blocker_text(const Blocker& blocker) {
    std::string text = std::to_string(blocker.label + 1);
    if (blocker.conflict.empty()) return text;
    text += " (" + blocker.conflict;
    if (blocker.origin_arc >= 0) text += ", arc " + std::to_string(blocker.origin_arc);
    return text + ")";
}

std::string blockers_text(const DroppedPiece& piece) {
    if (piece.blockers.empty()) return format_number(kUnknown, 0);
    std::string text;
    for (std::size_t i = 0; i < std::min(kBlockersShown, piece.blockers.size()); ++i)
        text += (i > 0 ? ", " : "") + blocker_text(piece.blockers[i]);
    const std::size_t rest =
        piece.blockers.size() - std::min(kBlockersShown, piece.blockers.size());
    return rest > 0 ? text + " and " + count_text(rest) + " more" : text;
}

double total_seconds(const IterationReport& iteration) {
    double seconds = 0;
    for (const auto& [phase, value] : iteration.seconds) seconds += value;
    return seconds;
}

}  // namespace

HtmlTable engineer_table(const std::vector<MeshRecord>& meshes) {
    HtmlTable table;
    table.caption = "Triangle meshes made with the initial and with the adapted network protected";
    table.header = {"Mesh",           "Scale",          "Network",
                    "Target edge",    "Triangles",      "Smallest angle",
                    "Under 15\u00b0", "Under 30\u00b0", "Shortest edge / target",
                    "Coverage",       "Conforming"};
    table.row_headers = 3;
    table.text_columns = 3;
    for (const MeshRecord& mesh : meshes) {
        for (const ScaleRecord& scale : mesh.scales) {
            const double edge = kEdgeLengthFactor * scale.rmin;
            const std::string dash = format_number(kUnknown, 0);
            Row initial{mesh.mesh.name, scale.label, "initial", format_significant(edge)};
            const Row before = quality_cells(scale.initial_quality, edge, scale.has_initial_remesh);
            initial.insert(initial.end(), before.begin(), before.end());
            initial.insert(initial.end(), {format_percent(1), dash});
            Row adapted{mesh.mesh.name, scale.label, "adapted", format_significant(edge)};
            const Row after = quality_cells(scale.remesh_quality, edge, scale.has_remesh);
            adapted.insert(adapted.end(), after.begin(), after.end());
            adapted.insert(adapted.end(), {format_percent(scale.adaptation.report.coverage),
                                           conforming_text(scale)});
            table.rows.push_back(std::move(initial));
            table.rows.push_back(std::move(adapted));
            table.is_emphasized.insert(table.is_emphasized.end(), {false, true});
        }
    }
    return table;
}

HtmlTable solver_table(const ScaleRecord& scale, bool has_timings) {
    HtmlTable table;
    table.caption = "Solvers side by side";
    table.header = {"Problem", "Solver", "Status", "Value", "Bound", "Gap"};
    if (has_timings) table.header.push_back("Seconds");
    table.row_headers = 2;
    table.text_columns = 3;
    std::map<std::string, double> best;
    for (const SolverComparison& solver : scale.solvers) {
        if (!std::isfinite(solver.value)) continue;
        const auto [it, is_new] = best.try_emplace(solver.problem, solver.value);
        if (!is_new) it->second = std::max(it->second, solver.value);
    }
    for (const SolverComparison& solver : scale.solvers) {
        Row row{solver.problem,
                solver.solver,
                solver.status,
                format_number(solver.value, 3),
                format_number(solver.bound, 3),
                format_percent(solver.gap, 3)};
        if (has_timings) row.push_back(format_number(solver.seconds, 2));
        table.rows.push_back(std::move(row));
        const auto it = best.find(solver.problem);
        table.is_emphasized.push_back(it != best.end() && solver.value == it->second);
    }
    return table;
}

HtmlTable iteration_table(const ScaleRecord& scale, bool has_timings) {
    HtmlTable table;
    table.caption = "Conflicts and decisions per iteration";
    table.header = {"Iteration", "Segments",  "short",     "long",   "Angle conflicts",
                    "Distance",  "Crossing",  "Node",      "Vertex", "Thin-wall exempt",
                    "Labels",    "Conflicts", "Bonuses",   "Rules",  "Components",
                    "Kept",      "Dropped",   "Collapsed", "Status", "Value",
                    "Bound"};
    if (has_timings) table.header.push_back("Seconds");
    table.text_columns = 1;
    for (const IterationReport& it : scale.adaptation.report.iterations) {
        Row row{std::to_string(it.iteration)};
        for (const std::size_t count :
             {it.segments, it.short_segments, it.long_segments, it.angle_conflicts,
              it.distance_conflicts, it.crossing_conflicts, it.node_conflicts, it.vertex_conflicts,
              it.exempt_pairs, it.labels, it.conflicts, it.bonuses, it.rules, it.components,
              it.kept, it.dropped, it.collapsed})
            row.push_back(count_text(count));
        row.emplace_back(labeling::to_string(it.status));
        row.push_back(format_number(it.value, 3));
        row.push_back(format_number(it.bound, 3));
        if (has_timings) row.push_back(format_number(total_seconds(it), 2));
        table.rows.push_back(std::move(row));
    }
    return table;
}

HtmlTable reason_table(const FeatureCurveNetwork& network) {
    struct Sum {
        std::size_t count = 0;
        double length = 0, weight = 0;
    };
    std::map<std::string, Sum> sums;
    for (const DroppedPiece& piece : network.dropped) {
        Sum& sum = sums[piece.reason.empty() ? "not recorded" : piece.reason];
        ++sum.count;
        sum.length += length_of(piece.polyline);
        sum.weight += piece.weight;
    }
    HtmlTable table;
    table.caption = "Why pieces were dropped";
    table.header = {"Reason", "Pieces", "Length", "Weight"};
    for (const auto& [reason, sum] : sums)
        table.rows.push_back({reason, count_text(sum.count), format_significant(sum.length),
                              format_number(sum.weight, 3)});
    return table;
}

HtmlTable heaviest_drops_table(const FeatureCurveNetwork& network, std::size_t count) {
    std::vector<std::size_t> order(network.dropped.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return network.dropped[a].weight > network.dropped[b].weight;
    });
    order.resize(std::min(count, order.size()));
    HtmlTable table;
    table.caption = "The heaviest dropped pieces and the labels kept against them";
    table.header = {"Reason",    "Initial arc", "Weight", "Length",
                    "Iteration", "Label",       "Margin", "Blockers"};
    for (const std::size_t i : order) {
        const DroppedPiece& piece = network.dropped[i];
        table.rows.push_back(
            {piece.reason, piece.origin_arc < 0 ? "\u2013" : std::to_string(piece.origin_arc),
             format_number(piece.weight, 3), format_significant(length_of(piece.polyline)),
             std::to_string(piece.iteration),
             piece.label < 0 ? "\u2013" : std::to_string(piece.label + 1),
             piece.margin ? format_number(*piece.margin, 3) : "\u2013", blockers_text(piece)});
    }
    return table;
}

HtmlTable violation_table(const ConformityReport& report, std::size_t count) {
    std::vector<const Violation*> order;
    for (const Violation& violation : report.violations) order.push_back(&violation);
    const auto rank = [](const Violation* v) {
        return v->is_exempt ? 2 : v->is_input_forced ? 1 : 0;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const Violation* a, const Violation* b) { return rank(a) < rank(b); });
    order.resize(std::min(count, order.size()));
    HtmlTable table;
    table.caption = "Violations of strict conformity";
    table.header = {"Kind", "Counts", "Items", "Measured", "Required", "Where"};
    table.text_columns = 2;
    for (const Violation* v : order) {
        const bool is_angle = v->kind == ViolationKind::Angle;
        const auto measure = [&](double value) {
            return is_angle ? format_number(value * kDegreesPerRadian, 2) + "\u00b0"
                            : format_significant(value, 5);
        };
        std::string items = std::to_string(v->first);
        if (v->second >= 0) items += ", " + std::to_string(v->second);
        const Vec3& at = v->witness_first;
        table.rows.push_back({to_string(v->kind),
                              v->is_exempt         ? "no: thin wall"
                              : v->is_input_forced ? "no: forced by the input"
                                                   : "yes",
                              items, measure(v->measured), measure(v->required),
                              format_significant(at[0]) + ", " + format_significant(at[1]) + ", " +
                                  format_significant(at[2])});
    }
    return table;
}

}  // namespace fcn
