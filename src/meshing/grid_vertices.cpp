// Vertices of the grid on a surface. Ebke, Bommes, Campen, Kobbelt 2013 (section 4.1, 4.2): whole
// points inside faces, on edges and at vertices are told apart by exact tests, and each has ports,
// one for every direction of the grid that leads into the surface. A direction along an edge
// belongs to the face on its left, so that each port exists once without comparing positions.
#include "meshing/grid_vertices.h"

#include <algorithm>

namespace fcn {
namespace {

bool is_before(const GridPoint& a, const GridPoint& b) {
    return a.v != b.v ? a.v < b.v : a.u < b.u;
}

/// Calls visit(d) for the directions that `is_inside` holds for, counter-clockwise; they are
/// consecutive, and not all four.
template <class Predicate, class Visit>
void visit_directions(Predicate&& is_inside, Visit&& visit) {
    for (int d = 0; d < 4; ++d) {
        if (!is_inside(d) || is_inside((d + 3) & 3)) continue;
        for (int i = d; is_inside(i & 3); ++i) visit(i & 3);
    }
}

}  // namespace

GridVertices::GridVertices(const GridMap& map)
    : map_(map), of_mesh_vertex_(at(map.vertex_count()), -1), in_edge_(at(3 * map.face_count())) {
    add_mesh_vertices();
    for (int f = 0; f < map.face_count(); ++f) add_face_points(f);
    for (const Vertex& vertex : vertices_) {
        first_ports_.push_back(port_count());
        add_ports(vertex);
    }
    first_ports_.push_back(port_count());
}

void GridVertices::add_mesh_vertices() {
    for (int v = 0; v < map_.vertex_count(); ++v) {
        const int h = map_.out(v);
        if (h < 0 || !map_.is_whole(map_.image(h))) continue;
        of_mesh_vertex_[at(v)] = count();
        vertices_.push_back({GridMap::face(h), map_.image(h), h, v, map_.is_boundary(v)});
    }
}

void GridVertices::add_face_points(int f) {
    std::vector<GridPoint> inside;
    for (const GridPoint& p : map_.whole_points(f)) {
        int edge = -1, zeros = 0;
        for (int h = 3 * f; h < 3 * f + 3; ++h) {
            if (map_.side(h, p) != 0) continue;
            edge = h;
            ++zeros;
        }
        if (zeros == 0) inside.push_back(p);
        if (zeros != 1 || map_.twin(edge) > edge) continue;
        in_edge_[at(edge)].push_back(count());
        vertices_.push_back({f, p, edge, -1, map_.twin(edge) < 0});
    }
    in_face_.push_back({count(), static_cast<int>(inside.size())});
    for (const GridPoint& p : inside) vertices_.push_back({f, p, -1, -1, false});
}

void GridVertices::add_port(int face, int direction, const GridPoint& image) {
    ports_.push_back({face, direction, image});
}

void GridVertices::add_ports(const Vertex& vertex) {
    const auto [face, image, halfedge, mesh_vertex, is_boundary] = vertex;
    if (halfedge < 0) {
        for (int d = 0; d < 4; ++d) add_port(face, d, image);
        return;
    }
    if (mesh_vertex < 0) {
        const int other = map_.twin(halfedge);
        visit_directions([&](int d) { return map_.is_in_half_plane(halfedge, d); },
                         [&](int d) { add_port(face, d, image); });
        if (other >= 0) {
            visit_directions(
                [&](int d) { return map_.is_in_half_plane(other, d); },
                [&](int d) { add_port(GridMap::face(other), d, map_.across(halfedge)(image)); });
            return;
        }
        // On a boundary the lines of the grid run along the edge, so the last port does, too.
        add_port(face, (ports_.back().direction + 1) & 3, image);
        return;
    }
    int h = halfedge;
    while (true) {
        visit_directions([&](int d) { return map_.is_in_corner(h, d); },
                         [&](int d) { add_port(GridMap::face(h), d, map_.image(h)); });
        const int next = map_.twin(GridMap::prev(h));
        if (next == halfedge) return;
        if (next < 0) break;
        h = next;
    }
    for (int d = 0; d < 4; ++d)
        if (map_.is_on_corner_end(h, d)) add_port(GridMap::face(h), d, map_.image(h));
}

SurfacePoint GridVertices::place(int v) const {
    const Vertex& vertex = vertices_[at(v)];
    SurfacePoint place;
    place.face = vertex.face;
    place.barycentric = map_.barycentric(vertex.face, vertex.image);
    return place;
}

int GridVertices::find_in_edge(int h, const GridPoint& p) const {
    if (map_.twin(h) > h) return find_in_edge(map_.twin(h), map_.across(h)(p));
    for (const int v : in_edge_[at(h)])
        if (vertices_[at(v)].image == p) return v;
    return -1;
}

int GridVertices::find(int f, const GridPoint& p) const {
    int zeros[3], zero_count = 0;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
        const int side = map_.side(h, p);
        if (side < 0) return -1;
        if (side == 0) zeros[zero_count++] = h;
    }
    if (zero_count == 1) return find_in_edge(zeros[0], p);
    if (zero_count == 2) {
        // The corner at which the two edges meet.
        const int h = GridMap::next(zeros[0]) == zeros[1] ? zeros[1] : zeros[0];
        return of_mesh_vertex_[at(map_.from(h))];
    }
    const auto begin = vertices_.begin() + in_face_[at(f)].first;
    const auto end = begin + in_face_[at(f)].count;
    const auto found = std::lower_bound(
        begin, end, p, [](const Vertex& a, const GridPoint& b) { return is_before(a.image, b); });
    return found != end && found->image == p ? static_cast<int>(found - vertices_.begin()) : -1;
}

int GridVertices::find_port(int v, int f, int d) const {
    const auto search = [&](int face, int direction) {
        for (int p = first_port(v); p < first_port(v + 1); ++p)
            if (port(p).face == face && port(p).direction == direction) return p;
        return -1;
    };
    const int found = search(f, d);
    const Vertex& vertex = vertices_[at(v)];
    if (found >= 0 || vertex.halfedge < 0) return found;
    // Along the edge that ends this face's share of the directions: it is the next face's.
    int end = vertex.halfedge;
    if (vertex.mesh_vertex >= 0) {
        end = 3 * f;
        while (map_.from(end) != vertex.mesh_vertex) ++end;
        end = GridMap::prev(end);
    } else if (GridMap::face(end) != f) {
        end = map_.twin(end);
    }
    const int other = map_.twin(end);
    return other < 0 ? -1 : search(GridMap::face(other), (d + map_.across(end).quarters) & 3);
}

}  // namespace fcn
