// The cross field behind quads, for people and programs that want to see or use it: kept with the
// triangles that carried it, where it is exact, and carried over to the input's own faces. An arm
// is turned with the normal by the shortest rotation, which keeps its angle to a crease that both
// meshes have; it is not averaged, since averages of crosses vanish around singularities.
#include "meshing/quad_field.h"

#include <cmath>

#include "geometry/mesh_curves.h"
#include "meshing/field_file.h"
#include "meshing/reference_surface.h"

namespace fcn {
namespace {

constexpr double kAnywhere = 1e300;

/// `arm`, tangent to a face with unit normal `from`, in the plane with unit normal `to`.
Vec3 turned_arm(const Vec3& arm, const Vec3& from, const Vec3& to) {
    const double cosine = from.dot(to);
    // The shortest rotation leaves the angle to the planes' common line as it is; without one, arms
    // already lie in the plane, whichever side it shows.
    Vec3 turned = arm;
    if (cosine > -1 + 1e-9) turned -= (arm.dot(to) / (1 + cosine)) * (from + to);
    turned -= turned.dot(to) * to;
    const double length = turned.norm();
    return length > 0 ? Vec3(turned / length) : arm;
}

}  // namespace

std::optional<QuadField> quad_field(const QuadDomain& domain, const FieldDesign& design) {
    if (design.field.angles.size() != domain.mesh.n_faces()) return std::nullopt;
    QuadField result;
    result.arms = arm_directions(domain.mesh, design.field);
    for (const Singularity& singularity : design.singularities)
        result.singularities.push_back({singularity.vertex, singularity.index});
    std::vector<std::array<int, 2>> lines;
    for (const EdgeHandle edge : domain.mesh.edges()) {
        const auto e = static_cast<std::size_t>(edge.idx());
        if (e >= domain.edge_arc.size() || domain.edge_arc[e] < 0) continue;
        const HalfedgeHandle h = domain.mesh.halfedge_handle(edge, 0);
        lines.push_back(
            {domain.mesh.from_vertex_handle(h).idx(), domain.mesh.to_vertex_handle(h).idx()});
    }
    result.mesh.mesh = domain.mesh;
    result.mesh.curves = chain_vertex_pairs(lines);
    result.mesh.name = "field";
    return result;
}

std::vector<Vec3> arms_on_faces(const QuadField& field, const Mesh& mesh) {
    const ReferenceSurface surface(field.mesh.mesh);
    std::vector<Vec3> arms;
    arms.reserve(mesh.n_faces());
    int hint = -1;
    for (const FaceHandle face : mesh.faces()) {
        Vec3 centre = Vec3::Zero();
        for (const VertexHandle v : face_vertices(mesh, face)) centre += mesh.point(v) / 3;
        const Vec3 normal = face_normal(mesh, face);
        ReferencePoint near = surface.closest(centre, normal, kAnywhere, hint);
        if (near.face < 0) near = surface.closest(centre, Vec3::Zero(), kAnywhere, hint);
        hint = near.face;
        const Vec3& arm = field.arms[static_cast<std::size_t>(near.face)];
        arms.push_back(turned_arm(arm, surface.normal(near.face), normal));
    }
    return arms;
}

}  // namespace fcn
