// Remeshing with a network, all of it: embed the network, remesh incrementally with its segments
// fixed (incremental_remeshing.h), say what did not become an edge. For L = 1.2 rmin the segments
// of an adapted network lie in the interval of lengths that the remesher leaves alone.
#include "meshing/remesh.h"

#include <chrono>
#include <memory>

#include "meshing/curvature_sizing.h"
#include "meshing/incremental_remeshing.h"
#include "meshing/network_embedding.h"
#include "meshing/remesh_output.h"

namespace fcn {

RemeshResult remesh_triangles(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                              const RemeshOptions& options) {
    check_remesh_input(mesh, options);
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    RemeshResult result;
    const std::unique_ptr<ReferenceSurface> own =
        options.reference ? nullptr : std::make_unique<ReferenceSurface>(mesh.mesh);
    const ReferenceSurface& reference = options.reference ? *options.reference : *own;
    NetworkInMesh work = options.is_protecting
                             ? embed_network(mesh, network, options.edge_length, reference)
                             : NetworkInMesh{working_mesh(mesh), {}, {}};
    result.warnings = work.warnings;
    result.statistics.embedding = seconds();

    const EdgeTarget target =
        options.curvature_tolerance > 0
            ? target_by_curvature(mesh.mesh, options.edge_length, options.curvature_tolerance)
            : EdgeTarget{options.edge_length, {}};
    IncrementalOptions incremental;
    incremental.iterations = options.iterations;
    incremental.is_improving = options.is_improving_angles;
    const IncrementalStatistics statistics =
        remesh_incrementally(work.mesh, reference, target, incremental);
    result.statistics.coarsening = statistics.coarsening;
    result.statistics.iterating = statistics.iterating;
    result.statistics.improving = statistics.improving;
    result.statistics.bad_faces_before = statistics.angles.bad_before;
    result.statistics.bad_faces_after = statistics.angles.bad_after;
    report_broken(work, network, result);
    fill_output(mesh, work.mesh.to_marked_mesh(), result);
    result.seconds = seconds();
    return result;
}

}  // namespace fcn
