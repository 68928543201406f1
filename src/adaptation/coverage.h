#pragma once

#include <vector>

#include "geometry/mesh.h"
#include "network/network.h"

namespace fcn {

/// A point of the initial network and what it is worth: sharpness times length.
struct CoverageSample {
    Vec3 position = Vec3::Zero();
    double worth = 0;
};

/// Share of the worth that lies within `reach` of a segment of the network; 1 when there is none.
double measure_coverage(const std::vector<CoverageSample>& samples,
                        const FeatureCurveNetwork& network, double reach);

}  // namespace fcn
