// A mesh's section of the report: pictures, 3D view, tables of every scale.
#include "report/report_section.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <functional>

#include "report/quad_words.h"
#include "report/report_tables.h"

namespace fcn {
namespace {

constexpr std::size_t kDropsShown = 10, kViolationsShown = 200;

std::string plural(std::size_t count, const std::string& one, const std::string& many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

struct LegendKey {
    Color color;
    std::string meaning;
};

class SectionWriter {
public:
    SectionWriter(const MeshRecord& record, std::size_t number, const DrawnMesh& drawn,
                  bool has_timings)
        : record_(record), number_(number), drawn_(drawn), has_timings_(has_timings) {}

    std::string write() {
        const std::string& unit = record_.mesh.units;
        html_.open("section", {{"id", mesh_id(number_)}});
        html_.element("h2", record_.mesh.name);
        html_.element(
            "p",
            plural(record_.mesh.mesh.n_faces(), "triangle", "triangles") + ", " +
                plural(record_.mesh.mesh.n_vertices(), "vertex", "vertices") + ", diagonal " +
                format_significant(bounding_box(record_.mesh.mesh).diagonal()) +
                (unit.empty() ? "" : " " + unit) + ". Initial network (" + record_.method +
                "): " + plural(record_.initial.arcs.size(), "arc", "arcs") + ", " +
                plural(record_.initial.nodes.size(), "node", "nodes") + ", length " +
                format_significant(record_.initial.total_length()) + ".",
            {{"class", "facts"}});
        write_messages("Messages", record_.messages);
        write_messages("Notes on the initial network", record_.initial.notes);
        if (drawn_.has_viewer)
            write_viewer(html_, record_, mesh_id(number_) + "-viewer", drawn_.viewer);
        if (drawn_.initial.empty())
            html_.element("p", "No pictures: with so many meshes the file would grow too large.",
                          {{"class", "facts"}});
        const ReportPalette palette;
        write_figure(
            drawn_.initial,
            "Shaded view of " + record_.mesh.name + " with the " +
                plural(record_.initial.arcs.size(), "arc", "arcs") +
                " of its initial feature network; hidden lines are removed.",
            "Initial network.",
            {{palette.initial, "feature"}, {palette.pinned, "pinned (boundary, label border)"}},
            "single");
        if (!record_.initial.orbits.empty()) write_orbits();
        for (std::size_t s = 0; s < record_.scales.size(); ++s) write_scale(s);
        html_.close();
        return html_.finish();
    }

private:
    void write_messages(const std::string& title, const std::vector<std::string>& messages) {
        if (messages.empty()) return;
        const bool is_short = messages.size() <= 4;
        html_.open("details", is_short ? HtmlAttributes{{"open", ""}} : HtmlAttributes{});
        html_.element("summary", title + " (" + std::to_string(messages.size()) + ")");
        html_.open("ul", {{"class", "messages"}});
        for (const std::string& message : messages) html_.element("li", message);
        html_.close();
        html_.close();
    }

    void write_figure(const std::string& png, const std::string& alt, const std::string& caption,
                      const std::vector<LegendKey>& legend, const std::string& css_class = "") {
        if (png.empty()) return;
        html_.open("figure",
                   css_class.empty() ? HtmlAttributes{} : HtmlAttributes{{"class", css_class}});
        html_.empty("img", {{"src", "data:image/png;base64," + encode_base64(png)},
                            {"alt", alt},
                            {"width", std::to_string(drawn_.width)},
                            {"height", std::to_string(drawn_.height)}});
        html_.open("figcaption");
        html_.element("div", caption);
        for (const LegendKey& key : legend) {
            html_.open("span", {{"class", "key"}});
            html_.element("i", "", {{"style", "background:" + css_color(key.color)}});
            html_.text(key.meaning);
            html_.close();
        }
        html_.close();
        html_.close();
    }

    void write_orbits() {
        std::size_t members = 0;
        for (const SymmetryOrbit& orbit : record_.initial.orbits) members += orbit.members.size();
        write_figure(
            drawn_.orbits,
            "Shaded view of " + record_.mesh.name + " with the " +
                plural(record_.initial.orbits.size(), "orbit", "orbits") +
                " of arcs that symmetries exchange, in colours; other arcs are grey.",
            plural(members, "arc", "arcs") + " in " +
                plural(record_.initial.orbits.size(), "symmetry orbit", "symmetry orbits") +
                ": arcs of one orbit have one colour (colours repeat) and share their labels.",
            {{ReportPalette().single, "no symmetric partner"}}, "single");
    }

    void write_scale(std::size_t index) {
        const ScaleRecord& scale = record_.scales[index];
        html_.element("h3",
                      "Scale " + scale.label + ": rmin " + format_significant(scale.rmin) +
                          ", edge length " + format_significant(kEdgeLengthFactor * scale.rmin),
                      {{"id", scale_id(number_, index)}});
        write_badges(scale);
        write_figures(scale, drawn_.scales[index]);
        write_messages("Warnings", scale.adaptation.report.warnings);
        write_messages("Notes on the adapted network", scale.adaptation.network.notes);
        if (scale.has_remesh)
            write_table(html_, ways_table(scale, bounding_box(record_.mesh.mesh).diagonal()));
        if (scale.quads) write_quads(*scale.quads);
        if (!scale.solvers.empty()) write_table(html_, solver_table(scale, has_timings_));
        if (!scale.adaptation.report.iterations.empty())
            write_table(html_, iteration_table(scale, has_timings_));
        write_dropped(scale.adaptation.network);
        write_conformity(scale.conformity);
    }

    void write_badge(const std::string& text, const std::string& css_class = "") {
        html_.element("li", text,
                      css_class.empty() ? HtmlAttributes{} : HtmlAttributes{{"class", css_class}});
    }

    void write_badges(const ScaleRecord& scale) {
        const AdaptationReport& report = scale.adaptation.report;
        html_.open("ul", {{"class", "badges"}});
        const bool is_conforming = scale.conformity.is_conforming();
        write_badge(is_conforming ? "strictly conforming"
                                  : plural(scale.conformity.counted, "violation", "violations"),
                    is_conforming ? "good" : "bad");
        const bool is_converged = report.status == AdaptationStatus::Converged;
        write_badge(to_string(report.status), is_converged ? "" : "bad");
        write_badge(report.is_optimal ? "every iteration proven optimal" : "optimality not proven");
        write_badge("coverage " + format_percent(report.coverage));
        write_badge(plural(scale.adaptation.network.segments.size(), "segment", "segments") +
                    " kept, " + plural(scale.adaptation.network.dropped.size(), "piece", "pieces") +
                    " dropped");
        write_badge(plural(report.iterations.size(), "iteration", "iterations"));
        if (has_timings_) write_badge(format_number(report.seconds, 2) + " s");
        html_.close();
    }

    void write_figures(const ScaleRecord& scale, const DrawnScale& drawn) {
        if (drawn.fate.empty()) return;
        const ReportPalette palette;
        const std::string& name = record_.mesh.name;
        html_.open("div", {{"class", "figures"}});
        write_figure(drawn.fate,
                     name + ": the initial network; the " +
                         plural(scale.adaptation.network.dropped.size(), "piece", "pieces") +
                         " dropped at scale " + scale.label + " stand out in orange.",
                     "What of the initial network had to go.",
                     {{palette.initial, "initial"},
                      {palette.dropped, "dropped"},
                      {palette.pinned, "pinned"}});
        write_figure(drawn.adapted,
                     name + ": the " +
                         plural(scale.adaptation.network.segments.size(), "segment", "segments") +
                         " of the network adapted to scale " + scale.label + ".",
                     "Adapted network, a dot on each node.",
                     {{palette.kept, "kept"}, {palette.pinned, "pinned"}});
        if (scale.has_remesh)
            write_figure(drawn.remesh,
                         name + " remeshed with " +
                             plural(scale.remesh.mesh.n_faces(), "triangle", "triangles") +
                             " on the adapted network; smallest angle " +
                             format_number(scale.remesh_quality.min_angle_degrees, 1) + " degrees.",
                         "Triangle mesh of edge length " +
                             format_significant(kEdgeLengthFactor * scale.rmin) +
                             " on the adapted network.",
                         {{palette.kept, "feature edges"}, {palette.pinned, "pinned edges"}});
        if (scale.quads)
            write_figure(drawn.quads,
                         name + " remeshed with " +
                             plural(scale.quads->quality.faces, "quad", "quads") +
                             " on the adapted network.",
                         "Quads on the adapted network.",
                         {{palette.kept, "kept"},
                          {palette.pinned, "pinned"},
                          {palette.fewer_quads, "fewer than four quads around it"},
                          {palette.more_quads, "more than four"}});
        html_.close();
    }

    void write_quads(const QuadRecord& quads) {
        write_table(html_, quad_table(quads, bounding_box(record_.mesh.mesh).diagonal()));
        html_.element("p", tier_words(quads.result), {{"class", "facts"}});
        if (!quads.result.reason.empty()) write_table(html_, attempt_table(quads.result.attempts));
    }

    void write_dropped(const FeatureCurveNetwork& network) {
        if (network.dropped.empty()) return;
        html_.open("details");
        html_.element("summary", "Dropped: " + plural(network.dropped.size(), "piece", "pieces") +
                                     ", by reason and by weight");
        write_table(html_, reason_table(network));
        write_table(html_, heaviest_drops_table(network, kDropsShown));
        html_.element("p",
                      "Labels are numbered from 1 as in the saved problem of that iteration. "
                      "The margin is what the objective would lose with the label in and its "
                      "blockers out; without one that is infeasible.",
                      {{"class", "facts"}});
        html_.close();
    }

    void write_conformity(const ConformityReport& report) {
        html_.open("details",
                   report.is_conforming() ? HtmlAttributes{} : HtmlAttributes{{"open", ""}});
        html_.element("summary", std::string("Conformity: ") +
                                     (report.is_conforming()
                                          ? "strictly conforming"
                                          : plural(report.counted, "violation", "violations")));
        html_.element(
            "p", plural(report.counted, "violation counts", "violations count") + "; " +
                     std::to_string(report.input_forced) +
                     " forced by pinned curves of the input; " + std::to_string(report.exempt) +
                     " exempt at thin walls; " +
                     plural(report.long_segments, "allowed long segment", "allowed long segments") +
                     ". Surface to Euclidean distance between close curves: " +
                     (report.distance_ratio_pairs == 0
                          ? "not measured, or no close pair."
                          : "at most " + format_number(report.max_distance_ratio, 3) + " over " +
                                plural(report.distance_ratio_pairs, "pair", "pairs") + ", " +
                                std::to_string(report.distance_ratio_over_two) + " over 2."));
        if (!report.violations.empty()) {
            if (report.violations.size() > kViolationsShown)
                html_.element("p", "The first " + std::to_string(kViolationsShown) + " of " +
                                       std::to_string(report.violations.size()) + ":");
            write_table(html_, violation_table(report, kViolationsShown));
        }
        html_.close();
    }

    const MeshRecord& record_;
    std::size_t number_ = 0;
    const DrawnMesh& drawn_;
    bool has_timings_ = true;
    HtmlWriter html_;
};

}  // namespace

std::string mesh_id(std::size_t mesh) { return "mesh-" + std::to_string(mesh + 1); }

std::string scale_id(std::size_t mesh, std::size_t scale) {
    return mesh_id(mesh) + "-scale-" + std::to_string(scale + 1);
}

std::size_t DrawnMesh::picture_bytes() const {
    std::size_t bytes = initial.size() + orbits.size();
    for (const DrawnScale& scale : scales)
        bytes +=
            scale.fate.size() + scale.adapted.size() + scale.remesh.size() + scale.quads.size();
    return bytes;
}

DrawnMesh draw_pictures(const MeshRecord& record, int width, int height) {
    DrawnMesh drawn;
    drawn.width = width;
    drawn.height = height;
    drawn.scales.resize(record.scales.size());
    if (width <= 0 || height <= 0) return drawn;
    const ReportPictures pictures(record, width, height);
    std::vector<std::function<void()>> jobs{[&] { drawn.initial = pictures.initial(); }};
    if (!record.initial.orbits.empty()) jobs.push_back([&] { drawn.orbits = pictures.orbits(); });
    for (std::size_t s = 0; s < record.scales.size(); ++s) {
        const ScaleRecord& scale = record.scales[s];
        DrawnScale& place = drawn.scales[s];
        jobs.push_back([&] { place.fate = pictures.fate(scale); });
        jobs.push_back([&] { place.adapted = pictures.adapted(scale); });
        if (scale.has_remesh) jobs.push_back([&] { place.remesh = pictures.remesh(scale); });
        if (scale.quads) jobs.push_back([&] { place.quads = pictures.quads(scale); });
    }
    tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t job) { jobs[job](); });
    return drawn;
}

std::string write_section(const MeshRecord& record, std::size_t number, const DrawnMesh& drawn,
                          bool has_timings) {
    return SectionWriter(record, number, drawn, has_timings).write();
}

}  // namespace fcn
