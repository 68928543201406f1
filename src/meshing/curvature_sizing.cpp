// Sizing by curvature (after Dunyach et al. 2013, "Adaptive remeshing for real-time mesh
// deformation"): an edge of length l on a surface of curvature k misses it by k l^2 / 8. Departure:
// lengths stay within S, since what a network was adapted to must stay true.
#include "meshing/curvature_sizing.h"

#include <algorithm>
#include <cmath>

#include "geometry/curvature.h"

namespace fcn {

EdgeTarget target_by_curvature(const Mesh& mesh, double edge_length, double tolerance) {
    EdgeTarget target{edge_length, {}, {}, {}};
    CurvatureOptions options;
    options.radius = edge_length / 2;
    const PrincipalCurvatures curvatures = principal_curvatures(mesh, options);
    target.face_factors.reserve(mesh.n_faces());
    for (const FaceHandle face : mesh.faces()) {
        double kappa = 0;
        for (const VertexHandle v : face_vertices(mesh, face))
            kappa =
                std::max(kappa, std::abs(curvatures.kappa_max[static_cast<std::size_t>(v.idx())]));
        const double factor =
            kappa > 0 ? std::sqrt(8 * tolerance / (kappa * edge_length)) : kCoarsestSizing;
        target.face_factors.push_back(
            static_cast<float>(std::clamp(factor, kFinestSizing, kCoarsestSizing)));
    }
    return target;
}

}  // namespace fcn
