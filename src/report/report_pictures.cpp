#include "report/report_pictures.h"

#include <cstdio>
#include <set>

#include "report/drawn_curves.h"

namespace fcn {
namespace {

constexpr int kChordSamples = 12;
constexpr double kThin = 2, kMedium = 2.4, kThick = 3, kDot = 6;  ///< pixels

/// Arcs of a network as layers: free ones, and pinned ones on top.
std::vector<PictureLayer> arc_layers(const FeatureCurveNetwork& network, double width) {
    const ReportPalette palette;
    std::vector<PictureLayer> layers{{{}, palette.initial, width}, {{}, palette.pinned, width}};
    for (const NetworkArc& arc : network.arcs)
        layers[is_pinned(arc) ? 1 : 0].polylines.push_back(polyline_of(arc));
    return layers;
}

bool has_node(const FeatureCurveNetwork& network, int node) {
    return node >= 0 && node < static_cast<int>(network.nodes.size());
}

/// Segments (free, pinned) and a dot on each of their nodes.
std::vector<PictureLayer> segment_layers(const FeatureCurveNetwork& network,
                                         const SurfaceQueries& surface, double width) {
    const ReportPalette palette;
    std::vector<PictureLayer> layers{{{}, palette.kept, width},
                                     {{}, palette.pinned, width},
                                     {{}, palette.kept, width * 1.25},
                                     {{}, palette.pinned, width * 1.25}};
    std::set<int> dotted;
    for (const NetworkSegment& segment : network.segments) {
        if (!has_node(network, segment.nodes[0]) || !has_node(network, segment.nodes[1])) continue;
        const bool has_arc =
            segment.arc >= 0 && segment.arc < static_cast<int>(network.arcs.size());
        const std::size_t kind =
            has_arc && is_pinned(network.arcs[static_cast<std::size_t>(segment.arc)]) ? 1 : 0;
        const auto at = [&](int end) {
            return network
                .nodes[static_cast<std::size_t>(segment.nodes[static_cast<std::size_t>(end)])]
                .position;
        };
        layers[kind].polylines.push_back(chord_on_surface(at(0), at(1), surface, kChordSamples));
        for (const int end : {0, 1})
            if (dotted.insert(segment.nodes[static_cast<std::size_t>(end)]).second)
                layers[2 + kind].polylines.push_back({at(end)});
    }
    return layers;
}

PictureLayer dropped_layer(const FeatureCurveNetwork& network) {
    PictureLayer layer{{}, ReportPalette().dropped, kThick};
    for (const DroppedPiece& piece : network.dropped)
        if (piece.polyline.size() > 1) layer.polylines.push_back(piece.polyline);
    return layer;
}

}  // namespace

std::string css_color(const Color& color) {
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", color.r, color.g, color.b);
    return text;
}

ReportPictures::ReportPictures(const MeshRecord& record, int width, int height)
    : record_(record),
      width_(width),
      height_(height),
      camera_(choose_camera(record.mesh.mesh)),
      surface_(record.mesh.mesh) {}

PictureOptions ReportPictures::options(bool is_wireframe) const {
    PictureOptions options;
    options.width = width_;
    options.height = height_;
    options.view = camera_.toward;
    options.up = camera_.up;
    options.is_drawing_wireframe = is_wireframe;
    return options;
}

std::string ReportPictures::initial() const {
    return render_png(record_.mesh.mesh, arc_layers(record_.initial, kMedium), options());
}

std::string ReportPictures::orbits() const {
    const ReportPalette palette;
    const FeatureCurveNetwork& network = record_.initial;
    std::vector<PictureLayer> layers{{{}, palette.single, kThin}};
    for (const Color& color : palette.orbits) layers.push_back({{}, color, kThick});
    std::vector<std::size_t> layer_of_arc(network.arcs.size(), 0);
    for (std::size_t o = 0; o < network.orbits.size(); ++o) {
        for (const OrbitMember& member : network.orbits[o].members)
            layer_of_arc[static_cast<std::size_t>(member.arc)] = 1 + o % palette.orbits.size();
    }
    for (std::size_t a = 0; a < network.arcs.size(); ++a)
        layers[layer_of_arc[a]].polylines.push_back(polyline_of(network.arcs[a]));
    return render_png(record_.mesh.mesh, layers, options());
}

std::string ReportPictures::fate(const ScaleRecord& scale) const {
    std::vector<PictureLayer> layers = arc_layers(record_.initial, kThin);
    layers.insert(layers.begin() + 1, dropped_layer(scale.adaptation.network));
    return render_png(record_.mesh.mesh, layers, options());
}

std::string ReportPictures::adapted(const ScaleRecord& scale) const {
    return render_png(record_.mesh.mesh,
                      segment_layers(scale.adaptation.network, surface_, kMedium), options());
}

std::string ReportPictures::remesh(const ScaleRecord& scale) const {
    if (scale.remesh.mesh.n_faces() == 0) return render_png(scale.remesh.mesh, {}, options());
    const SurfaceQueries remeshed(scale.remesh.mesh);
    std::vector<PictureLayer> layers = segment_layers(scale.adaptation.network, remeshed, kMedium);
    layers.resize(2);  // the mesh shows the nodes
    return render_png(scale.remesh.mesh, layers, options(true));
}

std::string ReportPictures::quads(const ScaleRecord& scale) const {
    const Mesh mesh = triangle_mesh(scale.quads->result.mesh);
    std::vector<PictureLayer> layers{quad_edges(scale.quads->result.mesh)};
    for (PictureLayer& layer :
         segment_layers(scale.adaptation.network, SurfaceQueries(mesh), kMedium))
        layers.push_back(std::move(layer));
    layers.resize(3);  // the mesh shows the nodes
    const ReportPalette palette;
    PictureLayer fewer{{}, palette.fewer_quads, kDot}, more{{}, palette.more_quads, kDot};
    for (const IrregularVertex& irregular : irregular_vertices(scale.quads->result.mesh))
        (irregular.valence < 4 ? fewer : more)
            .polylines.push_back(
                {scale.quads->result.mesh.points[static_cast<std::size_t>(irregular.vertex)]});
    layers.push_back(std::move(fewer));
    layers.push_back(std::move(more));
    return render_png(mesh, layers, options());
}

}  // namespace fcn
