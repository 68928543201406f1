// Quality of triangles and sampled distance between two surfaces.
//
// The distance follows METRO (Cignoni, Rocchini, Scopigno 1998): sample one surface, take each
// sample's distance to the other, and do the same the other way round. Where METRO scatters
// samples at random, ours lie on fixed grids (vertices, edge points, the centroids of the n^2
// equal sub-triangles of each face), so that the answer is the same on every run and thread count
// and the mean over the face samples is weighted by area exactly. A spacing of s finds the maximum
// up to an error of s: the distance function is 1-Lipschitz and no point of the surface is farther
// than s from a sample.
#include "meshing/measure.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/errors.h"
#include "meshing/reference_surface.h"

namespace fcn {
namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;
constexpr std::size_t kFacesPerChunk = 256;
constexpr double kMaxSamples = 1e9;

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

double smallest_angle(const std::array<Vec3, 3>& corner) {
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const Vec3 to_next = corner[(i + 1) % 3] - corner[i];
        const Vec3 to_last = corner[(i + 2) % 3] - corner[i];
        const bool is_collapsed = to_next.isZero(0) || to_last.isZero(0);
        smallest = std::min(smallest, is_collapsed ? 0.0 : angle_between(to_next, to_last));
    }
    return smallest;
}

std::array<Vec3, 3> corners(const Mesh& mesh, FaceHandle face) {
    const auto vertices = face_vertices(mesh, face);
    return {mesh.point(vertices[0]), mesh.point(vertices[1]), mesh.point(vertices[2])};
}

/// What a chunk of samples found.
struct Tally {
    double max = 0;
    double weighted_sum = 0;  ///< distance times area
    double squares = 0;       ///< of angles, times area
    double weight = 0;
    std::size_t samples = 0;
};

/// Number of pieces an edge of this length is cut into; kept the same for both faces of an edge.
int piece_count(double length, double spacing) {
    return std::max(1, static_cast<int>(std::ceil(length / spacing)));
}

/// The centroids of the n^2 equal parts of a triangle.
template <class Visit>
void for_centroids(const std::array<Vec3, 3>& corner, int n, const Visit& visit) {
    const auto at = [&](double u, double v) {
        visit(Vec3(corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0])));
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; i + j < n; ++j) {
            at((i + 1.0 / 3) / n, (j + 1.0 / 3) / n);
            if (i + j < n - 1) at((i + 2.0 / 3) / n, (j + 2.0 / 3) / n);
        }
    }
}

double distance_to(const ReferenceSurface& target, const Vec3& point) {
    return target.closest(point, Vec3::Zero(), std::numeric_limits<double>::max(), -1).distance;
}

void sample_face(const Mesh& mesh, FaceHandle face, double spacing, const ReferenceSurface& target,
                 Tally& tally) {
    const auto corner = corners(mesh, face);
    double longest = 0;
    for (int i = 0; i < 3; ++i)
        longest = std::max(longest, (corner[(i + 1) % 3] - corner[i]).norm());
    const int n = piece_count(longest, spacing);
    const double area = face_area(mesh, face);
    double sum = 0;
    for_centroids(corner, n, [&](const Vec3& point) {
        const double distance = distance_to(target, point);
        tally.max = std::max(tally.max, distance);
        sum += distance;
        ++tally.samples;
    });
    tally.weighted_sum += sum / (static_cast<double>(n) * n) * area;
    tally.weight += area;
}

void sample_edge(const Mesh& mesh, EdgeHandle edge, double spacing, const ReferenceSurface& target,
                 Tally& tally) {
    const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
    const Vec3& from = mesh.point(mesh.from_vertex_handle(halfedge));
    const Vec3& to = mesh.point(mesh.to_vertex_handle(halfedge));
    const int n = piece_count((to - from).norm(), spacing);
    for (int i = 1; i < n; ++i) {
        const Vec3 point = from + (static_cast<double>(i) / n) * (to - from);
        tally.max = std::max(tally.max, distance_to(target, point));
        ++tally.samples;
    }
}

void sample_vertex(const Mesh& mesh, VertexHandle vertex, const ReferenceSurface& target,
                   Tally& tally) {
    tally.max = std::max(tally.max, distance_to(target, mesh.point(vertex)));
    ++tally.samples;
}

