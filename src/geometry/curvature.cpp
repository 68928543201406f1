// Shape operator of a piecewise flat surface, averaged over a region B around each vertex
// (Alliez, Cohen-Steiner, Devillers, Levy, Desbrun: Anisotropic Polygonal Remeshing, 2003, sec. 2):
//
//     T(v) = 1/|B| * sum over edges e of  beta(e) |e in B| e e^T / |e|^2,
//
// beta the signed dihedral angle. T is projected to the plane of B's mean normal; the curvature of
// each eigenvalue belongs to the direction of the other eigenvector.
//
// Every edge is charged half to each of its faces, so that B is a set of faces: the one-ring, or
// what a breadth-first walk from the vertex reaches inside the ball. Unlike in the paper, faces
// that the sphere cuts count with the exact area of their part inside (a face's plane meets the
// ball in a disc), and the walk does not jump to sheets that are near but not connected inside the
// ball.
//
// The walk costs time in proportion to the faces in the ball. Where that is more than
// kMostFacesPerBall on average, faces are first gathered into connected patches of a sixteenth of
// the radius across, and the walk goes over patches; a patch that the sphere cuts counts with the
// share of its extent that is inside. This blurs the ball's border by that size and bounds the
// cost per vertex by a constant.

#include "geometry/curvature.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/errors.h"

namespace fcn {

namespace {

constexpr double kMostFacesPerBall = 1000;
constexpr double kPatchRadius = 1.0 / 16;

using Tensor = Eigen::Matrix3d;

/// Sums over a part of the surface.
struct Region {
    Tensor tensor = Tensor::Zero();
    Vec3 area_vector = Vec3::Zero();
    double area = 0;

    void add(const Region& other, double share = 1.0) {
        tensor += share * other.tensor;
        area_vector += share * other.area_vector;
        area += share * other.area;
    }
};

/// The mesh in flat arrays, each face with its share of the integral.
struct FaceArrays {
    std::vector<std::array<int, 3>> corners;
    std::vector<std::array<int, 3>> neighbours;  ///< across the edge that starts at that corner
    std::vector<std::array<double, 3>> bends;    ///< dihedral angle of that edge
    std::vector<Region> regions;

    explicit FaceArrays(const Mesh& mesh) {
        const std::size_t count = mesh.n_faces();
        corners.resize(count);
        neighbours.resize(count);
        bends.resize(count);
        regions.resize(count);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
            for (std::size_t face = range.begin(); face < range.end(); ++face) fill(mesh, face);
        });
    }

private:
    void fill(const Mesh& mesh, std::size_t face) {
        HalfedgeHandle halfedge = mesh.halfedge_handle(FaceHandle(static_cast<int>(face)));
        Region& region = regions[face];
        for (int i = 0; i < 3; ++i) {
            corners[face][i] = mesh.from_vertex_handle(halfedge).idx();
            neighbours[face][i] = mesh.face_handle(mesh.opposite_halfedge_handle(halfedge)).idx();
            bends[face][i] = dihedral_angle(mesh, mesh.edge_handle(halfedge));
            const Vec3 edge = mesh.point(mesh.to_vertex_handle(halfedge)) -
                              mesh.point(mesh.from_vertex_handle(halfedge));
            const double length = edge.norm();
            if (length > 0)
                region.tensor += 0.5 * bends[face][i] / length * edge * edge.transpose();
            halfedge = mesh.next_halfedge_handle(halfedge);
        }
        const FaceHandle handle(static_cast<int>(face));
        region.area = face_area(mesh, handle);
        region.area_vector = region.area * face_normal(mesh, handle);
    }
};

/// Length of the part of a segment inside a sphere.
double length_inside(const Vec3& from, const Vec3& to, const Vec3& centre, double radius) {
    const Vec3 run = to - from;
    const double length = run.norm();
    if (length == 0) return 0;
    const double foot = (centre - from).dot(run) / length;
    const double squared_height = (from + run * (foot / length) - centre).squaredNorm();
    const double half_chord = radius * radius - squared_height;
    if (half_chord <= 0) return 0;
    const double half = std::sqrt(half_chord);
    return std::max(0.0, std::min(length, foot + half) - std::max(0.0, foot - half));
}

