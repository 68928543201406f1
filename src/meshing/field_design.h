#pragma once

#include <string>
#include <vector>

#include "meshing/quad_domain.h"
#include "meshing/singularity_merging.h"

namespace fcn {

struct FieldOptions {
    double edge_length = 0;           ///< h of the quads, > 0, mesh units
    double curve_strength = 20;       ///< soft alignment to the network; 0: none
    double boundary_strength = 1e4;   ///< alignment to boundaries
    double curvature_strength = 0.2;  ///< alignment to curvature at scale h; 0: none
    double smoothing = 1.5;           ///< curvature is spread over this many h; 0: not at all
    double merging = 1.5;             ///< opposite singularities closer than this many h are merged
    std::uint64_t seed = 1;
};

struct FieldDesign {
    CrossField field;
    std::vector<Singularity> singularities;  ///< inside, ascending vertices
    int merged_pairs = 0;
    int close_pairs = 0;  ///< opposite singularities closer than h that are left
    /// Mean angle between arms and the network's edges, weighted by length, both sides; degrees.
    double curve_deviation_degrees = 0;
    std::string failure;  ///< empty: there is a field
    double seconds = 0;
};

/// A cross field for quads of edge h: aligned with the network's curves and the boundaries, smooth
/// elsewhere, blind to what is smaller than h. Deterministic. Throws InputError unless h > 0.
FieldDesign design_field(const QuadDomain& domain, const FieldOptions& options);

}  // namespace fcn
