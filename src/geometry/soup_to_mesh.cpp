// From what a file says to an oriented 2-manifold, in this order: check coordinates and indices,
// cut polygons into triangles, weld, drop faces with a repeated corner and repeated faces, pair and
// orient (manifold.cpp), build, flip away faces without area (zero_area.cpp). Faces without area
// that cannot be flipped away are dropped at a boundary; inside, their shortest edge is welded and
// the last steps are repeated. Vertices and faces keep their order; a clean input comes out as it
// went in.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/errors.h"
#include "geometry/polygon_soup.h"

namespace fcn {

namespace {

void check_soup(const PolygonSoup& soup, const std::string& source) {
    // Squared areas of larger coordinates would overflow.
    constexpr double kLargestCoordinate = 1e60;
    constexpr auto kMostItems = static_cast<std::size_t>(std::numeric_limits<int>::max() / 2);
    if (soup.polygon_count() == 0) throw InputError(source + ": no faces");
    if (soup.points.size() > kMostItems || soup.corners.size() > kMostItems) {
        throw InputError(source + ": more than " + std::to_string(kMostItems) +
                         " vertices or face corners are not supported");
    }
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        if (!soup.points[i].allFinite()) {
            throw InputError(source + ": vertex " + std::to_string(i) + " is not finite");
        }
        if (soup.points[i].cwiseAbs().maxCoeff() > kLargestCoordinate) {
            throw InputError(source + ": vertex " + std::to_string(i) +
                             " has a coordinate larger than 1e60");
        }
    }
    for (std::size_t polygon = 0; polygon < soup.polygon_count(); ++polygon) {
        for (std::size_t i = soup.corner_begin[polygon]; i < soup.corner_begin[polygon + 1]; ++i) {
            const int corner = soup.corners[i];
            if (corner < 0 || static_cast<std::size_t>(corner) >= soup.points.size()) {
                throw InputError(source + ": face " + std::to_string(polygon) + ": vertex index " +
                                 std::to_string(corner) + " is out of range, there are " +
                                 std::to_string(soup.points.size()) + " vertices");
            }
        }
    }
    if (!soup.labels.empty() && soup.labels.size() != soup.polygon_count()) {
        throw InputError(source + ": " + std::to_string(soup.labels.size()) + " labels for " +
                         std::to_string(soup.polygon_count()) + " faces");
    }
}

void keep_faces(TriangleSoup& soup, const std::vector<bool>& is_kept) {
    std::size_t kept = 0;
    for (std::size_t face = 0; face < soup.triangles.size(); ++face) {
        if (!is_kept[face]) continue;
        soup.triangles[kept] = soup.triangles[face];
        if (!soup.labels.empty()) soup.labels[kept] = soup.labels[face];
        ++kept;
    }
    soup.triangles.resize(kept);
    if (!soup.labels.empty()) soup.labels.resize(kept);
}

/// Merges the vertices; the count is of used vertices that disappeared.
std::size_t apply_weld(TriangleSoup& soup, const std::vector<int>& representative) {
    std::vector<bool> is_gone(soup.points.size(), false);
    std::size_t count = 0;
    for (auto& corners : soup.triangles) {
        for (int& corner : corners) {
            if (representative[corner] == corner) continue;
            if (!is_gone[corner]) ++count;
            is_gone[corner] = true;
            corner = representative[corner];
        }
    }
    return count;
}

void drop_repeated_corners(TriangleSoup& soup, RepairReport& report) {
    std::vector<bool> is_kept(soup.triangles.size(), true);
    std::size_t count = 0;
    for (std::size_t face = 0; face < soup.triangles.size(); ++face) {
        const auto [a, b, c] = soup.triangles[face];
        if (a != b && b != c && c != a) continue;
        is_kept[face] = false;
        ++count;
    }
    report.degenerate_face_count += count;
    if (count > 0) keep_faces(soup, is_kept);
}

/// Of faces with the same three corners, in whichever order, the first stays.
void drop_repeated_faces(TriangleSoup& soup, RepairReport& report) {
    const auto sorted = [&](int face) {
        std::array<int, 3> corners = soup.triangles[face];
        std::sort(corners.begin(), corners.end());
        return corners;
    };
    std::vector<int> begin(soup.points.size() + 1, 0);
    const int face_count = static_cast<int>(soup.triangles.size());
    for (int face = 0; face < face_count; ++face) ++begin[sorted(face)[0] + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<int> order(static_cast<std::size_t>(face_count));
    std::vector<int> cursor(begin.begin(), begin.end() - 1);
    for (int face = 0; face < face_count; ++face) order[cursor[sorted(face)[0]]++] = face;
    std::vector<bool> is_kept(static_cast<std::size_t>(face_count), true);
    std::size_t count = 0;
    for (std::size_t vertex = 0; vertex + 1 < begin.size(); ++vertex) {
        const auto first = order.begin() + begin[vertex];
        const auto last = order.begin() + begin[vertex + 1];
        std::sort(first, last, [&](int f, int g) {
            return sorted(f) != sorted(g) ? sorted(f) < sorted(g) : f < g;
        });
        for (auto it = first; it != last; ++it) {
            if (it == first || sorted(*it) != sorted(*(it - 1))) continue;
            is_kept[*it] = false;
            ++count;
        }
    }
    report.duplicate_face_count += count;
    if (count > 0) keep_faces(soup, is_kept);
}

/// Removes vertices without faces; returns their number.
std::size_t compact(TriangleSoup& soup) {
    std::vector<int> index(soup.points.size(), -1);
    for (const auto& corners : soup.triangles) {
        for (int corner : corners) index[corner] = 0;
    }
    int kept = 0;
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        if (index[i] < 0) continue;
        soup.points[kept] = soup.points[i];
        index[i] = kept++;
    }
    const std::size_t dropped = soup.points.size() - static_cast<std::size_t>(kept);
    soup.points.resize(static_cast<std::size_t>(kept));
    for (auto& corners : soup.triangles) {
        for (int& corner : corners) corner = index[corner];
    }
    return dropped;
}

TriangleSoup soup_of(const Mesh& mesh, std::vector<int> labels) {
    TriangleSoup soup;
    soup.labels = std::move(labels);
    for (const auto vertex : mesh.vertices()) soup.points.push_back(mesh.point(vertex));
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        soup.triangles.push_back({a.idx(), b.idx(), c.idx()});
    }
    return soup;
}

