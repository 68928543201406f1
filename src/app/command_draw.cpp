#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <map>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "app/length.h"
#include "app/outputs.h"
#include "meshing/quad_files.h"
#include "report/camera.h"
#include "report/drawn_curves.h"
#include "report/picture.h"
#include "report/report_pictures.h"

namespace fcn::app {
namespace {

struct DrawArguments {
    CommonArguments common;
    MeshArguments mesh;
    std::string input;
    std::string output;
    std::vector<std::string> curves;
    std::string seen_as;
    std::string view;
    std::string up;
    std::string size = "840x640";
    double line_width = 2.4;
    bool is_wireframe = false;
    bool has_dots = false;
};

/// A network to draw, by a colour's name, and whether its dropped pieces are meant.
struct DrawnNetwork {
    std::string path;
    Color color;
    bool is_dropped = false;
};

Color parse_color(const std::string& text) {
    const ReportPalette palette;
    const std::map<std::string, Color> named{
        {"initial", palette.initial}, {"kept", palette.kept},   {"dropped", palette.dropped},
        {"pinned", palette.pinned},   {"short", palette.brief}, {"grey", palette.single}};
    if (const auto found = named.find(text); found != named.end()) return found->second;
    unsigned value = 0;
    const char* end = text.data() + text.size();
    const bool is_hexadecimal = text.size() == 7 && text[0] == '#' &&
                                std::from_chars(text.data() + 1, end, value, 16).ptr == end;
    if (!is_hexadecimal)
        throw UsageError(fmt::format(
            "--curves: '{}' is no colour (initial, kept, dropped, pinned, short, grey, #rrggbb)",
            text));
    return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255),
            static_cast<std::uint8_t>(value & 255)};
}

/// "FILE", "FILE=COLOUR"; dropped is both a colour and what is drawn of a network that has some.
DrawnNetwork parse_curves(const std::string& text) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos) return {text, parse_color("kept"), false};
    const std::string color = text.substr(equals + 1);
    return {text.substr(0, equals), parse_color(color), color == "dropped"};
}

std::array<int, 2> parse_size(const std::string& text) {
    std::array<int, 2> size{};
    const char* end = text.data() + text.size();
    const auto [middle, error] = std::from_chars(text.data(), end, size[0]);
    if (error != std::errc() || middle == end || *middle != 'x' ||
        std::from_chars(middle + 1, end, size[1]).ptr != end || size[0] < 1 || size[1] < 1)
        throw UsageError(fmt::format("--size: '{}' is not WIDTHxHEIGHT in pixels", text));
    return size;
}

Vec3 parse_vector(const std::string& text, const std::string& option) {
    if (text.empty()) return Vec3::Zero();
    const std::vector<std::string> parts = split_list(text, option);
    Vec3 vector;
    for (std::size_t i = 0; i < 3; ++i) {
        char* end = nullptr;
        vector[static_cast<int>(i)] =
            i < parts.size() ? std::strtod(parts[i].c_str(), &end) : std::nan("");
        if (parts.size() != 3 || end == nullptr || *end != 0 || parts[i].empty())
            throw UsageError(fmt::format("{}: '{}' is not X,Y,Z", option, text));
    }
    return vector;
}

/// What a network looks like on the drawn mesh: lines, and a dot on each node where asked for.
void add_layers(const DrawnNetwork& drawn, const FeatureCurveNetwork& network,
                const SurfaceQueries& surface, double finest, const DrawArguments& arguments,
                std::vector<PictureLayer>& layers) {
    PictureLayer lines{{}, drawn.color, arguments.line_width};
    if (drawn.is_dropped && !network.dropped.empty()) {
        for (const DroppedPiece& piece : network.dropped)
            if (piece.polyline.size() > 1)
                lines.polylines.push_back(laid_on_surface(piece.polyline, surface, finest));
        layers.push_back(std::move(lines));
        return;
    }
    for (const NetworkSegment& segment : network.segments)
        lines.polylines.push_back(
            laid_on_surface({network.nodes[static_cast<std::size_t>(segment.nodes[0])].position,
                             network.nodes[static_cast<std::size_t>(segment.nodes[1])].position},
                            surface, finest));
    if (network.segments.empty())
        for (const NetworkArc& arc : network.arcs)
            lines.polylines.push_back(laid_on_surface(polyline_of(arc), surface, finest));
    PictureLayer dots{{}, drawn.color, arguments.line_width * 1.25};
    if (arguments.has_dots)
        for (const NetworkNode& node : network.nodes) dots.polylines.push_back({node.position});
    layers.push_back(std::move(lines));
    layers.push_back(std::move(dots));
}

