#pragma once

#include <vector>

#include "features/sharp_edges.h"

namespace fcn {

/// Undoes what noise does to chains of sharp edges, on noisy edges only: of two chains around a few
/// faces the weaker one goes, short spurs go, and gaps of a few edges are closed where there is a
/// rest of a crease in them. `high_angle` (radians) is that of a strong crease. Deterministic.
void mend_chains(const MeshArrays& arrays, const RobustDihedrals& dihedrals, double high_angle,
                 std::vector<bool>& is_sharp);

}  // namespace fcn
