// A network becomes marked edges of a working mesh. Every segment is laid along its dense samples:
// the samples lie on the surface, its chord does not, and only the samples say on which side of it
// the surface's features run. Samples may run together before the node they both end in (the
// adaptation drags them there); such pieces take the straight way over the surface instead. Mesh
// boundaries and borders between labels that the network leaves out are curves of their own, whose
// corners stay.
#include "meshing/network_embedding.h"

#include "geometry/errors.h"
#include "meshing/embedding.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kSnapShare = 0.03;      ///< of L: points closer than this to an edge lie on it
constexpr double kFlatnessShare = 0.01;  ///< of L: how closely the embedding follows the samples
constexpr int kMaxUntangling = 3;        ///< rounds of embedding
constexpr double kSharedEnd = 0.1;  ///< of L: curves may run together for so long before a node
constexpr double kLeastTurn = 0.5;  ///< cosine of the angle that faces may turn by there
constexpr double kCornerCosine = 0.7071067811865476;  ///< borders that turn more keep the vertex

int label_of(const LoadedMesh& mesh, int face) {
    return mesh.face_labels.empty() ? 0 : mesh.face_labels[static_cast<std::size_t>(face)];
}

EmbeddedMesh embed_apart(const LoadedMesh& input, FeaturePieces pieces, double edge_length) {
    EmbeddingOptions options;
    options.snap = kSnapShare * edge_length;
    options.flatness = kFlatnessShare * edge_length;
    options.detour = edge_length;
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

/// Ends, junctions and corners of curves, and where one kind of curve turns into another.
void fix_corners(WorkingMesh& mesh) {
    for (int v = 0; v < mesh.vertex_end(); ++v) {
        if (!mesh.is_vertex_alive(v) || mesh.is_fixed(v) || !mesh.is_on_curve(v)) continue;
        std::vector<std::pair<EdgeRole, Vec3>> marked;
        const auto add = [&](int h, int other) {
            if (mesh.is_marked(h))
                marked.emplace_back(mesh.role(h), (mesh.point(other) - mesh.point(v)).normalized());
        };
        int last = -1;
        mesh.visit_star(v, [&](int h) {
            add(h, mesh.to(h));
            last = WorkingMesh::prev(h);
            return true;
        });
        if (mesh.is_on_boundary(v)) add(last, mesh.from(last));
        bool is_corner = marked.size() != 2 || marked[0].first != marked[1].first;
        if (!is_corner && marked[0].first == EdgeRole::Border)
            is_corner = -marked[0].second.dot(marked[1].second) < kCornerCosine;
        // Where curves only run together there is no node, and better triangles may undo it.
        if (is_corner && marked.size() > 2)
            mesh.fix_cut(v);
        else if (is_corner)
            mesh.fix(v);
    }
}

bool keeps_faces(const WorkingMesh& mesh, int vanishing, int staying) {
    const Vec3 &here = mesh.point(vanishing), &there = mesh.point(staying);
    return mesh.visit_star(vanishing, [&](int h) {
        const int b = mesh.to(h), c = mesh.apex(h);
        if (b == staying || c == staying) return true;
        const Vec3 &pb = mesh.point(b), &pc = mesh.point(c);
        return triangle_normal(there, pb, pc).dot(triangle_normal(here, pb, pc)) > kLeastTurn;
    });
}

/// Where curves run together just before the node they all end in, the node is brought forward to
/// where they meet, or the edge they share would stay, however short it is.
void close_shared_ends(WorkingMesh& mesh, const std::vector<bool>& is_shared, double longest) {
    const auto close = [&](int h) {
        if (!mesh.is_halfedge_alive(h) || mesh.role(h) != EdgeRole::Feature) return false;
        const int v = mesh.to(h), node = mesh.from(h);
        if (!mesh.is_fixed(node) || mesh.is_fixed(v) || mesh.is_on_boundary(v) ||
            !is_shared[static_cast<std::size_t>(v)] ||
            (mesh.point(v) - mesh.point(node)).norm() > longest || !mesh.can_collapse(h, v) ||
            !keeps_faces(mesh, v, node))
            return false;
        mesh.collapse(h, v);
        return true;
    };
    for (bool is_closing = true; is_closing;) {
        is_closing = false;
        for (int h = 0; h < mesh.halfedge_end(); ++h) is_closing = close(h) || is_closing;
    }
}

/// Each vertex begins at a face of the input around it.
void place_vertices(WorkingMesh& mesh, const std::vector<int>& source_face) {
    for (int v = 0; v < mesh.vertex_end(); ++v)
        if (mesh.is_vertex_alive(v))
            mesh.set_place(v,
                           source_face[static_cast<std::size_t>(WorkingMesh::face(mesh.out(v)))]);
}

WorkingMesh mark(const LoadedMesh& input, EmbeddedMesh embedded, double edge_length) {
    std::vector<int> labels;
    labels.reserve(embedded.source_face.size());
    for (const int face : embedded.source_face) labels.push_back(label_of(input, face));
    WorkingMesh mesh(std::move(embedded.points), embedded.triangles, std::move(labels));
    for (const int vertex : embedded.station_vertex)
        if (vertex >= 0) mesh.fix(vertex);
    std::vector<bool> is_shared(static_cast<std::size_t>(mesh.vertex_end()), false);
    for (const auto& chain : embedded.chains) {
        for (std::size_t i = 1; i < chain.size(); ++i) {
            const int h = mesh.find_edge(chain[i - 1], chain[i]);
            if (h < 0) throw LogicError("remesh: a chain leaves the mesh's edges");
            if (mesh.role(h) == EdgeRole::Feature)
                for (const int v : {chain[i - 1], chain[i]})
                    is_shared[static_cast<std::size_t>(v)] = true;
            mesh.set_role(h, EdgeRole::Feature);
        }
    }
    mesh.track(embedded.station_vertex);
    place_vertices(mesh, embedded.source_face);
    close_shared_ends(mesh, is_shared, kSharedEnd * edge_length);
    fix_corners(mesh);
    return mesh;
}

}  // namespace

