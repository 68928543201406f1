// Crest lines break where the two principal curvatures are alike in magnitude for a moment, and
// stop short of creases, where nothing can be fitted. As Yoshizawa, Belyaev and Seidel (2005,
// section 3) connect components across a few rings, loose ends are joined here where their tangents
// agree, and run on to a crease that lies ahead. A bridge is the chord between the ends, projected
// to the faces between them: those connected to the one end within the gap's length, so that no
// bridge leads through a thin wall.

#include "features/crest_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

#include "features/triangle_point.h"

namespace fcn {
namespace {

constexpr double kAgreeingCosine = 0.70710678;  // 45 degrees
constexpr double kTangentReach = 0.7;           // of the neighbourhood's radius
constexpr double kSearchReach = 1.5;            // of the gap: how far faces between are looked for

struct LooseEnd {
    int point;
    Vec3 direction;  ///< outwards
    double reach;    ///< mesh units
    double length;   ///< of its line
};

class GapSearch {
public:
    GapSearch(const MeshArrays& arrays, const LocalFitter& fitter, double reach)
        : arrays_(arrays), fitter_(fitter), reach_(reach) {}

    std::vector<LooseEnd> loose_ends(const CrestGraph& graph) const {
        std::vector<int> valence(graph.points.size(), 0);
        for (const auto& piece : graph.pieces) {
            for (int p : piece) ++valence[p];
        }
        std::vector<LooseEnd> ends;
        for (const CrestLine& line : crest_lines(graph)) {
            if (line.is_closed) continue;
            for (int end = 0; end < 2; ++end) {
                const int point = end == 0 ? line.points.front() : line.points.back();
                if (valence[point] != 1 || is_at_boundary(graph.points[point])) continue;
                const double tangent = kTangentReach * graph.points[point].radius;
                ends.push_back({point, end_direction(graph, line, end, tangent),
                                reach_ * edge_length(graph.points[point]), length_of(graph, line)});
            }
        }
        std::sort(ends.begin(), ends.end(),
                  [](const LooseEnd& a, const LooseEnd& b) { return a.point < b.point; });
        return ends;
    }

    double edge_length(const CrestPoint& point) const {
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
            sum += point.surface.barycentric[i] *
                   fitter_.edge_length_at(arrays_.face_vertices[point.surface.face][i]);
        }
        return sum;
    }

    Vec3 normal(const CrestPoint& point) const { return arrays_.normals[point.surface.face]; }

    bool is_at_boundary(const CrestPoint& point) const {
        return point.edge >= 0 && point.vertex < 0 && arrays_.is_boundary(point.edge);
    }

    /// Faces connected to a face that have a corner within `radius` of `center`, not across a
    /// barrier; nearest first by the number of steps.
    std::vector<int> faces_around(int face, const Vec3& center, double radius) const {
        std::vector<int> faces{face};
        for (std::size_t i = 0; i < faces.size() && faces.size() < kMostFaces; ++i) {
            for (int k = 0; k < 3; ++k) {
                const int next = arrays_.face_neighbors[faces[i]][k];
                const auto [a, b] = arrays_.edge_vertices[arrays_.face_edges[faces[i]][k]];
                if (next < 0 || (fitter_.is_on_barrier(a) && fitter_.is_on_barrier(b))) continue;
                if (std::find(faces.begin(), faces.end(), next) != faces.end()) continue;
                const auto& corners = arrays_.face_vertices[next];
                if (std::any_of(corners.begin(), corners.end(), [&](int v) {
                        return (arrays_.points[v] - center).norm() <= radius;
                    })) {
                    faces.push_back(next);
                }
            }
        }
        return faces;
    }

    /// The point of the faces that is closest to `goal`.
    CrestPoint project(const Vec3& goal, const std::vector<int>& faces) const {
        CrestPoint best;
        double best_distance = std::numeric_limits<double>::infinity();
        for (int f : faces) {
            const auto [i, j, k] = arrays_.face_vertices[f];
            const Vec3 at =
                closest_barycentric(goal, arrays_.points[i], arrays_.points[j], arrays_.points[k]);
            const Vec3 position =
                at[0] * arrays_.points[i] + at[1] * arrays_.points[j] + at[2] * arrays_.points[k];
            const double distance = (position - goal).squaredNorm();
            if (distance >= best_distance) continue;
            best_distance = distance;
            best.position = position;
            best.surface = {f, at};
        }
        return best;
    }

private:
    static constexpr std::size_t kMostFaces = 512;
    const MeshArrays& arrays_;
    const LocalFitter& fitter_;
    double reach_;
};

/// Pairs of loose ends by distance.
struct Gap {
    double length;
    int one, other;  ///< indices of loose ends
    bool operator<(const Gap& gap) const {
        return std::tie(length, one, other) < std::tie(gap.length, gap.one, gap.other);
    }
};

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const Cell& cell) const {
        std::uint64_t hash = 1469598103934665603ULL;
        for (std::int64_t c : cell) {
            hash = (hash ^ static_cast<std::uint64_t>(c)) * 1099511628211ULL;
        }
        return hash;
    }
};

