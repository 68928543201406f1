// Remeshing with a network: embed, coarsen, remesh, polish.
//
// CGAL's remesher keeps protected edges as they are, so the network must arrive as edges of the
// right length. (1) Every segment is laid along its dense samples into the mesh (embedding.h): the
// samples lie on the surface, its chord does not, and only the samples say on which side of it the
// surface's features run. (2) The chain of small edges between the two nodes is collapsed to one
// (coarsening.h). (3) CGAL remeshes everything else (isotropic_cgal.h). (4) The few bad triangles
// that remain beside protected edges are improved one by one (polish.h). Plain remeshing, without
// protection, is CGAL's alone: it is the baseline. A segment whose chain does
// not collapse stays a chain, which is still a valid mesh, and is counted in a warning; a failure
// of CGAL is answered by a simpler run (no projection, then the coarsened mesh as it is). Mesh
// boundaries and borders between labels that the network leaves out are kept as curves of their
// own.
#include <chrono>
#include <cmath>

#include "geometry/errors.h"
#include "meshing/coarsening.h"
#include "meshing/embedding.h"
#include "meshing/feature_pieces.h"
#include "meshing/isotropic_cgal.h"
#include "meshing/polish.h"
#include "meshing/remesh.h"

namespace fcn {
namespace {

constexpr double kSnapShare = 0.03;      ///< of L: points closer than this to an edge lie on it
constexpr double kFlatnessShare = 0.01;  ///< of L: how closely the embedding follows the samples
constexpr int kMaxUntangling = 3;        ///< rounds of embedding

int label_of(const LoadedMesh& mesh, int face) {
    return mesh.face_labels.empty() ? 0 : mesh.face_labels[static_cast<std::size_t>(face)];
}

void mark_borders(MarkedMesh& marked) {
    for (const EdgeHandle edge : marked.mesh.edges()) {
        EdgeRole& role = marked.edge_role[static_cast<std::size_t>(edge.idx())];
        if (role != EdgeRole::Free) continue;
        if (marked.mesh.is_boundary(edge)) {
            role = EdgeRole::Border;
            continue;
        }
        const auto label = [&](unsigned side) {
            const FaceHandle face =
                marked.mesh.face_handle(marked.mesh.halfedge_handle(edge, side));
            return marked.face_label[static_cast<std::size_t>(face.idx())];
        };
        if (label(0) != label(1)) role = EdgeRole::Border;
    }
}

MarkedMesh mark(const LoadedMesh& input, EmbeddedMesh embedded) {
    MarkedMesh marked;
    marked.mesh = std::move(embedded.mesh);
    marked.edge_role.assign(marked.mesh.n_edges(), EdgeRole::Free);
    marked.is_fixed_vertex.assign(marked.mesh.n_vertices(), false);
    for (const int face : embedded.source_face) marked.face_label.push_back(label_of(input, face));
    marked.station_vertex = embedded.station_vertex;
    for (const int vertex : marked.station_vertex)
        if (vertex >= 0) marked.is_fixed_vertex[static_cast<std::size_t>(vertex)] = true;
    for (const auto& chain : embedded.chains) {
        for (std::size_t i = 1; i < chain.size(); ++i) {
            const HalfedgeHandle h =
                marked.mesh.find_halfedge(VertexHandle(chain[i - 1]), VertexHandle(chain[i]));
            if (!h.is_valid()) throw LogicError("remesh: a chain leaves the mesh's edges");
            marked.edge_role[static_cast<std::size_t>(marked.mesh.edge_handle(h).idx())] =
                EdgeRole::Feature;
        }
    }
    mark_borders(marked);
    return marked;
}

MarkedMesh unmarked(const LoadedMesh& input) {
    MarkedMesh marked;
    marked.mesh = input.mesh;
    marked.edge_role.assign(input.mesh.n_edges(), EdgeRole::Free);
    marked.is_fixed_vertex.assign(input.mesh.n_vertices(), false);
    for (const FaceHandle face : input.mesh.faces())
        marked.face_label.push_back(label_of(input, face.idx()));
    mark_borders(marked);
    return marked;
}

/// Pieces whose two stations are not joined by a single feature edge.
std::size_t count_broken(const MarkedMesh& marked, const FeaturePieces& pieces) {
    std::size_t broken = 0;
    for (const FeaturePiece& piece : pieces.pieces) {
        const int from = marked.station_vertex[static_cast<std::size_t>(piece.from)];
        const int to = marked.station_vertex[static_cast<std::size_t>(piece.to)];
        const HalfedgeHandle h = marked.mesh.find_halfedge(VertexHandle(from), VertexHandle(to));
        const bool is_edge =
            h.is_valid() &&
            marked.edge_role[static_cast<std::size_t>(marked.mesh.edge_handle(h).idx())] ==
                EdgeRole::Feature;
        broken += !is_edge;
    }
    return broken;
}

/// Embeds the pieces. Dense samples may run together before the node they both end in (the
/// adaptation drags them there); such pieces take the straight way over the surface instead.
EmbeddedMesh embed_apart(const LoadedMesh& input, FeaturePieces pieces, double edge_length) {
    EmbeddingOptions options;
    options.snap = kSnapShare * edge_length;
    options.flatness = kFlatnessShare * edge_length;
    EmbeddedMesh embedded = embed_pieces(input.mesh, pieces, options);
    for (int round = 0; round < kMaxUntangling; ++round) {
        bool is_changed = false;
        for (const int piece : entangled_pieces(embedded, pieces)) {
            auto& points = pieces.pieces[static_cast<std::size_t>(piece)].points;
            is_changed = is_changed || !points.empty();
            points.clear();
        }
        if (!is_changed) break;
        embedded = embed_pieces(input.mesh, pieces, options);
    }
    return embedded;
}

/// Embeds and coarsens; falls back to the mesh without the network, with a warning.
MarkedMesh prepare(const LoadedMesh& input, const FeatureCurveNetwork& network,
                   const RemeshOptions& options, const SurfaceQueries& surface,
                   std::vector<std::string>& warnings) {
    const double length = options.edge_length;
    CoarseningOptions coarsening;
    coarsening.edge_length = length;
    const FeaturePieces pieces = cut_into_pieces(network, length, surface);
    try {
        EmbeddedMesh embedded = embed_apart(input, pieces, length);
        if (embedded.lost_pieces > 0)
            warnings.push_back(std::to_string(embedded.lost_pieces) +
                               " pieces of the network join parts of the mesh that are not "
                               "connected; they are left out");
        MarkedMesh marked = coarsen(mark(input, std::move(embedded)), coarsening);
        if (const std::size_t broken = count_broken(marked, pieces); broken > 0)
            warnings.push_back(std::to_string(broken) + " of " +
                               std::to_string(pieces.pieces.size()) +
                               (network.segments.empty() ? " pieces of the initial network"
                                                         : " pieces of segments") +
                               " are not single edges of the mesh");
        return marked;
    } catch (const LogicError& error) {
        warnings.push_back(std::string("the network could not be embedded (") + error.what() +
                           "); remeshed without it");
        return coarsen(unmarked(input), coarsening);
    }
}

/// CGAL's remesher; where it fails, without projection; where that fails, the mesh as it is.
MarkedMesh remesh_robustly(const MarkedMesh& marked, const SurfaceQueries& surface,
                           const RemeshOptions& options, std::vector<std::string>& warnings) {
    IsotropicOptions isotropic;
    isotropic.edge_length = options.edge_length;
    isotropic.iterations = options.iterations;
    isotropic.is_protecting = options.is_protecting;
    for (const bool is_projecting : {true, false}) {
        isotropic.is_projecting = is_projecting;
        IsotropicResult result = remesh_isotropic(marked, surface, isotropic);
        if (result.lost_features > 0)
            warnings.push_back(std::to_string(result.lost_features) +
                               " protected edges were not kept by the remesher");
        if (result.has_succeeded) return std::move(result.mesh);
        warnings.push_back(std::string("CGAL's remesher failed") +
                           (is_projecting ? "" : " without projection too") + ": " +
                           result.failure);
    }
    warnings.push_back("the mesh is coarsened only");
    return marked;
}

LoadedMesh make_output(const LoadedMesh& input, const MarkedMesh& remeshed) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const VertexHandle vertex : remeshed.mesh.vertices())
        points.push_back(remeshed.mesh.point(vertex));
    for (const FaceHandle face : remeshed.mesh.faces()) {
        const auto v = face_vertices(remeshed.mesh, face);
        triangles.push_back({v[0].idx(), v[1].idx(), v[2].idx()});
    }
    const std::vector<int> labels =
        input.face_labels.empty() ? std::vector<int>{} : remeshed.face_label;
    // The soup is an oriented manifold already; the reader's path also computes the hash.
    LoadedMesh output = mesh_from_soup(points, triangles, labels);
    const bool is_same = output.repairs.is_clean() && output.mesh.n_vertices() == points.size() &&
                         output.mesh.n_faces() == triangles.size();
    if (!is_same) {  // e.g. two vertices at one place: keep them apart
        output = {};
        output.mesh = remeshed.mesh;
        output.face_labels = labels;
    }
    output.repairs = {};
    output.label_names = input.label_names;
    output.name = input.name;
    output.units = input.units;
    return output;
}

