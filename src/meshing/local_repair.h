#pragma once

#include "meshing/surface_faults.h"
#include "network/network.h"

namespace fcn {

struct RepairOptions {
    int max_rounds = 8;
    int max_idle_rounds = 3;  ///< without progress
};

struct RepairStatistics {
    int rounds = 0;
    std::size_t cuts = 0;     ///< of feature edges, in the result
    std::size_t sources = 0;  ///< of the target that the result was made with
};

/// Repairs a finished, compacted remesh where it has faults: edges become shorter around them, by
/// and by, features too where nothing else helps, and the mesh is remeshed there; the rest of it
/// stays. The best state is kept. `faults` are those of the mesh, before and after. `network`,
/// which may be empty, says where new vertices of features lie. Deterministic.
RepairStatistics repair_locally(WorkingMesh& mesh, const ReferenceSurface& reference,
                                const FaultFinder& finder, const FeatureCurveNetwork& network,
                                EdgeTarget& target, SurfaceFaults& faults,
                                const RepairOptions& options = {});

}  // namespace fcn
