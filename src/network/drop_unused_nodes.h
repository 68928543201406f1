#pragma once

#include "network/network.h"

namespace fcn {

/// Removes nodes that no arc and no segment uses and renumbers the others in their order.
void drop_unused_nodes(FeatureCurveNetwork& network);

}  // namespace fcn
