#pragma once

#include <vector>

#include "features/mesh_arrays.h"

namespace fcn {

struct NormalFilterOptions {
    int rounds = 3;
    double range = 0.45;  ///< radians: largest standard deviation of the weights by normals
    int threads = 1;
};

struct FilteredNormals {
    std::vector<Vec3> normals;
    double displacement = 0;  ///< of vertices by noise, standard deviation, mesh units
    double residual = 0;      ///< mean squared deviation, radians^2, that is left where it is flat
};

/// Normals of faces without the noise of vertices, creases kept: those of `is_noisy_face` are
/// filtered, the others as they are. Near-linear; deterministic on any number of threads.
FilteredNormals filtered_normals(const MeshArrays& arrays, const std::vector<bool>& is_noisy_face,
                                 const NormalFilterOptions& options = {});

}  // namespace fcn
