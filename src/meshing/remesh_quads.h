#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "meshing/quad_mesh.h"
#include "network/network.h"

namespace fcn {

class ReferenceSurface;

/// How quads come to be: from a cross field and a map to the plane, or from pairs of triangles.
enum class QuadTier { Pairing = 0, Field = 1 };

/// What the cross field is told of the network.
enum class QuadGuidance {
    Network,    ///< to follow its curves, each with its weight
    None,       ///< nothing but boundaries
    Threshold,  ///< to follow the curves above a curvature, as if there were no adaptation
};

struct QuadOptions {
    double edge_length = 0;                ///< target h of the quads, mesh units, > 0
    QuadTier best_tier = QuadTier::Field;  ///< the first to be tried
    QuadGuidance guidance = QuadGuidance::Network;
    double threshold = 0.8;  ///< radians, for QuadGuidance::Threshold
    int iterations = 10;     ///< of remeshing triangles, in 1 .. 1000
    int smoothing_rounds = 30;
    const ReferenceSurface* reference = nullptr;  ///< of the mesh, made already; not owned
};

/// One try at quads of one edge length along a field.
struct QuadAttempt {
    double edge_length = 0;
    std::size_t triangles = 0;  ///< that carry field and map
    int singularities = 0;
    /// That failed: domain, field, map, extraction, or smoothing; empty: none.
    std::string step;
    std::string reason;  ///< empty: it succeeded
    /// Seconds of the steps.
    double domain = 0, field = 0, map = 0, extraction = 0, smoothing = 0;
};

/// The cross field along which quads were made, and the triangles that carried it.
struct QuadField {
    /// The surface with edges of about a third of a quad's, short boundary loops closed; its curves
    /// are those of the network that the field was guided by.
    LoadedMesh mesh;
    std::vector<Vec3> arms;  ///< per face: one of the four unit vectors, in the face's plane
    struct Singularity {
        int vertex = -1;  ///< of the mesh, inside
        int index = 0;    ///< in quarters: 1 has three quads around it, -1 five
    };
    std::vector<Singularity> singularities;  ///< ascending vertices
};

struct QuadResult {
    QuadMesh mesh;
    QuadTier tier = QuadTier::Pairing;
    /// Why the tier is not the one asked for, or the edges are shorter; empty: they are as asked.
    std::string reason;
    std::vector<QuadAttempt> attempts;  ///< at a field
    std::optional<QuadField> field;     ///< that the quads follow; none by pairing
    double edge_length = 0;             ///< that was aimed at in the end
    int inverted_corners = 0;
    /// Of the network, that are no chains of edges of the mesh; by pairing alone.
    std::vector<int> broken_segments;
    std::vector<std::string> warnings;
    double seconds = 0;
};

/// A mesh of quads alone with about the given edge length and the input's topology, on the
/// surface, guided by the network. Deterministic. Throws InputError.
QuadResult remesh_quads(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                        const QuadOptions& options);

/// The way that never fails: triangles of twice the length with the network's segments as edges,
/// paired and cut at their middles. Segments are chains of edges, mostly single ones.
QuadResult quads_by_pairing(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                            const QuadOptions& options);

}  // namespace fcn
