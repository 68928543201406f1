// The report as a page. A mesh is drawn when it is added and its section kept as text, so that the
// page can be written again after every mesh without drawing anything twice. Pictures and 3D views
// get shares of a fixed space: what the meshes before did not need goes to those still to come.
#include "report/report.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_io.h"
#include "report/html.h"
#include "report/report_section.h"
#include "report/report_style.h"
#include "report/report_tables.h"
#include "report/report_viewer.h"
#include "report/viewer_data.h"

namespace fcn {
namespace {

/// Faces in all 3D views, of about 6 bytes of page each; and in one of their meshes, more than a
/// screen has pixels for.
constexpr std::size_t kFaceBudget = 2'500'000, kMostFaces = 400'000;
/// Bytes of all pictures, before base64, and what one needs for a pixel.
constexpr double kPictureBudget = 6.5e6, kBytesPerPixel = 0.3;
constexpr int kWidth = 840, kHeight = 640;
constexpr int kLeastWidth = 200;  ///< less shows nothing

}  // namespace

struct Report::State {
    ReportOptions options;
    std::size_t meshes_left = 1;  ///< that are still to come
    double picture_bytes_left = kPictureBudget;
    std::size_t faces_left = kFaceBudget;
    std::vector<std::string> sections;
    std::vector<std::pair<std::string, std::string>> links;  ///< place in the page, text
    HtmlTable table = engineer_table();

    bool has_viewer() const { return !options.viewer_script.empty(); }

    /// What this many pictures of the next mesh may be wide; 0: too little to show anything.
    int picture_width(std::size_t pictures) const {
        const double share = picture_bytes_left / static_cast<double>(meshes_left);
        const double pixels = std::max(0.0, share) / static_cast<double>(pictures) / kBytesPerPixel;
        const int width =
            static_cast<int>(std::min<double>(kWidth, std::sqrt(pixels * kWidth / kHeight)));
        return width < kLeastWidth ? 0 : width;
    }

    /// Faces that each mesh of the next record may have in the 3D view.
    std::size_t face_limit(const std::vector<std::size_t>& counts) const {
        return std::min(kMostFaces, fair_face_limit(counts, faces_left / meshes_left));
    }
};

namespace {

class PageWriter {
public:
    explicit PageWriter(const Report::State& state) : state_(state) {}

    std::string write() {
        html_.raw("<!DOCTYPE html>\n");
        html_.open("html", {{"lang", "en"}});
        write_head();
        html_.open("body");
        write_header();
        html_.open("main");
        for (const std::string& section : state_.sections) html_.raw(section);
        write_closing_table();
        html_.close();
        write_footer();
        if (state_.has_viewer()) write_viewer_script(html_, state_.options.viewer_script);
        return html_.finish();
    }

private:
    void write_head() {
        html_.open("head");
        html_.empty("meta", {{"charset", "utf-8"}});
        html_.empty("meta",
                    {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
        html_.element("title", state_.options.title);
        html_.open("style");
        html_.raw(kReportStyle);
        html_.close();
        html_.close();
    }

    void write_header() {
        html_.open("header");
        html_.element("h1", state_.options.title);
        html_.element("p",
                      "Feature curve networks adapted to prescribed scales: which curves a mesh of "
                      "a given edge length can carry, chosen by optimisation.");
        if (!state_.options.command.empty()) {
            html_.open("p", {{"class", "facts"}});
            html_.text("Made by ");
            html_.element("code", state_.options.command);
            html_.close();
        }
        html_.open("nav", {{"aria-label", "Contents"}});
        html_.open("ul");
        write_link("summary", "Closing table");
        for (const auto& [id, name] : state_.links) write_link(id, name);
        html_.close();
        html_.close();
        html_.close();
    }

    void write_link(const std::string& id, const std::string& name) {
        html_.open("li");
        html_.element("a", name, {{"href", "#" + id}});
        html_.close();
    }

    void write_closing_table() {
        html_.open("section", {{"id", "summary"}});
        html_.element("h2", "What the mesh engineer gets");
        write_table(html_, state_.table);
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
        html_.text(state_.has_viewer()
                       ? "This page needs no network; pictures and 3D views are part of it."
                       : "This page needs no network and no scripts; the pictures are part of it. "
                         "Pictures only: the 3D viewer was not set up (scripts/setup_viewer.sh).");
        html_.close();
        html_.close();
    }

    const Report::State& state_;
    HtmlWriter html_;
};

}  // namespace

Report::Report(ReportOptions options, std::size_t mesh_count) : state_(new State) {
    state_->options = std::move(options);
    state_->meshes_left = std::max<std::size_t>(1, mesh_count);
}

Report::~Report() = default;
Report::Report(Report&&) noexcept = default;

void Report::add(const MeshRecord& record) {
    State& state = *state_;
    std::size_t pictures = record.initial.orbits.empty() ? 1 : 2;
    for (const ScaleRecord& scale : record.scales) pictures += scale.has_remesh ? 3 : 2;
    const int width = state.picture_width(pictures);
    DrawnMesh drawn = draw_pictures(record, width, width * kHeight / kWidth);
    state.picture_bytes_left -= static_cast<double>(drawn.picture_bytes());
    if (state.has_viewer()) {
        const std::vector<std::size_t> counts = viewer_face_counts(record);
        const std::size_t limit = state.face_limit(counts);
        drawn.viewer = make_viewer_blocks(record, limit);
        drawn.has_viewer = true;
        for (const std::size_t count : counts)
            state.faces_left -= std::min({state.faces_left, limit, count});
    }
    const std::size_t number = state.sections.size();
    state.sections.push_back(write_section(record, number, drawn, state.options.has_timings));
    state.links.emplace_back(mesh_id(number), record.mesh.name);
    for (std::size_t s = 0; s < record.scales.size(); ++s)
        state.links.emplace_back(scale_id(number, s),
                                 record.mesh.name + " " + record.scales[s].label);
    add_engineer_rows(record, state.table);
    if (state.meshes_left > 1) --state.meshes_left;
}

std::string Report::html() const { return PageWriter(*state_).write(); }

void write_report(const std::filesystem::path& path, const std::vector<MeshRecord>& meshes,
                  const ReportOptions& options) {
    Report report(options, meshes.size());
    for (const MeshRecord& record : meshes) report.add(record);
    write_file_atomically(path, report.html());
}

}  // namespace fcn
