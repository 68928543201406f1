#pragma once

#include <vector>

#include "adaptation/adaptation.h"
#include "adaptation/scale.h"
#include "adaptation/segment_graph.h"

namespace fcn {

/// What the weight of a segment is made of (paper section 5.3.1), each averaged by length over the
/// dense sample intervals that the segment approximates.
struct SegmentAttributes {
    double sharpness = 0;     ///< I(e): mean |kappa_max|; best mode: turning / its median
    double contrast = 1;      ///< best mode: >= 1, for creases of 20 to 40 degrees and more
    double curve_length = 0;  ///< length of the supporting curve, mesh units
    bool is_on_loop = false;
    bool is_symmetric = false;
    double length = 0;  ///< of the segment, mesh units
};

/// 30 from 40 degrees of dihedral angle (radians in) on; below, from 1 (20 degrees) up to 3.
double crease_contrast(double dihedral);

/// w(e) = I L Sym Loop; best mode: I contrast sqrt(L / rmin) Sym Loop length / rmin.
double segment_weight(const SegmentAttributes& attributes, const ScaleInterval& scale,
                      const AdaptationOptions& options);

/// a_s = cos^p(2 gamma) for gamma <= pi/4, else 0; gamma = turning angle at the shared node.
double smoothness(double gamma, double power);
/// a_par,perp = cos^2p(2 gamma); gamma = angle between the two lines.
double orthogonality(double gamma, double power);

/// Earned when both segments are kept; first < second.
struct PairBonus {
    int first = -1, second = -1;
    double value = 0;
};

/// lambda0 a_s over pairs that share a node plus lambda1 a_par,perp over pairs (not in
/// `excluded`, sorted pairs) whose midpoints are closer than ortho_radius rmax. In best mode each
/// is multiplied by the smaller contrast * sharpness of the pair, so that smooth borders cannot
/// outvote creases. Sorted, at most one entry a pair.
std::vector<PairBonus> pair_bonuses(const SegmentGraph& graph,
                                    const std::vector<SegmentAttributes>& attributes,
                                    const std::vector<std::pair<int, int>>& excluded,
                                    const ScaleInterval& scale, const AdaptationOptions& options);

}  // namespace fcn
