#pragma once

#include <string>
#include <vector>

#include "meshing/comparison.h"
#include "meshing/quad_quality.h"
#include "meshing/remesh_quads.h"

namespace fcn {

/// One way's quads, measured against the input and the adapted network.
struct QuadComparisonRow {
    std::string name;
    std::string failure;  ///< empty: there is a mesh, its topology the input's
    QuadResult result;
    QuadQuality quality;
    MeshDistance distance;    ///< from the input, as it was before any filter
    QuadAlignment alignment;  ///< with the adapted network
    double cpu_seconds = 0;   ///< of the whole process while it was made
};

/// own: along a field that follows the adapted network. own-initial: all initial features.
/// own-plain: no network. curvature-T: initial features that turn by T radians and more. filtered:
/// own-plain on the surface without detail below rmin; filtered-K: below K rmin. pairing: the
/// adapted network, without a field. quad_way_names() has T of 0.5 and 0.8, and no K.
std::vector<std::string> quad_way_names();

/// Throws InputError for an unknown name. What a way throws becomes its row's failure.
QuadComparisonRow run_quad_way(const std::string& name, const ComparisonInput& input);

}  // namespace fcn
