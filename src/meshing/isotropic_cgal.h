#pragma once

#include <string>

#include "geometry/surface_queries.h"
#include "meshing/marked_mesh.h"

namespace fcn {

struct IsotropicOptions {
    double edge_length = 0;
    int iterations = 10;
    bool is_protecting = true;  ///< marked edges are left alone; false: curves may be re-cut
    bool is_projecting = true;  ///< back onto the reference surface after every iteration
};

struct IsotropicResult {
    bool has_succeeded = false;
    std::string failure;            ///< what CGAL said
    MarkedMesh mesh;                ///< marks and labels carried over
    std::size_t lost_features = 0;  ///< feature edges that the remesher did not respect
};

/// CGAL's isotropic_remeshing of a marked mesh; its exceptions come back as a failure.
IsotropicResult remesh_isotropic(const MarkedMesh& marked, const SurfaceQueries& reference,
                                 const IsotropicOptions& options);

}  // namespace fcn
