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

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The way from a whole point to the next, in the chart of a face it crosses.
struct Step {
    int face = -1;
    int direction = 0;
    GridPoint start, goal;
};

class QuadWalk {
public:
    QuadWalk(const GridMap& map, const GridVertices& vertices) : map_(map), vertices_(vertices) {}

    /// Port at which the line out of port p arrives, -1: it does not.
    int arrival(int p) const {
        const GridPort& port = vertices_.port(p);
        const GridPoint way = direction_vector(port.direction);
        const std::int64_t unit = map_.unit();
        Step step{port.face, port.direction, port.image,
                  port.image + GridPoint{way.u * unit, way.v * unit}};
        // Without folds a straight line of length 1 is in no face twice, apart from its charts.
        for (int i = 0; i <= 4 * map_.face_count(); ++i) {
            if (is_at_goal(step)) {
                const int v = vertices_.find(step.face, step.goal);
                return v < 0 ? -1 : vertices_.find_port(v, step.face, (step.direction + 2) & 3);
            }
            if (!leave_face(step)) return -1;
        }
        return -1;
    }

private:
    bool is_at_goal(const Step& step) const {
        const int h = 3 * step.face;
        return map_.side(h, step.goal) >= 0 && map_.side(h + 1, step.goal) >= 0 &&
               map_.side(h + 2, step.goal) >= 0;
    }

    void cross(Step& step, int h) const {
        const GridTransition& transition = map_.across(h);
        step = {GridMap::face(map_.twin(h)), (step.direction + transition.quarters) & 3,
                transition(step.start), transition(step.goal)};
    }

    bool leave_face(Step& step) const {
        const GridPoint way = direction_vector(step.direction);
        std::int64_t sides[3];
        for (int i = 0; i < 3; ++i) {
            const GridPoint p = map_.image(3 * step.face + i) - step.start;
            sides[i] = way.u * p.v - way.v * p.u;
        }
        int exit = -1;
        std::int64_t farthest = 0;
        for (int i = 0; i < 3; ++i) {
            const int h = 3 * step.face + i;
            if (sides[i] < 0 && sides[(i + 1) % 3] > 0) {
                if (map_.twin(h) < 0) return false;
                cross(step, h);
                return true;
            }
            const GridPoint p = map_.image(h) - step.start;
            const std::int64_t along = way.u * p.u + way.v * p.v;
            if (sides[i] == 0 && (exit < 0 || along > farthest)) {
                exit = h;
                farthest = along;
            }
        }
        return exit >= 0 && pass_vertex(step, exit);
    }

    /// Goes on from the origin of h, a corner of the step's face.
    bool pass_vertex(Step& step, int h) const {
        const Step before = step;
        const int first = h;
        do {
            if (map_.is_in_corner(h, step.direction)) return true;
            const int end = GridMap::prev(h);
            if (map_.twin(end) < 0) {
                if (map_.is_on_corner_end(h, step.direction)) return true;
                break;
            }
            cross(step, end);
            h = map_.twin(end);
        } while (h != first);
        step = before;
        for (h = first; map_.twin(h) >= 0;) {
            cross(step, h);
            h = GridMap::next(map_.twin(h));
            if (h == first) return false;
            if (map_.is_in_corner(h, step.direction)) return true;
        }
        return false;
    }

    const GridMap& map_;
    const GridVertices& vertices_;
};

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
    const QuadWalk walk(map, vertices);
    for (int p = 0; p < vertices.port_count(); ++p) {
        if (links.arrivals[at(p)] >= 0) continue;
        const int q = walk.arrival(p);
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

/// Fills the mesh's faces; returns the first fault.
std::string close_faces(const GridVertices& vertices, const Links& links, QuadMesh& mesh) {
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
            face[at(sides++)] = links.owners[at(p)];
            p = turn_left(vertices, links, links.arrivals[at(p)]);
        } while (p != start);
        if (sides < 4) {
            return "a face that starts at " + name_of(vertices, links.owners[at(start)]) + " has " +
                   std::to_string(sides) + " sides";
        }
        mesh.faces.push_back(face);
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

QuadExtraction extract_quads(const Mesh& domain, const CornerMap& map) {
    QuadExtraction result;
    const GridMap grid(domain, map);
    result.fault = grid.fault();
    if (!result.fault.empty()) return result;
    const GridVertices vertices(grid);
    const Links links = link_ports(grid, vertices);
    result.fault = links.fault;
    if (!result.fault.empty()) return result;
    QuadMesh mesh;
    result.fault = close_faces(vertices, links, mesh);
    if (!result.fault.empty()) return result;
    for (int v = 0; v < vertices.count(); ++v) {
        result.places.push_back(vertices.place(v));
        result.domain_vertices.push_back(vertices.mesh_vertex(v));
        mesh.points.push_back(position(domain, result.places.back()));
    }
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
