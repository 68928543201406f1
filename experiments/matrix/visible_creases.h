#pragma once

#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn::experiments {

/// A crease, and how much of the part of it that lies far from every other crease is covered.
struct IsolatedCrease {
    double length = 0;                 ///< isolated part, mesh units
    double covered = 0;                ///< of that part, within rmin / 2 of the network
    Vec3 uncovered_at = Vec3::Zero();  ///< a point that is not, where there is one
};

/// What a person sees of an adapted network (DESIGN 4.12): for each crease of at least 40 degrees
/// the part that runs farther than 1.5 rmin from every other such crease, and how much of it is
/// covered. Where a crease bends back to within 1.5 rmin of itself it is not isolated either.
/// Creases are traced anew from the mesh's dihedral angles; those without an isolated part are
/// left out.
std::vector<IsolatedCrease> isolated_creases(const LoadedMesh& mesh,
                                             const FeatureCurveNetwork& network, double rmin);

/// Connected pieces of the adapted network shorter than 3 rmin that are neither pinned nor whole
/// curves of the initial network (nor whole connected components of it).
int count_crumbs(const FeatureCurveNetwork& initial, const FeatureCurveNetwork& network,
                 double rmin);

}  // namespace fcn::experiments
