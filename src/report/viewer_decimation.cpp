// Vertex clustering (Rossignac and Borrel 1993) with a quadric a cell that places its vertex, so
// that creases stay sharp (Lindstrom, Out-of-Core Simplification of Large Polygonal Models, 2000).
// Collapsing edges in order of their error looks slightly better and takes many times as long; for
// a picture in which a cell is about a pixel wide that is not worth waiting for.
#include "report/viewer_decimation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace fcn {
namespace {

constexpr int kMostRounds = 40;
/// Weight of the mean of a cell's vertices against its planes, which alone may not fix a point.
constexpr double kMeanWeight = 1e-3;

/// What is known of one cell: planes of the triangles at its vertices, and those vertices.
struct Cell {
    Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();  ///< sum of area^2 n n^T
    Vec3 offsets = Vec3::Zero();                        ///< sum of area^2 n (n . p)
    Vec3 sum = Vec3::Zero();
    int count = 0;
};

class Clustering {
public:
    Clustering(const TriangleArrays& mesh, double size) : mesh_(mesh), size_(size) {
        BoundingBox box{mesh.points.front(), mesh.points.front()};
        for (const Vec3& point : mesh.points) box.min = box.min.cwiseMin(point);
        corner_ = box.min;
        cell_of_.reserve(mesh.points.size());
        std::unordered_map<std::uint64_t, int> cells;
        cells.reserve(mesh.points.size() / 2);
        for (const Vec3& point : mesh.points) {
            std::uint64_t key = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double step = std::floor((point[axis] - corner_[axis]) / size_);
                key = key << 21 | (static_cast<std::uint64_t>(step) & 0x1fffff);
            }
            cell_of_.push_back(cells.emplace(key, static_cast<int>(cells.size())).first->second);
        }
        cell_count_ = cells.size();
    }

    bool is_whole(const std::array<int, 3>& triangle) const {
        const int a = cell(triangle[0]), b = cell(triangle[1]), c = cell(triangle[2]);
        return a != b && b != c && c != a;
    }

    std::size_t triangle_count() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(mesh_.triangles, [this](const auto& t) { return is_whole(t); }));
    }

    TriangleArrays result() const {
        TriangleArrays result;
        for (const Cell& known : cells()) result.points.push_back(place(known));
        for (const auto& triangle : mesh_.triangles)
            if (is_whole(triangle))
                result.triangles.push_back(
                    {cell(triangle[0]), cell(triangle[1]), cell(triangle[2])});
        return result;
    }

private:
    int cell(int vertex) const { return cell_of_[static_cast<std::size_t>(vertex)]; }

    std::vector<Cell> cells() const {
        std::vector<Cell> cells(cell_count_);
        for (std::size_t v = 0; v < cell_of_.size(); ++v) {
            Cell& known = cells[static_cast<std::size_t>(cell_of_[v])];
            known.sum += mesh_.points[v];
            ++known.count;
        }
        for (const auto& triangle : mesh_.triangles) {
            const auto at = [&](std::size_t k) -> const Vec3& {
                return mesh_.points[static_cast<std::size_t>(triangle[k])];
            };
            const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0));
            for (std::size_t k = 0; k < 3; ++k) {
                Cell& known = cells[static_cast<std::size_t>(cell(triangle[k]))];
                known.normals += normal * normal.transpose();
                known.offsets += normal * normal.dot(at(0) - known.sum / known.count);
            }
        }
        return cells;
    }

    /// The point nearest to all planes, relative to the mean; never far outside its cell.
    Vec3 place(const Cell& known) const {
        const Vec3 mean = known.sum / known.count;
        const double weight = known.normals.trace();
        if (!(weight > 0)) return mean;
        const Eigen::Matrix3d matrix =
            known.normals + kMeanWeight * weight * Eigen::Matrix3d::Identity();
        const Vec3 step = matrix.ldlt().solve(known.offsets);
        return step.allFinite() && step.norm() <= size_ ? Vec3(mean + step) : mean;
    }

    const TriangleArrays& mesh_;
    double size_;
    Vec3 corner_;
    std::vector<int> cell_of_;  ///< per vertex
    std::size_t cell_count_ = 0;
};

double area_of(const TriangleArrays& mesh) {
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3& p = mesh.points[static_cast<std::size_t>(a)];
        area += (mesh.points[static_cast<std::size_t>(b)] - p)
                    .cross(mesh.points[static_cast<std::size_t>(c)] - p)
                    .norm() /
                2;
    }
    return area;
}

/// Cells are keyed by 21 bits an axis.
double smallest_cell(const TriangleArrays& mesh) {
    BoundingBox box{mesh.points.front(), mesh.points.front()};
    for (const Vec3& point : mesh.points) {
        box.min = box.min.cwiseMin(point);
        box.max = box.max.cwiseMax(point);
    }
    return (box.max - box.min).maxCoeff() / 2e6;
}

}  // namespace

TriangleArrays triangle_arrays(const Mesh& mesh) {
    TriangleArrays arrays;
    for (const VertexHandle vertex : mesh.vertices()) arrays.points.push_back(mesh.point(vertex));
    for (const FaceHandle face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        arrays.triangles.push_back({a.idx(), b.idx(), c.idx()});
    }
    return arrays;
}

TriangleArrays decimate_for_display(const TriangleArrays& mesh, std::size_t face_limit) {
    if (mesh.triangles.size() <= face_limit) return mesh;
    if (face_limit == 0) return {};
    // A plane of area A has about 2 A / size^2 triangles; a curved surface meets more cells.
    double size = std::max(std::sqrt(2 * area_of(mesh) / static_cast<double>(face_limit)),
                           smallest_cell(mesh));
    for (int round = 0; round < kMostRounds && size > 0; ++round) {
        const Clustering clustering(mesh, size);
        const std::size_t count = clustering.triangle_count();
        if (count <= face_limit) return clustering.result();
        size *= 1.02 * std::sqrt(static_cast<double>(count) / static_cast<double>(face_limit));
    }
    return {};
}

}  // namespace fcn
