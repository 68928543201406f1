// The surface is remeshed to short edges with the network in it, as for triangles
// (incremental_remeshing.h), but cut more finely: each segment becomes a chain of edges that
// follows the dense samples, not the chord. Then every edge that joins curves without being part of
// one is halved, so that no face lies between two curves: a direction in such a face could follow
// only one of them, and a map could not keep both straight without squeezing it. What
// keeps triangles from crossing, and the attempts and repairs of adaptive_remeshing.h, are left
// out: they mend a surface that others see, and here only its inside matters, which carries a field
// and a map.
#include "meshing/quad_domain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "geometry/errors.h"
#include "meshing/hole_filling.h"
#include "meshing/incremental_remeshing.h"
#include "meshing/network_embedding.h"
#include "meshing/remesh_output.h"

namespace fcn {
namespace {

constexpr double kLeastImportance = 0.1;
constexpr std::size_t kLongestWalk = 64;  ///< edges of a piece that is not a single one

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool is_curve_vertex(const WorkingMesh& mesh, int v) {
    return mesh.is_on_curve(v) || mesh.is_on_boundary(v);
}

/// Halves free edges between vertices of curves.
void separate_curves(WorkingMesh& mesh, const ReferenceSurface& reference) {
    std::vector<std::array<int, 2>> joints;
    for (int h = 0; h < mesh.halfedge_end(); ++h)
        if (mesh.is_first(h) && !mesh.is_marked(h) && is_curve_vertex(mesh, mesh.from(h)) &&
            is_curve_vertex(mesh, mesh.to(h)))
            joints.push_back({mesh.from(h), mesh.to(h)});
    for (const auto& [a, b] : joints) {
        const int h = mesh.find_edge(a, b);
        const auto [i, j, k] = mesh.corners(WorkingMesh::face(h));
        const Vec3 normal = (mesh.point(j) - mesh.point(i)).cross(mesh.point(k) - mesh.point(i));
        const Vec3 middle = (mesh.point(a) + mesh.point(b)) / 2;
        const int place = mesh.place(a);
        const ReferencePoint near = reference.closest(middle, normal.stableNormalized(),
                                                      (mesh.point(a) - middle).norm(), place);
        const int vertex = mesh.split(h, near.face >= 0 ? near.position : middle);
        mesh.set_place(vertex, near.face >= 0 ? near.face : place);
    }
}

/// Between 0 and 1 by the weight for its length, compared with that of strong segments.
std::vector<double> importances(const FeatureCurveNetwork& network) {
    std::vector<double> density;
    for (const NetworkSegment& segment : network.segments) {
        const auto& nodes = network.nodes;
        const double length =
            (nodes[at(segment.nodes[0])].position - nodes[at(segment.nodes[1])].position).norm();
        density.push_back(length > 0 ? std::max(0.0, segment.weight) / length : 0);
    }
    if (density.empty()) return {};
    std::vector<double> sorted = density;
    std::sort(sorted.begin(), sorted.end());
    const double strong = sorted[sorted.size() * 9 / 10];
    for (double& d : density)
        d = strong > 0 ? std::clamp(std::sqrt(d / strong), kLeastImportance, 1.0) : 1;
    return density;
}

/// Finds the edges of the pieces in the finished mesh.
class CurveLabels {
public:
    CurveLabels(const MarkedMesh& marked, QuadDomain& domain)
        : mesh_(marked.mesh), roles_(marked.edge_role), domain_(domain) {
        domain_.edge_arc.assign(mesh_.n_edges(), -1);
        domain_.edge_segment.assign(mesh_.n_edges(), -1);
        domain_.edge_weight.assign(mesh_.n_edges(), 0);
    }

    void label(const FeaturePiece& piece, int from, int to, double importance) {
        if (from < 0 || to < 0) return;
        const HalfedgeHandle direct = mesh_.find_halfedge(VertexHandle(from), VertexHandle(to));
        if (direct.is_valid() && is_open(mesh_.edge_handle(direct))) {
            set(mesh_.edge_handle(direct), piece, importance);
            return;
        }
        for (const EdgeHandle edge : walk(VertexHandle(from), VertexHandle(to)))
            set(edge, piece, importance);
    }

private:
    bool is_open(EdgeHandle edge) const {
        return roles_[at(edge.idx())] == EdgeRole::Feature && domain_.edge_arc[at(edge.idx())] < 0;
    }

    void set(EdgeHandle edge, const FeaturePiece& piece, double importance) {
        domain_.edge_arc[at(edge.idx())] = piece.arc;
        domain_.edge_segment[at(edge.idx())] = piece.segment;
        domain_.edge_weight[at(edge.idx())] = importance;
    }