std::vector<Gap> find_gaps(const GapSearch& search, const CrestGraph& graph,
                           const std::vector<LooseEnd>& ends) {
    double longest = 0;
    for (const LooseEnd& end : ends) longest = std::max(longest, end.reach);
    std::vector<Gap> gaps;
    if (!(longest > 0)) return gaps;
    const auto cell_of = [&](const Vec3& p) {
        const Vec3 scaled = (p / longest).array().floor();
        return Cell{static_cast<std::int64_t>(scaled.x()), static_cast<std::int64_t>(scaled.y()),
                    static_cast<std::int64_t>(scaled.z())};
    };
    std::unordered_map<Cell, std::vector<int>, CellHash> cells;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        cells[cell_of(graph.points[ends[i].point].position)].push_back(static_cast<int>(i));
    }
    const auto consider = [&](int one, int other) {
        if (one >= other) return;
        const LooseEnd& a = ends[one];
        const LooseEnd& b = ends[other];
        const CrestPoint& p = graph.points[a.point];
        const CrestPoint& q = graph.points[b.point];
        const Vec3 chord = q.position - p.position;
        const double length = chord.norm();
        if (!(length > 0) || length > std::min({a.reach, b.reach, a.length, b.length})) return;
        if (a.direction.dot(chord) < kAgreeingCosine * length ||
            -b.direction.dot(chord) < kAgreeingCosine * length ||
            -a.direction.dot(b.direction) < kAgreeingCosine ||
            search.normal(p).dot(search.normal(q)) <= 0) {
            return;
        }
        gaps.push_back({length, one, other});
    };
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Cell center = cell_of(graph.points[ends[i].point].position);
        for (int n = 0; n < 27; ++n) {
            const Cell cell{center[0] + n % 3 - 1, center[1] + n / 3 % 3 - 1,
                            center[2] + n / 9 - 1};
            const auto found = cells.find(cell);
            if (found == cells.end()) continue;
            for (int other : found->second) consider(static_cast<int>(i), other);
        }
    }
    std::sort(gaps.begin(), gaps.end());
    return gaps;
}

CrestPoint between(const CrestPoint& one, const CrestPoint& other, CrestPoint place) {
    for (double CrestPoint::*member :
         {&CrestPoint::kappa, &CrestPoint::kappa_other, &CrestPoint::cyclideness, &CrestPoint::drop,
          &CrestPoint::run, &CrestPoint::e_error, &CrestPoint::radius}) {
        place.*member = 0.5 * (one.*member + other.*member);
    }
    return place;
}

/// Appends pieces from one point of the graph to another along the surface.
void lay_bridge(const GapSearch& search, const std::vector<int>& faces, int one, int other,
                CrestGraph& graph) {
    const CrestPoint from = graph.points[one];
    const CrestPoint to = graph.points[other];
    const double length = (to.position - from.position).norm();
    const int count =
        std::max(1, static_cast<int>(std::ceil(length / (0.5 * search.edge_length(from)))));
    int last = one;
    for (int k = 1; k <= count; ++k) {
        int next = other;
        if (k < count) {
            const double share = static_cast<double>(k) / count;
            const Vec3 goal = (1 - share) * from.position + share * to.position;
            next = static_cast<int>(graph.points.size());
            graph.points.push_back(between(from, to, search.project(goal, faces)));
        }
        graph.pieces.push_back({std::min(last, next), std::max(last, next)});
        graph.piece_faces.push_back(-1);
        last = next;
    }
}

}  // namespace

void bridge_gaps(const MeshArrays& arrays, const LocalFitter& fitter, double reach,
                 CrestGraph& graph) {
    if (!(reach > 0)) return;
    const GapSearch search(arrays, fitter, reach);
    const std::vector<LooseEnd> ends = search.loose_ends(graph);
    std::vector<bool> is_joined(ends.size(), false);
    for (const Gap& gap : find_gaps(search, graph, ends)) {
        if (is_joined[gap.one] || is_joined[gap.other]) continue;
        const int one = ends[gap.one].point, other = ends[gap.other].point;
        const Vec3 middle = 0.5 * (graph.points[one].position + graph.points[other].position);
        const std::vector<int> faces =
            search.faces_around(graph.points[one].surface.face, middle, kSearchReach * gap.length);
        if (std::find(faces.begin(), faces.end(), graph.points[other].surface.face) == faces.end())
            continue;
        is_joined[gap.one] = is_joined[gap.other] = true;
        lay_bridge(search, faces, one, other, graph);
    }
}

void meet_barriers(const MeshArrays& arrays, const LocalFitter& fitter, double reach,
                   CrestGraph& graph) {
    if (!(reach > 0)) return;
    const GapSearch search(arrays, fitter, reach);
    std::unordered_map<int, int> point_of_vertex;
    for (const LooseEnd& end : search.loose_ends(graph)) {
        const CrestPoint start = graph.points[end.point];
        const std::vector<int> faces =
            search.faces_around(start.surface.face, start.position, end.reach);
        CrestPoint goal;
        double best_distance = end.reach;
        for (int f : faces) {
            for (int i = 0; i < 3; ++i) {
                const int v = arrays.face_vertices[f][i];
                if (!fitter.is_on_barrier(v)) continue;
                const Vec3 chord = arrays.points[v] - start.position;
                const double length = chord.norm();
                if (!(length > 0) || length >= best_distance ||
                    end.direction.dot(chord) < kAgreeingCosine * length) {
                    continue;
                }
                best_distance = length;
                goal.vertex = v;
                goal.surface = {f, Vec3::Unit(i)};
            }
        }
        if (goal.vertex < 0) continue;
        goal.position = arrays.points[goal.vertex];
        const auto [known, is_new] =
            point_of_vertex.try_emplace(goal.vertex, static_cast<int>(graph.points.size()));
        if (is_new) graph.points.push_back(between(start, start, goal));
        lay_bridge(search, faces, end.point, known->second, graph);
    }
}

}  // namespace fcn
