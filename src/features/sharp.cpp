// Sharp edges by hysteresis on the dihedral angle: an edge above the high angle seeds a chain,
// edges above the low angle continue it (the two thresholds of Canny's edge detector, on mesh
// edges). A weak edge continues a chain where it goes on in about the same direction, or where no
// comparable edge runs beside it: the facets of a coarsely meshed hole meet its rim at right
// angles and are no part of the rim, but a single weak crease may begin at a sharp corner.
//
// The plain dihedral takes noise for features: on a plane whose vertices are displaced by a fifth
// of the edge length most edges exceed 18 degrees. So the angle is measured at two scales where
// the surroundings are noisy. Noisy is a place whose faces disagree with all their neighbours, and
// clearly with all but one and with the neighbours' mean normal: on a clean surface, beside creases
// and on coarsely meshed fillets as well, at least one of the three is small. Medians over some
// thirty faces decide; a part that has fewer is never noisy. There the edge counts only as far as
// the area-weighted mean normals of the areas left and right of it (radius 2.5 edges) enclose the
// angle, too: an integral of normals over an area depends on the area's border alone, so noise of
// single vertices fades fast, while a crease keeps its angle. Tiny holes and ribs look like noise
// to that test; what tells them apart is that their creases are regular: nine edges in a row, or a
// ring, that turn little and have the same dihedral within 15%. Clean places and regular creases
// keep the plain dihedral.

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

constexpr double kNoise = 4 * std::numbers::pi / 180;  // medians of face_noise()
constexpr double kLeastNoise = 1.5 * std::numbers::pi / 180;
constexpr int kNoiseFaceCount = 32;        // faces in that median
constexpr double kWideRadius = 2.5;        // of the wide dihedral, in edges
constexpr double kContinuingCosine = 0.5;  // a chain turns by up to 60 degrees
constexpr int kRegularEdges = 9;
constexpr double kRegularDifference = 0.15;  // relative
constexpr int kIsolationFaceCount = 14;      // faces searched for parallel edges
constexpr double kIsolatedShare = 0.5;       // of the angle; more is comparable
constexpr double kParallelCosine = 0.7;
constexpr int kSupportedEdges = 7;  // fewer may be noise if they end inside the surface
constexpr int kLeastEdges = 3;      // fewer are
constexpr int kWideFaceCount = 64;  // at most, per side

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

/// How far a face disagrees with all its neighbours (first), and with all but one of them and with
/// their mean (second).
std::array<double, 2> face_noise(const MeshArrays& arrays, int face) {
    std::array<double, 3> angles{};
    Vec3 mean = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
        const int neighbor = arrays.face_neighbors[face][i];
        // No neighbour agrees with nothing: boundary faces are as noisy as those behind them.
        angles[i] = neighbor < 0 ? std::numbers::pi
                                 : std::abs(arrays.dihedrals[arrays.face_edges[face][i]]);
        mean += arrays.normals[neighbor >= 0 ? neighbor : face];
    }
    std::sort(angles.begin(), angles.end());
    const Vec3& normal = arrays.normals[face];
    const double from_mean = std::atan2(normal.cross(mean).norm(), normal.dot(mean));
    return {angles[0], std::min(angles[1], from_mean)};
}

