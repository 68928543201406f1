#pragma once

#include <vector>

#include "features/sharp_edges.h"

namespace fcn {

/// Takes away chains of sharp edges that filtered normals made of a rounded edge: noisy ones that
/// turn, averaged along the chain, by less than `high_angle` (radians) and by little more than the
/// surface beside them does. Deterministic; near-linear.
void drop_rounded_edges(const MeshArrays& arrays, const RobustDihedrals& dihedrals,
                        double high_angle, std::vector<bool>& is_sharp);

}  // namespace fcn
