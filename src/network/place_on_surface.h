#pragma once

#include <string>

#include "network/network.h"

namespace fcn {

/// Gives every node and sample its place on the surface. Points whose place is known and fits the
/// mesh stay; the others move to the closest surface point (those closer than 1e-9 diagonals keep
/// their coordinates to the last bit). Samples that fall together become one; an arc that vanishes
/// is dropped with a note. Arcs along mesh edges get their dihedral angle if it is unknown. Throws
/// InputError, naming `source`, if a point is farther than 5% of the mesh's diagonal from it.
void place_on_surface(FeatureCurveNetwork& network, const Mesh& mesh, const std::string& source);

}  // namespace fcn
