#pragma once

#include <vector>

#include "features/features.h"
#include "features/mesh_arrays.h"

namespace fcn {

/// Ends patches at creases that divide them: what lies across a crease from the main part of its
/// patch joins a neighbour on its own side where that costs little, and becomes a patch of its own
/// otherwise. New patches are appended; a crease that ends inside a patch divides nothing.
void end_patches_at_creases(const MeshArrays& arrays, const std::vector<bool>& is_crease_edge,
                            VsaResult& patches);

}  // namespace fcn