/// Signed area of the intersection of a disc about the origin with the triangle (origin, a, b).
double sector_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius) {
    const auto wedge = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
        return 0.5 * radius * radius * std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
    };
    const auto triangle = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
        return 0.5 * (p.x() * q.y() - p.y() * q.x());
    };
    const Eigen::Vector2d run = b - a;
    const double squared_length = run.squaredNorm();
    if (squared_length == 0) return 0;
    const double foot = -a.dot(run) / squared_length;
    const double discriminant = foot * foot - (a.squaredNorm() - radius * radius) / squared_length;
    if (discriminant <= 0) return wedge(a, b);
    const double root = std::sqrt(discriminant);
    const double enter = std::clamp(foot - root, 0.0, 1.0);
    const double leave = std::clamp(foot + root, 0.0, 1.0);
    if (enter >= leave) return wedge(a, b);
    const Eigen::Vector2d first = a + enter * run;
    const Eigen::Vector2d last = a + leave * run;
    double area = triangle(first, last);
    if (enter > 0) area += wedge(a, first);
    if (leave < 1) area += wedge(last, b);
    return area;
}

/// Area of the part of a triangle inside a sphere.
double area_inside(const std::array<Vec3, 3>& corner, const Vec3& normal, const Vec3& centre,
                   double radius) {
    const double height = normal.dot(centre - corner[0]);
    const double squared_disc = radius * radius - height * height;
    if (squared_disc <= 0) return 0;
    const Vec3 middle = centre - height * normal;
    const Vec3 u = (corner[1] - corner[0]).normalized();
    const Vec3 v = normal.cross(u);
    std::array<Eigen::Vector2d, 3> flat;
    for (int i = 0; i < 3; ++i) {
        flat[i] = {u.dot(corner[i] - middle), v.dot(corner[i] - middle)};
    }
    double area = 0;
    for (int i = 0; i < 3; ++i) {
        area += sector_area(flat[i], flat[(i + 1) % 3], std::sqrt(squared_disc));
    }
    return std::max(0.0, area);
}

/// A breadth-first walk that can be started again without clearing its marks.
struct Walk {
    std::vector<int> mark;
    std::vector<int> queue;
    int round = 0;

    void restart(std::size_t size) {
        mark.resize(size, 0);
        queue.clear();
        ++round;
    }
    void visit(int item) {
        if (item < 0 || mark[item] == round) return;
        mark[item] = round;
        queue.push_back(item);
    }
};

class BallSums {
public:
    BallSums(const Mesh& mesh, const FaceArrays& faces, double radius)
        : mesh_(mesh), faces_(faces), radius_(radius) {}

    Region around(VertexHandle vertex, Walk& walk) const {
        Region sum;
        const Vec3& centre = mesh_.point(vertex);
        walk.restart(faces_.corners.size());
        for (const auto face : mesh_.vf_range(vertex)) walk.visit(face.idx());
        for (std::size_t head = 0; head < walk.queue.size(); ++head) {
            add_face(static_cast<std::size_t>(walk.queue[head]), centre, sum, walk);
        }
        return sum;
    }

private:
    void add_face(std::size_t face, const Vec3& centre, Region& sum, Walk& walk) const {
        const auto corners = points(face);
        int inside_count = 0;
        for (const Vec3& corner : corners) {
            inside_count += (corner - centre).squaredNorm() <= radius_ * radius_ ? 1 : 0;
        }
        if (inside_count == 3) {
            sum.add(faces_.regions[face]);
            for (int neighbour : faces_.neighbours[face]) walk.visit(neighbour);
            return;
        }
        for (int i = 0; i < 3; ++i) {
            const double inside = length_inside(corners[i], corners[(i + 1) % 3], centre, radius_);
            if (inside <= 0) continue;
            walk.visit(faces_.neighbours[face][i]);
            const Vec3 direction = (corners[(i + 1) % 3] - corners[i]).normalized();
            sum.tensor += 0.5 * faces_.bends[face][i] * inside * direction * direction.transpose();
        }
        const Region& whole = faces_.regions[face];
        if (whole.area <= 0) return;
        const Vec3 normal = whole.area_vector / whole.area;
        const double area = std::min(whole.area, area_inside(corners, normal, centre, radius_));
        sum.area += area;
        sum.area_vector += area * normal;
    }

    std::array<Vec3, 3> points(std::size_t face) const {
        const auto& index = faces_.corners[face];
        return {mesh_.point(VertexHandle(index[0])), mesh_.point(VertexHandle(index[1])),
                mesh_.point(VertexHandle(index[2]))};
    }

