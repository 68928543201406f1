// Marked mesh edges become nodes and arcs. A marked vertex is a node unless exactly two marked
// edges meet there and the same two patches lie on both sides of both; the arcs are the maximal
// chains between nodes, traced from nodes in the order of vertex ids, edges in the order of edge
// ids. What is left are closed chains: each starts at its sharpest corner (three edges to either
// side, so that the zigzag of single edges does not decide), the smallest vertex id among equals.
// Corners inside an arc stay inside it: the adaptation decides where samples are needed.

#include "features/edge_chains.h"

#include <algorithm>
#include <cmath>

#include "geometry/errors.h"

namespace fcn {
namespace {

class ChainTracer {
public:
    ChainTracer(const MeshArrays& arrays, const std::vector<bool>& is_marked_edge,
                const std::vector<int>& patch_of_face, const std::vector<bool>& is_corner_vertex)
        : arrays_(arrays),
          patch_of_face_(patch_of_face),
          is_corner_vertex_(is_corner_vertex),
          edges_of_vertex_(edges_of_vertices(arrays, is_marked_edge)),
          is_marked_edge_(is_marked_edge),
          is_used_(arrays.edge_count(), false),
          node_of_vertex_(arrays.vertex_count(), -1),
          face_of_vertex_(arrays.vertex_count(), -1) {
        for (int f = arrays.face_count() - 1; f >= 0; --f) {
            for (int v : arrays.face_vertices[f]) face_of_vertex_[v] = f;
        }
    }

    EdgeNetwork trace(const std::string& source) {
        result_.network.diagonal = diagonal();
        for (int v = 0; v < arrays_.vertex_count(); ++v) {
            if (is_node(v)) add_node(v);
        }
        for (std::size_t n = 0; n < result_.node_vertices.size(); ++n) {
            const int v = result_.node_vertices[n];
            for (const int* e = edges_of_vertex_.begin(v); e != edges_of_vertex_.end(v); ++e) {
                if (!is_used_[*e]) emit(walk(v, *e));
            }
        }
        for (int e = 0; e < arrays_.edge_count(); ++e) {
            if (is_marked_edge_[e] && !is_used_[e]) trace_closed(e);
        }
        for (NetworkArc& arc : result_.network.arcs) arc.source = source;
        return std::move(result_);
    }

private:
    struct Chain {
        std::vector<int> vertices;
        std::vector<int> edges;
    };

    double diagonal() const {
        if (arrays_.points.empty()) return 0;
        Vec3 low = arrays_.points.front(), high = low;
        for (const Vec3& p : arrays_.points) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        return (high - low).norm();
    }

    /// Patches left and right of an edge walked from `vertex`.
    std::array<int, 2> patches(int edge, int vertex) const {
        if (patch_of_face_.empty()) return {-1, -1};
        std::array<int, 2> pair{-1, -1};
        for (int side = 0; side < 2; ++side) {
            const int face = arrays_.edge_faces[edge][side];
            if (face >= 0) pair[side] = patch_of_face_[face];
        }
        if (arrays_.edge_vertices[edge][0] != vertex) std::swap(pair[0], pair[1]);
        return pair;
    }

    int other_end(int edge, int vertex) const {
        const auto [a, b] = arrays_.edge_vertices[edge];
        return a == vertex ? b : a;
    }

    bool is_node(int v) const {
        const int valence = edges_of_vertex_.size(v);
        if (valence == 0) return false;
        if (valence != 2) return true;
        if (!is_corner_vertex_.empty() && is_corner_vertex_[v]) return true;
        const int first = edges_of_vertex_.begin(v)[0], second = edges_of_vertex_.begin(v)[1];
        return patches(first, other_end(first, v)) != patches(second, v);
    }

    void add_node(int v) {
        node_of_vertex_[v] = static_cast<int>(result_.node_vertices.size());
        result_.node_vertices.push_back(v);
        result_.network.nodes.push_back({arrays_.points[v], surface_point(v)});
    }

    SurfacePoint surface_point(int v) const {
        return surface_point_of_vertex(arrays_, v, face_of_vertex_[v]);
    }

