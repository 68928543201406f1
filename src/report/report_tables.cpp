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

/// A length in percent of another; a dash if it was not measured.
std::string share_of(double length, double whole, int digits) {
    return format_percent(whole > 0 ? length / whole : kUnknown, digits);
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

HtmlTable engineer_table() {
    HtmlTable table;
    table.caption = "Triangle meshes made with the initial and with the adapted network protected";
    table.header = {"Mesh",           "Scale",          "Network",
                    "Target edge",    "Triangles",      "Smallest angle",
                    "Under 15\u00b0", "Under 30\u00b0", "Shortest edge / target",
                    "Hausdorff",      "Coverage",       "Conforming"};
    table.row_headers = 3;
    table.text_columns = 3;
    return table;
}

void add_engineer_rows(const MeshRecord& mesh, HtmlTable& table) {
    const std::string dash = format_number(kUnknown, 0);
    for (const ScaleRecord& scale : mesh.scales) {
        const double edge = kEdgeLengthFactor * scale.rmin;
        const ComparisonRow none;
        const ComparisonRow& on_initial =
            scale.has_initial_remesh && !scale.compared.empty() ? scale.compared.front().row : none;
        const auto add = [&](const char* network, const TriangleQuality& quality, bool is_known,
                             const ComparisonRow& measured, const Row& last) {
            Row row{mesh.mesh.name, scale.label, network, format_significant(edge)};
            const Row cells = quality_cells(quality, edge, is_known);
            row.insert(row.end(), cells.begin(), cells.end());
            row.push_back(share_of(measured.distance.hausdorff, measured.distance.diagonal, 2));
            row.insert(row.end(), last.begin(), last.end());
            table.rows.push_back(std::move(row));
        };
        add("initial", scale.initial_quality, scale.has_initial_remesh, on_initial,
            {format_percent(1), dash});
        add("adapted", scale.remesh_quality, scale.has_remesh, scale.remesh_row,
            {format_percent(scale.adaptation.report.coverage), conforming_text(scale)});
        table.is_emphasized.insert(table.is_emphasized.end(), {false, true});
    }
}

HtmlTable ways_table(const ScaleRecord& scale, double diagonal) {
    HtmlTable table;
    table.caption = "Ways to a mesh of this edge length, measured against the input";
    table.header = {"Way",
                    "Triangles",
                    "Smallest angle",
                    "Under 15\u00b0",
                    "Under 30\u00b0",
                    "Edges within S",
                    "Hausdorff",
                    "Mean distance",
                    "Normals off",
                    "Kept curves off"};
    const auto add = [&](const std::string& name, const ComparisonRow& row) {
        Row cells{name};
        if (!row.failure.empty()) {
            cells.push_back("failed: " + row.failure);
            cells.resize(table.header.size(), format_number(kUnknown, 0));
        } else {
            cells.insert(cells.end(), {count_text(row.quality.faces),
                                       format_number(row.quality.min_angle_degrees, 1) + "\u00b0",
                                       format_percent(row.quality.share_under_15, 2),
                                       format_percent(row.quality.share_under_30, 2),
                                       format_percent(row.edges.inside, 1),
                                       share_of(row.distance.hausdorff, diagonal, 2),
                                       share_of(row.distance.mean_forward, diagonal, 3),
                                       format_number(row.normals.mean_degrees, 1) + "\u00b0",
                                       share_of(row.features.mean, diagonal, 3)});
        }
        table.rows.push_back(std::move(cells));
    };
    if (scale.has_remesh) add("Remesh on the adapted network", scale.remesh_row);
    for (const auto& [name, row] : scale.compared) add(name, row);
    table.is_emphasized = {scale.has_remesh};
    return table;
}

HtmlTable quad_table(const QuadRecord& quads, double diagonal) {
    HtmlTable table;
    table.caption = "Quads";
    table.header = {"Made by",
                    "Quads",
                    "Mean scaled Jacobian",
                    "Least",
                    "Inverted corners",
                    "Irregular vertices",
                    "Hausdorff",
                    "Off kept curves"};
    table.rows.push_back({quads.result.tier == QuadTier::Field ? "cross field" : "pairing",
                          count_text(quads.quality.faces),
                          format_number(quads.quality.mean_scaled_jacobian, 3),
                          format_number(quads.quality.min_scaled_jacobian, 3),
                          count_text(quads.quality.inverted_corners),
                          format_percent(quads.quality.share_irregular, 1),
                          share_of(quads.distance.hausdorff, diagonal, 2),
                          format_number(quads.alignment.mean_degrees, 1) + "\u00b0"});
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
