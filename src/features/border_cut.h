#pragma once

#include <vector>

#include "features/mesh_arrays.h"

namespace fcn {

/// What a patch border costs and how far it may move.
struct BorderCutOptions {
    int band_width = 3;            ///< faces to either side of a border that may change patch
    double crease_angle = 0.5236;  ///< radians (30 degrees): full discount from here on
    double flat_angle = 0.1396;    ///< radians (8 degrees): no discount up to here
    double crease_cost = 0.05;     ///< per length, relative to flat
    double normal_weight = 1.0;    ///< of the VSA error against the border's length
    int sweeps = 2;                ///< over all pairs of neighbouring patches
};

/// Moves the borders between patches onto creases and shortens them elsewhere, by minimum cuts in
/// a band around each border. `angles` are signed dihedrals per edge; edges between different
/// `face_labels` (may be empty) count as creases. Every patch stays connected and keeps its
/// innermost faces. Returns the patch of each face. Deterministic.
std::vector<int> move_borders(const MeshArrays& arrays, const std::vector<double>& angles,
                              const std::vector<int>& face_labels,
                              const std::vector<int>& patch_of_face,
                              const std::vector<Vec3>& proxy_normals,
                              const BorderCutOptions& options = {});

}  // namespace fcn
