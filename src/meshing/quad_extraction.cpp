// Quads from a map to the plane. Ebke, Bommes, Campen, Kobbelt 2013 (QEx), section 4: from every
// port of every grid vertex the line of the grid is followed over faces and transitions to the next
// grid vertex, and faces are closed by turning left at each of them. There the map may be folded
// and rounded, so ports are repaired; here it must be exact and keep orientation (grid_map.h), so
// that each line arrives, in a closed triangle at a time, decided by whole numbers alone. Lines are
// parallel to an axis in every chart: which side of one a corner lies on is a comparison.
// Boundaries must be lines of the grid; cells that they cut were no quads.
#include "meshing/quad_extraction.h"

#include <algorithm>

#include "meshing/grid_vertices.h"
#include "meshing/grid_walk.h"
#include "meshing/quad_rows.h"

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Port at which the line out of port p arrives, -1: it does not.
int arrival(const GridWalk& walk, const GridMap& map, const GridVertices& vertices, int p) {
    const GridPort& port = vertices.port(p);
    const auto there = walk.go({port.face, port.image, port.direction}, map.unit());
    if (!there) return -1;
    const int v = vertices.find(there->face, there->image);
    return v < 0 ? -1 : vertices.find_port(v, there->face, (there->direction + 2) & 3);
}

/// Links of ports, or the first fault.
struct Links {
    std::vector<int> owners;    ///< per port: its vertex
    std::vector<int> arrivals;  ///< per port: the port at the other end of its line
    std::string fault;
};

std::string name_of(const GridVertices& vertices, int v) {
    const int own = vertices.mesh_vertex(v);
    return own >= 0 ? "vertex " + std::to_string(own)
                    : "face " + std::to_string(vertices.place(v).face);
}

Links link_ports(const GridMap& map, const GridVertices& vertices) {
    Links links;
    links.owners.resize(at(vertices.port_count()));
    links.arrivals.assign(at(vertices.port_count()), -1);
    for (int v = 0; v < vertices.count(); ++v)
        for (int p = vertices.first_port(v); p < vertices.first_port(v + 1); ++p)
            links.owners[at(p)] = v;
    const GridWalk walk(map);
    for (int p = 0; p < vertices.port_count(); ++p) {
        if (links.arrivals[at(p)] >= 0) continue;
        const int q = arrival(walk, map, vertices, p);
        if (q < 0 || q == p || links.arrivals[at(q)] >= 0) {
            links.fault = "a line of the grid that starts at " +
                          name_of(vertices, links.owners[at(p)]) + " does not arrive";
            return links;
        }
        links.arrivals[at(p)] = q;
        links.arrivals[at(q)] = p;
    }
    return links;
}

/// The next port of the face on the left, after arriving at port p; -1: no face there.
int turn_left(const GridVertices& vertices, const Links& links, int p) {
    const int v = links.owners[at(p)];
    if (p > vertices.first_port(v)) return p - 1;
    return vertices.is_boundary(v) ? -1 : vertices.first_port(v + 1) - 1;
}

/// Fills the ports at which the sides of faces begin; returns the first fault.
std::string close_faces(const GridVertices& vertices, const Links& links,
                        std::vector<std::array<int, 4>>& faces) {
    std::vector<char> is_used(links.arrivals.size(), 0);
    for (int start = 0; start < vertices.port_count(); ++start) {
        if (is_used[at(start)]) continue;
        const int first_turn = turn_left(vertices, links, links.arrivals[at(start)]);
        if (first_turn < 0) continue;  // along a boundary, the surface on the right
        std::array<int, 4> face{};
        int p = start, sides = 0;
        do {
            if (p < 0 || is_used[at(p)] || sides == 4) {
                return "a face that starts at " + name_of(vertices, links.owners[at(start)]) +
                       " has not four sides";
            }
            is_used[at(p)] = 1;
            face[at(sides++)] = p;
            p = turn_left(vertices, links, links.arrivals[at(p)]);
        } while (p != start);
        if (sides < 4) {
            return "a face that starts at " + name_of(vertices, links.owners[at(start)]) + " has " +
                   std::to_string(sides) + " sides";
        }
        faces.push_back(face);
    }
    return {};
}

std::string compare_topology(const QuadMesh& mesh, const Mesh& domain) {
    const QuadTopology quads = check_topology(mesh), wanted = topology_of(domain);
    if (!quads.fault.empty()) return quads.fault;
    const auto differ = [](const char* what, int is, int should) {
        return std::string(what) + " " + std::to_string(is) + " instead of " +
               std::to_string(should);
    };
    if (quads.components != wanted.components)
        return differ("components:", quads.components, wanted.components);
    if (quads.boundary_loops != wanted.boundary_loops)
        return differ("boundary loops:", quads.boundary_loops, wanted.boundary_loops);
    if (quads.euler_characteristic != wanted.euler_characteristic)
        return differ("Euler characteristic:", quads.euler_characteristic,
                      wanted.euler_characteristic);
    return {};
}

}  // namespace

QuadExtraction extract_quads(const Mesh& domain, const CornerMap& map, const RowOptions& options) {
    QuadExtraction result;
    const GridMap grid(domain, map);
    result.fault = grid.fault();
    if (!result.fault.empty()) return result;
    const GridVertices vertices(grid);
    const Links links = link_ports(grid, vertices);
    result.fault = links.fault;
    if (!result.fault.empty()) return result;
    std::vector<std::array<int, 4>> sides;
    result.fault = close_faces(vertices, links, sides);
    if (!result.fault.empty()) return result;
    DividedRows rows =
        divide_rows(grid, vertices, links.owners, links.arrivals, sides, domain, options);
    QuadMesh mesh;
    mesh.faces = std::move(rows.faces);
    result.divided_rows = rows.divided;
    result.places = std::move(rows.places);
    for (const SurfacePoint& place : result.places) mesh.points.push_back(position(domain, place));
    for (int v = 0; v < vertices.count(); ++v)
        result.domain_vertices.push_back(vertices.mesh_vertex(v));
    result.domain_vertices.resize(mesh.points.size(), -1);
    result.fault = compare_topology(mesh, domain);
    if (result.fault.empty()) {
        result.mesh = std::move(mesh);
    } else {
        result.places.clear();
        result.domain_vertices.clear();
    }
    return result;
}

}  // namespace fcn
