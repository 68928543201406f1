#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn::test {

/// A surface point at a mesh vertex.
inline SurfacePoint at_vertex(const Mesh& mesh, VertexHandle vertex) {
    const FaceHandle face = *mesh.cvf_iter(vertex);
    SurfacePoint point;
    point.face = face.idx();
    const auto corners = face_vertices(mesh, face);
    for (int i = 0; i < 3; ++i)
        point.barycentric[i] = corners[static_cast<std::size_t>(i)] == vertex ? 1 : 0;
    return point;
}

/// Chains of edges whose dihedral angle exceeds `angle` (boundary edges count) as an initial
/// network: nodes at vertices of valence other than two and one per closed chain.
inline FeatureCurveNetwork crease_network(const Mesh& mesh, double angle) {
    std::vector<bool> is_marked(mesh.n_edges()), is_used(mesh.n_edges());
    std::vector<int> valence(mesh.n_vertices()), node(mesh.n_vertices(), -1);
    for (const EdgeHandle edge : mesh.edges()) {
        const auto i = static_cast<std::size_t>(edge.idx());
        is_marked[i] = mesh.is_boundary(edge) || std::abs(dihedral_angle(mesh, edge)) > angle;
        if (!is_marked[i]) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        ++valence[static_cast<std::size_t>(mesh.from_vertex_handle(h).idx())];
        ++valence[static_cast<std::size_t>(mesh.to_vertex_handle(h).idx())];
    }
    FeatureCurveNetwork network;
    network.diagonal = bounding_box(mesh).diagonal();
    const auto node_at = [&](VertexHandle vertex) {
        int& index = node[static_cast<std::size_t>(vertex.idx())];
        if (index < 0) {
            index = static_cast<int>(network.nodes.size());
            network.nodes.push_back({mesh.point(vertex), at_vertex(mesh, vertex)});
        }
        return index;
    };
    const auto trace = [&](HalfedgeHandle h) {
        NetworkArc arc;
        arc.nodes[0] = node_at(mesh.from_vertex_handle(h));
        const auto add = [&](VertexHandle v) {
            arc.samples.push_back({mesh.point(v), at_vertex(mesh, v)});
        };
        add(mesh.from_vertex_handle(h));
        while (true) {
            is_used[static_cast<std::size_t>(mesh.edge_handle(h).idx())] = true;
            const VertexHandle to = mesh.to_vertex_handle(h);
            add(to);
            const auto i = static_cast<std::size_t>(to.idx());
            if (node[i] >= 0 || valence[i] != 2) break;
            for (const HalfedgeHandle out : mesh.voh_range(to)) {
                const auto e = static_cast<std::size_t>(mesh.edge_handle(out).idx());
                if (is_marked[e] && !is_used[e]) h = out;
            }
        }
        arc.nodes[1] = node_at(mesh.to_vertex_handle(h));
        network.arcs.push_back(std::move(arc));
    };
    for (const bool is_closed_pass : {false, true}) {
        for (const VertexHandle vertex : mesh.vertices()) {
            const int count = valence[static_cast<std::size_t>(vertex.idx())];
            if (count == 0 || (!is_closed_pass && count == 2)) continue;
            for (const HalfedgeHandle out : mesh.voh_range(vertex)) {
                const auto e = static_cast<std::size_t>(mesh.edge_handle(out).idx());
                if (is_marked[e] && !is_used[e]) trace(out);
            }
        }
    }
    return network;
}

/// Every arc that is long enough cut into segments of about 1.2 rmin; shorter arcs left out.
inline FeatureCurveNetwork cut_evenly(const FeatureCurveNetwork& initial, double rmin) {
    FeatureCurveNetwork result = initial;
    result.scale = rmin;
    result.ratio = 1.5;
    result.arcs.clear();
    for (NetworkArc arc : initial.arcs) {
        const double length = arc.length();
        const int count = static_cast<int>(std::round(length / (1.2 * rmin)));
        if (count < (arc.is_closed() ? 3 : 1) || length < 1.1 * rmin) continue;
        // Samples at the cuts.
        std::vector<ArcSample> samples{arc.samples.front()};
        std::vector<int> cuts{0};
        double reached = 0;
        int k = 1;
        for (std::size_t i = 1; i < arc.samples.size(); ++i) {
            const ArcSample &a = arc.samples[i - 1], &b = arc.samples[i];
            const double step = (b.position - a.position).norm();
            for (; k < count && length * k / count <= reached + step * (1 - 1e-9); ++k) {
                const double t = (length * k / count - reached) / step;
                if (t < 1e-9) {
                    cuts.push_back(static_cast<int>(samples.size()) - 1);
                    continue;
                }
                ArcSample cut;
                cut.position = (1 - t) * a.position + t * b.position;
                samples.push_back(cut);
                cuts.push_back(static_cast<int>(samples.size()) - 1);
            }
            samples.push_back(b);
            reached += step;
        }
        cuts.push_back(static_cast<int>(samples.size()) - 1);
        arc.samples = samples;
        const int index = static_cast<int>(result.arcs.size());
        int from = arc.nodes[0];
        for (std::size_t i = 1; i < cuts.size(); ++i) {
            const bool is_last = i + 1 == cuts.size();
            const auto sample = static_cast<std::size_t>(cuts[i]);
            const int to = is_last ? arc.nodes[1] : static_cast<int>(result.nodes.size());
            if (!is_last)
                result.nodes.push_back({samples[sample].position, samples[sample].surface});
            result.segments.push_back({{from, to}, index, cuts[i - 1], cuts[i], 1, false});
            from = to;
        }
        result.arcs.push_back(std::move(arc));
    }
    return result;
}

}  // namespace fcn::test
