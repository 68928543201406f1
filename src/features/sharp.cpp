// Sharp edges by hysteresis on the dihedral angle: an edge above the high angle seeds a chain,
// edges above the low angle that share a vertex with it continue it (the two thresholds of Canny's
// edge detector, on mesh edges).
//
// The plain dihedral takes noise for features: on a plane whose vertices are displaced by a fifth
// of the edge length a quarter of all edges exceed 18 degrees. So the angle is measured at two
// scales where the surroundings are noisy. A noisy place is one where the faces around disagree
// with *all but one* of their neighbours: the middle one of a face's three dihedrals is small on
// any clean surface, beside a crease as well, and its median over some thirty faces is the local
// noise level. There the edge counts only as far as the area-weighted mean normals of the areas
// left and right of it (radius 2.5 edges) enclose the angle, too: an integral of normals over an
// area depends on the area's border alone, so noise of single vertices fades fast, while a crease
// keeps its angle. Clean places keep the plain dihedral, hence exact creases between narrow strips.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "features/edge_chains.h"
#include "features/sharp_edges.h"
#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr double kNoisyAngle = 4 * std::numbers::pi / 180;  // median of the middle dihedral
constexpr int kNoiseFaceCount = 32;                         // faces in that median
constexpr double kWideRadius = 2.5;                         // of the wide dihedral, in edges
constexpr int kWideFaceCount = 64;                          // at most, per side

/// The faces around `start` in breadth-first order that `accept` lets in, at most `limit`.
template <typename Accept>
std::vector<int> grow(const MeshArrays& arrays, int start, int limit, Accept accept) {
    std::vector<int> faces{start};
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (int neighbor : arrays.face_neighbors[faces[i]]) {
            if (neighbor < 0 || static_cast<int>(faces.size()) >= limit) continue;
            if (std::find(faces.begin(), faces.end(), neighbor) != faces.end()) continue;
            if (accept(neighbor)) faces.push_back(neighbor);
        }
    }
    return faces;
}

double middle_dihedral(const MeshArrays& arrays, int face) {
    std::array<double, 3> angles{};
    for (int i = 0; i < 3; ++i) angles[i] = std::abs(arrays.dihedrals[arrays.face_edges[face][i]]);
    std::sort(angles.begin(), angles.end());
    return angles[1];
}

double noise_level(const MeshArrays& arrays, int edge) {
    const std::vector<int> faces =
        grow(arrays, arrays.edge_faces[edge][0], kNoiseFaceCount, [](int) { return true; });
    std::vector<double> angles;
    angles.reserve(faces.size());
    for (int f : faces) angles.push_back(middle_dihedral(arrays, f));
    const auto median = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
    std::nth_element(angles.begin(), median, angles.end());
    return *median;
}

/// Mean normal of the area on one side of an edge.
Vec3 side_normal(const MeshArrays& arrays, int edge, int side, double radius) {
    const auto [from, to] = arrays.edge_vertices[edge];
    const Vec3 middle = 0.5 * (arrays.points[from] + arrays.points[to]);
    const Vec3 along = (arrays.points[to] - arrays.points[from]).normalized();
    const int face = arrays.edge_faces[edge][side];
    Vec3 inward = arrays.centroid(face) - middle;
    inward -= inward.dot(along) * along;
    const std::vector<int> faces = grow(arrays, face, kWideFaceCount, [&](int f) {
        const Vec3 offset = arrays.centroid(f) - middle;
        return offset.dot(inward) > 0 && offset.norm() <= radius;
    });
    Vec3 sum = Vec3::Zero();
    for (int f : faces) sum += arrays.areas[f] * arrays.normals[f];
    return sum.normalized();
}

double wide_dihedral(const MeshArrays& arrays, int edge) {
    double length = 0;
    for (int face : arrays.edge_faces[edge]) {
        for (int e : arrays.face_edges[face]) length += arrays.edge_length(e) / 6;
    }
    const Vec3 left = side_normal(arrays, edge, 0, kWideRadius * length);
    const Vec3 right = side_normal(arrays, edge, 1, kWideRadius * length);
    const auto [from, to] = arrays.edge_vertices[edge];
    const double sine = left.cross(right).dot(arrays.points[to] - arrays.points[from]);
    const double angle = std::atan2(left.cross(right).norm(), left.dot(right));
    return sine < 0 ? -angle : angle;
}