    const Mesh& mesh_;
    const FaceArrays& faces_;
    double radius_;
};

/// Connected groups of faces about one size, and balls made of them.
class PatchSums {
public:
    PatchSums(const Mesh& mesh, const FaceArrays& faces, double radius)
        : mesh_(mesh), faces_(faces), radius_(radius) {
        gather_patches();
        connect_patches();
    }

    Region around(VertexHandle vertex, Walk& walk) const {
        Region sum;
        const Vec3& centre = mesh_.point(vertex);
        walk.restart(patches_.size());
        for (const auto face : mesh_.vf_range(vertex)) walk.visit(patch_of_[face.idx()]);
        for (std::size_t head = 0; head < walk.queue.size(); ++head) {
            const int index = walk.queue[head];
            const Patch& patch = patches_[index];
            const double distance = (patch.middle - centre).norm();
            const double share =
                std::clamp((radius_ - distance + patch.extent) / (2 * patch.extent), 0.0, 1.0);
            if (share <= 0) continue;
            sum.add(patch.region, share);
            for (int k = first_neighbour_[index]; k < first_neighbour_[index + 1]; ++k) {
                walk.visit(neighbours_[k]);
            }
        }
        return sum;
    }

private:
    struct Patch {
        Region region;
        Vec3 middle = Vec3::Zero();
        double extent = 0;
    };

    Vec3 middle_of(int face) const {
        const auto& index = faces_.corners[face];
        return (mesh_.point(VertexHandle(index[0])) + mesh_.point(VertexHandle(index[1])) +
                mesh_.point(VertexHandle(index[2]))) /
               3;
    }

    void gather_patches() {
        const double reach = kPatchRadius * radius_;
        patch_of_.assign(faces_.corners.size(), -1);
        std::vector<int> queue;
        for (std::size_t seed = 0; seed < patch_of_.size(); ++seed) {
            if (patch_of_[seed] >= 0) continue;
            const int index = static_cast<int>(patches_.size());
            const Vec3 start = middle_of(static_cast<int>(seed));
            Patch patch;
            queue.assign(1, static_cast<int>(seed));
            patch_of_[seed] = index;
            for (std::size_t head = 0; head < queue.size(); ++head) {
                const Region& region = faces_.regions[queue[head]];
                patch.region.add(region);
                patch.middle += region.area * middle_of(queue[head]);
                for (int next : faces_.neighbours[queue[head]]) {
                    if (next < 0 || patch_of_[next] >= 0) continue;
                    if ((middle_of(next) - start).norm() > reach) continue;
                    patch_of_[next] = index;
                    queue.push_back(next);
                }
            }
            patch.middle = patch.region.area > 0 ? Vec3(patch.middle / patch.region.area) : start;
            for (int face : queue) {
                for (int corner : faces_.corners[face]) {
                    patch.extent = std::max(
                        patch.extent, (mesh_.point(VertexHandle(corner)) - patch.middle).norm());
                }
            }
            patches_.push_back(patch);
        }
    }

    void connect_patches() {
        std::vector<std::pair<int, int>> pairs;
        for (std::size_t face = 0; face < patch_of_.size(); ++face) {
            for (int next : faces_.neighbours[face]) {
                if (next >= 0 && patch_of_[next] != patch_of_[face]) {
                    pairs.emplace_back(patch_of_[face], patch_of_[next]);
                }
            }
        }
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        first_neighbour_.assign(patches_.size() + 1, 0);
        for (const auto& [patch, neighbour] : pairs) {
            ++first_neighbour_[patch + 1];
            neighbours_.push_back(neighbour);
        }
        for (std::size_t i = 1; i < first_neighbour_.size(); ++i) {
            first_neighbour_[i] += first_neighbour_[i - 1];
        }
    }

    const Mesh& mesh_;
    const FaceArrays& faces_;
    double radius_;
    std::vector<Patch> patches_;
    std::vector<int> patch_of_;
    std::vector<int> first_neighbour_, neighbours_;
};

Region one_ring(const Mesh& mesh, const FaceArrays& faces, VertexHandle vertex) {
    Region sum;
    for (const auto face : mesh.vf_range(vertex)) sum.add(faces.regions[face.idx()]);
    return sum;
}