    /// Feature edges of the shortest way along features; empty: none.
    std::vector<EdgeHandle> walk(VertexHandle from, VertexHandle to) const {
        std::vector<VertexHandle> queue{from};
        std::vector<HalfedgeHandle> arrived{HalfedgeHandle()};
        for (std::size_t i = 0; i < queue.size() && i < kLongestWalk; ++i) {
            for (const HalfedgeHandle out : mesh_.voh_range(queue[i])) {
                const VertexHandle next = mesh_.to_vertex_handle(out);
                if (!is_open(mesh_.edge_handle(out)) ||
                    std::find(queue.begin(), queue.end(), next) != queue.end())
                    continue;
                queue.push_back(next);
                arrived.push_back(out);
                if (next == to) return way_back(queue, arrived);
            }
        }
        return {};
    }

    std::vector<EdgeHandle> way_back(const std::vector<VertexHandle>& queue,
                                     const std::vector<HalfedgeHandle>& arrived) const {
        std::vector<EdgeHandle> edges;
        for (std::size_t i = queue.size() - 1; arrived[i].is_valid();) {
            edges.push_back(mesh_.edge_handle(arrived[i]));
            const VertexHandle before = mesh_.from_vertex_handle(arrived[i]);
            i = static_cast<std::size_t>(std::find(queue.begin(), queue.end(), before) -
                                         queue.begin());
        }
        return edges;
    }

    const Mesh& mesh_;
    const std::vector<EdgeRole>& roles_;
    QuadDomain& domain_;
};

/// The incremental steps. No thin places are marked: triangles of two sheets may cross.
void remesh(WorkingMesh& mesh, const ReferenceSurface& reference, const EdgeTarget& target,
            int iterations) {
    coarsen(mesh, target);
    for (int i = 0; i < iterations; ++i) remesh_once(mesh, reference, target);
    flip_for_angles(mesh, target);
}

QuadDomain domain_of(const LoadedMesh& input, const FeatureCurveNetwork& network,
                     const ReferenceSurface& reference, const QuadDomainOptions& options) {
    NetworkInMesh work = options.is_guided
                             ? embed_network(input, network, options.edge_length, reference)
                             : NetworkInMesh{working_mesh(input), {}, {}};
    const EdgeTarget target{options.edge_length, {}, {}, {}};
    remesh(work.mesh, reference, target, options.iterations);
    separate_curves(work.mesh, reference);
    work.mesh.compact();

    QuadDomain domain;
    domain.warnings = std::move(work.warnings);
    MarkedMesh marked = work.mesh.to_marked_mesh();
    CurveLabels labels(marked, domain);
    const std::vector<double> importance = importances(network);
    for (const FeaturePiece& piece : work.pieces.pieces)
        labels.label(piece, marked.station_vertex[at(piece.from)],
                     marked.station_vertex[at(piece.to)],
                     piece.segment >= 0 ? importance[at(piece.segment)] : 1);
    for (int v = 0; v < work.mesh.vertex_end(); ++v)
        domain.vertex_place.push_back(work.mesh.place(v));
    domain.node_vertex.assign(network.nodes.size(), -1);
    for (std::size_t i = 0; i < network.nodes.size() && i < marked.station_vertex.size(); ++i)
        domain.node_vertex[i] = marked.station_vertex[i];
    domain.face_label = std::move(marked.face_label);
    domain.mesh = std::move(marked.mesh);
    return domain;
}

/// Numbers of arcs, segments and faces as the caller knows them.
QuadDomain domain_of_filled(const LoadedMesh& input, const FeatureCurveNetwork& network,
                            const FilledMesh& filled, const QuadDomainOptions& options) {
    const KeptNetwork kept = without_filled_loops(network, filled);
    QuadDomain domain =
        domain_of(filled.mesh, kept.network, ReferenceSurface(filled.mesh.mesh), options);
    for (int& arc : domain.edge_arc)
        if (arc >= 0) arc = kept.arcs[at(arc)];
    for (int& segment : domain.edge_segment)
        if (segment >= 0) segment = kept.segments[at(segment)];
    for (int& place : domain.vertex_place)
        if (place >= static_cast<int>(input.mesh.n_faces())) place = -1;
    domain.filled_holes = filled.holes;
    return domain;
}

}  // namespace

QuadDomain make_quad_domain(const LoadedMesh& input, const FeatureCurveNetwork& network,
                            const QuadDomainOptions& options) {
    RemeshOptions checked;
    checked.edge_length = options.edge_length;
    checked.iterations = options.iterations;
    check_remesh_input(input, checked);
    if (options.filled_loop > 0) {
        const FilledMesh filled = fill_short_loops(input, options.filled_loop);
        if (!filled.holes.empty()) return domain_of_filled(input, network, filled, options);
    }
    const std::unique_ptr<ReferenceSurface> own =
        options.reference ? nullptr : std::make_unique<ReferenceSurface>(input.mesh);
    return domain_of(input, network, options.reference ? *options.reference : *own, options);
}

}  // namespace fcn
