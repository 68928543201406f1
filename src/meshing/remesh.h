#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// Edge length of a mesh on a network of scale rmin, in rmin: a remesher that aims at it need not
/// split or collapse a segment.
inline constexpr double kEdgeLengthFactor = 1.2;

class ReferenceSurface;

/// A place where edges have to be shorter than asked for.
struct RefinedPlace {
    Vec3 position = Vec3::Zero();
    double edge_length = 0;  ///< there, growing with the distance
};

struct RemeshOptions {
    double edge_length = 0;  ///< target L, mesh units, > 0
    int iterations = 10;     ///< in 1 .. 1000
    /// Protect the network's segments (or dense arcs if it has none); false: plain remeshing.
    bool is_protecting = true;
    bool is_improving_angles = true;  ///< the phases for small angles and other faults
    /// > 0: edges are as long as lets the surface deviate from them by this share of L, within
    /// [L / 1.2, 1.25 L]; 0: one length everywhere.
    double curvature_tolerance = 0;
    std::vector<RefinedPlace> refined_places;     ///< known already; is_improving_angles only
    const ReferenceSurface* reference = nullptr;  ///< of the mesh, made already; not owned
};

struct RemeshStatistics {
    std::size_t bad_faces_before = 0, bad_faces_after = 0;  ///< under 31 degrees, not forced
    int attempts = 1;                                       ///< at the whole mesh
    int repair_rounds = 0;                                  ///< where it had faults
    /// Seconds of the phases.
    double embedding = 0, coarsening = 0, iterating = 0, improving = 0, repairing = 0;
};

/// Where on the network an edge lies; -1: unknown, or the network has no segments.
struct FeatureSource {
    int arc = -1, segment = -1;
};

struct RemeshResult {
    LoadedMesh mesh;  ///< labels travel from the input
    /// Pairs of vertex indices of `mesh` that lie on the protected network.
    std::vector<std::array<int, 2>> feature_edges;
    std::vector<FeatureSource> feature_sources;  ///< per feature edge; own remesher only
    /// Segments of the network (arcs if it has none) of which a piece is not a single edge.
    std::vector<int> broken_segments;
    /// Faces with an angle under 30 degrees between two protected edges, or at the tip of a spike:
    /// a fixed vertex with less than 90 degrees around it.
    std::vector<int> forced_faces;
    /// Pairs of faces that intersect, away from where the input's do; own remesher only.
    std::size_t new_intersections = 0;
    std::vector<RefinedPlace> refined_places;
    std::vector<std::string> warnings;
    RemeshStatistics statistics;
    double seconds = 0;
};

/// Incremental isotropic remeshing with the network embedded in the mesh and protected. Topology,
/// boundaries, labels stay, and no triangles come to cross. Where the edge length cannot carry the
/// surface edges get shorter, down to an eighth of it, to a thirtieth around pinholes.
/// Deterministic. Throws InputError.
RemeshResult remesh_triangles(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                              const RemeshOptions& options);

/// What CGAL's remesher is told about the network, when it is protected at all.
enum class CgalFeatures {
    Protected,    ///< segments as single edges, which it may not touch
    Constrained,  ///< dense curves, which it may cut anew; nodes stay
};

/// The same through CGAL's Polygon_mesh_processing, to compare with.
RemeshResult remesh_with_cgal(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                              const RemeshOptions& options,
                              CgalFeatures features = CgalFeatures::Protected);

}  // namespace fcn
