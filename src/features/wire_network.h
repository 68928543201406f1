#pragma once

#include "features/wire.h"
#include "features/wire_search.h"

namespace fcn {

/// A path as a network of one arc between two nodes (one node and no junction where it is closed).
FeatureCurveNetwork network_of_path(const WirePath& path, Pin pin);

/// The metric's options in mesh units; throws InputError on options out of range.
WireMetricOptions metric_options(const WireOptions& options, double diagonal);

/// The point of the cheapest edge within `radius` of a seed, if steps along it cost at most half of
/// those at the seed; else the seed. So a seed beside a crease makes no spur.
SurfacePoint snapped_seed(const MeshArrays& arrays, const WireMetric& metric,
                          const SurfacePoint& seed, double radius);

/// How far wires that run along each other may be apart to become one; mesh units.
double wire_tolerance(const MeshArrays& arrays, double diagonal);

}  // namespace fcn