double robust_dihedral(const MeshArrays& arrays, int edge, double low_angle) {
    const double plain = arrays.dihedrals[edge];
    if (std::abs(plain) < low_angle || noise_level(arrays, edge) < kNoisyAngle) return plain;
    const double wide = wide_dihedral(arrays, edge);
    if (plain * wide <= 0) return 0;
    return std::abs(wide) < std::abs(plain) ? wide : plain;
}

bool has_sign(double angle, SharpSign sign) {
    return sign == SharpSign::Both || (sign == SharpSign::Convex) == (angle > 0);
}

}  // namespace

std::vector<double> robust_dihedrals(const MeshArrays& arrays, double low_angle, int threads) {
    std::vector<double> angles(arrays.edge_count());
    tbb::task_arena arena(std::max(1, threads));
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, arrays.edge_count(), 1024),
                          [&](const tbb::blocked_range<int>& range) {
                              for (int e = range.begin(); e < range.end(); ++e) {
                                  angles[e] = robust_dihedral(arrays, e, low_angle);
                              }
                          });
    });
    return angles;
}

std::vector<bool> sharp_edges(const MeshArrays& arrays, const std::vector<double>& angles,
                              const SharpOptions& options, int min_edge_count) {
    std::vector<bool> is_candidate(arrays.edge_count());
    for (int e = 0; e < arrays.edge_count(); ++e) {
        is_candidate[e] =
            std::abs(angles[e]) >= options.low_angle && has_sign(angles[e], options.sign);
    }
    const IndexRows at_vertex = edges_of_vertices(arrays, is_candidate);
    std::vector<bool> is_sharp(arrays.edge_count(), false), is_visited(arrays.edge_count(), false);
    for (int seed = 0; seed < arrays.edge_count(); ++seed) {
        if (!is_candidate[seed] || is_visited[seed]) continue;
        if (std::abs(angles[seed]) < options.high_angle) continue;
        std::vector<int> chain{seed};
        is_visited[seed] = true;
        double length = 0;
        for (std::size_t i = 0; i < chain.size(); ++i) {
            length += arrays.edge_length(chain[i]);
            for (int v : arrays.edge_vertices[chain[i]]) {
                for (const int* e = at_vertex.begin(v); e != at_vertex.end(v); ++e) {
                    if (is_visited[*e] || angles[*e] * angles[chain[i]] < 0) continue;
                    is_visited[*e] = true;
                    chain.push_back(*e);
                }
            }
        }
        if (length < options.min_length || static_cast<int>(chain.size()) < min_edge_count) {
            continue;
        }
        for (int e : chain) is_sharp[e] = true;
    }
    return is_sharp;
}

FeatureCurveNetwork detect_sharp(const LoadedMesh& mesh, const SharpOptions& options) {
    if (!(options.high_angle > 0 && options.high_angle <= std::numbers::pi)) {
        throw InputError("sharp edges: high angle must lie in (0, 180] degrees, got " +
                         std::to_string(options.high_angle * 180 / std::numbers::pi));
    }
    if (!(options.low_angle > 0 && options.low_angle <= options.high_angle)) {
        throw InputError("sharp edges: low angle must lie in (0, high angle], got " +
                         std::to_string(options.low_angle * 180 / std::numbers::pi) + " degrees");
    }
    if (!(options.min_length >= 0)) {
        throw InputError("sharp edges: minimum length must be >= 0, got " +
                         std::to_string(options.min_length));
    }
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    const std::vector<double> angles = robust_dihedrals(arrays, options.low_angle);
    FeatureCurveNetwork network =
        trace_edges(arrays, sharp_edges(arrays, angles, options), {}, "sharp").network;
    set_provenance(network, mesh);
    return network;
}

}  // namespace fcn