int root_of(const std::vector<int>& representative, int vertex) {
    while (representative[vertex] != vertex) vertex = representative[vertex];
    return vertex;
}

/// Takes out faces without area that no flip could mend: dropped if their longest edge is a
/// boundary (or if `is_final`), otherwise collapsed along the shortest edge.
void remove_stuck_faces(TriangleSoup& soup, const Mesh& mesh, const std::vector<int>& stuck,
                        bool is_final) {
    std::vector<bool> is_kept(soup.triangles.size(), true);
    std::vector<int> representative(soup.points.size());
    std::iota(representative.begin(), representative.end(), 0);
    for (int face : stuck) {
        const auto& corners = soup.triangles[face];
        const auto length = [&](int c) {
            return (soup.points[corners[c]] - soup.points[corners[(c + 1) % 3]]).squaredNorm();
        };
        int shortest = 0;
        int longest = 0;
        for (int c = 1; c < 3; ++c) {
            if (length(c) < length(shortest)) shortest = c;
            if (length(c) > length(longest)) longest = c;
        }
        const VertexHandle a(corners[longest]);
        const VertexHandle b(corners[(longest + 1) % 3]);
        if (is_final || mesh.is_boundary(mesh.edge_handle(mesh.find_halfedge(a, b)))) {
            is_kept[face] = false;
            continue;
        }
        const int one = root_of(representative, corners[shortest]);
        const int other = root_of(representative, corners[(shortest + 1) % 3]);
        representative[std::max(one, other)] = std::min(one, other);
    }
    // Every entry points downwards, so going up in order resolves all chains.
    for (int& entry : representative) entry = representative[entry];
    keep_faces(soup, is_kept);
    apply_weld(soup, representative);
}

std::uint64_t hash_of(const Mesh& mesh) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    const auto add = [&hash](std::uint64_t value, int byte_count) {
        for (int i = 0; i < byte_count; ++i) {
            hash = (hash ^ ((value >> (8 * i)) & 0xff)) * 0x100000001b3ULL;
        }
    };
    for (const auto vertex : mesh.vertices()) {
        for (double coordinate : mesh.point(vertex)) {
            add(std::bit_cast<std::uint64_t>(coordinate + 0.0), 8);
        }
    }
    for (const auto face : mesh.faces()) {
        for (VertexHandle vertex : face_vertices(mesh, face)) {
            add(static_cast<std::uint64_t>(vertex.idx()), 4);
        }
    }
    return hash;
}