bool is_noisy(const MeshArrays& arrays, int edge, double share = 1) {
    const std::vector<int> faces =
        grow(arrays, arrays.edge_faces[edge][0], kNoiseFaceCount, [](int) { return true; });
    // A part of few faces is a polyhedron whose every face was meant.
    if (static_cast<int>(faces.size()) < kNoiseFaceCount) return false;
    std::array<std::vector<double>, 2> levels;
    for (int f : faces) {
        const auto noise = face_noise(arrays, f);
        for (int i = 0; i < 2; ++i) levels[i].push_back(noise[i]);
    }
    const auto median = [](std::vector<double>& values) {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    };
    return median(levels[0]) >= share * kLeastNoise && median(levels[1]) >= share * kNoise;
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

/// Does `next` go on from `edge` beyond their common vertex without turning much?
bool is_continuing(const MeshArrays& arrays, int edge, int next, int vertex) {
    const auto away = [&](int e) {
        const auto [from, to] = arrays.edge_vertices[e];
        const Vec3 direction = arrays.points[to] - arrays.points[from];
        return Vec3((from == vertex ? direction : Vec3(-direction)).normalized());
    };
    return -away(edge).dot(away(next)) >= kContinuingCosine;
}

/// Length, in edges, of the regular crease through an edge, counted up to kRegularEdges.
int regular_edge_count(const MeshArrays& arrays, const IndexRows& at_vertex, int edge) {
    const double angle = arrays.dihedrals[edge];
    int count = 1;
    for (int side = 0; side < 2; ++side) {
        int current = edge, vertex = arrays.edge_vertices[edge][side];
        while (count < kRegularEdges) {
            int best = -1;
            double best_difference = kRegularDifference * std::abs(angle);
            for (const int* e = at_vertex.begin(vertex); e != at_vertex.end(vertex); ++e) {
                const double difference = std::abs(arrays.dihedrals[*e] - angle);
                if (*e == current || difference > best_difference) continue;
                if (!is_continuing(arrays, current, *e, vertex)) continue;
                best = *e;
                best_difference = difference;
            }
            if (best == edge) return kRegularEdges;  // once around
            if (best < 0) break;
            const auto [from, to] = arrays.edge_vertices[best];
            vertex = from == vertex ? to : from;
            current = best;
            ++count;
        }
    }
    return count;
}

double robust_dihedral(const MeshArrays& arrays, const IndexRows& at_vertex, int edge,
                       double low_angle) {
    const double plain = arrays.dihedrals[edge];
    if (std::abs(plain) < low_angle || !is_noisy(arrays, edge)) return plain;
    if (regular_edge_count(arrays, at_vertex, edge) >= kRegularEdges) return plain;
    const double wide = wide_dihedral(arrays, edge);
    if (plain * wide <= 0) return 0;
    return std::abs(wide) < std::abs(plain) ? wide : plain;
}

bool has_sign(double angle, SharpSign sign) {
    return sign == SharpSign::Both || (sign == SharpSign::Convex) == (angle > 0);
}

/// Seeds and what continues them.
std::vector<bool> grow_chains(const MeshArrays& arrays, const std::vector<double>& angles,
                              const SharpOptions& options) {
    std::vector<bool> is_candidate(arrays.edge_count()), is_sharp(arrays.edge_count(), false);
    std::vector<int> queue;
    for (int e = 0; e < arrays.edge_count(); ++e) {
        is_candidate[e] =
            std::abs(angles[e]) >= options.low_angle && has_sign(angles[e], options.sign);
        if (!is_candidate[e] || std::abs(angles[e]) < options.high_angle) continue;
        is_sharp[e] = true;
        queue.push_back(e);
    }
    const IndexRows at_vertex = edges_of_vertices(arrays, is_candidate);
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const int edge = queue[i];
        for (int v : arrays.edge_vertices[edge]) {
            for (const int* e = at_vertex.begin(v); e != at_vertex.end(v); ++e) {
                if (is_sharp[*e] || angles[*e] * angles[edge] < 0) continue;
                if (!is_continuing(arrays, edge, *e, v) && !is_isolated(arrays, angles, *e)) {
                    continue;
                }
                is_sharp[*e] = true;
                queue.push_back(*e);
            }
        }
    }
    return is_sharp;
}

/// Does a chain end inside the surface?
bool is_dangling(const MeshArrays& arrays, const IndexRows& at_vertex,
                 const std::vector<bool>& is_boundary_vertex, const std::vector<int>& chain) {
    return std::any_of(chain.begin(), chain.end(), [&](int e) {
        const auto [a, b] = arrays.edge_vertices[e];
        return (at_vertex.size(a) == 1 && !is_boundary_vertex[a]) ||
               (at_vertex.size(b) == 1 && !is_boundary_vertex[b]);
    });
}

