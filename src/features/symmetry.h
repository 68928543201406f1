#pragma once

#include <cstdint>
#include <vector>

#include "features/isometry.h"
#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// An isometry that maps much of a surface onto the surface.
struct SurfaceSymmetry {
    SymmetryKind kind = SymmetryKind::Reflection;
    Isometry map;
    double coverage = 0;  ///< share of the surface's area whose image lies on the surface
    double error = 0;     ///< root mean square distance of those images, mesh units
};

struct SymmetryOptions {
    double tolerance = 0;       ///< how far images may be off, mesh units; 0 = 0.5% of the diagonal
    double min_coverage = 0.6;  ///< share of the area, (0, 1]
    int max_count = 512;        ///< of symmetries; those of largest coverage
    std::uint64_t seed = 1;     ///< of the samples on the surface
    int threads = 1;
};

/// Reflections, rotations and translations under which the surface, or `min_coverage` of it, is
/// symmetric, by falling coverage. Arcs of the network (with surface points) and curved places
/// vote. Empty for meshes without area. Deterministic on any number of threads.
std::vector<SurfaceSymmetry> find_symmetries(const LoadedMesh& mesh,
                                             const FeatureCurveNetwork& network,
                                             const SymmetryOptions& options = {});

/// Arcs that symmetries map onto each other: two arcs are partners when at least 80% of either
/// lies within `tolerance` of the other's image, with tangents within 15 degrees. Partners of
/// partners are in one orbit; its arc of least index is the representative. Pinned arcs,
/// which nobody chooses, and arcs of different kinds are no partners. Every orbit has at least two
/// members.
std::vector<SymmetryOrbit> symmetry_orbits(const FeatureCurveNetwork& network,
                                           const std::vector<SurfaceSymmetry>& symmetries,
                                           double tolerance);

/// Both: fills `network.orbits`; returns the symmetries.
std::vector<SurfaceSymmetry> add_symmetry_orbits(FeatureCurveNetwork& network,
                                                 const LoadedMesh& mesh,
                                                 const SymmetryOptions& options = {});

}  // namespace fcn
