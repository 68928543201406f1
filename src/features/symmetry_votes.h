#pragma once

#include <cstdint>
#include <vector>

#include "features/isometry.h"
#include "features/mesh_arrays.h"
#include "network/network.h"

namespace fcn {

/// Isometries that pairs of like arcs suggest: open arcs by both directions, closed ones by the
/// shifts that fit, each proper and improper; and the reflection and the translation between
/// their centres. Only those that map the one arc onto the other within `tolerance`.
std::vector<Isometry> votes_of_arcs(const MeshArrays& arrays, const FeatureCurveNetwork& network,
                                    double tolerance, std::uint64_t seed);

/// Isometries that pairs of curved places suggest, which have like principal curvatures and whose
/// normals and principal directions fit (`radius`: the curvatures' scale, mesh units).
std::vector<Isometry> votes_of_curvature(const Mesh& mesh, const MeshArrays& arrays, double radius,
                                         std::uint64_t seed, int threads);

}  // namespace fcn
