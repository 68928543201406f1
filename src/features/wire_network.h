#pragma once

#include "features/wire.h"
#include "features/wire_search.h"

namespace fcn {

/// A path as a network of one arc between two nodes (one node and no junction where it is closed).
FeatureCurveNetwork network_of_path(const WirePath& path, Pin pin);

/// The metric's options in mesh units; throws InputError on options out of range.
WireMetricOptions metric_options(const WireOptions& options, double diagonal);

/// How far wires that run along each other may be apart to become one; mesh units.
double wire_tolerance(const MeshArrays& arrays, double diagonal);

}  // namespace fcn
