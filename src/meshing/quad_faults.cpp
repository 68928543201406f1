// Distances between quads and the surface at samples of both, in chunks that do not depend on the
// number of threads.
#include "meshing/quad_faults.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fcn {
namespace {

constexpr std::size_t kMostPlaces = 2000;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Sample {
    Vec3 position;
    double distance;
};

void add_distances(const std::vector<Vec3>& points, const ReferenceSurface& surface,
                   std::vector<Sample>& samples) {
    const std::size_t begin = samples.size();
    for (const Vec3& p : points) samples.push_back({p, 0});
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        samples[begin + i].distance =
            surface.closest(points[i], Vec3::Zero(), std::numeric_limits<double>::max(), -1)
                .distance;
    });
}

std::vector<Vec3> points_of(const QuadMesh& mesh) {
    std::vector<Vec3> points = mesh.points;
    for (const auto& face : mesh.faces) {
        Vec3 centre = Vec3::Zero();
        for (const int v : face) centre += 0.25 * mesh.points[at(v)];
        points.push_back(centre);
    }
    return points;
}

ReferenceSurface surface_of(const QuadMesh& mesh,
                            const std::vector<std::array<int, 3>>& triangles) {
    std::vector<std::array<Vec3, 3>> corners;
    for (const auto& [a, b, c] : triangles)
        corners.push_back({mesh.points[at(a)], mesh.points[at(b)], mesh.points[at(c)]});
    return ReferenceSurface(corners);
}

}  // namespace

std::vector<Vec3> sample_points(const Mesh& mesh, double spacing) {
    std::vector<Vec3> points;
    for (const VertexHandle v : mesh.vertices()) points.push_back(mesh.point(v));
    for (const EdgeHandle edge : mesh.edges()) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const Vec3 &a = mesh.point(mesh.from_vertex_handle(h)),
                   &b = mesh.point(mesh.to_vertex_handle(h));
        const int pieces = static_cast<int>(std::min(1e4, std::ceil((b - a).norm() / spacing)));
        for (int i = 1; i < pieces; ++i)
            points.push_back(a + i / static_cast<double>(pieces) * (b - a));
    }
    return points;
}

QuadDistance find_far_places(const QuadMesh& mesh, const Mesh& input,
                             const ReferenceSurface& reference, double tolerance, double spacing) {
    std::vector<Sample> samples;
    add_distances(points_of(mesh), reference, samples);
    add_distances(sample_points(input, spacing), surface_of(mesh, cut_into_triangles(mesh)),
                  samples);
    QuadDistance result;
    std::erase_if(samples, [&](const Sample& sample) {
        result.largest = std::max(result.largest, sample.distance);
        return sample.distance <= tolerance;
    });
    std::stable_sort(samples.begin(), samples.end(),
                     [](const Sample& a, const Sample& b) { return a.distance > b.distance; });
    for (const Sample& sample : samples) {
        const bool is_apart =
            std::none_of(result.places.begin(), result.places.end(),
                         [&](const Vec3& p) { return (p - sample.position).norm() < spacing; });
        if (is_apart) result.places.push_back(sample.position);
        if (result.places.size() >= kMostPlaces) break;
    }
    return result;
}

std::vector<FarPoint> far_points(const QuadMesh& mesh, const std::vector<Vec3>& points,
                                 const ReferenceSurface& reference, double least) {
    constexpr double kAnywhere = std::numeric_limits<double>::max();
    const auto triangles = cut_into_triangles(mesh);
    const ReferenceSurface quads = surface_of(mesh, triangles);
    // Of each triangle the centre and the middles of the sides.
    constexpr std::size_t kPerTriangle = 4;
    std::vector<FarPoint> result(points.size() + kPerTriangle * triangles.size());
    tbb::parallel_for(std::size_t{0}, result.size(), [&](std::size_t i) {
        if (i < points.size()) {
            const ReferencePoint near = quads.closest(points[i], Vec3::Zero(), kAnywhere, -1);
            result[i] = {near.distance, points[i], near.face / 2};
            return;
        }
        const std::size_t t = (i - points.size()) / kPerTriangle;
        const std::size_t k = (i - points.size()) % kPerTriangle;
        const auto corner = [&](std::size_t c) { return mesh.points[at(triangles[t][c % 3])]; };
        const Vec3 p = k == 3 ? Vec3((corner(0) + corner(1) + corner(2)) / 3)
                              : Vec3((corner(k) + corner(k + 1)) / 2);
        const ReferencePoint near = reference.closest(p, Vec3::Zero(), kAnywhere, -1);
        result[i] = {near.distance, near.position, static_cast<int>(t / 2)};
    });
    std::erase_if(result, [&](const FarPoint& point) { return !(point.distance > least); });
    std::stable_sort(result.begin(), result.end(),
                     [](const FarPoint& a, const FarPoint& b) { return a.distance > b.distance; });
    return result;
}

}  // namespace fcn
