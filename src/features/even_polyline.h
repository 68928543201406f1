#pragma once

#include <vector>

#include "network/network.h"

namespace fcn {

/// `count` points at even steps along an arc from end to end; of a closed arc the last step ends
/// before the first point, so that all points differ. count >= 2.
std::vector<Vec3> even_points(const NetworkArc& arc, int count);

}  // namespace fcn
