#include "app/closing_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "meshing/remesh.h"

namespace fcn::app {
namespace {

using Row = std::vector<std::string>;

/// Columns as wide as their widest entry; the first `left_count` columns flush left.
std::string aligned(const std::vector<Row>& rows, std::size_t left_count) {
    std::vector<std::size_t> widths;
    for (const Row& row : rows) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line = " ";
        for (std::size_t i = 0; i < row.size(); ++i)
            line += i < left_count ? fmt::format(" {:<{}}", row[i], widths[i] + 1)
                                   : fmt::format(" {:>{}}", row[i], widths[i] + 1);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string number_or_dash(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

std::string percent_or_dash(double share, int digits) {
    return std::isfinite(share) ? fmt::format("{:.{}f} %", 100 * share, digits) : "-";
}

Row quality_cells(const TriangleQuality& quality, double edge_length, bool is_known) {
    if (!is_known) return {"-", "-", "-", "-", "-"};
    return {fmt::format("{}", quality.faces), fmt::format("{:.1f}", quality.min_angle_degrees),
            percent_or_dash(quality.share_under_15, 2), percent_or_dash(quality.share_under_30, 2),
            fmt::format("{:.2f}", quality.min_edge / edge_length)};
}

std::string verdict(const ScaleRecord& scale) {
    std::string text =
        scale.conformity.is_conforming() ? "yes" : fmt::format("no ({})", scale.conformity.counted);
    if (scale.adaptation.report.status != AdaptationStatus::Converged)
        text += fmt::format(" [{}]", to_string(scale.adaptation.report.status));
    return text;
}

std::vector<Row> triangle_rows(const MeshRecord& mesh) {
    std::vector<Row> rows{{"scale", "edge length", "network", "triangles", "smallest angle (deg)",
                           "under 15 deg", "under 30 deg", "shortest edge / target", "coverage",
                           "conforming"}};
    for (const ScaleRecord& scale : mesh.scales) {
        const double edge_length = kEdgeLengthFactor * scale.rmin;
        Row initial{scale.label, fmt::format("{:.4g}", edge_length), "initial"};
        for (auto& cell :
             quality_cells(scale.initial_quality, edge_length, scale.has_initial_remesh))
            initial.push_back(std::move(cell));
        initial.insert(initial.end(), {"100.0 %", "-"});
        Row adapted{"", "", "adapted"};
        for (auto& cell : quality_cells(scale.remesh_quality, edge_length, scale.has_remesh))
            adapted.push_back(std::move(cell));
        adapted.push_back(percent_or_dash(scale.adaptation.report.coverage, 1));
        adapted.push_back(verdict(scale));
        rows.push_back(std::move(initial));
        rows.push_back(std::move(adapted));
    }
    return rows;
}

std::vector<Row> quad_rows(const MeshRecord& mesh) {
    std::vector<Row> rows{{"scale", "edge length", "made by", "quads", "mean scaled Jacobian",
                           "least", "inverted corners", "irregular", "Hausdorff / edge length",
                           "off kept curves (deg)"}};
    for (const ScaleRecord& scale : mesh.scales) {
        if (!scale.quads) continue;
        const QuadQuality& quality = scale.quads->quality;
        const double edge_length = kEdgeLengthFactor * scale.rmin;
        rows.push_back({scale.label, fmt::format("{:.4g}", edge_length),
                        scale.quads->result.tier == QuadTier::Field ? "field" : "pairing",
                        fmt::format("{}", quality.faces),
                        number_or_dash(quality.mean_scaled_jacobian, 3),
                        number_or_dash(quality.min_scaled_jacobian, 3),
                        fmt::format("{}", quality.inverted_corners),
                        percent_or_dash(quality.share_irregular, 1),
                        number_or_dash(scale.quads->distance.hausdorff / edge_length, 2),
                        number_or_dash(scale.quads->alignment.mean_degrees, 1)});
    }
    return rows;
}

std::vector<Row> solver_rows(const MeshRecord& mesh, bool has_timings) {
    Row head{"scale", "solver", "status", "value", "bound", "gap"};
    if (has_timings) head.push_back("seconds");
    std::vector<Row> rows{head};
    for (const ScaleRecord& scale : mesh.scales)
        for (const SolverComparison& solver : scale.solvers) {
            Row row{scale.label,
                    solver.solver,
                    solver.status,
                    number_or_dash(solver.value, 3),
                    number_or_dash(solver.bound, 3),
                    percent_or_dash(solver.gap, 3)};
            if (has_timings) row.push_back(number_or_dash(solver.seconds, 2));
            rows.push_back(std::move(row));
        }
    return rows;
}

}  // namespace

std::string closing_table(const MeshRecord& mesh, bool has_timings) {
    std::string text =
        fmt::format("\n{}: {} triangles, {} feature arcs (method {})\n", mesh.mesh.name,
                    mesh.mesh.mesh.n_faces(), mesh.initial.arcs.size(), mesh.method);
    if (mesh.scales.empty()) return text;
    text += aligned(triangle_rows(mesh), 3);
    const std::vector<Row> quads = quad_rows(mesh);
    if (quads.size() > 1) text += "\n" + aligned(quads, 3);
    const std::vector<Row> solvers = solver_rows(mesh, has_timings);
    if (solvers.size() > 1)
        text += "\n  first labeling problem of each scale, every solver from scratch:\n" +
                aligned(solvers, 3);
    return text;
}

}  // namespace fcn::app
