// Maps with seams and what must hold of them before quads are read from them (Ebke, Bommes,
// Campen, Kobbelt 2013, "QEx", section 3). Orientations come from exact products: with fma a
// product of two doubles is known as a sum of two, and rounding keeps order.
#include "meshing/corner_map.h"

#include <cmath>
#include <limits>

namespace fcn {
namespace {

bool is_integer(double value) { return value == std::floor(value); }
bool is_integer(const Vec2& point) { return is_integer(point[0]) && is_integer(point[1]); }

/// Sign of a d - b c.
int determinant_sign(double a, double b, double c, double d) {
    const double p = a * d, q = b * c;
    if (p != q) return p > q ? 1 : -1;
    const double p_rest = std::fma(a, d, -p), q_rest = std::fma(b, c, -q);
    return p_rest == q_rest ? 0 : (p_rest > q_rest ? 1 : -1);
}

/// Angle of a corner's image.
double corner_angle(const std::array<Vec2, 3>& uv, std::size_t i) {
    const Vec2 a = uv[(i + 1) % 3] - uv[i], b = uv[(i + 2) % 3] - uv[i];
    return std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
}

std::size_t corner_of(const Mesh& mesh, FaceHandle face, VertexHandle vertex) {
    const auto corners = face_vertices(mesh, face);
    return corners[0] == vertex ? 0 : (corners[1] == vertex ? 1 : 2);
}

const Vec2& image(const Mesh& mesh, const CornerMap& map, FaceHandle face, VertexHandle vertex) {
    return map.uv[static_cast<std::size_t>(face.idx())][corner_of(mesh, face, vertex)];
}

void count_edge_faults(const Mesh& mesh, const CornerMap& map, EdgeHandle edge,
                       CornerMapFaults& faults) {
    HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
    if (mesh.is_boundary(halfedge)) halfedge = mesh.opposite_halfedge_handle(halfedge);
    const auto ends = edge_image(mesh, map, halfedge);
    if (mesh.is_boundary(edge)) {
        const bool is_on_line = (ends[0][0] == ends[1][0] && is_integer(ends[0][0])) ||
                                (ends[0][1] == ends[1][1] && is_integer(ends[0][1]));
        if (!is_on_line) ++faults.free_boundary;
        return;
    }
    const auto across = edge_image(mesh, map, mesh.opposite_halfedge_handle(halfedge));
    const MapTransition transition = map_transition(mesh, map, halfedge);
    if (turned(ends[0], transition.turns) + transition.translation != across[1] ||
        turned(ends[1], transition.turns) + transition.translation != across[0])
        ++faults.open_edges;
    else if (!is_integer(transition.translation))
        ++faults.fractional_edges;
}

}  // namespace

Vec2 turned(const Vec2& vector, int turns) {
    switch (turns & 3) {
        case 0:
            return vector;
        case 1:
            return {-vector[1], vector[0]};
        case 2:
            return {-vector[0], -vector[1]};
        default:
            return {vector[1], -vector[0]};
    }
}

std::array<Vec2, 2> edge_image(const Mesh& mesh, const CornerMap& map, HalfedgeHandle halfedge) {
    const FaceHandle face = mesh.face_handle(halfedge);
    return {image(mesh, map, face, mesh.from_vertex_handle(halfedge)),
            image(mesh, map, face, mesh.to_vertex_handle(halfedge))};
}

MapTransition map_transition(const Mesh& mesh, const CornerMap& map, HalfedgeHandle halfedge) {
    const auto here = edge_image(mesh, map, halfedge);
    const auto there = edge_image(mesh, map, mesh.opposite_halfedge_handle(halfedge));
    const Vec2 from = here[1] - here[0], to = there[0] - there[1];
    MapTransition result;
    double best = std::numeric_limits<double>::infinity();
    for (int turns = 0; turns < 4; ++turns) {
        const double error = (turned(from, turns) - to).squaredNorm();
        if (error < best) {
            best = error;
            result.turns = turns;
        }
    }
    result.translation = there[1] - turned(here[0], result.turns);
    return result;
}

int image_orientation(const std::array<Vec2, 3>& uv) {
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    return determinant_sign(a[0], a[1], b[0], b[1]);
}

int quarters_around(const Mesh& mesh, const CornerMap& map, VertexHandle vertex) {
    double angle = 0;
    for (const FaceHandle face : mesh.vf_range(vertex))
        angle += corner_angle(map.uv[static_cast<std::size_t>(face.idx())],
                              corner_of(mesh, face, vertex));
    return static_cast<int>(std::lround(angle / (2 * std::atan(1.0))));
}

CornerMapFaults corner_map_faults(const Mesh& mesh, const CornerMap& map) {
    CornerMapFaults faults;
    for (const auto& uv : map.uv)
        if (image_orientation(uv) <= 0) ++faults.turned_over_faces;
    for (const EdgeHandle edge : mesh.edges()) count_edge_faults(mesh, map, edge, faults);
    for (const VertexHandle vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex)) continue;
        const int regular = mesh.is_boundary(vertex) ? 2 : 4;
        if (quarters_around(mesh, map, vertex) == regular) continue;
        if (!is_integer(image(mesh, map, *mesh.cvf_begin(vertex), vertex)))
            ++faults.fractional_corners;
    }
    return faults;
}

std::string CornerMapFaults::message() const {
    std::string text;
    const auto add = [&](std::size_t count, const char* what) {
        if (count == 0) return;
        if (!text.empty()) text += ", ";
        text += std::to_string(count) + " " + what;
    };
    add(turned_over_faces, "faces turned over");
    add(open_edges, "edges open");
    add(fractional_edges, "edges with fractional translation");
    add(free_boundary, "boundary edges on no grid line");
    add(fractional_corners, "singular vertices at no grid point");
    return text;
}

}  // namespace fcn
