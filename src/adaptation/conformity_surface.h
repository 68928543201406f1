#pragma once

#include <array>
#include <vector>

#include "adaptation/conformity_boxes.h"
#include "geometry/mesh.h"

namespace fcn::conformity {

/// The mesh as flat arrays. Half-edge 3f + k runs from corner k to corner k + 1 of face f and is
/// opposite to corner k + 2.
struct FlatMesh {
    explicit FlatMesh(const Mesh& mesh);

    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> faces;
    std::vector<int> twins;           ///< half-edge -> half-edge; -1 at a boundary
    std::vector<int> corner_offsets;  ///< vertex -> range of corners
    std::vector<int> corners;         ///< corners (3f + k) around each vertex, ascending

    int face_count() const { return static_cast<int>(faces.size()); }
    int origin(int halfedge) const { return faces[halfedge / 3][halfedge % 3]; }
    static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
    int target(int halfedge) const { return origin(next(halfedge)); }
    int apex(int halfedge) const { return origin(previous(halfedge)); }
    Vec3 cross(int face) const;  ///< normal times twice the area
};

/// A point of the surface. At most one of vertex and halfedge is set: the point counts as lying on
/// it when it is within the tolerance of the projection.
struct Foot {
    int face = -1;
    int vertex = -1;
    int halfedge = -1;  ///< of `face`
    Vec3 position = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  ///< unit; zero if every face here is degenerate
};

/// Closest points and sections of a mesh.
class Surface {
public:
    explicit Surface(const Mesh& mesh);

    /// Closest surface point. The normal is that of the face; within `tolerance` (mesh units) of
    /// an edge the mean of its faces' unit normals, of a vertex their mean weighted by angle.
    Foot project(const Vec3& point, double tolerance) const;

    /// Length of a path on the surface from one foot to the other, an upper bound of their surface
    /// distance: the section with the plane that holds both and their mean normal. Infinite when
    /// the section does not connect them within `limit`.
    double section_length(const Foot& from, const Foot& to, double limit) const;

    const FlatMesh& mesh() const { return mesh_; }

private:
    double walk_section(const Foot& from, const Foot& to, const Vec3& plane_normal, int first_exit,
                        double limit) const;
    FlatMesh mesh_;
    BoxTree tree_;
};

/// Faces that hold the foot's position up to rounding (1e-9 of an edge), ascending: one, the two
/// at an edge, or all around a vertex.
std::vector<int> touching_faces(const FlatMesh& mesh, const Foot& foot);

/// Closest point of a triangle.
Vec3 closest_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace fcn::conformity
