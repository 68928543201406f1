// One face of the embedding: a constrained Delaunay triangulation (CGAL) of the points that curves
// put on and into it, with the curves' pieces as constraints. Crossings become points of their own.
// Points on a side may bulge in or out by rounding, so the face is what the boundary constraints
// enclose, not the convex hull.
#include "meshing/face_subdivision.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <deque>
#include <set>

namespace fcn {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Index of a vertex in the subdivision.
struct Number {
    int value = -1;
};

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Number, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Storage = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Storage, CGAL::Exact_predicates_tag>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<Delaunay>;
using Point = Kernel::Point_2;

class Subdivider {
public:
    explicit Subdivider(const FaceSubdivisionInput& input) : input_(input) {}

    FaceSubdivision run() {
        if (!insert_points()) return {};
        for (int i = 0; i < input_.boundary_count; ++i) {
            const int next = (i + 1) % input_.boundary_count;
            sides_.push_back(triangulation_.insert_constraint(
                vertices_[static_cast<std::size_t>(i)], vertices_[static_cast<std::size_t>(next)]));
        }
        std::vector<Triangulation::Constraint_id> lines;
        for (const auto& [a, b] : input_.lines)
            lines.push_back(triangulation_.insert_constraint(
                vertices_[static_cast<std::size_t>(a)], vertices_[static_cast<std::size_t>(b)]));
        number_crossings();
        for (const auto& side : sides_)
            if (path(side).size() != 2) return {};  // a line cut a side: rounding went too far
        for (const auto& line : lines) result_.paths.push_back(path(line));
        collect_triangles();
        return std::move(result_);
    }

private:
    /// False if two points coincide: the caller must have merged them.
    bool insert_points() {
        for (std::size_t i = 0; i < input_.points.size(); ++i) {
            const auto vertex =
                triangulation_.insert(Point(input_.points[i][0], input_.points[i][1]));
            if (vertex->info().value >= 0) return false;
            vertex->info().value = static_cast<int>(i);
            vertices_.push_back(vertex);
        }
        return true;
    }

    void number_crossings() {
        int next = static_cast<int>(input_.points.size());
        for (const auto vertex : triangulation_.finite_vertex_handles()) {
            if (vertex->info().value >= 0) continue;
            vertex->info().value = next++;
            result_.added.emplace_back(vertex->point().x(), vertex->point().y());
        }
    }

    std::vector<int> path(const Triangulation::Constraint_id& line) const {
        std::vector<int> points;
        for (auto it = triangulation_.vertices_in_constraint_begin(line);
             it != triangulation_.vertices_in_constraint_end(line); ++it)
            points.push_back((*it)->info().value);
        return points;
    }

    /// Everything but what can be reached from outside without crossing a side.
    void collect_triangles() {
        std::set<std::pair<int, int>> is_side;
        for (int i = 0; i < input_.boundary_count; ++i)
            is_side.insert(std::minmax({i, (i + 1) % input_.boundary_count}));
        std::set<Triangulation::Face_handle> outside{triangulation_.infinite_face()};
        std::deque<Triangulation::Face_handle> queue{triangulation_.infinite_face()};
        while (!queue.empty()) {
            const auto face = queue.front();
            queue.pop_front();
            for (int i = 0; i < 3; ++i) {
                const auto a = face->vertex(Triangulation::ccw(i));
                const auto b = face->vertex(Triangulation::cw(i));
                const bool is_finite =
                    !triangulation_.is_infinite(a) && !triangulation_.is_infinite(b);
                if (is_finite && is_side.count(std::minmax({a->info().value, b->info().value})))
                    continue;
                if (outside.insert(face->neighbor(i)).second) queue.push_back(face->neighbor(i));
            }
        }
        for (const auto face : triangulation_.finite_face_handles()) {
            if (outside.count(face)) continue;
            std::array<int, 3> triangle{};
            for (int i = 0; i < 3; ++i)
                triangle[static_cast<std::size_t>(i)] = face->vertex(i)->info().value;
            std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                        triangle.end());
            result_.triangles.push_back(triangle);
        }
        std::sort(result_.triangles.begin(), result_.triangles.end());
        // Euler: a triangulated polygon with b boundary and k inner points has b + 2k - 2 faces.
        const std::size_t boundary = static_cast<std::size_t>(input_.boundary_count);
        const std::size_t inner = input_.points.size() + result_.added.size() - boundary;
        result_.is_valid = result_.triangles.size() + 2 == boundary + 2 * inner;
    }

    const FaceSubdivisionInput& input_;
    Triangulation triangulation_;
    std::vector<Triangulation::Vertex_handle> vertices_;
    std::vector<Triangulation::Constraint_id> sides_;
    FaceSubdivision result_;
};

}  // namespace

FaceSubdivision subdivide_face(const FaceSubdivisionInput& input) {
    return Subdivider(input).run();
}

}  // namespace fcn
