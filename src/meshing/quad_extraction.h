#pragma once

#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "meshing/corner_map.h"
#include "meshing/quad_mesh.h"
#include "meshing/quad_rows.h"

namespace fcn {

struct QuadExtraction {
    /// Why there is no mesh, with the face, edge, or vertex; empty: there is one.
    std::string fault;
    QuadMesh mesh;                     ///< empty if there is a fault
    std::vector<SurfacePoint> places;  ///< per vertex: where it is on the domain
    std::vector<int> domain_vertices;  ///< per vertex: the domain's vertex it is; -1: none
    int divided_rows = 0;              ///< rows of quads that were divided where tubes are thin
};

/// The quads that the grid of whole numbers cuts a domain into. The map must keep orientation, have
/// transitions of quarter turns and whole shifts, and whole numbers at singular vertices and along
/// boundaries, all without rounding; if it does not, that is the fault. The mesh is then
/// all quads, manifold, and of the domain's topology, or there is a fault. Linear in the faces and
/// quads. Deterministic. Source: Ebke, Bommes, Campen, Kobbelt 2013.
QuadExtraction extract_quads(const Mesh& domain, const CornerMap& map, const RowOptions& rows = {});

}  // namespace fcn
