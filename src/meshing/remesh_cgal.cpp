// Remeshing with a network by CGAL: embed, coarsen, remesh, improve.
//
// CGAL's remesher keeps protected edges as they are, so the network must arrive as edges of the
// right length: it is embedded, and its chains become single edges, as for our own remesher. Plain
// remeshing, without protection, is CGAL's alone: a baseline. A failure of CGAL is answered by a
// simpler run (no projection, then the coarsened mesh as it is).
#include <chrono>

#include "meshing/incremental_remeshing.h"
#include "meshing/isotropic_cgal.h"
#include "meshing/network_embedding.h"
#include "meshing/remesh.h"
#include "meshing/remesh_output.h"

namespace fcn {
namespace {

/// CGAL's remesher; where it fails, without projection; where that fails, the mesh as it is.
MarkedMesh remesh_robustly(const MarkedMesh& marked, const SurfaceQueries& surface,
                           const RemeshOptions& options, CgalFeatures features,
                           std::vector<std::string>& warnings) {
    IsotropicOptions isotropic;
    isotropic.edge_length = options.edge_length;
    isotropic.iterations = options.iterations;
    isotropic.is_protecting = options.is_protecting && features == CgalFeatures::Protected;
    for (const bool is_projecting : {true, false}) {
        isotropic.is_projecting = is_projecting;
        IsotropicResult result = remesh_isotropic(marked, surface, isotropic);
        if (isotropic.is_protecting && result.lost_features > 0)
            warnings.push_back(std::to_string(result.lost_features) +
                               " protected edges were not kept by the remesher");
        if (result.has_succeeded) return std::move(result.mesh);
        warnings.push_back(std::string("CGAL's remesher failed") +
                           (is_projecting ? "" : " without projection too") + ": " +
                           result.failure);
    }
    warnings.push_back("the mesh is coarsened only");
    return marked;
}

}  // namespace

RemeshResult remesh_with_cgal(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                              const RemeshOptions& options, CgalFeatures features) {
    check_remesh_input(mesh, options);
    const auto start = std::chrono::steady_clock::now();
    RemeshResult result;
    const ReferenceSurface reference(mesh.mesh);
    const EdgeTarget target{options.edge_length, {}, {}, {}};
    MarkedMesh marked;
    if (options.is_protecting) {
        NetworkInMesh embedded = embed_network(mesh, network, options.edge_length, reference);
        result.warnings = std::move(embedded.warnings);
        if (features == CgalFeatures::Protected) {
            coarsen(embedded.mesh, target);
            report_broken(embedded, network, result);
        }
        embedded.mesh.compact();
        marked = embedded.mesh.to_marked_mesh();
    } else {
        marked = working_mesh(mesh).to_marked_mesh();
        marked.is_fixed_vertex.assign(marked.is_fixed_vertex.size(), false);
    }
    const SurfaceQueries surface(mesh.mesh);
    const MarkedMesh remeshed =
        remesh_robustly(marked, surface, options, features, result.warnings);
    fill_output(mesh, remeshed, result);
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace fcn
