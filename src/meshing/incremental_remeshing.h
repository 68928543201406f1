#pragma once

#include "meshing/angle_improvement.h"

namespace fcn {

struct IncrementalOptions {
    int iterations = 10;
    bool is_improving = true;  ///< raise small angles at the end
};

struct IncrementalStatistics {
    double coarsening = 0, iterating = 0, improving = 0;  ///< seconds
    AngleStatistics angles;
};

/// Collapses what is much shorter than the target, so that all that follows is cheap.
void coarsen_early(WorkingMesh& mesh, const EdgeTarget& target, const ReferenceSurface& reference);

/// Incremental remeshing (Botsch, Kobbelt 2004) of `mesh`, whose vertices lie on `reference`, to
/// edges in [4/5, 4/3] of the target; chains of feature edges between fixed vertices become single
/// edges where topology and shape permit. Ends compacted. Deterministic.
IncrementalStatistics remesh_incrementally(WorkingMesh& mesh, const ReferenceSurface& reference,
                                           const EdgeTarget& target,
                                           const IncrementalOptions& options);

/// One round of it: splits, collapses, chains, flips for valence, smoothing; ends compacted.
void remesh_once(WorkingMesh& mesh, const ReferenceSurface& reference, const EdgeTarget& target);

/// Only what makes chains of features single edges, with the mesh coarsened around them.
void coarsen(WorkingMesh& mesh, const EdgeTarget& target);

}  // namespace fcn
