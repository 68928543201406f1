// Scans have holes smaller than a quad. Their boundaries would have to lie on grid lines, so that a
// map had to blow a hole up to the size of a quad at least, and the field to turn a whole round
// within less than that. The mesh that carries field and map is closed there: a triangle, or a fan
// around the loop's middle. Whoever needs the input's topology takes a quad out again.
#include "meshing/hole_filling.h"

#include <algorithm>
#include <array>

namespace fcn {
namespace {

constexpr double kLeastComponent = 4;  ///< area of a component, in squares of a loop's length / 4

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Components by face, and their areas.
struct Components {
    std::vector<int> of_face;
    std::vector<double> areas;
};

Components find_components(const Mesh& mesh) {
    Components components{std::vector<int>(mesh.n_faces(), -1), {}};
    std::vector<FaceHandle> stack;
    for (const FaceHandle start : mesh.faces()) {
        if (components.of_face[at(start.idx())] >= 0) continue;
        const int number = static_cast<int>(components.areas.size());
        components.areas.push_back(0);
        components.of_face[at(start.idx())] = number;
        stack.push_back(start);
        while (!stack.empty()) {
            const FaceHandle face = stack.back();
            stack.pop_back();
            components.areas.back() += face_area(mesh, face);
            for (const FaceHandle next : mesh.ff_range(face)) {
                if (components.of_face[at(next.idx())] >= 0) continue;
                components.of_face[at(next.idx())] = number;
                stack.push_back(next);
            }
        }
    }
    return components;
}

/// Halfedges without a face, around one hole.
std::vector<HalfedgeHandle> loop_at(const Mesh& mesh, HalfedgeHandle start) {
    std::vector<HalfedgeHandle> loop;
    HalfedgeHandle h = start;
    do {
        loop.push_back(h);
        h = mesh.next_halfedge_handle(h);
    } while (h != start);
    return loop;
}

void close_loop(const std::vector<HalfedgeHandle>& loop, FilledMesh& filled) {
    Mesh& mesh = filled.mesh.mesh;
    const HalfedgeHandle across = mesh.opposite_halfedge_handle(loop[0]);
    const int beside = mesh.face_handle(across).idx();
    std::vector<VertexHandle> corners;
    Vec3 middle = Vec3::Zero();
    for (const HalfedgeHandle h : loop) {
        corners.push_back(mesh.from_vertex_handle(h));
        middle += mesh.point(corners.back()) / static_cast<double>(loop.size());
        filled.is_filled_vertex[at(corners.back().idx())] = true;
    }
    std::size_t added = 0;
    if (corners.size() == 3) {
        added += mesh.add_face(corners[0], corners[1], corners[2]).is_valid();
    } else {
        const VertexHandle centre = mesh.add_vertex(middle);
        filled.is_filled_vertex.push_back(true);
        for (std::size_t i = 0; i < corners.size(); ++i)
            added +=
                mesh.add_face(corners[i], corners[(i + 1) % corners.size()], centre).is_valid();
    }
    filled.holes.push_back(middle);
    auto& labels = filled.mesh.face_labels;
    if (!labels.empty()) labels.insert(labels.end(), added, labels[at(beside)]);
}

}  // namespace

FilledMesh fill_short_loops(const LoadedMesh& input, double length) {
    FilledMesh filled{input, {}, std::vector<bool>(input.mesh.n_vertices(), false)};
    const Mesh& mesh = input.mesh;
    Components components;
    std::vector<bool> is_seen(mesh.n_halfedges(), false);
    for (const HalfedgeHandle start : mesh.halfedges()) {
        if (!mesh.is_boundary(start) || is_seen[at(start.idx())]) continue;
        const std::vector<HalfedgeHandle> loop = loop_at(mesh, start);
        double around = 0;
        for (const HalfedgeHandle h : loop) {
            is_seen[at(h.idx())] = true;
            around += mesh.calc_edge_length(h);
        }
        if (around >= length || loop.size() < 3) continue;
        if (components.areas.empty()) components = find_components(mesh);
        const FaceHandle beside = mesh.face_handle(mesh.opposite_halfedge_handle(start));
        const double area = components.areas[at(components.of_face[at(beside.idx())])];
        if (area < kLeastComponent * length * length / 16) continue;
        // A triangle on the three vertices of another face would be that face from behind.
        const bool is_lone_triangle =
            loop.size() == 3 && std::all_of(loop.begin(), loop.end(), [&](HalfedgeHandle h) {
                return mesh.face_handle(mesh.opposite_halfedge_handle(h)) == beside;
            });
        if (!is_lone_triangle) close_loop(loop, filled);
    }
    return filled;
}

KeptNetwork without_filled_loops(const FeatureCurveNetwork& network, const FilledMesh& filled) {
    KeptNetwork kept;
    kept.network.diagonal = network.diagonal;
    kept.network.scale = network.scale;
    kept.network.ratio = network.ratio;
    kept.network.nodes = network.nodes;
    const Mesh& mesh = filled.mesh.mesh;
    const auto is_on_filled = [&](const ArcSample& sample) {
        const int face = sample.surface.face;
        if (face < 0 || face >= static_cast<int>(mesh.n_faces())) return false;
        const auto corners = face_vertices(mesh, FaceHandle(face));
        for (std::size_t i = 0; i < 3; ++i)
            if (sample.surface.barycentric[static_cast<Eigen::Index>(i)] > 1e-9 &&
                !filled.is_filled_vertex[at(corners[i].idx())])
                return false;
        return true;
    };
    std::vector<int> number(network.arcs.size(), -1);
    for (std::size_t i = 0; i < network.arcs.size(); ++i) {
        const NetworkArc& arc = network.arcs[i];
        if (arc.kind == ArcKind::Boundary &&
            std::all_of(arc.samples.begin(), arc.samples.end(), is_on_filled))
            continue;
        number[i] = static_cast<int>(kept.arcs.size());
        kept.arcs.push_back(static_cast<int>(i));
        kept.network.arcs.push_back(arc);
    }
    for (std::size_t i = 0; i < network.segments.size(); ++i) {
        NetworkSegment segment = network.segments[i];
        const bool is_known =
            segment.arc >= 0 && segment.arc < static_cast<int>(network.arcs.size());
        if (is_known && number[at(segment.arc)] < 0) continue;
        if (is_known) segment.arc = number[at(segment.arc)];
        kept.segments.push_back(static_cast<int>(i));
        kept.network.segments.push_back(segment);
    }
    return kept;
}

}  // namespace fcn
