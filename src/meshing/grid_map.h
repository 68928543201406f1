#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "meshing/corner_map.h"

namespace fcn {

/// A point or vector of the plane in whole units, of which GridMap::unit() make the side of a quad.
struct GridPoint {
    std::int64_t u = 0, v = 0;
    bool operator==(const GridPoint&) const = default;
    GridPoint operator+(const GridPoint& p) const { return {u + p.u, v + p.v}; }
    GridPoint operator-(const GridPoint& p) const { return {u - p.u, v - p.v}; }
};

/// Turned counter-clockwise by quarters of a turn, 0 .. 3.
GridPoint turned(const GridPoint& p, int quarters);
/// The unit vector of a direction 0 .. 3: +u, +v, -u, -v.
GridPoint direction_vector(int direction);
/// Sign of the cross product.
int orientation(const GridPoint& a, const GridPoint& b);

/// From the chart of one face to that of a neighbour: turn, then shift.
struct GridTransition {
    int quarters = 0;
    GridPoint shift;
    GridPoint operator()(const GridPoint& p) const { return turned(p, quarters) + shift; }
};

/// A map of a mesh to the plane in whole numbers, so that every question about it has an exact
/// answer. Halfedge 3 f + i of face f runs from its corner i to corner i + 1; twin -1: boundary.
class GridMap {
public:
    GridMap(const Mesh& mesh, const CornerMap& map);

    /// Why no quads can be extracted, empty if they can: coordinates that are not finite, too
    /// large or too fine for 62 bits; a face that is not counter-clockwise; transitions that are
    /// not quarter turns with whole shifts; a singular vertex off the grid; a boundary edge that
    /// is not on a line of the grid; more than `kMostQuads` quads. Names face, edge, or vertex.
    const std::string& fault() const { return fault_; }
    static constexpr double kMostQuads = 5e7;

    std::int64_t unit() const { return std::int64_t{1} << bits_; }
    bool is_whole(const GridPoint& p) const {
        const std::int64_t mask = unit() - 1;
        return (p.u & mask) == 0 && (p.v & mask) == 0;
    }

    static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int prev(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
    static int face(int h) { return h / 3; }
    int face_count() const { return static_cast<int>(from_.size() / 3); }
    int vertex_count() const { return static_cast<int>(out_.size()); }
    int from(int h) const { return from_[at(h)]; }
    int twin(int h) const { return twin_[at(h)]; }
    /// Some halfedge out of v, at a boundary the first one counter-clockwise; -1: in no face.
    int out(int v) const { return out_[at(v)]; }
    bool is_boundary(int v) const { return out(v) >= 0 && twin(out(v)) < 0; }

    /// Image of from(h) in the chart of h's face.
    const GridPoint& image(int h) const { return images_[at(h)]; }
    GridPoint vector(int h) const { return image(next(h)) - image(h); }
    /// > 0: p lies left of h, in its face's chart.
    int side(int h, const GridPoint& p) const { return orientation(vector(h), p - image(h)); }
    const GridTransition& across(int h) const { return across_[at(h)]; }
    /// Whole points of the closed face f in its chart, by rows: ascending v, then u. Linear in
    /// their number and the number of rows.
    std::vector<GridPoint> whole_points(int f) const;
    /// Of a point of the closed face f, in its chart.
    Vec3 barycentric(int f, const GridPoint& p) const;

    /// Whether direction d points from the corner at h's origin into h's face, or along h (but not
    /// along the corner's other edge).
    bool is_in_corner(int h, int d) const;
    /// The same at a point inside edge h: into h's face or along h, not against it.
    bool is_in_half_plane(int h, int d) const;
    /// Whether direction d points along the corner's other edge, from h's origin.
    bool is_on_corner_end(int h, int d) const;
    /// Directions of the grid around v, each once; 4 at a regular vertex inside.
    int direction_count(int v) const;

private:
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    void copy_connectivity(const Mesh& mesh);
    bool scale(const CornerMap& map);
    bool check_faces();
    bool find_transitions();
    bool check_vertices();
    bool check_boundary();

    std::vector<int> from_, twin_, out_;
    std::vector<GridPoint> images_;
    std::vector<GridTransition> across_;
    int bits_ = 0;
    std::string fault_;
};

}  // namespace fcn
