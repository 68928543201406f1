#pragma once

#include <string>
#include <vector>

#include "meshing/measure.h"
#include "meshing/remesh.h"

namespace fcn {

/// What the ways of making a mesh of one scale start from.
struct ComparisonInput {
    const LoadedMesh& mesh;
    const FeatureCurveNetwork& initial;  ///< all that was detected
    const FeatureCurveNetwork& adapted;  ///< to rmin
    double rmin = 0, ratio = 1.5;
    int iterations = 10;
    double sample_spacing = 0;                    ///< of distances, mesh units, > 0
    const ReferenceSurface* reference = nullptr;  ///< of the mesh, made already; not owned
};

/// One way's mesh, measured against the input and the adapted network.
struct ComparisonRow {
    std::string name;
    std::string failure;  ///< empty: there is a mesh
    LoadedMesh mesh;
    TriangleQuality quality;
    EdgeShares edges;  ///< against S = [rmin, ratio rmin]
    MeshDistance distance;
    NormalDeviation normals;
    FeatureDeviation features;  ///< of the adapted network
    std::size_t broken_segments = 0, forced_faces = 0;
    std::size_t self_intersections = 0;  ///< pairs of faces, those of the input's included
    std::vector<std::string> warnings;
    double cpu_seconds = 0;  ///< of the whole process while it was made
};

/// own: this remesher on the adapted network. own-initial: on all initial features. own-plain:
/// without features. curvature-T: on initial features that turn by T radians and more. quadrics:
/// decimated to the vertex count of `own`. filtered: the surface without detail below rmin, plain.
/// cgal, cgal-constrained, cgal-initial, cgal-plain: CGAL's remesher on the adapted network with
/// its segments protected, with its curves constrained but not protected, on the initial network,
/// without features.
std::vector<std::string> remesher_names();

/// Throws InputError for an unknown name. `vertex_count` is what decimation aims at. What a way
/// throws becomes its row's failure.
ComparisonRow run_remesher(const std::string& name, const ComparisonInput& input,
                           std::size_t vertex_count);

/// Measures a mesh that came from elsewhere.
void measure_row(const ComparisonInput& input, ComparisonRow& row);

}  // namespace fcn