    Chain walk(int start, int first_edge) {
        Chain chain{{start}, {}};
        int edge = first_edge;
        while (true) {
            is_used_[edge] = true;
            const int v = other_end(edge, chain.vertices.back());
            chain.edges.push_back(edge);
            chain.vertices.push_back(v);
            if (v == start || node_of_vertex_[v] >= 0) return chain;
            const int* at = edges_of_vertex_.begin(v);
            edge = at[0] == edge ? at[1] : at[0];
        }
    }

    void trace_closed(int first_edge) {
        Chain chain = walk(arrays_.edge_vertices[first_edge][0], first_edge);
        const int count = static_cast<int>(chain.edges.size());
        const int reach = std::min(3, std::max(1, count / 4));
        const auto point = [&](int i) {
            return arrays_.points[chain.vertices[(i % count + count) % count]];
        };
        const auto turning = [&](int i) {
            const Vec3 in = point(i) - point(i - reach), out = point(i + reach) - point(i);
            return std::atan2(in.cross(out).norm(), in.dot(out));
        };
        int best = 0;
        double best_turning = turning(0);
        for (int i = 1; i < count; ++i) {
            const double t = turning(i);
            const bool is_equal = std::abs(t - best_turning) <= 1e-9;
            if ((!is_equal && t > best_turning) ||
                (is_equal && chain.vertices[i] < chain.vertices[best])) {
                best = i;
                best_turning = t;
            }
        }
        chain.vertices.pop_back();
        std::rotate(chain.vertices.begin(), chain.vertices.begin() + best, chain.vertices.end());
        std::rotate(chain.edges.begin(), chain.edges.begin() + best, chain.edges.end());
        chain.vertices.push_back(chain.vertices.front());
        add_node(chain.vertices.front());
        emit(std::move(chain));
    }

    void emit(Chain chain) {
        NetworkArc arc;
        arc.nodes = {node_of_vertex_[chain.vertices.front()],
                     node_of_vertex_[chain.vertices.back()]};
        arc.samples.reserve(chain.vertices.size());
        for (int v : chain.vertices) arc.samples.push_back({arrays_.points[v], surface_point(v)});
        arc.patches = patches(chain.edges.front(), chain.vertices.front());
        double length = 0;
        for (int e : chain.edges) {
            length += arrays_.edge_length(e);
            arc.dihedral += arrays_.edge_length(e) * arrays_.dihedrals[e];
        }
        if (length > 0) arc.dihedral /= length;
        result_.network.arcs.push_back(std::move(arc));
        result_.arc_vertices.push_back(std::move(chain.vertices));
        result_.arc_edges.push_back(std::move(chain.edges));
    }

    const MeshArrays& arrays_;
    const std::vector<int>& patch_of_face_;
    const std::vector<bool>& is_corner_vertex_;
    IndexRows edges_of_vertex_;
    const std::vector<bool>& is_marked_edge_;
    std::vector<bool> is_used_;
    std::vector<int> node_of_vertex_;
    std::vector<int> face_of_vertex_;
    EdgeNetwork result_;
};

}  // namespace

EdgeNetwork trace_edges(const MeshArrays& arrays, const std::vector<bool>& is_marked_edge,
                        const std::vector<int>& patch_of_face, const std::string& source,
                        const std::vector<bool>& is_corner_vertex) {
    return ChainTracer(arrays, is_marked_edge, patch_of_face, is_corner_vertex).trace(source);
}

FeatureCurveNetwork network_from_edges(const Mesh& mesh, const std::vector<bool>& is_marked_edge,
                                       const std::vector<int>& patch_of_face,
                                       const std::string& source) {
    if (is_marked_edge.size() != mesh.n_edges()) {
        throw LogicError("network_from_edges: " + std::to_string(is_marked_edge.size()) +
                         " marks for " + std::to_string(mesh.n_edges()) + " edges");
    }
    if (!patch_of_face.empty() && patch_of_face.size() != mesh.n_faces()) {
        throw LogicError("network_from_edges: " + std::to_string(patch_of_face.size()) +
                         " patch ids for " + std::to_string(mesh.n_faces()) + " faces");
    }
    return trace_edges(mesh_arrays(mesh), is_marked_edge, patch_of_face, source).network;
}

void set_provenance(FeatureCurveNetwork& network, const LoadedMesh& mesh) {
    network.mesh_name = mesh.name;
    network.mesh_hash = mesh.hash;
    network.units = mesh.units;
    network.diagonal = bounding_box(mesh.mesh).diagonal();
}

}  // namespace fcn
