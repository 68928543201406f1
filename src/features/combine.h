#pragma once

#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

struct CombineOptions {
    /// Mesh units: no point of any given network is farther than this from the result. Stretches
    /// within half of it, and along what is there, are fused. 0 = two mean edge lengths, at most
    /// 1% of the bounding-box diagonal.
    double tolerance = 0;
};

/// What `tolerance` 0 stands for.
double default_combine_tolerance(const LoadedMesh& mesh);

/// Merges initial networks of one mesh. Earlier ones win: of each later arc the stretches that run
/// along what is there are left out, what remains ends at it in a junction, and crossing arcs get
/// one. Trimmed pieces that lie wholly within the tolerance are dropped. Arcs keep their source,
/// kind, pin and patches (renumbered, so that they stay apart); a pin of a stretch that is left out
/// goes to the arc that stands for it. Curves and orbits are not kept. The geometry does not depend
/// on the order of arcs within a network. O(n log n) for bounded density. Throws InputError on a
/// tolerance that is no length.
FeatureCurveNetwork combine_networks(const std::vector<FeatureCurveNetwork>& networks,
                                     const LoadedMesh& mesh, const CombineOptions& options = {});

}  // namespace fcn
