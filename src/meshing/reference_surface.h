#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// A point of the reference surface.
struct ReferencePoint {
    int face = -1;  ///< -1: none within reach
    Vec3 position = Vec3::Zero();
    double distance = 0;
};

/// The surface that remeshing projects to, for millions of queries from points whose sheet is
/// known: a tree of boxes over copies of the triangles, about 120 bytes a face. Queries are const
/// and thread-safe; ties go to the triangle met first, which the tree alone decides.
class ReferenceSurface {
public:
    explicit ReferenceSurface(const Mesh& mesh);
    /// Triangles by their corners; equal ones make a segment or a point.
    explicit ReferenceSurface(const std::vector<std::array<Vec3, 3>>& corners);

    /// Closest point within `reach` on faces whose unit normal m has m . normal > least_cosine
    /// (zero normal: on any face). `hint`, a face near the answer or -1, saves time and changes
    /// nothing but ties.
    ReferencePoint closest(const Vec3& point, const Vec3& normal, double reach, int hint,
                           double least_cosine = kSameSheet) const;

    /// Whether anything within `reach` has a unit normal m with m . normal > least_cosine.
    bool is_any_facing(const Vec3& point, const Vec3& normal, double reach,
                       double least_cosine) const;

    /// Unit; zero where degenerate.
    const Vec3& normal(int face) const { return normals_[slot(face)]; }
    int face_count() const { return static_cast<int>(slots_.size()); }

    /// About 101 degrees: beside a crease the normals of both of its sides are on one sheet.
    static constexpr double kSameSheet = -0.2;

private:
    struct Node {
        std::array<float, 3> low, high;
        int begin = 0;  ///< leaf: its first triangle; inner node: its second child
        int count = 0;  ///< 0: inner node, whose first child is the next node
    };
    struct Triangle {
        Vec3 a, ab, ac;
    };
    /// Around the normals of all triangles below a node.
    struct Cone {
        std::array<float, 3> axis{};
        float cosine = -1, sine = 0;  ///< of the half angle; a half turn holds every normal
    };
    struct Item;
    int build(std::vector<Item>& items, int begin, int end);
    std::size_t slot(int face) const {
        return static_cast<std::size_t>(slots_[static_cast<std::size_t>(face)]);
    }

    double add_cones(int index);

    std::vector<Node> nodes_;
    std::vector<Cone> cones_;          ///< of the nodes
    std::vector<Triangle> triangles_;  ///< in the order of the leaves
    std::vector<Vec3> normals_;        ///< the same
    std::vector<int> faces_;           ///< face of a triangle
    std::vector<int> slots_;           ///< triangle of a face
};

}  // namespace fcn
