#pragma once

#include "meshing/marked_mesh.h"
#include "meshing/network_embedding.h"
#include "meshing/remesh.h"

namespace fcn {

/// Throws InputError on what no remesher can take.
void check_remesh_input(const LoadedMesh& mesh, const RemeshOptions& options);

/// Lists the segments that are not single edges of `embedded.mesh`, with a warning.
void report_broken(const NetworkInMesh& embedded, const FeatureCurveNetwork& network,
                   RemeshResult& result);

/// Sets the result's mesh, feature edges and forced faces.
void fill_output(const LoadedMesh& input, const MarkedMesh& remeshed, RemeshResult& result);

/// For each feature edge the piece of the network that it is part of: pieces are chains of feature
/// edges between stations.
std::vector<FeatureSource> find_sources(const NetworkInMesh& embedded,
                                        const std::vector<std::array<int, 2>>& feature_edges);

}  // namespace fcn