double bounding_diagonal(const std::vector<Vec3>& points) {
    Vec3 low = points.front();
    Vec3 high = points.front();
    for (const Vec3& point : points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    return (high - low).norm();
}

void weld(TriangleSoup& soup, bool is_unconnected, double tolerance, RepairReport& report) {
    if (is_unconnected) apply_weld(soup, weld_map(soup.points, 0.0));
    if (tolerance > 0) {
        const double distance = tolerance * bounding_diagonal(soup.points);
        report.welded_vertex_count += apply_weld(soup, weld_map(soup.points, distance));
    } else if (!is_unconnected) {
        report.welded_vertex_count += apply_weld(soup, weld_map(soup.points, 0.0));
    }
}

}  // namespace

LoadedMesh mesh_from_polygons(PolygonSoup&& input, const std::string& source,
                              const ReadOptions& options) {
    if (!(options.weld_tolerance >= 0 && options.weld_tolerance < 1)) {
        throw InputError("weld tolerance must lie in [0, 1)");
    }
    check_soup(input, source);
    LoadedMesh result;
    result.units = std::move(input.units);
    result.label_names = std::move(input.label_names);
    const std::size_t polygon_count = input.polygon_count();
    const double precision = input.precision;
    const bool is_unconnected = input.is_unconnected;
    RepairReport& report = result.repairs;
    TriangleSoup soup = triangulate(std::move(input), source, report);
    const std::size_t unused = [&] {
        std::vector<bool> is_used(soup.points.size(), false);
        for (const auto& corners : soup.triangles) {
            for (int corner : corners) is_used[corner] = true;
        }
        return static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), false));
    }();
    report.unreferenced_vertex_count = unused;
    weld(soup, is_unconnected, options.weld_tolerance, report);
    // A weld can make new non-manifold edges, whose cutting adds vertices again; so there is a
    // limit after which stuck faces are simply dropped, and one after which the input is refused.
    constexpr int kWeldingRounds = 50;
    constexpr int kMostRounds = 200;
    for (int round = 0;; ++round) {
        if (round > kMostRounds) throw InputError(source + ": faces without area defy repair");
        drop_repeated_corners(soup, report);
        drop_repeated_faces(soup, report);
        if (soup.triangles.empty()) {
            throw InputError(source + ": none of the " + std::to_string(polygon_count) +
                             " faces has an area");
        }
        compact(soup);
        ManifoldSoup manifold = make_manifold(std::move(soup), report);
        result.mesh = build_mesh(manifold);
        result.face_labels = std::move(manifold.soup.labels);
        const std::vector<int> stuck =
            flip_zero_area_faces(result.mesh, result.face_labels, precision, report);
        if (stuck.empty()) break;
        soup = soup_of(result.mesh, std::move(result.face_labels));
        const std::size_t before = soup.triangles.size();
        remove_stuck_faces(soup, result.mesh, stuck, round >= kWeldingRounds);
        report.degenerate_face_count += before - soup.triangles.size();
    }
    if (!options.is_repairing) {
        RepairReport refused = report;
        refused.triangulated_polygon_count = 0;
        if (!refused.is_clean()) {
            throw InputError(source + ": needs repair: " + refused.messages().front());
        }
    }
    result.hash = hash_of(result.mesh);
    return result;
}

LoadedMesh mesh_from_soup(const std::vector<Vec3>& points,
                          const std::vector<std::array<int, 3>>& triangles,
                          const std::vector<int>& labels, const ReadOptions& options) {
    PolygonSoup soup;
    soup.points = points;
    soup.labels = labels;
    soup.corners.reserve(3 * triangles.size());
    soup.corner_begin.reserve(triangles.size() + 1);
    for (const auto& corners : triangles) {
        soup.corners.insert(soup.corners.end(), corners.begin(), corners.end());
        soup.close_polygon();
    }
    return mesh_from_polygons(std::move(soup), "triangle soup", options);
}

bool RepairReport::is_clean() const { return messages().empty(); }

std::vector<std::string> RepairReport::messages() const {
    std::vector<std::string> lines;
    const auto add = [&lines](std::size_t count, const char* one, const char* many) {
        if (count > 0) lines.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
    };
    add(welded_vertex_count, "vertex welded to another", "vertices welded to others");
    add(degenerate_face_count, "face without area removed", "faces without area removed");
    add(duplicate_face_count, "repeated face dropped", "repeated faces dropped");
    add(unreferenced_vertex_count, "vertex without a face dropped",
        "vertices without a face dropped");
    add(reoriented_face_count, "face turned over to agree with its neighbours",
        "faces turned over to agree with their neighbours");
    add(split_edge_count, "non-manifold edge cut", "non-manifold edges cut");
    add(split_vertex_count, "non-manifold vertex doubled", "non-manifold vertices doubled");
    add(triangulated_polygon_count, "polygon cut into triangles", "polygons cut into triangles");
    return lines;
}

}  // namespace fcn