/// Convex and concave chains count apart. A few edges that end inside the surface are noise, a few
/// more where the surroundings are at all noisy.
void drop_short_chains(const MeshArrays& arrays, const std::vector<double>& angles,
                       double min_length, int min_edge_count, std::vector<bool>& is_sharp) {
    const IndexRows at_vertex = edges_of_vertices(arrays, is_sharp);
    std::vector<bool> is_visited(arrays.edge_count(), false);
    std::vector<bool> is_boundary(arrays.vertex_count(), false);
    for (int e = 0; e < arrays.edge_count(); ++e) {
        if (!arrays.is_boundary(e)) continue;
        for (int v : arrays.edge_vertices[e]) is_boundary[v] = true;
    }
    for (int start = 0; start < arrays.edge_count(); ++start) {
        if (!is_sharp[start] || is_visited[start]) continue;
        std::vector<int> chain{start};
        is_visited[start] = true;
        double length = 0;
        for (std::size_t i = 0; i < chain.size(); ++i) {
            length += arrays.edge_length(chain[i]);
            for (int v : arrays.edge_vertices[chain[i]]) {
                for (const int* e = at_vertex.begin(v); e != at_vertex.end(v); ++e) {
                    if (is_visited[*e] || angles[*e] * angles[start] < 0) continue;
                    is_visited[*e] = true;
                    chain.push_back(*e);
                }
            }
        }
        const int edge_count = static_cast<int>(chain.size());
        bool is_crumb = false;
        if (edge_count < kSupportedEdges) {
            const bool is_short = edge_count < kLeastEdges;
            const bool is_open = is_dangling(arrays, at_vertex, is_boundary, chain);
            is_crumb = (is_short && is_open) ||
                       ((is_short || is_open) && is_noisy(arrays, chain[edge_count / 2], 0.4));
        }
        if (length >= min_length && edge_count >= min_edge_count && !is_crumb) continue;
        for (int e : chain) is_sharp[e] = false;
    }
}

}  // namespace

bool is_isolated(const MeshArrays& arrays, const std::vector<double>& angles, int edge) {
    const auto [from, to] = arrays.edge_vertices[edge];
    const Vec3 middle = 0.5 * (arrays.points[from] + arrays.points[to]);
    const double length = arrays.edge_length(edge);
    const Vec3 along = (arrays.points[to] - arrays.points[from]) / length;
    for (int side : arrays.edge_faces[edge]) {
        for (int f : grow(arrays, side, kIsolationFaceCount, [](int) { return true; })) {
            for (int e : arrays.face_edges[f]) {
                if (std::abs(angles[e]) < kIsolatedShare * std::abs(angles[edge])) continue;
                const Vec3& a = arrays.points[arrays.edge_vertices[e][0]];
                const Vec3& b = arrays.points[arrays.edge_vertices[e][1]];
                const Vec3 offset = 0.5 * (a + b) - middle;
                const double lateral = (offset - offset.dot(along) * along).norm();
                const bool is_parallel =
                    std::abs((b - a).normalized().dot(along)) > kParallelCosine;
                if (is_parallel && lateral > 0.3 * length) return false;
            }
        }
    }
    return true;
}

std::vector<double> robust_dihedrals(const MeshArrays& arrays, double low_angle, int threads) {
    std::vector<double> angles(arrays.edge_count());
    std::vector<bool> is_candidate(arrays.edge_count());
    for (int e = 0; e < arrays.edge_count(); ++e) {
        is_candidate[e] = std::abs(arrays.dihedrals[e]) >= low_angle;
    }
    const IndexRows at_vertex = edges_of_vertices(arrays, is_candidate);
    tbb::task_arena arena(std::max(1, threads));
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, arrays.edge_count(), 1024),
                          [&](const tbb::blocked_range<int>& range) {
                              for (int e = range.begin(); e < range.end(); ++e) {
                                  angles[e] = robust_dihedral(arrays, at_vertex, e, low_angle);
                              }
                          });
    });
    return angles;
}

std::vector<bool> sharp_edges(const MeshArrays& arrays, const std::vector<double>& angles,
                              const SharpOptions& options, int min_edge_count) {
    std::vector<bool> is_sharp = grow_chains(arrays, angles, options);
    drop_short_chains(arrays, angles, options.min_length, min_edge_count, is_sharp);
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
