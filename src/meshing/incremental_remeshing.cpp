// Incremental remeshing after Botsch and Kobbelt 2004, "A remeshing approach to multiresolution
// modeling", section 3: split long edges, collapse short ones, flip for valence, smooth, project,
// a number of times. Departures: a fine mesh is coarsened first with growing thresholds, which
// keeps valences low and lets the chains of a network become single edges before anything is built
// around them; a chain that could not is tried again each time, when the mesh around it has
// changed; and a phase for the smallest angles comes last.
#include "meshing/incremental_remeshing.h"

#include <algorithm>
#include <chrono>

#include "meshing/crossing_guard.h"

namespace fcn {
namespace {

constexpr int kMaxRounds = 8;
constexpr int kMarkEvery = 4;  ///< iterations; vertices do not move far in between

/// How far away another sheet matters to collapses up to a share of the target.
double thin_reach(const EdgeTarget& target, double share) {
    return std::min(1.0, 2.5 * share) * target.length;
}

double seconds_since(std::chrono::steady_clock::time_point& start) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start).count();
    start = now;
    return seconds;
}

/// Collapses up to a share of the target; with a reference also where that takes care.
void coarsen_to(WorkingMesh& mesh, const EdgeTarget& target, double share,
                const ReferenceSurface* reference) {
    if (reference != nullptr) mark_thin_places(mesh, *reference, thin_reach(target, share));
    for (int round = 0; round < kMaxRounds; ++round) {
        const std::size_t collapsed = collapse_short_edges(mesh, target, share);
        if (collapsed == 0) break;
        flip_for_angles(mesh, target);
        if (5 * collapsed < static_cast<std::size_t>(mesh.face_end()) / 100) break;
    }
    mesh.compact();
}

void coarsen_late(WorkingMesh& mesh, const EdgeTarget& target, const ReferenceSurface* reference) {
    for (const double share : {0.4, kShortestEdge}) coarsen_to(mesh, target, share, reference);
    for (int round = 0; round < kMaxRounds; ++round) {
        if (straighten_chains(mesh, target) == 0) break;
        flip_for_angles(mesh, target);
    }
    mesh.compact();
}

double mean_edge(const WorkingMesh& mesh) {
    double sum = 0, count = 0;
    for (int h = 0; h < mesh.halfedge_end(); ++h) {
        if (!mesh.is_first(h)) continue;
        sum += (mesh.point(mesh.to(h)) - mesh.point(mesh.from(h))).norm();
        ++count;
    }
    return count > 0 ? sum / count : 0;
}

}  // namespace

void coarsen_early(WorkingMesh& mesh, const EdgeTarget& target, const ReferenceSurface& reference) {
    double share = 0.2;
    while (share > 0.01 && share * target.length > mean_edge(mesh)) share /= 2;
    for (; share < 0.3; share *= 2) coarsen_to(mesh, target, share, &reference);
}

void coarsen(WorkingMesh& mesh, const EdgeTarget& target) {
    for (const double share : {0.1, 0.2}) coarsen_to(mesh, target, share, nullptr);
    coarsen_late(mesh, target, nullptr);
}

void remesh_once(WorkingMesh& mesh, const ReferenceSurface& reference, const EdgeTarget& target) {
    split_long_edges(mesh, target);
    collapse_short_edges(mesh, target, kShortestEdge);
    straighten_chains(mesh, target);
    flip_for_valence(mesh, target);
    smooth(mesh, reference, target);
    mesh.compact();
}

IncrementalStatistics remesh_incrementally(WorkingMesh& mesh, const ReferenceSurface& reference,
                                           const EdgeTarget& target,
                                           const IncrementalOptions& options) {
    IncrementalStatistics statistics;
    auto start = std::chrono::steady_clock::now();
    coarsen_late(mesh, target, &reference);
    statistics.coarsening = seconds_since(start);
    for (int i = 0; i < options.iterations; ++i) {
        if (i % kMarkEvery == 0)
            mark_thin_places(mesh, reference, thin_reach(target, kShortestEdge));
        remesh_once(mesh, reference, target);
    }
    statistics.iterating = seconds_since(start);
    flip_for_angles(mesh, target);
    if (options.is_improving) {
        statistics.angles = improve_angles(mesh, reference, target);
        mesh.compact();
    }
    statistics.improving = seconds_since(start);
    return statistics;
}

}  // namespace fcn