/// Runs visit(index, tally) over [0, count) in chunks of fixed size; the chunks are added up in
/// their order, so the sums do not depend on the schedule.
template <class Visit>
Tally tally_chunks(std::size_t count, const Visit& visit) {
    std::vector<Tally> chunks((count + kFacesPerChunk - 1) / kFacesPerChunk);
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t chunk) {
        const std::size_t end = std::min(count, (chunk + 1) * kFacesPerChunk);
        for (std::size_t i = chunk * kFacesPerChunk; i < end; ++i) visit(i, chunks[chunk]);
    });
    Tally total;
    for (const Tally& chunk : chunks) {
        total.max = std::max(total.max, chunk.max);
        total.weighted_sum += chunk.weighted_sum;
        total.squares += chunk.squares;
        total.weight += chunk.weight;
        total.samples += chunk.samples;
    }
    return total;
}

Tally one_sided(const Mesh& mesh, const ReferenceSurface& target, double spacing) {
    Tally total = tally_chunks(mesh.n_faces(), [&](std::size_t i, Tally& tally) {
        sample_face(mesh, FaceHandle(static_cast<int>(i)), spacing, target, tally);
    });
    const Tally edges = tally_chunks(mesh.n_edges(), [&](std::size_t i, Tally& tally) {
        sample_edge(mesh, EdgeHandle(static_cast<int>(i)), spacing, target, tally);
    });
    const Tally vertices = tally_chunks(mesh.n_vertices(), [&](std::size_t i, Tally& tally) {
        sample_vertex(mesh, VertexHandle(static_cast<int>(i)), target, tally);
    });
    total.max = std::max({total.max, edges.max, vertices.max});
    total.samples += edges.samples + vertices.samples;
    return total;
}

/// As a floating-point number: a spacing far too small must not overflow.
double expected_samples(const Mesh& mesh, double spacing) {
    double samples = 0;
    for (const FaceHandle face : mesh.faces()) {
        const auto corner = corners(mesh, face);
        double longest = 0;
        for (int i = 0; i < 3; ++i)
            longest = std::max(longest, (corner[(i + 1) % 3] - corner[i]).norm());
        const double pieces = std::max(1.0, std::ceil(longest / spacing));
        samples += pieces * pieces;
    }
    return samples;
}

void check_distance_input(const Mesh& mesh, const Mesh& reference, double spacing) {
    if (mesh.n_faces() == 0 || reference.n_faces() == 0)
        throw InputError("measure: a mesh without faces has no distance to another");
    if (!(spacing > 0) || !std::isfinite(spacing))
        throw InputError("measure: sample spacing must be > 0, it is " + std::to_string(spacing));
    const double samples = expected_samples(mesh, spacing) + expected_samples(reference, spacing);
    if (!(samples <= kMaxSamples))
        throw InputError("measure: sample spacing " + std::to_string(spacing) + " asks for " +
                         std::to_string(samples) + " samples");
}

double radius_ratio(const std::array<Vec3, 3>& corner) {
    const double a = (corner[1] - corner[0]).norm(), b = (corner[2] - corner[1]).norm(),
                 c = (corner[0] - corner[2]).norm();
    const double product = a * b * c;
    if (!(product > 0)) return 0;
    // 2 r / R with r = 2 A / (a + b + c), R = a b c / (4 A).
    const double twice_area = (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
    return std::min(1.0, 4 * twice_area * twice_area / ((a + b + c) * product));
}

void measure_valences(const Mesh& mesh, TriangleQuality& quality) {
    std::size_t inner = 0, regular = 0;
    bool is_first = true;
    for (const VertexHandle vertex : mesh.vertices()) {
        const int valence = static_cast<int>(mesh.valence(vertex));
        quality.min_valence = is_first ? valence : std::min(quality.min_valence, valence);
        quality.max_valence = std::max(quality.max_valence, valence);
        is_first = false;
        if (mesh.is_boundary(vertex)) continue;
        ++inner;
        regular += valence == 6;
    }
    if (inner > 0)
        quality.share_regular = static_cast<double>(regular) / static_cast<double>(inner);
}

}  // namespace

