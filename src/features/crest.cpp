// Crest lines (Yoshizawa, Belyaev, Seidel 2005): local fits give curvatures and their derivatives
// (local_fit), crossings of mesh edges are linked to lines (crest_crossings, crest_lines), gaps are
// bridged (crest_gaps), and lines below the thresholds go (crest_measures).
//
// Departures: sharp edges are found first; they are features themselves, and no fit reaches across
// them, since a polynomial over a crease means nothing. The radius of the fits follows the noise
// (crest_scale). What decides by default is whether a line stands out from the errors of the fits
// (significance) and how much sharper than a cyclide the surface is there (sharpness): the authors'
// thresholds, in the units of one model, need a hand for each mesh. Lines far from significant go
// before gaps are bridged, or they would catch the ends of others.

#include "features/crest.h"

#include <algorithm>
#include <cmath>

#include "features/crest_gaps.h"
#include "features/crest_measures.h"
#include "features/crest_network.h"
#include "features/crest_scale.h"
#include "features/crest_smoothing.h"
#include "features/edge_chains.h"
#include "features/sharp_edges.h"
#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr double kTwigRadii = 1;        // shorter dead ends at forks are none
constexpr int kLeastSharpEdges = 6;     // in a chain; shorter ones may be noise on a crest
constexpr int kFacetLines = 2;          // beside an edge of a rounded crest
constexpr double kCertainAngle = 1.22;  // radians (70 degrees): sharp whatever runs beside it
constexpr double kCleanRings = 3;       // wider fits mean noise
constexpr double kSpacing = 0.2;        // of samples, in radii of the fits, where there is noise
constexpr double kHopelessShare = 0.4;  // of thresholds, before gaps are bridged

void check(const CrestOptions& options) {
    const auto expect = [](double value, const char* name, double least, double most) {
        if (value >= least && value <= most) return;
        throw InputError("crest lines: " + std::string(name) + " must lie in [" +
                         std::to_string(least) + ", " + std::to_string(most) + "], got " +
                         std::to_string(value));
    };
    constexpr double kMost = 1e300;
    if (options.rings != 0) expect(options.rings, "rings", 1.5, 50);
    expect(options.radius, "radius", 0, kMost);
    expect(options.min_significance, "significance", 0, kMost);
    expect(options.min_sharpness, "sharpness", 0, kMost);
    expect(options.min_ridgeness, "ridgeness", 0, kMost);
    expect(options.min_sphericalness, "sphericalness", 0, 1);
    expect(options.min_cyclideness, "cyclideness", 0, kMost);
    expect(options.min_length, "length", 0, kMost);
    expect(options.min_radii, "length in radii", 0, kMost);
    expect(options.gap, "gap", 0, 50);
    expect(options.snap, "snap", 0, 0.49);
}

bool is_kept(const CrestMeasures& m, double radius, const CrestOptions& options) {
    return m.significance >= options.min_significance && m.sharpness >= options.min_sharpness &&
           m.ridgeness >= options.min_ridgeness && m.sphericalness >= options.min_sphericalness &&
           m.cyclideness >= options.min_cyclideness && m.length >= options.min_length &&
           m.length >= options.min_radii * radius;
}

/// Drops the lines that `is_good` refuses.
template <typename Test>
void filter(CrestGraph& graph, Test is_good) {
    std::vector<bool> is_dropped(graph.pieces.size(), false);
    for (const CrestLine& line : crest_lines(graph)) {
        const double radius = graph.points[line.points[line.points.size() / 2]].radius;
        if (is_good(measure(graph, line), radius)) continue;
        for (int piece : line.pieces) is_dropped[piece] = true;
    }
    drop_pieces(graph, is_dropped);
}

CrestGraph lines_of_kind(const MeshArrays& arrays, const LocalFitter& fitter,
                         const std::vector<VertexFit>& fits, bool is_ravine,
                         const CrestOptions& options) {
    CrestGraph graph = find_crests(arrays, fits, is_ravine);
    drop_twigs(graph, kTwigRadii);
    filter(graph, [&](const CrestMeasures& m, double) {
        return m.significance >= kHopelessShare * options.min_significance &&
               m.sharpness >= kHopelessShare * options.min_sharpness;
    });
    bridge_gaps(arrays, fitter, options.gap, graph);
    filter(graph,
           [&](const CrestMeasures& m, double radius) { return is_kept(m, radius, options); });
    smooth_lines(arrays, graph);
    snap_to_vertices(arrays, options.snap, graph);
    drop_twigs(graph, kTwigRadii);
    meet_barriers(arrays, fitter, options.gap, graph);
    return graph;
}

