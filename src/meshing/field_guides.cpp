// What a cross field is to follow, at the scale of the quads (Ebke, Campen, Bommes, Kobbelt 2014):
// curves weigh by their length in quads, curvature by area in quads and by how much the surface
// turns over one quad.
#include "meshing/field_guides.h"

#include <algorithm>
#include <cmath>

#include "geometry/curvature.h"
#include "meshing/cross_field.h"

namespace fcn {
namespace {

constexpr double kLeastAnisotropy = 0.05;  ///< radians over one quad; less has no direction

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void add_sides(const Mesh& mesh, EdgeHandle edge, double weight, std::vector<FieldGuide>& guides) {
    for (const unsigned side : {0u, 1u}) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, side);
        if (!mesh.is_boundary(h))
            guides.push_back({mesh.face_handle(h).idx(), halfedge_angle(mesh, h), weight});
    }
}

}  // namespace

std::vector<FieldGuide> curve_guides(const QuadDomain& domain, double edge_length,
                                     double strength) {
    std::vector<FieldGuide> guides;
    for (const EdgeHandle edge : domain.mesh.edges()) {
        const double importance = domain.edge_weight[at(edge.idx())];
        if (importance > 0)
            add_sides(domain.mesh, edge,
                      strength * importance * domain.mesh.calc_edge_length(edge) / edge_length,
                      guides);
    }
    return guides;
}

std::vector<FieldGuide> boundary_guides(const Mesh& mesh, double edge_length, double strength) {
    std::vector<FieldGuide> guides;
    for (const EdgeHandle edge : mesh.edges())
        if (mesh.is_boundary(edge))
            add_sides(mesh, edge, strength * mesh.calc_edge_length(edge) / edge_length, guides);
    return guides;
}

std::vector<FieldGuide> curvature_guides(const Mesh& mesh, double edge_length, double strength) {
    std::vector<FieldGuide> guides;
    CurvatureOptions options;
    options.radius = edge_length;
    const PrincipalCurvatures curvature = principal_curvatures(mesh, options);
    for (const FaceHandle face : mesh.faces()) {
        const auto corners = face_vertices(mesh, face);
        const Vec3 x = (mesh.point(corners[1]) - mesh.point(corners[0])).stableNormalized();
        const Vec3 y = face_normal(mesh, face).cross(x);
        // Directions of the corners as a mean of complex fourth powers.
        double re = 0, im = 0;
        for (const VertexHandle v : corners) {
            const std::size_t i = at(v.idx());
            const double bend =
                edge_length * std::abs(curvature.kappa_max[i] - curvature.kappa_min[i]);
            if (!(bend > kLeastAnisotropy)) continue;
            const Vec3& d = curvature.direction_max[i];
            const double angle = 4 * std::atan2(d.dot(y), d.dot(x));
            re += std::min(1.0, bend) * std::cos(angle) / 3;
            im += std::min(1.0, bend) * std::sin(angle) / 3;
        }
        const double weight =
            strength * std::hypot(re, im) * face_area(mesh, face) / (edge_length * edge_length);
        if (weight > 0) guides.push_back({face.idx(), std::atan2(im, re) / 4, weight});
    }
    return guides;
}

}  // namespace fcn
