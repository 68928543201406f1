#pragma once

#include <vector>

#include "adaptation/adaptation.h"
#include "adaptation/adaptation_surface.h"
#include "adaptation/coverage.h"
#include "adaptation/crumbs.h"
#include "adaptation/working_network.h"

namespace fcn {

/// What every dense sample interval carries from the arc of the initial network it came from;
/// computed once (L, Loop, membership), never again.
struct OriginAttributes {
    double curve_length = 0;  ///< of the arc's supporting curve
    bool is_on_loop = false;
    bool is_symmetric = false;
    int curve = -1;
    int rank_in_curve = 0;  ///< place of the arc in its curve
    bool is_reversed_in_curve = false;
};

struct InitialState {
    WorkingNetwork network;
    std::vector<OriginAttributes> origins;  ///< per arc of the initial network
    std::vector<CoverageSample> coverage;
    CrumbOptions crumbs;
    std::vector<DroppedPiece> dropped;  ///< arcs pinned out
    double median_turning = 0;          ///< radians; what best mode's I(e) is measured in
};

/// Dense sampling, sharpness and origins of the initial network at a scale. Best mode: sharpness =
/// turning of the surface within rmin / 2, divided by its length-weighted median (at least 0.05
/// radians); paper mode: |kappa_max| of the one-ring shape operator.
InitialState make_initial_state(const LoadedMesh& mesh, const AdaptationSurface& surface,
                                const FeatureCurveNetwork& initial, const ScaleInterval& scale,
                                const AdaptationOptions& options);

}  // namespace fcn
