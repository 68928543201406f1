#pragma once

#include <utility>
#include <vector>

#include "geometry/mesh.h"
#include "network/network.h"

namespace fcn::test {

/// Network of straight segments between the given points. `arcs[i]` is the arc of segment i; when
/// empty every segment is an arc of its own. Arcs get their segments' ends as samples.
inline FeatureCurveNetwork segment_network(const std::vector<Vec3>& points,
                                           const std::vector<std::pair<int, int>>& segments,
                                           std::vector<int> arcs = {}) {
    FeatureCurveNetwork network;
    network.scale = 1;
    for (const Vec3& point : points) {
        network.nodes.emplace_back();
        network.nodes.back().position = point;
    }
    if (arcs.empty()) {
        for (std::size_t i = 0; i < segments.size(); ++i) arcs.push_back(static_cast<int>(i));
    }
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const auto [from, to] = segments[i];
        if (arcs[i] >= static_cast<int>(network.arcs.size())) network.arcs.resize(arcs[i] + 1);
        NetworkArc& arc = network.arcs[arcs[i]];
        if (arc.samples.empty()) {
            arc.samples.push_back({points[from], {}});
            arc.nodes[0] = from;
        }
        arc.nodes[1] = to;
        NetworkSegment segment;
        segment.nodes = {from, to};
        segment.arc = arcs[i];
        segment.first_sample = static_cast<int>(arc.samples.size()) - 1;
        segment.last_sample = segment.first_sample + 1;
        arc.samples.push_back({points[to], {}});
        network.segments.push_back(segment);
    }
    return network;
}

inline Mesh make_mesh(const std::vector<Vec3>& points,
                      const std::vector<std::array<int, 3>>& faces) {
    Mesh mesh;
    std::vector<VertexHandle> handles;
    for (const Vec3& point : points) handles.push_back(mesh.add_vertex(point));
    for (const auto& [a, b, c] : faces) mesh.add_face(handles[a], handles[b], handles[c]);
    return mesh;
}

/// Open sheet over a grid of columns x rows cells: vertex (i, j) at place(i, j), the normal to the
/// left of the turn from i to j (reversed on request).
template <class Place>
Mesh sheet(int columns, int rows, Place&& place, bool is_reversed = false) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> faces;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) points.push_back(place(i, j));
    }
    const auto index = [&](int i, int j) { return j * (columns + 1) + i; };
    const auto add = [&](int a, int b, int c) {
        if (is_reversed) std::swap(b, c);
        faces.push_back({a, b, c});
    };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            add(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            add(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    }
    return make_mesh(points, faces);
}

}  // namespace fcn::test
