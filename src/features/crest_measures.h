#pragma once

#include "features/crest_lines.h"

namespace fcn {

/// What a crest line is judged by; ds is arc length along it.
struct CrestMeasures {
    double length = 0;         ///< mesh units
    double ridgeness = 0;      ///< integral of |kappa| ds; dimensionless
    double sphericalness = 0;  ///< mean window of the shape index, 0 sphere to 1 cylinder or saddle
    double cyclideness = 0;    ///< length times integral of sqrt(e_max^2 + e_min^2) ds
    double sharpness = 0;      ///< second derivative of kappa across the line, over kappa^3; median
    double significance = 0;   ///< fall of e across a fit over its standard error; median
};

/// Gaps count with the mean of their two ends. Near-linear time.
CrestMeasures measure(const CrestGraph& graph, const CrestLine& line);

}  // namespace fcn