/// Any unit vector across `normal`, the same for the same normal.
Vec3 some_tangent(const Vec3& normal) {
    int smallest = 0;
    normal.cwiseAbs().minCoeff(&smallest);
    return normal.cross(Vec3::Unit(smallest)).normalized();
}

void decompose(const Region& region, const Vec3& vertex_normal, int vertex,
               PrincipalCurvatures& result) {
    Vec3 normal = region.area_vector;
    // A ball that wraps around a thin part has no mean normal.
    if (normal.norm() < 1e-3 * region.area) normal = vertex_normal;
    normal = normal.norm() > 0 ? Vec3(normal.normalized()) : Vec3(Vec3::UnitZ());
    const Vec3 u = some_tangent(normal);
    const Vec3 v = normal.cross(u);
    double uu = 0;
    double uv = 0;
    double vv = 0;
    if (region.area > 0) {
        uu = u.dot(region.tensor * u) / region.area;
        uv = u.dot(region.tensor * v) / region.area;
        vv = v.dot(region.tensor * v) / region.area;
    }
    const double mean = 0.5 * (uu + vv);
    const double spread = std::hypot(0.5 * (uu - vv), uv);
    // Direction of the larger eigenvalue, mean + spread.
    const double angle = 0.5 * std::atan2(uv, 0.5 * (uu - vv));
    const Vec3 of_larger = std::cos(angle) * u + std::sin(angle) * v;
    const Vec3 of_smaller = normal.cross(of_larger);
    const bool is_larger_dominant = std::abs(mean + spread) >= std::abs(mean - spread);
    result.kappa_max[vertex] = is_larger_dominant ? mean + spread : mean - spread;
    result.kappa_min[vertex] = is_larger_dominant ? mean - spread : mean + spread;
    result.direction_max[vertex] = is_larger_dominant ? of_smaller : of_larger;
    result.direction_min[vertex] = is_larger_dominant ? of_larger : of_smaller;
}

template <typename Sum>
void for_each_vertex(const Mesh& mesh, const FaceArrays& faces, PrincipalCurvatures& result,
                     const Sum& sum) {
    tbb::enumerable_thread_specific<Walk> walks;
    tbb::parallel_for(tbb::blocked_range<int>(0, static_cast<int>(mesh.n_vertices()), 256),
                      [&](const tbb::blocked_range<int>& range) {
                          Walk& walk = walks.local();
                          for (int vertex = range.begin(); vertex < range.end(); ++vertex) {
                              const VertexHandle handle(vertex);
                              decompose(sum(handle, walk),
                                        one_ring(mesh, faces, handle).area_vector, vertex, result);
                          }
                      });
}

void compute(const Mesh& mesh, double radius, PrincipalCurvatures& result) {
    const FaceArrays faces(mesh);
    if (radius == 0) {
        for_each_vertex(mesh, faces, result,
                        [&](VertexHandle vertex, Walk&) { return one_ring(mesh, faces, vertex); });
        return;
    }
    double area = 0;
    for (const Region& region : faces.regions) area += region.area;
    const double ball_area = std::min(std::numbers::pi * radius * radius, area);
    const double faces_per_ball = ball_area / area * static_cast<double>(mesh.n_faces());
    if (faces_per_ball <= kMostFacesPerBall) {
        const BallSums sums(mesh, faces, radius);
        for_each_vertex(mesh, faces, result,
                        [&](VertexHandle vertex, Walk& walk) { return sums.around(vertex, walk); });
    } else {
        const PatchSums sums(mesh, faces, radius);
        for_each_vertex(mesh, faces, result,
                        [&](VertexHandle vertex, Walk& walk) { return sums.around(vertex, walk); });
    }
}

}  // namespace

PrincipalCurvatures principal_curvatures(const Mesh& mesh, const CurvatureOptions& options) {
    if (!(options.radius >= 0) || !std::isfinite(options.radius)) {
        throw InputError("curvature radius must be finite and not negative");
    }
    PrincipalCurvatures result;
    const std::size_t count = mesh.n_vertices();
    result.kappa_max.resize(count);
    result.kappa_min.resize(count);
    result.direction_max.resize(count, Vec3::Zero());
    result.direction_min.resize(count, Vec3::Zero());
    if (mesh.n_faces() == 0) return result;
    // More threads than there are would make TBB print a warning.
    const int available = tbb::this_task_arena::max_concurrency();
    tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, available) : available);
    arena.execute([&] { compute(mesh, options.radius, result); });
    return result;
}

}  // namespace fcn