struct Barriers {
    std::vector<bool> is_sharp;
    RobustDihedrals dihedrals;
};

/// The creases. Edges with two lines of the like beside them are facets of a rounded crest, found
/// by fits; two creases side by side, as of a chamfer, stay creases, but where noise makes lines
/// too.
Barriers sharp_barriers(const MeshArrays& arrays, const CrestOptions& options) {
    if (!options.is_sharp_first) return {std::vector<bool>(arrays.edge_count(), false), {}};
    SharpOptions sharp;
    sharp.high_angle = options.sharp_angle;
    sharp.low_angle = options.sharp_low_angle;
    RobustDihedrals dihedrals = robust_dihedrals(arrays, sharp.low_angle, options.threads);
    std::vector<double>& angles = dihedrals.angles;
    std::vector<int> facets;
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const double angle = std::abs(angles[e]);
        if (angle < sharp.low_angle || angle >= kCertainAngle) continue;
        const int most = dihedrals.is_noisy_edge[e] ? 1 : kFacetLines;
        if (lines_beside(arrays, angles, e, most) == most) facets.push_back(e);
    }
    for (int e : facets) angles[e] = 0;
    std::vector<bool> is_sharp = sharp_edges(arrays, dihedrals, sharp, kLeastSharpEdges);
    return {std::move(is_sharp), std::move(dihedrals)};
}

/// Sharp edges as arcs, with nodes where crest lines meet them. What crest lines end at stays when
/// arcs are straightened.
EdgeNetwork sharp_network(const MeshArrays& arrays, const Barriers& barriers,
                          const std::vector<CrestGraph>& graphs, const LocalFitter& fitter) {
    std::vector<bool> is_corner(arrays.vertex_count(), false);
    for (const CrestGraph& graph : graphs) {
        for (const auto& piece : graph.pieces) {
            for (int p : piece) {
                const int vertex = graph.points[p].vertex;
                if (vertex >= 0 && fitter.is_on_barrier(vertex)) is_corner[vertex] = true;
            }
        }
    }
    EdgeNetwork edges = trace_edges(arrays, barriers.is_sharp, {}, "sharp", is_corner);
    RobustDihedrals dihedrals = barriers.dihedrals;
    for (int e = 0; e < arrays.edge_count() && !dihedrals.normals.empty(); ++e)
        for (int v : arrays.edge_vertices[e])
            if (is_corner[v]) dihedrals.is_noisy_edge[e] = false;
    edges.network = straighten_noisy(arrays, dihedrals, edges);
    return edges;
}

}  // namespace

FeatureCurveNetwork detect_crest(const LoadedMesh& mesh, const CrestOptions& options) {
    check(options);
    const MeshArrays arrays = mesh_arrays(mesh.mesh, options.threads);
    const Barriers barriers = sharp_barriers(arrays, options);
    const LocalFitter fitter(arrays, barriers.is_sharp);
    LocalFitOptions fit{
        .rings = options.rings, .radius = options.radius, .threads = options.threads};
    if (!(fit.rings > 0) && !(fit.radius > 0))
        fit.rings = choose_rings(fitter, arrays.vertex_count(), options.threads);
    const std::vector<VertexFit> fits = fitter.fit_all(fit);
    std::vector<CrestGraph> graphs;
    std::vector<std::string> sources;
    for (bool is_ravine : {false, true}) {
        if (options.kind == (is_ravine ? CrestKind::Ridges : CrestKind::Ravines)) continue;
        graphs.push_back(lines_of_kind(arrays, fitter, fits, is_ravine, options));
        sources.push_back(is_ravine ? "crest-ravine" : "crest-ridge");
    }
    EdgeNetwork edges = sharp_network(arrays, barriers, graphs, fitter);
    FeatureCurveNetwork network = std::move(edges.network);
    std::vector<int> node_of_vertex(arrays.vertex_count(), -1);
    for (std::size_t n = 0; n < edges.node_vertices.size(); ++n)
        node_of_vertex[edges.node_vertices[n]] = static_cast<int>(n);
    const double spacing = fit.rings > kCleanRings ? kSpacing : 0;
    int next_line = 0;
    for (std::size_t g = 0; g < graphs.size(); ++g)
        next_line =
            add_crest_arcs(graphs[g], node_of_vertex, sources[g], next_line, spacing, network);
    set_provenance(network, mesh);
    return network;
}

}  // namespace fcn
