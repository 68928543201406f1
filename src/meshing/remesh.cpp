// Remeshing with a network, all of it: embed the network, remesh with its segments fixed
// (adaptive_remeshing.h), say what did not become an edge. For L = 1.2 rmin the segments
// of an adapted network lie in the interval of lengths that the remesher leaves alone.
#include "meshing/remesh.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "meshing/adaptive_remeshing.h"
#include "meshing/curvature_sizing.h"
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

    EdgeTarget target =
        options.curvature_tolerance > 0
            ? target_by_curvature(mesh.mesh, options.edge_length, options.curvature_tolerance)
            : EdgeTarget{options.edge_length, {}, {}, {}};
    target.sources = SizeSources(options.edge_length);
    for (const RefinedPlace& place : options.refined_places)
        target.sources.add(place.position, place.edge_length);
    IncrementalOptions incremental;
    incremental.iterations = options.iterations;
    incremental.is_improving = options.is_improving_angles;
    AdaptiveStatistics statistics;
    if (options.is_improving_angles) {
        statistics =
            remesh_adaptively(work.mesh, reference, mesh.mesh, network, target, incremental);
    } else {
        coarsen_early(work.mesh, target, reference);
        statistics.incremental = remesh_incrementally(work.mesh, reference, target, incremental);
    }
    result.statistics.coarsening = statistics.incremental.coarsening;
    result.statistics.iterating = statistics.incremental.iterating;
    result.statistics.improving = statistics.incremental.improving;
    result.statistics.repairing = statistics.repairing;
    result.statistics.attempts = std::max(1, statistics.attempts);
    result.statistics.repair_rounds = statistics.repair.rounds;
    result.new_intersections = statistics.crossings;
    for (const auto& [position, size] : statistics.refined)
        result.refined_places.push_back({position, size});
    result.statistics.bad_faces_before = statistics.incremental.angles.bad_before;
    result.statistics.bad_faces_after = statistics.incremental.angles.bad_after;
    report_broken(work, network, result);
    fill_output(mesh, work.mesh.to_marked_mesh(), result);
    result.feature_sources = find_sources(work, result.feature_edges);
    result.seconds = seconds();
    return result;
}

}  // namespace fcn
