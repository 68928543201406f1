#pragma once

#include "features/features.h"
#include "features/mesh_arrays.h"

namespace fcn {

/// segment_vsa() on flat arrays.
VsaResult segment_vsa(const MeshArrays& arrays, const VsaOptions& options);

}  // namespace fcn
