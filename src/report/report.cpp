#include "report/report.h"

#include <algorithm>

#include "geometry/mesh_io.h"
#include "report/html.h"
#include "report/report_pictures.h"
#include "report/report_style.h"
#include "report/report_tables.h"
#include "report/report_viewer.h"

namespace fcn {
namespace {

constexpr std::size_t kDropsShown = 10, kViolationsShown = 200;

std::string mesh_id(std::size_t mesh) { return "mesh-" + std::to_string(mesh + 1); }
std::string scale_id(std::size_t mesh, std::size_t scale) {
    return mesh_id(mesh) + "-scale-" + std::to_string(scale + 1);
}

std::string plural(std::size_t count, const std::string& one, const std::string& many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

struct LegendKey {
    Color color;
    std::string meaning;
};

class ReportWriter {
public:
    ReportWriter(const std::vector<MeshRecord>& meshes, const ReportOptions& options)
        : meshes_(meshes), options_(options) {}

    std::string write() {
        html_.raw("<!DOCTYPE html>\n");
        html_.open("html", {{"lang", "en"}});
        write_head();
        html_.open("body");
        write_header();
        html_.open("main");
        for (std::size_t i = 0; i < meshes_.size(); ++i) write_mesh(i);
        write_closing_table();
        html_.close();
        write_footer();
        if (has_viewer()) write_viewer_script(html_, options_.viewer_script);
        return html_.finish();
    }

private:
    bool has_viewer() const { return !options_.viewer_script.empty(); }

    void write_head() {
        html_.open("head");
        html_.empty("meta", {{"charset", "utf-8"}});
        html_.empty("meta",
                    {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
        html_.element("title", options_.title);
        html_.open("style");
        html_.raw(kReportStyle);
        html_.close();
        html_.close();
    }

    void write_header() {
        html_.open("header");
        html_.element("h1", options_.title);
        html_.element("p",
                      "Feature curve networks adapted to prescribed scales: which curves a mesh of "
                      "a given edge length can carry, chosen by optimisation.");
        if (!options_.command.empty()) {
            html_.open("p", {{"class", "facts"}});
            html_.text("Made by ");
            html_.element("code", options_.command);
            html_.close();
        }
        html_.open("nav", {{"aria-label", "Contents"}});
        html_.open("ul");
        write_link("summary", "Closing table");
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            write_link(mesh_id(i), meshes_[i].mesh.name);
            for (std::size_t s = 0; s < meshes_[i].scales.size(); ++s)
                write_link(scale_id(i, s), meshes_[i].mesh.name + " " + meshes_[i].scales[s].label);
        }
        html_.close();
        html_.close();
        html_.close();
    }

    void write_link(const std::string& id, const std::string& name) {
        html_.open("li");
        html_.element("a", name, {{"href", "#" + id}});
        html_.close();
    }

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
        html_.open("figure",
                   css_class.empty() ? HtmlAttributes{} : HtmlAttributes{{"class", css_class}});
        html_.empty("img", {{"src", "data:image/png;base64," + encode_base64(png)},
                            {"alt", alt},
                            {"width", "840"},
                            {"height", "640"}});
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

    void write_mesh(std::size_t index) {
        const MeshRecord& record = meshes_[index];
        const ReportPictures pictures(record);
        const std::string& unit = record.mesh.units;
        html_.open("section", {{"id", mesh_id(index)}});
        html_.element("h2", record.mesh.name);
        html_.element("p",
                      plural(record.mesh.mesh.n_faces(), "triangle", "triangles") + ", " +
                          plural(record.mesh.mesh.n_vertices(), "vertex", "vertices") +
                          ", diagonal " +
                          format_significant(bounding_box(record.mesh.mesh).diagonal()) +
                          (unit.empty() ? "" : " " + unit) + ". Initial network (" + record.method +
                          "): " + plural(record.initial.arcs.size(), "arc", "arcs") + ", " +
                          plural(record.initial.nodes.size(), "node", "nodes") + ", length " +
                          format_significant(record.initial.total_length()) + ".",
                      {{"class", "facts"}});
        write_messages("Messages", record.messages);
        write_messages("Notes on the initial network", record.initial.notes);
        if (has_viewer())
            write_viewer(html_, record, mesh_id(index) + "-viewer", viewer_face_limit(meshes_));
        const ReportPalette palette;
        write_figure(
            pictures.initial(),
            "Shaded view of " + record.mesh.name + " with the " +
                plural(record.initial.arcs.size(), "arc", "arcs") +
                " of its initial feature network; hidden lines are removed.",
            "Initial network.",
            {{palette.initial, "feature"}, {palette.pinned, "pinned (boundary, label border)"}},
            "single");
        if (!record.initial.orbits.empty()) write_orbits(record, pictures);
        for (std::size_t s = 0; s < record.scales.size(); ++s) write_scale(index, s, pictures);
        html_.close();
    }

    void write_orbits(const MeshRecord& record, const ReportPictures& pictures) {
        std::size_t members = 0;
        for (const SymmetryOrbit& orbit : record.initial.orbits) members += orbit.members.size();
        write_figure(
            pictures.orbits(),
            "Shaded view of " + record.mesh.name + " with the " +
                plural(record.initial.orbits.size(), "orbit", "orbits") +
                " of arcs that symmetries exchange, in colours; other arcs are grey.",
            plural(members, "arc", "arcs") + " in " +
                plural(record.initial.orbits.size(), "symmetry orbit", "symmetry orbits") +
                ": arcs of one orbit have one colour (colours repeat) and share their labels.",
            {{ReportPalette().single, "no symmetric partner"}}, "single");
    }

    void write_scale(std::size_t mesh, std::size_t index, const ReportPictures& pictures) {
        const MeshRecord& record = meshes_[mesh];
        const ScaleRecord& scale = record.scales[index];
        html_.element("h3",
                      "Scale " + scale.label + ": rmin " + format_significant(scale.rmin) +
                          ", edge length " + format_significant(kEdgeLengthFactor * scale.rmin),
                      {{"id", scale_id(mesh, index)}});
        write_badges(scale);
        write_figures(record, scale, pictures);
        write_messages("Warnings", scale.adaptation.report.warnings);
        write_messages("Notes on the adapted network", scale.adaptation.network.notes);
        if (!scale.solvers.empty()) write_table(html_, solver_table(scale, options_.has_timings));
        if (!scale.adaptation.report.iterations.empty())
            write_table(html_, iteration_table(scale, options_.has_timings));
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
        if (options_.has_timings) write_badge(format_number(report.seconds, 2) + " s");
        html_.close();
    }

    void write_figures(const MeshRecord& record, const ScaleRecord& scale,
                       const ReportPictures& pictures) {
        const ReportPalette palette;
        const std::string& name = record.mesh.name;
        html_.open("div", {{"class", "figures"}});
        write_figure(pictures.fate(scale),
                     name + ": the initial network; the " +
                         plural(scale.adaptation.network.dropped.size(), "piece", "pieces") +
                         " dropped at scale " + scale.label + " stand out in orange.",
                     "What of the initial network had to go.",
                     {{palette.initial, "initial"},
                      {palette.dropped, "dropped"},
                      {palette.pinned, "pinned"}});
        write_figure(pictures.adapted(scale),
                     name + ": the " +
                         plural(scale.adaptation.network.segments.size(), "segment", "segments") +
                         " of the network adapted to scale " + scale.label + ".",
                     "Adapted network, a dot on each node.",
                     {{palette.kept, "kept"}, {palette.pinned, "pinned"}});
        if (scale.has_remesh)
            write_figure(pictures.remesh(scale),
                         name + " remeshed with " +
                             plural(scale.remesh.mesh.n_faces(), "triangle", "triangles") +
                             " on the adapted network; smallest angle " +
                             format_number(scale.remesh_quality.min_angle_degrees, 1) + " degrees.",
                         "Triangle mesh of edge length " +
                             format_significant(kEdgeLengthFactor * scale.rmin) +
                             " on the adapted network.",
                         {{palette.kept, "feature edges"}, {palette.pinned, "pinned edges"}});
        html_.close();
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

    void write_closing_table() {
        html_.open("section", {{"id", "summary"}});
        html_.element("h2", "What the mesh engineer gets");
        write_table(html_, engineer_table(meshes_));
        html_.element("p",
                      "Each pair of rows is the same mesh at the same edge length. Initial: every "
                      "detected curve is protected, cut into pieces as even as the edge length "
                      "allows. Adapted: only the curves chosen for this scale are. Coverage is the "
                      "sharpness-weighted share of the initial feature length that lies within "
                      "rmin of the network.",
                      {{"class", "facts"}});
        html_.close();
    }

    void write_footer() {
        html_.open("footer");
        html_.open("p", {{"class", "facts"}});
        html_.text(has_viewer()
                       ? "This page needs no network; pictures and 3D views are part of it."
                       : "This page needs no network and no scripts; the pictures are part of it. "
                         "Pictures only: the 3D viewer was not set up (scripts/setup_viewer.sh).");
        html_.close();
        html_.close();
    }

    const std::vector<MeshRecord>& meshes_;
    const ReportOptions& options_;
    HtmlWriter html_;
};

}  // namespace

void write_report(const std::filesystem::path& path, const std::vector<MeshRecord>& meshes,
                  const ReportOptions& options) {
    write_file_atomically(path, ReportWriter(meshes, options).write());
}

}  // namespace fcn
