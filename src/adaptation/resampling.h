#pragma once

#include <span>
#include <vector>

#include "adaptation/scale.h"
#include "geometry/mesh.h"

namespace fcn {

/// A chain v_1 ... v_k chosen among the dense samples of an arc (paper section 5.2.1).
struct Resampling {
    /// Indices into the arc's samples, ascending; the first is 0 and the last samples - 1 for an
    /// open arc. For a closed arc the first is `start` and the chain runs once around:
    /// indices >= samples - 1 wrap (index - (samples - 1)); the last is start + samples - 1.
    std::vector<int> chain;
    int start = 0;          ///< closed arcs: the sample that became the node
    int long_segment = -1;  ///< position in the chain of the one segment longer than rmax; -1 none
    bool is_short = false;  ///< no chain exists; chain = {first, last} of an open arc
    /// Closed arc that cannot carry three segments; the chain is empty.
    bool is_unrepresentable = false;
    double cost = 0;  ///< integral deviation / rmin^2 plus the evenness term
};

struct ResamplingOptions {
    /// Closed arc through an extraordinary node: the start stays at sample 0.
    bool is_start_fixed = false;
    /// Starts tried on a short free closed arc, spread over its first rmax; a long one takes two.
    int start_count = 12;
    /// Weight of ((length - sqrt(rmin rmax)) / rmin)^2 per segment, which decides ties.
    double evenness = 1e-6;
};

/// Best chain with every length in S by shortest path over the samples, edge cost = integral
/// distance of the samples from the chord; where none exists a chain with one long segment (at
/// most kLongSegmentFactor rmin) at either end; else short. A closed arc (first and last sample
/// equal) needs three segments. Deterministic. Cost O(n w^2), w = samples within rmax.
Resampling resample_arc(std::span<const Vec3> samples, bool is_closed, const ScaleInterval& scale,
                        const ResamplingOptions& options = {});

/// Integral over the polyline samples[first..last] of the distance to the chord between its ends
/// (trapezoidal rule), in length^2.
double chord_deviation(std::span<const Vec3> samples, int first, int last);

}  // namespace fcn
