#pragma once

#include <functional>

#include "meshing/hard_curves.h"
#include "meshing/quad_map.h"

namespace fcn {

struct CurveMapOptions {
    double edge_length = 0;  ///< h of the quads, > 0, mesh units
    double soft_weight =
        1;                ///< of alignment to the network where it is not hard, against the field
    bool is_hard = true;  ///< false: no curve is asked to lie on grid lines
    int rounds = 4;       ///< with hard curves; then all are soft
    std::function<QuadMapResult(const Mesh&, const CrossField&, const QuadMapOptions&)> make_map =
        make_quad_map;
};

struct CurveMap {
    QuadMapResult result;
    std::vector<HardCurve> curves;  ///< that are on grid lines, by descending importance
    std::size_t found_edges = 0;    ///< of the domain, on curves that were asked for at first
    std::size_t kept_edges = 0;     ///< on those left
    int rounds = 0;                 ///< maps that were made
};

/// A map whose grid has lines on as many of the network's folds as it can, the more important ones
/// first, and follows the others softly. Deterministic.
CurveMap map_with_curves(const QuadDomain& domain, const CrossField& field,
                         const CurveMapOptions& options);

}  // namespace fcn
