// Dihedral angles that noise does not pass for creases: on a plane whose vertices are displaced by
// a fifth of the edge length most edges exceed 18 degrees, and along a crease of 90 degrees so
// displaced some do not exceed 40.
//
// Noisy is a place whose faces disagree with all their neighbours, and clearly with all but one and
// with the neighbours' mean normal: on a clean surface, beside creases and on coarsely meshed
// fillets as well, at least one of the three is small. Most of some thirty faces decide; a part
// that has fewer is never noisy. There, and three rings around, normals are filtered
// (normal_filter), and edges get the angles between the filtered normals. Filters make stairs of
// fillets: so angles below 60 degrees are bounded by the mean of the plain dihedrals along the
// chain through the edge, in which noise averages out. Tiny holes and ribs look like noise to the
// test; what tells them apart is that their creases are regular: nine edges in a row, or a ring,
// that turn little and have the same dihedral within 15%. Clean places and regular creases keep the
// plain dihedral.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "features/normal_filter.h"
#include "features/sharp_edges.h"

namespace fcn {
namespace {

constexpr double kNoise = 4 * std::numbers::pi / 180;  // medians of face_noise()
constexpr double kLeastNoise = 1.5 * std::numbers::pi / 180;
constexpr int kNoiseFaceCount = 32;           // faces in that median
constexpr double kLeastDisplacement = 0.015;  // by noise, in mean edges
constexpr double kMuch = 0.5;                 // of the faces
constexpr int kRings = 3;                     // around noisy faces
constexpr double kContinuingCosine = 0.5;     // a chain turns by up to 60 degrees
constexpr int kRegularEdges = 9;
constexpr double kRegularDifference = 0.15;  // relative
constexpr int kMeanSteps = 5;                // to either side, of the mean along a chain
constexpr double kCertain = 60 * std::numbers::pi / 180;  // no staircase
constexpr double kMeanFactor = 1.2;
constexpr int kIsolationFaceCount = 14;  // faces searched for parallel edges
constexpr double kIsolatedShare = 0.5;   // of the angle; more is comparable
constexpr double kParallelCosine = 0.7;
constexpr double kLineDistance = 0.3;  // of lines that count apart, in lengths of the edge

/// The faces around `start` in breadth-first order, at most `limit`.
std::vector<int> grow(const MeshArrays& arrays, int start, int limit) {
    std::vector<int> faces{start};
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (int neighbor : arrays.face_neighbors[faces[i]]) {
            if (neighbor < 0 || static_cast<int>(faces.size()) >= limit) continue;
            if (std::find(faces.begin(), faces.end(), neighbor) != faces.end()) continue;
            faces.push_back(neighbor);
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

/// Mean plain dihedral of the edges that go on from an edge to either side, those of the largest
/// filtered angle at each vertex.
double mean_along(const MeshArrays& arrays, const IndexRows& at_vertex,
                  const std::vector<double>& filtered, int edge) {
    double sum = arrays.edge_length(edge) * arrays.dihedrals[edge];
    double length = arrays.edge_length(edge);
    for (int side = 0; side < 2; ++side) {
        int current = edge, vertex = arrays.edge_vertices[edge][side];
        for (int step = 0; step < kMeanSteps; ++step) {
            int best = -1;
            double largest = 0;
            for (const int* e = at_vertex.begin(vertex); e != at_vertex.end(vertex); ++e) {
                const double angle = filtered[edge] > 0 ? filtered[*e] : -filtered[*e];
                if (*e == current || angle <= largest) continue;
                if (!is_continuing(arrays, current, *e, vertex)) continue;
                best = *e;
                largest = angle;
            }
            if (best < 0 || best == edge) break;
            const auto [from, to] = arrays.edge_vertices[best];
            vertex = from == vertex ? to : from;
            current = best;
            sum += arrays.edge_length(best) * arrays.dihedrals[best];
            length += arrays.edge_length(best);
        }
    }
    return sum / length;
}

/// Faces in noisy places, as far as edges above the low angle tell, and the rings around them.
std::vector<bool> noisy_faces(const MeshArrays& arrays, const std::vector<char>& is_noise) {
    std::vector<bool> is_noisy(arrays.face_count(), false);
    std::vector<int> rim;
    for (int e = 0; e < arrays.edge_count(); ++e) {
        if (!is_noise[e]) continue;
        for (int f : arrays.edge_faces[e]) {
            if (f < 0 || is_noisy[f]) continue;
            is_noisy[f] = true;
            rim.push_back(f);
        }
    }
    if (rim.empty()) return is_noisy;
    const IndexRows at_vertex = faces_of_vertices(arrays);
    for (int ring = 0; ring < kRings; ++ring) {
        std::vector<int> next;
        for (int f : rim) {
            for (int v : arrays.face_vertices[f]) {
                for (const int* g = at_vertex.begin(v); g != at_vertex.end(v); ++g) {
                    if (is_noisy[*g]) continue;
                    is_noisy[*g] = true;
                    next.push_back(*g);
                }
            }
        }
        rim = std::move(next);
    }
    // Where much of a mesh is noisy all of it is; some places are flatter by chance.
    const auto count = std::count(is_noisy.begin(), is_noisy.end(), true);
    if (static_cast<double>(count) > kMuch * arrays.face_count())
        is_noisy.assign(arrays.face_count(), true);
    return is_noisy;
}

double dihedral_of(const MeshArrays& arrays, const std::vector<Vec3>& normals, int edge) {
    const auto [left, right] = arrays.edge_faces[edge];
    if (left < 0 || right < 0) return 0;
    const auto [from, to] = arrays.edge_vertices[edge];
    const Vec3 cross = normals[left].cross(normals[right]);
    const double angle = std::atan2(cross.norm(), normals[left].dot(normals[right]));
    return cross.dot(arrays.points[to] - arrays.points[from]) < 0 ? -angle : angle;
}

/// Which edges look like noise, and which belong to regular creases; edges below the low angle are
/// neither.
struct EdgeKinds {
    std::vector<char> is_noise, is_regular;
};

EdgeKinds edge_kinds(const MeshArrays& arrays, const IndexRows& at_vertex,
                     const std::vector<bool>& is_candidate, int threads) {
    EdgeKinds kinds{std::vector<char>(arrays.edge_count(), 0),
                    std::vector<char>(arrays.edge_count(), 0)};
    tbb::task_arena arena(std::max(1, threads));
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, arrays.edge_count(), 1024),
                          [&](const tbb::blocked_range<int>& range) {
                              for (int e = range.begin(); e < range.end(); ++e) {
                                  if (!is_candidate[e]) continue;
                                  const int count = regular_edge_count(arrays, at_vertex, e);
                                  kinds.is_regular[e] = count >= kRegularEdges;
                                  kinds.is_noise[e] =
                                      !kinds.is_regular[e] &&
                                      is_noisy_place(arrays, arrays.edge_faces[e][0]);
                              }
                          });
    });
    return kinds;
}

