#pragma once

#include "meshing/remeshing_steps.h"

namespace fcn {

struct AngleOptions {
    double good_angle = 0.541;  ///< radians (31 degrees): triangles above it are left alone
    int max_rounds = 6;
};

struct AngleStatistics {
    std::size_t bad_before = 0, bad_after = 0;  ///< faces under the good angle
    std::size_t improvements = 0;
};

/// Raises small angles: each bad triangle, worst first, gets the best of some local changes, each
/// followed by flips and moves around it, if the patch as a whole is better then and no farther
/// from the reference. Marked edges and fixed vertices stay. Deterministic.
AngleStatistics improve_angles(WorkingMesh& mesh, const ReferenceSurface& reference,
                               const EdgeTarget& target, const AngleOptions& options = {});

}  // namespace fcn
