// What the 3D view needs to know, column by column: for each kind of curve the polylines as whole
// numbers in the block and, in the header, one list per property, so that a reader can be written
// in a few lines and repeated names cost nothing.
#include "report/viewer_data.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "report/camera.h"
#include "report/drawn_curves.h"
#include "report/field_crosses.h"
#include "report/quad_words.h"
#include "report/viewer_mesh.h"

namespace fcn {
namespace {

using Json = nlohmann::json;

constexpr double kTolerance = 1e-4;  ///< of drawn curves, in diagonals
constexpr int kChordPieces = 8;
constexpr std::size_t kMostCrosses = 4000;
constexpr double kCrossSpacing = 0.8;  ///< in edge lengths of the quads

/// The box of the input, a little larger: remeshes may leave it.
BoundingBox roomy_box(const Mesh& mesh) {
    BoundingBox box = bounding_box(mesh);
    const Vec3 margin = Vec3::Constant(0.01 * box.diagonal());
    box.min -= margin;
    box.max += margin;
    return box;
}

double length_of(const Polyline& points) {
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
    return length;
}

Json lines(BlockWriter& block, const std::vector<Polyline>& polylines, const PointGrid& grid) {
    std::vector<std::uint32_t> sizes;
    std::vector<Vec3> points;
    for (const Polyline& polyline : polylines) {
        sizes.push_back(static_cast<std::uint32_t>(polyline.size()));
        points.insert(points.end(), polyline.begin(), polyline.end());
    }
    return {{"sizes", block.add_numbers(sizes)}, {"points", block.add_points(points, grid)}};
}

/// Texts that repeat, as indices into a list.
class Names {
public:
    std::size_t operator()(const std::string& name) {
        const auto [at, is_new] = index_.emplace(name, names_.size());
        if (is_new) names_.push_back(name);
        return at->second;
    }
    const std::vector<std::string>& all() const { return names_; }

private:
    std::map<std::string, std::size_t> index_;
    std::vector<std::string> names_;
};

bool has_index(int index, std::size_t count) {
    return index >= 0 && static_cast<std::size_t>(index) < count;
}

int at_or_none(const std::vector<int>& list, int index) {
    return has_index(index, list.size()) ? list[static_cast<std::size_t>(index)] : -1;
}

Json conflict_lines(BlockWriter& block, const AdaptationReport& report, const PointGrid& grid) {
    Json kinds = Json::array(), measured = Json::array(), arcs = Json::array(),
         weights = Json::array(), kept = Json::array();
    Names names;
    std::vector<Polyline> chords;
    for (const ConflictPlace& place : report.conflict_places) {
        chords.push_back({place.first, place.second});
        kinds.push_back(names(place.kind));
        measured.push_back(short_number(place.measured));
        arcs.push_back(place.origin_arcs);
        weights.push_back({short_number(place.weights[0]), short_number(place.weights[1])});
        kept.push_back(int(place.is_kept[0]) + 2 * int(place.is_kept[1]));
    }
    std::size_t total = 0;
    if (!report.iterations.empty()) {
        const IterationReport& first = report.iterations.front();
        total = first.angle_conflicts + first.distance_conflicts + first.crossing_conflicts +
                first.node_conflicts;
    }
    return {{"lines", lines(block, chords, grid)},
            {"names", names.all()},
            {"kind", kinds},
            {"measured", measured},
            {"arcs", arcs},
            {"weights", weights},
            {"kept", kept},
            {"total", total}};
}

}  // namespace

ViewerData::ViewerData(const MeshRecord& record, std::size_t face_limit)
    : record_(record),
      face_limit_(face_limit),
      grid_(roomy_box(record.mesh.mesh)),
      surface_(record.mesh.mesh),
      tolerance_(kTolerance * bounding_box(record.mesh.mesh).diagonal()) {
    // Arcs that belong to no curve are curves of their own behind the others.
    std::size_t count = record.initial.curves.size();
    for (const NetworkArc& arc : record.initial.arcs) {
        const bool is_known = has_index(arc.curve, record.initial.curves.size());
        curve_of_arc_.push_back(is_known ? arc.curve : static_cast<int>(count++));
    }
    curve_length_.assign(count, 0);
    for (std::size_t a = 0; a < curve_of_arc_.size(); ++a)
        curve_length_[static_cast<std::size_t>(curve_of_arc_[a])] +=
            record.initial.arcs[a].length();
}

std::string ViewerData::model() const {
    BlockWriter block;
    const CameraFrame camera = choose_camera(record_.mesh.mesh);
    const auto list = [](const Vec3& v) { return Json{v[0], v[1], v[2]}; };
    std::vector<Polyline> arcs;
    Json pinned = Json::array();
    for (const NetworkArc& arc : record_.initial.arcs) {
        arcs.push_back(simplified(polyline_of(arc), tolerance_));
        pinned.push_back(int(is_pinned(arc)));
    }
    Json curve_length = Json::array();
    for (const double length : curve_length_) curve_length.push_back(short_number(length));
    Json header{
        {"kind", "model"},
        {"name", record_.mesh.name},
        {"units", record_.mesh.units},
        {"grid", grid_.to_json()},
        {"camera", {{"toward", list(camera.toward)}, {"up", list(camera.up)}}},
        {"meshes", {add_mesh(block, record_.mesh.mesh, "Input", grid_, face_limit_, nullptr)}},
        {"initial",
         {{"lines", lines(block, arcs, grid_)}, {"pinned", pinned}, {"curve", curve_of_arc_}}},
        {"curve_length", curve_length},
        {"has_quads", std::ranges::any_of(record_.scales, [](const ScaleRecord& scale) {
             return scale.quads.has_value();
         })}};
    return block.finish(header);
}

Json ViewerData::adapted_lines(BlockWriter& block, const FeatureCurveNetwork& network) const {
    std::vector<Polyline> chords;
    Json pinned = Json::array(), curve = Json::array(), weight = Json::array();
    for (const NetworkSegment& segment : network.segments) {
        if (!has_index(segment.nodes[0], network.nodes.size()) ||
            !has_index(segment.nodes[1], network.nodes.size()) ||
            !has_index(segment.arc, network.arcs.size()))
            continue;
        const NetworkArc& arc = network.arcs[static_cast<std::size_t>(segment.arc)];
        const auto end = [&](std::size_t k) -> const Vec3& {
            return network.nodes[static_cast<std::size_t>(segment.nodes[k])].position;
        };
        chords.push_back(
            simplified(chord_on_surface(end(0), end(1), surface_, kChordPieces), tolerance_));
        pinned.push_back(int(is_pinned(arc)));
        weight.push_back(short_number(segment.weight));
        const int middle = (segment.first_sample + segment.last_sample) / 2;
        curve.push_back(at_or_none(curve_of_arc_, at_or_none(arc.origins, middle)));
    }
    return {{"lines", lines(block, chords, grid_)},
            {"pinned", pinned},
            {"curve", curve},
            {"weight", weight}};
}

Json ViewerData::dropped_lines(BlockWriter& block, const FeatureCurveNetwork& network) const {
    std::vector<Polyline> pieces;
    Names reasons, conflicts;
    Json reason = Json::array(), arc = Json::array(), curve = Json::array(), weight = Json::array(),
         margin = Json::array(), length = Json::array(), iteration = Json::array(),
         blockers = Json::array();
    for (const DroppedPiece& piece : network.dropped) {
        if (piece.polyline.size() < 2) continue;
        pieces.push_back(simplified(piece.polyline, tolerance_));
        reason.push_back(reasons(piece.reason.empty() ? "not recorded" : piece.reason));
        arc.push_back(piece.origin_arc);
        curve.push_back(at_or_none(curve_of_arc_, piece.origin_arc));
        weight.push_back(short_number(piece.weight));
        margin.push_back(piece.margin ? short_number(*piece.margin) : Json(nullptr));
        length.push_back(short_number(length_of(piece.polyline)));
        iteration.push_back(piece.iteration);
        Json against = Json::array();
        for (const Blocker& blocker : piece.blockers)
            against.push_back({blocker.origin_arc, short_number(blocker.weight),
                               conflicts(blocker.conflict), short_number(blocker.measured)});
        blockers.push_back(std::move(against));
    }
    return {{"lines", lines(block, pieces, grid_)},
            {"reasons", reasons.all()},
            {"conflicts", conflicts.all()},
            {"reason", reason},
            {"arc", arc},
            {"curve", curve},
            {"weight", weight},
            {"margin", margin},
            {"length", length},
            {"iteration", iteration},
            {"blockers", blockers}};
}

void ViewerData::add_quad_layers(BlockWriter& block, const QuadRecord& quads, Json& header) const {
    header["quads"] = {{"tier", quads.result.tier == QuadTier::Field ? "field" : "pairing"},
                       {"words", tier_words(quads.result)}};
    std::vector<Vec3> points;
    Json valence = Json::array();
    for (const IrregularVertex& irregular : irregular_vertices(quads.result.mesh)) {
        points.push_back(quads.result.mesh.points[static_cast<std::size_t>(irregular.vertex)]);
        valence.push_back(irregular.valence);
    }
    header["singularities"] = {{"points", block.add_points(points, grid_)}, {"valence", valence}};
    if (quads.result.field)
        header["field"] = {
            {"lines", lines(block,
                            field_crosses(*quads.result.field,
                                          kCrossSpacing * quads.result.edge_length, kMostCrosses),
                            grid_)}};
}

std::string ViewerData::level(const ScaleRecord& scale) const {
    BlockWriter block;
    const AdaptationReport& report = scale.adaptation.report;
    const FeatureCurveNetwork& network = scale.adaptation.network;
    Json meshes = Json::array();
    if (scale.quads)
        meshes.push_back(add_quads(block, scale.quads->result.mesh, "Quads on the adapted network",
                                   grid_, face_limit_, scale.quads->quality));
    if (scale.has_remesh)
        meshes.push_back(add_mesh(block, scale.remesh.mesh, "Remesh on the adapted network", grid_,
                                  face_limit_, &scale.remesh_quality));
    for (const auto& [name, row] : scale.compared)
        if (row.failure.empty())
            meshes.push_back(
                add_mesh(block, row.mesh.mesh, name, grid_, face_limit_, &row.quality));
    std::vector<double> kept(curve_length_.size(), 0);
    for (const NetworkArc& arc : network.arcs)
        for (std::size_t i = 0; i < arc.origins.size() && i + 1 < arc.samples.size(); ++i) {
            const int curve = at_or_none(curve_of_arc_, arc.origins[i]);
            if (curve >= 0)
                kept[static_cast<std::size_t>(curve)] +=
                    (arc.samples[i + 1].position - arc.samples[i].position).norm();
        }
    Json curve_kept = Json::array();
    for (const double length : kept) curve_kept.push_back(short_number(length));
    Json header{{"kind", "level"},
                {"label", scale.label},
                {"rmin", short_number(scale.rmin)},
                {"edge_length", short_number(kEdgeLengthFactor * scale.rmin)},
                {"coverage", short_number(report.coverage)},
                {"violations", scale.conformity.counted},
                {"status", to_string(report.status)},
                {"meshes", meshes},
                {"adapted", adapted_lines(block, network)},
                {"dropped", dropped_lines(block, network)},
                {"conflicts", conflict_lines(block, report, grid_)},
                {"curve_kept", curve_kept}};
    if (scale.quads) add_quad_layers(block, *scale.quads, header);
    return block.finish(header);
}

std::size_t fair_face_limit(std::vector<std::size_t> face_counts, std::size_t budget) {
    std::sort(face_counts.begin(), face_counts.end());
    std::size_t left = budget, limit = 0;
    for (std::size_t i = 0; i < face_counts.size(); ++i) {
        limit = left / (face_counts.size() - i);
        if (face_counts[i] > limit) return limit;
        left -= face_counts[i];
    }
    return std::max(budget, limit);
}

}  // namespace fcn