WorkingMesh working_mesh(const LoadedMesh& input) {
    EmbeddedMesh plain;
    for (const VertexHandle vertex : input.mesh.vertices())
        plain.points.push_back(input.mesh.point(vertex));
    for (const FaceHandle face : input.mesh.faces()) {
        const auto v = face_vertices(input.mesh, face);
        plain.triangles.push_back({v[0].idx(), v[1].idx(), v[2].idx()});
        plain.source_face.push_back(face.idx());
    }
    return mark(input, std::move(plain), 0);
}

std::vector<int> broken_pieces(const WorkingMesh& mesh, const FeaturePieces& pieces) {
    std::vector<int> broken;
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        const FeaturePiece& piece = pieces.pieces[i];
        const int from = mesh.tracked()[static_cast<std::size_t>(piece.from)];
        const int to = mesh.tracked()[static_cast<std::size_t>(piece.to)];
        const int h = from < 0 || to < 0 ? -1 : mesh.find_edge(from, to);
        if (h < 0 || mesh.role(h) != EdgeRole::Feature) broken.push_back(static_cast<int>(i));
    }
    return broken;
}

NetworkInMesh embed_network(const LoadedMesh& input, const FeatureCurveNetwork& network,
                            double edge_length, const ReferenceSurface& reference) {
    FeaturePieces pieces = cut_into_pieces(network, edge_length, input.mesh, reference);
    std::vector<std::string> warnings;
    try {
        EmbeddedMesh embedded = embed_apart(input, pieces, edge_length);
        if (embedded.lost_pieces > 0)
            warnings.push_back(std::to_string(embedded.lost_pieces) +
                               " pieces of the network join points that are not connected, or "
                               "only far around; they are left out");
        return {mark(input, std::move(embedded), edge_length), std::move(pieces),
                std::move(warnings)};
    } catch (const LogicError& error) {
        warnings.push_back(std::string("the network could not be embedded (") + error.what() +
                           "); remeshed without it");
        return {working_mesh(input), {}, std::move(warnings)};
    }
}

}  // namespace fcn
