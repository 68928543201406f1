#pragma once

// OpenMesh's Eigen adapter specialises a template that the first header declares: keep this order.
// clang-format off
#include <OpenMesh/Core/Utils/vector_traits.hh>
#include <OpenMesh/Core/Geometry/EigenVectorT.hh>
// clang-format on
#include <Eigen/Core>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fcn {

using Vec3 = Eigen::Vector3d;

struct MeshTraits : OpenMesh::DefaultTraits {
    using Point = Vec3;
    using Normal = Vec3;
    using TexCoord2D = Eigen::Vector2d;
    VertexAttributes(OpenMesh::Attributes::None);
    FaceAttributes(OpenMesh::Attributes::None);
    EdgeAttributes(OpenMesh::Attributes::None);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
};

/// The one mesh type: oriented 2-manifold triangle mesh, possibly open, of several components.
using Mesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;

using VertexHandle = OpenMesh::VertexHandle;
using HalfedgeHandle = OpenMesh::HalfedgeHandle;
using EdgeHandle = OpenMesh::EdgeHandle;
using FaceHandle = OpenMesh::FaceHandle;

/// A point on a mesh surface. Barycentric coordinates refer to the face's vertices in the order
/// of face_vertices(); they are >= 0 and sum to 1.
struct SurfacePoint {
    int face = -1;
    Vec3 barycentric = Vec3::Zero();
};

/// Vertices of a face, counter-clockwise, starting at halfedge_handle(face)'s origin.
std::array<VertexHandle, 3> face_vertices(const Mesh& mesh, FaceHandle face);

Vec3 position(const Mesh& mesh, const SurfacePoint& point);

/// Area-weighted, unit length; zero vector for a degenerate face.
Vec3 face_normal(const Mesh& mesh, FaceHandle face);
double face_area(const Mesh& mesh, FaceHandle face);

struct BoundingBox {
    Vec3 min = Vec3::Zero();
    Vec3 max = Vec3::Zero();
    double diagonal() const { return (max - min).norm(); }
};
BoundingBox bounding_box(const Mesh& mesh);

/// Signed dihedral angle deviation at an edge in radians, (-pi, pi): 0 flat, > 0 convex,
/// < 0 concave; 0 at a boundary edge.
double dihedral_angle(const Mesh& mesh, EdgeHandle edge);

}  // namespace fcn