std::vector<std::array<int, 2>> feature_edges(const MarkedMesh& marked) {
    std::vector<std::array<int, 2>> edges;
    for (const EdgeHandle edge : marked.mesh.edges()) {
        if (marked.edge_role[static_cast<std::size_t>(edge.idx())] != EdgeRole::Feature) continue;
        const HalfedgeHandle h = marked.mesh.halfedge_handle(edge, 0);
        edges.push_back(
            {marked.mesh.from_vertex_handle(h).idx(), marked.mesh.to_vertex_handle(h).idx()});
    }
    return edges;
}

void check_input(const LoadedMesh& mesh, const RemeshOptions& options) {
    if (!(options.edge_length > 0) || !std::isfinite(options.edge_length))
        throw InputError("remesh: edge length must be > 0, it is " +
                         std::to_string(options.edge_length));
    if (options.iterations < 1 || options.iterations > 1000)
        throw InputError("remesh: iterations must be in 1 .. 1000, they are " +
                         std::to_string(options.iterations));
    if (mesh.mesh.n_faces() == 0) throw InputError("remesh: the mesh has no faces");
    if (!mesh.face_labels.empty() && mesh.face_labels.size() != mesh.mesh.n_faces())
        throw InputError("remesh: the mesh has " + std::to_string(mesh.mesh.n_faces()) +
                         " faces but " + std::to_string(mesh.face_labels.size()) + " labels");
    double area = 0;
    for (const FaceHandle face : mesh.mesh.faces()) area += face_area(mesh.mesh, face);
    constexpr double kMaxFaces = 5e7;
    if (2.3 * area / (options.edge_length * options.edge_length) > kMaxFaces)
        throw InputError("remesh: edge length " + std::to_string(options.edge_length) +
                         " asks for more than 50 million faces");
}

}  // namespace

RemeshResult remesh_with_cgal(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                              const RemeshOptions& options) {
    check_input(mesh, options);
    const auto start = std::chrono::steady_clock::now();
    RemeshResult result;
    const SurfaceQueries surface(mesh.mesh);
    const MarkedMesh marked = options.is_protecting
                                  ? prepare(mesh, network, options, surface, result.warnings)
                                  : unmarked(mesh);
    MarkedMesh remeshed = remesh_robustly(marked, surface, options, result.warnings);
    if (options.is_protecting) {
        PolishOptions polishing;
        polishing.edge_length = options.edge_length;
        remeshed = polish(remeshed, surface, polishing);
    }
    result.mesh = make_output(mesh, remeshed);
    result.feature_edges = feature_edges(remeshed);
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace fcn