TriangleQuality measure_triangles(const Mesh& mesh) {
    TriangleQuality quality;
    quality.vertices = mesh.n_vertices();
    quality.faces = mesh.n_faces();
    if (quality.faces == 0) return quality;

    double min_angle = std::numeric_limits<double>::infinity(), angle_sum = 0;
    double min_ratio = 1, ratio_sum = 0;
    std::size_t under_15 = 0, under_30 = 0;
    for (const FaceHandle face : mesh.faces()) {
        const double angle = smallest_angle(corners(mesh, face)) * kDegreesPerRadian;
        min_angle = std::min(min_angle, angle);
        angle_sum += angle;
        under_15 += angle < 15;
        under_30 += angle < 30;
        const double ratio = radius_ratio(corners(mesh, face));
        min_ratio = std::min(min_ratio, ratio);
        ratio_sum += ratio;
    }
    const double count = static_cast<double>(quality.faces);
    quality.min_angle_degrees = min_angle;
    quality.mean_min_angle_degrees = angle_sum / count;
    quality.min_radius_ratio = min_ratio;
    quality.mean_radius_ratio = ratio_sum / count;
    quality.share_under_15 = static_cast<double>(under_15) / count;
    quality.share_under_30 = static_cast<double>(under_30) / count;

    double min_edge = std::numeric_limits<double>::infinity(), edge_sum = 0;
    for (const EdgeHandle edge : mesh.edges()) {
        const double length = mesh.calc_edge_length(edge);
        min_edge = std::min(min_edge, length);
        quality.max_edge = std::max(quality.max_edge, length);
        edge_sum += length;
    }
    quality.min_edge = min_edge;
    quality.mean_edge = edge_sum / static_cast<double>(mesh.n_edges());
    measure_valences(mesh, quality);
    return quality;
}

EdgeShares measure_edges(const Mesh& mesh, double shortest, double longest) {
    EdgeShares shares;
    if (mesh.n_edges() == 0) return shares;
    const double slack = 1e-6 * (longest - shortest);
    for (const EdgeHandle edge : mesh.edges()) {
        const double length = mesh.calc_edge_length(edge);
        double& share = length < shortest - slack  ? shares.below
                        : length > longest + slack ? shares.above
                                                   : shares.inside;
        share += 1.0 / static_cast<double>(mesh.n_edges());
    }
    return shares;
}

NormalDeviation measure_normals(const Mesh& mesh, const Mesh& reference, double sample_spacing) {
    check_distance_input(mesh, reference, sample_spacing);
    return measure_normals(mesh, reference, ReferenceSurface(reference), sample_spacing);
}

NormalDeviation measure_normals(const Mesh& mesh, const Mesh& reference,
                                const ReferenceSurface& target, double sample_spacing) {
    check_distance_input(mesh, reference, sample_spacing);
    const auto sample = [&](std::size_t i, Tally& tally) {
        const FaceHandle face(static_cast<int>(i));
        const auto corner = corners(mesh, face);
        const Vec3 normal = face_normal(mesh, face);
        double longest = 0;
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, (corner[(k + 1) % 3] - corner[k]).norm());
        const int n = piece_count(longest, sample_spacing);
        const double weight = face_area(mesh, face) / (static_cast<double>(n) * n);
        for_centroids(corner, n, [&](const Vec3& point) {
            const ReferencePoint near =
                target.closest(point, Vec3::Zero(), std::numeric_limits<double>::max(), -1);
            const double angle =
                angle_between(normal, target.normal(near.face)) * kDegreesPerRadian;
            tally.weighted_sum += weight * angle;
            tally.squares += weight * angle * angle;
            tally.weight += weight;
        });
    };
    const Tally total = tally_chunks(mesh.n_faces(), sample);
    NormalDeviation deviation;
    if (!(total.weight > 0)) return deviation;
    deviation.mean_degrees = total.weighted_sum / total.weight;
    deviation.rms_degrees = std::sqrt(total.squares / total.weight);
    return deviation;
}

MeshDistance measure_distance(const Mesh& mesh, const Mesh& reference, double sample_spacing) {
    check_distance_input(mesh, reference, sample_spacing);
    return measure_distance(mesh, reference, ReferenceSurface(reference), sample_spacing);
}

MeshDistance measure_distance(const Mesh& mesh, const Mesh& reference,
                              const ReferenceSurface& reference_queries, double sample_spacing) {
    check_distance_input(mesh, reference, sample_spacing);
    const ReferenceSurface mesh_queries(mesh);
    const Tally forward = one_sided(mesh, reference_queries, sample_spacing);
    const Tally backward = one_sided(reference, mesh_queries, sample_spacing);

    MeshDistance distance;
    distance.forward = forward.max;
    distance.backward = backward.max;
    distance.hausdorff = std::max(forward.max, backward.max);
    distance.mean_forward = forward.weight > 0 ? forward.weighted_sum / forward.weight : 0;
    distance.mean_backward = backward.weight > 0 ? backward.weighted_sum / backward.weight : 0;
    distance.samples = forward.samples + backward.samples;
    distance.diagonal = bounding_box(reference).diagonal();
    return distance;
}

}  // namespace fcn
