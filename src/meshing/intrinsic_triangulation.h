#pragma once

#include <vector>

#include "meshing/map_problem.h"
#include "meshing/symbolic_transition.h"
#include "meshing/vertex_sectors.h"

namespace fcn {

/// Triangles with straight edges in the metric of a seamless map, which need not be those of the
/// mesh: edges can be flipped, and vertices without curvature taken out. Slot 3 f + i is the side
/// of face f from its corner i to corner i + 1. Faces may be glued to themselves. Hard edges are
/// boundaries of what lies on either side, so a vertex on them is one a sector.
class IntrinsicTriangulation {
public:
    /// That of the mesh, its vertices the sectors between hard edges; the map must turn no face
    /// over.
    IntrinsicTriangulation(const Mesh& mesh, const MapProblem& problem,
                           const VertexSectors& sectors, const Eigen::VectorXd& all_values);

    struct Corner {
        int vertex = -1;
        int copy = -1;
        SymbolicTransition from_copy;  ///< position = from_copy(that of the copy)
        Vec2 position = Vec2::Zero();  ///< in the face's frame
    };
    struct Side {
        int opposite = -1;            ///< slot; -1: boundary or hard
        SymbolicTransition crossing;  ///< from this face's frame to the opposite one
    };

    static int next(int slot) { return slot % 3 == 2 ? slot - 2 : slot + 1; }
    static int previous(int slot) { return slot % 3 == 0 ? slot + 2 : slot - 1; }

    int slot_count() const { return static_cast<int>(corners_.size()); }
    bool is_alive(int slot) const { return corners_[at(slot)].vertex >= 0; }
    const Corner& corner(int slot) const { return corners_[at(slot)]; }
    const Side& side(int slot) const { return sides_[at(slot)]; }

    /// Takes out a vertex of curvature 0, on a boundary one whose sides are straight; false: stays.
    bool remove(int vertex);
    /// Flips edges until they are Delaunay's, where they may be flipped.
    void make_delaunay();

private:
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    double orientation(const Vec2& a, const Vec2& b, const Vec2& c) const;
    bool can_flip(int slot, double& quality, double least_at_origin) const;
    void flip(int slot);
    std::vector<int> fan(int vertex, bool& is_closed) const;
    Corner seen_from(const SymbolicTransition& change, const Corner& corner) const;
    void set_corner(int slot, Corner corner);
    struct OuterSide {
        int old_slot = -1, new_slot = -1;
        SymbolicTransition to_old;  ///< from the new frame to the one the side was in
    };
    void glue_outer(const std::vector<OuterSide>& outer);

    std::vector<Corner> corners_;
    std::vector<Side> sides_;
    std::vector<Vec2> translations_;
    std::vector<int> slot_of_;  ///< per vertex: a slot that starts there; -1: gone
};

}  // namespace fcn
