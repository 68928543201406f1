#pragma once

#include <string>
#include <vector>

#include "adaptation/working_network.h"

namespace fcn {

/// Gives the members of every orbit the representative's chain, transported: each chain node goes
/// to the member's sample nearest to its image. Members' segments get the same orbit class as the
/// representative's. An orbit whose arcs were merged away, or a member where the transported
/// lengths leave the scale, is resampled on its own and reported in `warnings`. Call after the
/// first resampling; `arc_of_origin` maps initial arcs to unmerged working arcs (-1 otherwise).
void transport_orbits(WorkingNetwork& network, const std::vector<SymmetryOrbit>& orbits,
                      const std::vector<int>& arc_of_origin, const ScaleInterval& scale,
                      std::vector<std::string>& warnings);

}  // namespace fcn
