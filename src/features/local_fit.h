#pragma once

#include <vector>

#include "features/mesh_arrays.h"

namespace fcn {

/// Curvature and its derivatives at a vertex. Curvatures are positive where the surface is convex.
struct VertexFit {
    double kappa_max = 0;               ///< the larger principal curvature (signed), 1/length
    double kappa_min = 0;               ///< the smaller one
    double e_max = 0;                   ///< derivative of kappa_max along its direction, 1/length^2
    double e_min = 0;                   ///< of kappa_min along its direction
    double kappa_error = 0;             ///< standard error of the curvatures
    double e_error = 0;                 ///< standard error of the derivatives
    Vec3 direction_max = Vec3::Zero();  ///< unit, tangent; its sign means nothing, but e_max's
    Vec3 direction_min = Vec3::Zero();  ///< belongs to it
    double radius = 0;                  ///< of the neighbourhood
    bool is_valid = false;              ///< enough neighbours around
};

struct LocalFitOptions {
    double rings = 3;   ///< radius of the neighbourhood in local mean edge lengths
    double radius = 0;  ///< the same in mesh units, instead of rings where > 0
    int threads = 1;
};

/// Fits cubic height functions. Neighbourhoods do not reach across `is_barrier_edge` edges (may be
/// empty); vertices on them get no fit.
class LocalFitter {
public:
    LocalFitter(const MeshArrays& arrays, const std::vector<bool>& is_barrier_edge);

    /// All vertices, in parallel; the same bytes on any number of threads. Time linear in the
    /// vertices times those in a neighbourhood.
    std::vector<VertexFit> fit_all(const LocalFitOptions& options) const;
    /// Some vertices alone.
    std::vector<VertexFit> fit_some(const std::vector<int>& vertices,
                                    const LocalFitOptions& options) const;

    bool is_on_barrier(int vertex) const { return is_on_barrier_[vertex]; }
    /// Mean length of the edges around a vertex, averaged over its neighbours.
    double edge_length_at(int vertex) const { return edge_lengths_[vertex]; }
    /// Unit normal of a vertex.
    const Vec3& normal(int vertex) const { return normals_[vertex]; }
    /// Vertices next to a vertex that are not beyond a barrier.
    const IndexRows& neighbors() const { return neighbors_; }

private:
    void connect();
    void measure_edges();
    std::vector<Vec3> smooth_normals(const LocalFitOptions& options) const;

    const MeshArrays& arrays_;
    std::vector<bool> is_on_barrier_;
    IndexRows neighbors_;
    std::vector<Vec3> normals_;
    std::vector<double> edge_lengths_;
};

}  // namespace fcn
