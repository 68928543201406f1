#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meshing/cross_field.h"

namespace fcn {

/// A mesh cut open along edges into disks without singularities inside, one a component, and its
/// field with all arms turned to agree inside them.
struct CutMesh {
    std::vector<std::uint8_t> is_cut;  ///< per edge; boundaries are not counted
    std::vector<int> arms;             ///< per face: right angles that its arm was turned by
    std::vector<int> turns;            ///< per halfedge: as a CrossField's; 0 off the cut
    /// Per face and corner: the copy of the vertex that belongs to its side of the cut.
    std::vector<std::array<int, 3>> copies;
    int copy_count = 0;
    std::vector<std::array<int, 3>> corners;  ///< per face: vertices
    int vertex_count = 0;
    /// Per vertex: whether the arms come back turned after a round trip; inner vertices only.
    std::vector<std::uint8_t> is_singular;
    /// Chains of cut edges that begin and end at singular vertices, branchings and boundaries, as
    /// halfedges in order.
    std::vector<std::vector<HalfedgeHandle>> chains;
    std::string fault;  ///< empty: none
};

CutMesh cut_to_disks(const Mesh& mesh, const CrossField& field);

}  // namespace fcn
