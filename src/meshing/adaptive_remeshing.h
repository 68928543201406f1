#pragma once

#include "meshing/incremental_remeshing.h"
#include "meshing/local_repair.h"

namespace fcn {

struct AdaptiveStatistics {
    IncrementalStatistics incremental;  ///< of the attempt that was kept; seconds of all
    RepairStatistics repair;
    int attempts = 0;
    std::size_t crossings = 0;  ///< pairs of faces that intersect where the input's do not
    std::vector<SizeSources::Source> refined;  ///< where edges are shorter than the target
    double repairing = 0;                      ///< seconds
};

/// Remeshes incrementally, looks at the result, and tries again with what has been learned: points
/// that the mesh must keep, places where edges have to be shorter. What is left is repaired
/// locally. `input` is the mesh of `reference`. Deterministic.
AdaptiveStatistics remesh_adaptively(WorkingMesh& mesh, const ReferenceSurface& reference,
                                     const Mesh& input, const FeatureCurveNetwork& network,
                                     EdgeTarget target, const IncrementalOptions& options);

}  // namespace fcn
