#pragma once

#include <array>
#include <vector>

#include "meshing/grid_map.h"

namespace fcn {

/// A way out of a grid vertex along a line of the grid.
struct GridPort {
    int face = -1;       ///< the way begins in this closed face
    int direction = -1;  ///< 0 .. 3 in its chart
    GridPoint image;     ///< of the vertex in its chart
};

/// The points of a surface whose images are whole, each once, whether they lie inside a face, on an
/// edge, or at a vertex; with the ways out of each, counter-clockwise.
class GridVertices {
public:
    explicit GridVertices(const GridMap& map);

    int count() const { return static_cast<int>(vertices_.size()); }
    SurfacePoint place(int v) const;
    /// The vertex of the mesh it is, -1: none.
    int mesh_vertex(int v) const { return vertices_[at(v)].mesh_vertex; }
    /// Ports of v have the numbers first_port(v) .. first_port(v + 1) - 1. On a boundary the first
    /// one has no face on its right, the last one none on its left.
    int first_port(int v) const { return first_ports_[at(v)]; }
    int port_count() const { return static_cast<int>(ports_.size()); }
    const GridPort& port(int p) const { return ports_[at(p)]; }
    bool is_boundary(int v) const { return vertices_[at(v)].is_boundary; }

    /// The vertex at p, whole and in the closed face f, in its chart; -1: none known.
    int find(int f, const GridPoint& p) const;
    /// The port of v, which is in the closed face f, that goes in direction d of f's chart; -1: it
    /// leads out of the surface.
    int find_port(int v, int f, int d) const;

private:
    struct Vertex {
        int face = -1;  ///< image's chart
        GridPoint image;
        int halfedge = -1;  ///< of `face`: it is inside this edge, or its origin
        int mesh_vertex = -1;
        bool is_boundary = false;
    };
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    void add_mesh_vertices();
    void add_face_points(int f);
    void add_ports(const Vertex& vertex);
    void add_port(int face, int direction, const GridPoint& image);
    int find_in_edge(int h, const GridPoint& p) const;

    const GridMap& map_;
    std::vector<Vertex> vertices_;
    std::vector<int> of_mesh_vertex_;
    std::vector<std::vector<int>> in_edge_;  ///< per first halfedge of an edge: vertices inside
    struct Range {
        int first = 0, count = 0;
    };
    std::vector<Range> in_face_;  ///< per face: vertices inside, by rows
    std::vector<GridPort> ports_;
    std::vector<int> first_ports_;
};

}  // namespace fcn
