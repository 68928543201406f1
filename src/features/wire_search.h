#pragma once

#include <memory>
#include <vector>

#include "features/mesh_arrays.h"
#include "features/wire_metric.h"
#include "features/wire_vertices.h"

namespace fcn {

/// A point of a path: on a vertex, inside an edge (at t from its first vertex), or inside a face.
struct WirePoint {
    int vertex = -1;
    int edge = -1;
    double t = 0;
    SurfacePoint surface;
    Vec3 position = Vec3::Zero();
};

struct WirePath {
    std::vector<WirePoint> points;  ///< empty: the ends are on different components
    double cost = 0;
    double length = 0;
};

struct WireSearchOptions {
    /// Meshes of more faces are searched along their vertices first, and only a band is refined.
    int whole_mesh_faces = 20000;
};

/// Cheapest paths between points of a mesh in a metric. Keeps references. Not for several threads
/// at once; the answer depends on the two ends only.
class WireSearch {
public:
    WireSearch(const MeshArrays& arrays, const WireMetric& metric,
               const WireSearchOptions& options = {});

    /// A point as the search wants it: on a vertex or an edge if it is within rounding of one.
    WirePoint point_at(const SurfacePoint& surface) const;
    WirePath path(const WirePoint& from, const WirePoint& to);

private:
    class Band;
    std::vector<int> faces_at(const WirePoint& point) const;
    double step(int face, const WirePoint& a, const WirePoint& b) const;
    std::vector<int> vertex_path(const WirePoint& from, const WirePoint& to);
    std::vector<int> grown(std::vector<int> faces, int rings);
    WirePath search(const std::vector<int>& faces, int per_edge, const WirePoint& from,
                    const WirePoint& to);
    int common_face(const WirePoint& a, const WirePoint& b) const;
    double cost_between(const WirePoint& a, const WirePoint& b) const;
    WirePoint on_edge(int edge, double t) const;
    void tighten(WirePath& path) const;

    const MeshArrays& arrays_;
    const WireMetric& metric_;
    WireSearchOptions options_;
    IndexRows faces_;
    std::unique_ptr<VertexSearch> vertex_search_;           ///< of large meshes
    std::vector<int> face_mark_, vertex_mark_, edge_mark_;  ///< number within the current band
};

}  // namespace fcn
