#pragma once

#include <vector>

#include "meshing/cross_field.h"
#include "meshing/quad_domain.h"

namespace fcn {

struct HardCurveOptions {
    double edge_length = 0;          ///< h of the quads, > 0, mesh units
    double least_fold_degrees = 25;  ///< of the surface along an arc, on average
    double most_off_degrees = 30;    ///< of the field beside an edge
    double least_length = 0.9;       ///< of a curve, in h
    double least_distance = 0.6;     ///< of a curve's end from others that it does not meet, in h
};

/// A chain of edges of a domain whose image can be on one line of a map's grid.
struct HardCurve {
    int arc = -1;            ///< of the network
    std::vector<int> edges;  ///< in order
    double importance = 0;   ///< length in h, times the angle by which the surface folds, radians
};

/// Curves of the network along which the surface folds, as far as the field follows them and all
/// of them together can be grid lines: at no vertex do two leave in the same direction of the
/// field. By descending importance. Deterministic.
std::vector<HardCurve> find_hard_curves(const QuadDomain& domain, const CrossField& field,
                                        const HardCurveOptions& options);

/// What is left of a curve without some of its edges (per edge of the curve): a curve a piece that
/// is not too short.
std::vector<HardCurve> without_edges(const QuadDomain& domain, const HardCurve& curve,
                                     const std::vector<bool>& is_gone,
                                     const HardCurveOptions& options);

}  // namespace fcn
