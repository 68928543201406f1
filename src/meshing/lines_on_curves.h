#pragma once

#include "meshing/quad_domain.h"
#include "meshing/quad_extraction.h"

namespace fcn {

/// What of a quad mesh lies on curves of its domain because the map put it there.
struct LinesOnCurves {
    std::vector<QuadFeatureEdge> edges;  ///< between neighbours along a curve
    std::vector<int> arc;                ///< per vertex: of the network; -1: on no such curve
    std::vector<bool> is_corner;         ///< per vertex: where curves meet, or turn
};

/// Edges of quads along the given edges of the domain, whose images have to lie on grid lines.
/// Linear. Deterministic.
LinesOnCurves lines_on_curves(const QuadDomain& domain, const std::vector<int>& hard_edges,
                              const QuadExtraction& extraction);

}  // namespace fcn
