// Incremental remeshing after Botsch and Kobbelt 2004, "A remeshing approach to multiresolution
// modeling", section 3: split long edges, collapse short ones, flip for valence, smooth, project,
// a number of times. Departures: a fine mesh is coarsened first with growing thresholds, which
// keeps valences low and lets the chains of a network become single edges before anything is built
// around them; a chain that could not is tried again each time, when the mesh around it has
// changed; and a phase for the smallest angles comes last.
#include "meshing/incremental_remeshing.h"

#include <chrono>

namespace fcn {
namespace {

constexpr int kMaxRounds = 8;

double seconds_since(std::chrono::steady_clock::time_point& start) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start).count();
    start = now;
    return seconds;
}

}  // namespace

void coarsen(WorkingMesh& mesh, const EdgeTarget& target) {
    for (const double share : {0.1, 0.2, 0.4, kShortestEdge}) {
        for (int round = 0; round < kMaxRounds; ++round) {
            const std::size_t collapsed = collapse_short_edges(mesh, target, share);
            if (collapsed == 0) break;
            flip_for_angles(mesh);
            if (5 * collapsed < static_cast<std::size_t>(mesh.face_end()) / 100) break;
        }
        mesh.compact();
    }
    for (int round = 0; round < kMaxRounds; ++round) {
        if (straighten_chains(mesh) == 0) break;
        flip_for_angles(mesh);
    }
    mesh.compact();
}

IncrementalStatistics remesh_incrementally(WorkingMesh& mesh, const ReferenceSurface& reference,
                                           const EdgeTarget& target,
                                           const IncrementalOptions& options) {
    IncrementalStatistics statistics;
    auto start = std::chrono::steady_clock::now();
    coarsen(mesh, target);
    statistics.coarsening = seconds_since(start);
    for (int i = 0; i < options.iterations; ++i) {
        split_long_edges(mesh, target);
        collapse_short_edges(mesh, target, kShortestEdge);
        straighten_chains(mesh);
        flip_for_valence(mesh);
        smooth(mesh, reference, target);
        mesh.compact();
    }
    statistics.iterating = seconds_since(start);
    flip_for_angles(mesh);
    if (options.is_improving) {
        statistics.angles = improve_angles(mesh, reference, target);
        mesh.compact();
    }
    statistics.improving = seconds_since(start);
    return statistics;
}

}  // namespace fcn
