#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "meshing/reference_surface.h"
#include "network/network.h"

namespace fcn {

struct QuadDomainOptions {
    double edge_length = 0;  ///< of the triangles, > 0, mesh units; about a third of a quad's
    /// Boundary loops shorter than this are closed, mesh units; 0: none.
    double filled_loop = 0;
    bool is_guided = true;                        ///< false: the network is left out
    int iterations = 5;                           ///< of remeshing
    const ReferenceSurface* reference = nullptr;  ///< of the mesh, made already; not owned
};

/// The triangle mesh on which cross fields and maps to the plane live: the surface with short
/// edges, the network's curves chains of edges. Same topology and boundaries as the input
/// but for loops that are closed.
struct QuadDomain {
    Mesh mesh;
    std::vector<int> edge_arc;        ///< per edge: arc of the network; -1: none
    std::vector<int> edge_segment;    ///< per edge: segment of an adapted network; -1: none
    std::vector<double> edge_weight;  ///< per edge on the network: importance in (0, 1]; else 0
    std::vector<int> face_label;      ///< per face
    std::vector<int>
        vertex_place;  ///< per vertex: a face of the input near it; -1: in a filled hole
    std::vector<Vec3> filled_holes;  ///< middles of what was closed
    std::vector<int> node_vertex;    ///< per node of the network: its vertex; -1: none
    std::vector<std::string> warnings;
};

/// Deterministic. Throws InputError on what no remesher takes (remesh.h).
QuadDomain make_quad_domain(const LoadedMesh& input, const FeatureCurveNetwork& network,
                            const QuadDomainOptions& options);

}  // namespace fcn
