#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/surface_queries.h"
#include "network/network.h"
#include "network/written_network.h"

namespace fcn {

/// Where a point lies among the edges of a mesh: on a vertex, inside an edge, or neither.
struct MeshPlace {
    VertexHandle vertex;
    EdgeHandle edge;
};

MeshPlace place_of(const Mesh& mesh, const SurfacePoint& point);

/// The edge that two different places both lie on, its ends included; invalid when there is none.
EdgeHandle common_edge(const Mesh& mesh, const MeshPlace& a, const MeshPlace& b);

/// Turns written polylines into paths of mesh vertices. Points whose place on the surface is
/// unknown, or of another mesh, are located by a closest-point query.
class MeshEdgePaths {
public:
    /// `target` names the file to be written in messages.
    MeshEdgePaths(const Mesh& mesh, std::string target);

    /// Consecutive vertices are joined by an edge; a closed arc repeats its first. Points inside
    /// edges on the way are passed over. Throws InputError where the polyline leaves the edges.
    std::vector<VertexHandle> vertices_along(const WrittenNetwork& network, std::size_t arc);
    /// The vertices of every arc.
    std::vector<std::vector<int>> all(const WrittenNetwork& network);

private:
    MeshPlace locate(const WrittenNetwork& network, int point);

    const Mesh& mesh_;
    std::string target_;
    double tolerance_;
    std::unique_ptr<SurfaceQueries> queries_;  ///< built when first needed
};

}  // namespace fcn
