#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "meshing/reference_surface.h"
#include "meshing/working_mesh.h"

namespace fcn {

/// Marks the vertices of faces that see another sheet of the reference within `reach`, across a
/// wall or a gap, as thin.
void mark_thin_places(WorkingMesh& mesh, const ReferenceSurface& reference, double reach);

/// Refuses changes of a mesh by which triangles would cross that did not cross before. Only faces
/// at thin vertices (WorkingMesh::is_thin) are looked at, in a hash grid; elsewhere nothing is
/// refused, at no cost. Whoever changes the mesh says so by update().
class CrossingGuard {
public:
    /// Cells are `cell` wide, about the length of an edge.
    CrossingGuard(const WorkingMesh& mesh, double cell);

    bool allows_move(int v, const Vec3& to) const;
    bool allows_collapse(int h, int vanishing) const;
    bool allows_flip(int h) const;
    /// Crossings of these faces with each other and with all others.
    std::size_t crossings(const std::vector<int>& faces) const;

    /// After changes at a vertex or to faces.
    void update_star(int v);
    void update_face(int f);

private:
    struct Corner {
        int vertex;
        Vec3 point;
    };
    using Triangle = std::array<Corner, 3>;
    using Cell = std::array<int, 3>;
    struct CellHash {
        std::size_t operator()(const Cell& cell) const;
    };
    bool is_watched(int f) const;
    Triangle triangle(int f) const;
    std::array<Cell, 2> cells_of(const Triangle& t) const;
    /// Faces of the grid that meet t, without those that `left_out` says.
    std::size_t count(const Triangle& t, const std::vector<int>& left_out) const;
    bool allows(const std::vector<Triangle>& after, const std::vector<int>& replaced) const;

    const WorkingMesh& mesh_;
    double cell_;
    bool is_empty_ = true;
    std::unordered_map<Cell, std::vector<int>, CellHash> grid_;
    mutable std::vector<int> candidates_;
    mutable std::vector<unsigned> stamps_;  ///< per face: the query that met it last
    mutable unsigned stamp_ = 0;
};

}  // namespace fcn
