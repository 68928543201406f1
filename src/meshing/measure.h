#pragma once

#include "geometry/mesh.h"
#include "network/network.h"

namespace fcn {

class ReferenceSurface;

/// Triangle quality, angles in degrees (a person reads them).
struct TriangleQuality {
    std::size_t vertices = 0, faces = 0;
    double min_angle_degrees = 0, mean_min_angle_degrees = 0;
    double share_under_15 = 0;  ///< share of faces whose smallest angle is under 15 degrees, [0, 1]
    double share_under_30 = 0;
    double min_edge = 0, mean_edge = 0, max_edge = 0;  ///< mesh units
    /// Twice the inscribed over the circumscribed circle's radius, [0, 1]; 1: equilateral.
    double min_radius_ratio = 0, mean_radius_ratio = 0;
    double share_regular = 0;  ///< share of vertices inside the boundary that have valence 6
    int min_valence = 0, max_valence = 0;
};
TriangleQuality measure_triangles(const Mesh& mesh);

/// Shares of edges, [0, 1], against an interval of lengths; a millionth of it is tolerance.
struct EdgeShares {
    double below = 0, inside = 0, above = 0;
};
EdgeShares measure_edges(const Mesh& mesh, double shortest, double longest);

/// How a network's curves (dense samples of its arcs, every `sample_spacing`) lie in a mesh.
struct FeatureDeviation {
    double max = 0, mean = 0;            ///< distance to the nearest mesh edge, mesh units
    double max_node = 0, mean_node = 0;  ///< of nodes that segments use to the nearest vertex
    std::size_t samples = 0;
};
/// Throws InputError on a mesh without faces or a spacing that is not > 0.
FeatureDeviation measure_features(const Mesh& mesh, const FeatureCurveNetwork& network,
                                  double sample_spacing);

/// Angles between the mesh's face normals and the reference's at the closest points, degrees; over
/// the mesh's area, with samples as in measure_distance.
struct NormalDeviation {
    double mean_degrees = 0, rms_degrees = 0;
};
NormalDeviation measure_normals(const Mesh& mesh, const Mesh& reference, double sample_spacing);
/// `surface` is the reference's.
NormalDeviation measure_normals(const Mesh& mesh, const Mesh& reference,
                                const ReferenceSurface& surface, double sample_spacing);

/// Two-sided sampled Hausdorff distance and means, mesh units.
struct MeshDistance {
    double hausdorff = 0, forward = 0, backward = 0, mean_forward = 0, mean_backward = 0;
    std::size_t samples = 0;
    double diagonal = 0;  ///< of the reference
};
MeshDistance measure_distance(const Mesh& mesh, const Mesh& reference, double sample_spacing);
/// `surface` is the reference's.
MeshDistance measure_distance(const Mesh& mesh, const Mesh& reference,
                              const ReferenceSurface& surface, double sample_spacing);

}  // namespace fcn
