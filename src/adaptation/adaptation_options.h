#pragma once

#include "adaptation/adaptation.h"

namespace fcn {

/// With the defaults that depend on mode and target in place of -1.
AdaptationOptions with_defaults(AdaptationOptions options);

/// Throws InputError for options out of range, and for curves that would need more samples at the
/// scale than fit into memory.
void require_valid(const AdaptationOptions& options, const FeatureCurveNetwork& initial);

}  // namespace fcn