/// No larger than what the plain dihedrals along the chain allow.
double bounded(double angle, double mean) {
    if (std::abs(angle) >= kCertain) return angle;
    if (angle * mean <= 0) return 0;
    return std::abs(kMeanFactor * mean) < std::abs(angle) ? kMeanFactor * mean : angle;
}

}  // namespace

bool is_noisy_place(const MeshArrays& arrays, int face, double share) {
    const std::vector<int> faces = grow(arrays, face, kNoiseFaceCount);
    // A part of few faces is a polyhedron whose every face was meant.
    if (static_cast<int>(faces.size()) < kNoiseFaceCount) return false;
    std::array<int, 2> above{};
    for (int f : faces) {
        const auto noise = face_noise(arrays, f);
        above[0] += noise[0] >= share * kLeastNoise ? 1 : 0;
        above[1] += noise[1] >= share * kNoise ? 1 : 0;
    }
    const int half = (kNoiseFaceCount + 1) / 2;
    return above[0] >= half && above[1] >= half;
}

int lines_beside(const MeshArrays& arrays, const std::vector<double>& angles, int edge, int most) {
    const auto [from, to] = arrays.edge_vertices[edge];
    const Vec3 middle = 0.5 * (arrays.points[from] + arrays.points[to]);
    const double length = arrays.edge_length(edge);
    const Vec3 along = (arrays.points[to] - arrays.points[from]) / length;
    std::vector<Vec3> lines;  // offsets across the edge
    for (int side : arrays.edge_faces[edge]) {
        for (int f : grow(arrays, side, kIsolationFaceCount)) {
            for (int e : arrays.face_edges[f]) {
                if (std::abs(angles[e]) < kIsolatedShare * std::abs(angles[edge])) continue;
                const Vec3& a = arrays.points[arrays.edge_vertices[e][0]];
                const Vec3& b = arrays.points[arrays.edge_vertices[e][1]];
                const Vec3 offset = 0.5 * (a + b) - middle;
                const Vec3 across = offset - offset.dot(along) * along;
                const bool is_parallel =
                    std::abs((b - a).normalized().dot(along)) > kParallelCosine;
                if (!is_parallel || across.norm() <= kLineDistance * length) continue;
                const bool is_known = std::any_of(lines.begin(), lines.end(), [&](const Vec3& l) {
                    return (l - across).norm() <= kLineDistance * length;
                });
                if (is_known) continue;
                lines.push_back(across);
                if (static_cast<int>(lines.size()) == most) return most;
            }
        }
    }
    return static_cast<int>(lines.size());
}

bool is_isolated(const MeshArrays& arrays, const std::vector<double>& angles, int edge) {
    return lines_beside(arrays, angles, edge, 1) == 0;
}

RobustDihedrals robust_dihedrals(const MeshArrays& arrays, double low_angle, int threads) {
    RobustDihedrals result{
        arrays.dihedrals, std::vector<bool>(arrays.edge_count(), false), {}, 0, 0};
    std::vector<bool> is_candidate(arrays.edge_count());
    for (int e = 0; e < arrays.edge_count(); ++e)
        is_candidate[e] = std::abs(arrays.dihedrals[e]) >= low_angle;
    const EdgeKinds kinds =
        edge_kinds(arrays, edges_of_vertices(arrays, is_candidate), is_candidate, threads);
    const std::vector<bool> is_noisy = noisy_faces(arrays, kinds.is_noise);
    FilteredNormals without_noise = filtered_normals(arrays, is_noisy, {.threads = threads});
    if (without_noise.displacement < kLeastDisplacement * arrays.mean_edge_length) return result;
    std::vector<double> filtered = arrays.dihedrals;
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const auto [f, g] = arrays.edge_faces[e];
        if (f < 0 || g < 0 || kinds.is_regular[e] || !(is_noisy[f] || is_noisy[g])) continue;
        result.is_noisy_edge[e] = true;
        filtered[e] = dihedral_of(arrays, without_noise.normals, e);
        is_candidate[e] = std::abs(filtered[e]) >= low_angle;
    }
    const IndexRows candidates = edges_of_vertices(arrays, is_candidate);
    for (int e = 0; e < arrays.edge_count(); ++e) {
        if (!result.is_noisy_edge[e]) continue;
        result.angles[e] = is_candidate[e]
                               ? bounded(filtered[e], mean_along(arrays, candidates, filtered, e))
                               : filtered[e];
    }
    result.normals = std::move(without_noise.normals);
    result.displacement = without_noise.displacement;
    result.residual = without_noise.residual;
    return result;
}

}  // namespace fcn
