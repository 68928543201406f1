#include "meshing/remesh_output.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/errors.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kForcedCosine = 0.8660254037844387;  ///< 30 degrees

bool is_marked(const MarkedMesh& marked, HalfedgeHandle h) {
    return marked.edge_role[static_cast<std::size_t>(marked.mesh.edge_handle(h).idx())] !=
           EdgeRole::Free;
}

bool is_spike(const MarkedMesh& marked, VertexHandle vertex) {
    const Mesh& mesh = marked.mesh;
    if (!marked.is_fixed_vertex[static_cast<std::size_t>(vertex.idx())] || mesh.is_boundary(vertex))
        return false;
    double angles = 0;
    for (const HalfedgeHandle h : mesh.voh_range(vertex))
        angles += angle_at(mesh.point(vertex), mesh.point(mesh.to_vertex_handle(h)),
                           mesh.point(mesh.to_vertex_handle(mesh.next_halfedge_handle(h))));
    return angles < kSpikeAngle;
}

/// Whether the face's smallest angle is small and lies between two marked edges or at a spike.
bool is_forced(const MarkedMesh& marked, FaceHandle face) {
    const Mesh& mesh = marked.mesh;
    HalfedgeHandle shortest = mesh.halfedge_handle(face);
    for (const HalfedgeHandle h : mesh.fh_range(face))
        if (mesh.calc_edge_length(h) < mesh.calc_edge_length(shortest)) shortest = h;
    if (!(is_marked(marked, mesh.next_halfedge_handle(shortest)) &&
          is_marked(marked, mesh.prev_halfedge_handle(shortest))) &&
        !is_spike(marked, mesh.to_vertex_handle(mesh.next_halfedge_handle(shortest))))
        return false;
    const auto v = face_vertices(mesh, face);
    return cosine_of_smallest_angle(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2])) >
           kForcedCosine;
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

}  // namespace

void check_remesh_input(const LoadedMesh& mesh, const RemeshOptions& options) {
    if (!(options.edge_length > 0) || !std::isfinite(options.edge_length))
        throw InputError("remesh: edge length must be > 0, it is " +
                         std::to_string(options.edge_length));
    if (options.iterations < 1 || options.iterations > 1000)
        throw InputError("remesh: iterations must be in 1 .. 1000, they are " +
                         std::to_string(options.iterations));
    if (!(options.curvature_tolerance >= 0) || !std::isfinite(options.curvature_tolerance))
        throw InputError("remesh: curvature tolerance must be >= 0, it is " +
                         std::to_string(options.curvature_tolerance));
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

void report_broken(const NetworkInMesh& embedded, const FeatureCurveNetwork& network,
                   RemeshResult& result) {
    const std::vector<int> broken = broken_pieces(embedded.mesh, embedded.pieces);
    if (broken.empty()) return;
    result.warnings.push_back(
        std::to_string(broken.size()) + " of " + std::to_string(embedded.pieces.pieces.size()) +
        (network.segments.empty() ? " pieces of the initial network" : " pieces of segments") +
        " are not single edges of the mesh");
    for (const int piece : broken) {
        const FeaturePiece& what = embedded.pieces.pieces[static_cast<std::size_t>(piece)];
        result.broken_segments.push_back(what.segment >= 0 ? what.segment : what.arc);
    }
    std::sort(result.broken_segments.begin(), result.broken_segments.end());
    result.broken_segments.erase(
        std::unique(result.broken_segments.begin(), result.broken_segments.end()),
        result.broken_segments.end());
}

void fill_output(const LoadedMesh& input, const MarkedMesh& remeshed, RemeshResult& result) {
    result.mesh = make_output(input, remeshed);
    for (const EdgeHandle edge : remeshed.mesh.edges()) {
        if (remeshed.edge_role[static_cast<std::size_t>(edge.idx())] != EdgeRole::Feature) continue;
        const HalfedgeHandle h = remeshed.mesh.halfedge_handle(edge, 0);
        result.feature_edges.push_back(
            {remeshed.mesh.from_vertex_handle(h).idx(), remeshed.mesh.to_vertex_handle(h).idx()});
    }
    for (const FaceHandle face : remeshed.mesh.faces())
        if (is_forced(remeshed, face)) result.forced_faces.push_back(face.idx());
}

std::vector<FeatureSource> find_sources(const NetworkInMesh& embedded,
                                        const std::vector<std::array<int, 2>>& feature_edges) {
    const auto count = static_cast<std::size_t>(embedded.mesh.vertex_end());
    std::vector<std::vector<int>> edges_at(count);
    for (int e = 0; e < static_cast<int>(feature_edges.size()); ++e)
        for (const int v : feature_edges[static_cast<std::size_t>(e)])
            edges_at[static_cast<std::size_t>(v)].push_back(e);
    std::vector<bool> is_station(count, false);
    for (const int v : embedded.mesh.tracked())
        if (v >= 0) is_station[static_cast<std::size_t>(v)] = true;
    std::multimap<std::pair<int, int>, int> pieces;  // by the vertices of their ends
    for (std::size_t i = 0; i < embedded.pieces.pieces.size(); ++i) {
        const FeaturePiece& piece = embedded.pieces.pieces[i];
        const int from = embedded.mesh.tracked()[static_cast<std::size_t>(piece.from)];
        const int to = embedded.mesh.tracked()[static_cast<std::size_t>(piece.to)];
        pieces.emplace(std::pair(std::min(from, to), std::max(from, to)), static_cast<int>(i));
    }
    std::vector<FeatureSource> sources(feature_edges.size());
    std::vector<bool> is_done(feature_edges.size(), false);
    const auto trace = [&](int start, int edge) {
        std::vector<int> chain;
        int v = start;
        while (edge >= 0 && !is_done[static_cast<std::size_t>(edge)]) {
            is_done[static_cast<std::size_t>(edge)] = true;
            chain.push_back(edge);
            const auto& ends = feature_edges[static_cast<std::size_t>(edge)];
            v = ends[0] == v ? ends[1] : ends[0];
            const auto& here = edges_at[static_cast<std::size_t>(v)];
            if (is_station[static_cast<std::size_t>(v)] || here.size() != 2) break;
            edge = here[0] == edge ? here[1] : here[0];
        }
        const auto found = pieces.find({std::min(start, v), std::max(start, v)});
        if (found == pieces.end()) return;
        const FeaturePiece& piece = embedded.pieces.pieces[static_cast<std::size_t>(found->second)];
        for (const int e : chain) sources[static_cast<std::size_t>(e)] = {piece.arc, piece.segment};
        pieces.erase(found);
    };
    for (int v = 0; v < embedded.mesh.vertex_end(); ++v)
        if (is_station[static_cast<std::size_t>(v)])
            for (const int e : edges_at[static_cast<std::size_t>(v)])
                if (!is_done[static_cast<std::size_t>(e)]) trace(v, e);
    return sources;
}

}  // namespace fcn