/// With --wireframe a mesh of quads alone is drawn as such, without the diagonals.
std::optional<QuadMesh> quads_to_draw(const DrawArguments& arguments) {
    if (!arguments.is_wireframe || arguments.input == "-") return std::nullopt;
    std::optional<QuadMesh> quads = read_quads(arguments.input);
    return quads && check_topology(*quads).fault.empty() ? quads : std::nullopt;
}

int draw(const DrawArguments& arguments) {
    std::vector<DrawnNetwork> networks;
    for (const std::string& text : arguments.curves) networks.push_back(parse_curves(text));
    const std::array<int, 2> size = parse_size(arguments.size);
    PictureOptions options;
    options.width = size[0];
    options.height = size[1];
    options.view = parse_vector(arguments.view, "--view");
    options.up = parse_vector(arguments.up, "--up");
    options.is_drawing_wireframe = arguments.is_wireframe;
    prepare_output(arguments.output, OutputKind::Other, arguments.common);
    std::vector<PictureLayer> layers;
    const std::optional<QuadMesh> quads = quads_to_draw(arguments);
    if (quads) {
        options.is_drawing_wireframe = false;
        layers.push_back(quad_edges(*quads));
    }
    LoadedMesh mesh;
    if (quads)
        mesh.mesh = triangle_mesh(*quads);
    else
        mesh = load_mesh(arguments.input, arguments.mesh, arguments.common);
    LoadedMesh other;
    if (!arguments.seen_as.empty()) {
        other = load_mesh(arguments.seen_as, arguments.mesh, arguments.common);
        options.seen_as = &other.mesh;
    }
    if (mesh.mesh.n_faces() > 0) {
        const SurfaceQueries surface(mesh.mesh);
        const double finest = 0.004 * bounding_box(mesh.mesh).diagonal();
        for (const DrawnNetwork& drawn : networks) {
            // A network that knows its points may be of another mesh, which this one was made of.
            const Mesh* of = is_lossless_network(drawn.path) ? nullptr : &mesh.mesh;
            add_layers(drawn, load_network(drawn.path, of), surface, finest, arguments, layers);
        }
    }
    save_text(arguments.output, render_png(mesh.mesh, layers, options));
    if (arguments.output == "-") return kDone;
    if (arguments.common.is_json)
        print_json({{"mesh", mesh_json(mesh)}, {"files", {arguments.output}}});
    else
        fmt::print("wrote {}\n", arguments.output);
    return kDone;
}

}  // namespace

Command add_draw_command(CLI::App& program) {
    auto arguments = std::make_shared<DrawArguments>();
    CLI::App* parser = program.add_subcommand("draw", "A picture of a mesh and of curves on it");
    parser->add_option("MESH", arguments->input, "Triangle mesh (- for standard input)")
        ->required();
    parser->add_option("-o,--output", arguments->output, "PNG file (- for standard output)")
        ->required();
    parser->add_option("--curves", arguments->curves,
                       "Curves to draw, a file each, by its name or as FILE=COLOUR: initial, kept, "
                       "dropped (its dropped pieces, if it has any), pinned, short, grey, #rrggbb");
    parser->add_flag("--dots", arguments->has_dots, "A dot on each node of the curves");
    parser->add_flag("--wireframe", arguments->is_wireframe,
                     "The mesh's edges, of quads without their diagonals");
    parser->add_option("--as", arguments->seen_as,
                       "Mesh whose view and framing are taken, for pictures side by side");
    parser->add_option("--view", arguments->view,
                       "Direction X,Y,Z from the mesh to the eye (default: chosen)");
    parser->add_option("--up", arguments->up, "Direction X,Y,Z that points up, with --view");
    parser->add_option("--size", arguments->size, "Pixels, WIDTHxHEIGHT")->capture_default_str();
    parser->add_option("--line-width", arguments->line_width, "Pixels")
        ->check(CLI::Range(0.1, 100.0))
        ->capture_default_str();
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n  scalefcn draw part.stl --curves part_2pct.fcn.json=kept --dots -o part.png");
    return {parser, [arguments] { return draw(*arguments); }};
}

}  // namespace fcn::app
