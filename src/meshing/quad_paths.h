#pragma once

#include <map>
#include <vector>

#include "meshing/quad_mesh.h"
#include "meshing/sampled_curve.h"

namespace fcn {

/// Finds lines of quad edges that run beside curves.
class QuadPaths {
public:
    /// Vertices farther than `reach` from a curve are not on its path; mesh units, > 0.
    QuadPaths(const QuadMesh& mesh, double reach);

    /// A path, vertices in order, and where along the curve each of them goes.
    struct Path {
        std::vector<int> vertices;  ///< the first again at the end if the curve is closed
        std::vector<double> parameters;
        bool is_empty() const { return vertices.empty(); }
    };

    /// The best path along the curve, over vertices that are in no path yet; it makes no turn that
    /// two edges of one quad make. `from`, `to`: vertices at the ends of an open curve, -1: any
    /// near the end. Empty: there is none. Its vertices, ends aside, are taken.
    Path find(const SampledCurve& curve, int from, int to);

    /// The nearest vertex that is not taken, within reach; -1: none.
    int nearest(const Vec3& point) const;
    void take(int vertex) { is_taken_[static_cast<std::size_t>(vertex)] = true; }
    bool is_boundary(int vertex) const { return is_boundary_[static_cast<std::size_t>(vertex)]; }

private:
    struct Sight {
        double distance = 0;
        int parameter = 0;
    };
    using Sights = std::map<int, Sight>;
    int from(int h) const { return mesh_.faces[at(h / 4)][at(h % 4)]; }
    int to(int h) const { return from(next_in_quad(h)); }
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    std::array<long, 3> cell(const Vec3& p) const;
    template <class Visit>
    void visit_near(const Vec3& point, Visit&& visit) const;
    Sights look_from(const SampledCurve& curve, int from, int to) const;
    double cost(const SampledCurve& curve, const Sights& sights, int h) const;
    std::vector<int> search(const SampledCurve& curve, const Sights& sights,
                            const std::map<int, double>& starts,
                            const std::map<int, double>& goals) const;

    const QuadMesh& mesh_;
    double reach_;
    std::vector<int> opposite_;
    std::vector<std::vector<int>> out_;  ///< per vertex: halfedges
    std::vector<bool> is_boundary_, is_taken_;
    std::map<std::array<long, 3>, std::vector<int>> cells_;
};

}  // namespace fcn
