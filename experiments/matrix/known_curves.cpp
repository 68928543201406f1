#include "known_curves.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

#include "features/edge_chains.h"
#include "features/mesh_arrays.h"
#include "features/polyline_tree.h"
#include "features/sharp_edges.h"
#include "geometry/errors.h"
#include "geometry/models.h"

namespace fcn {
namespace {

constexpr double kRequiredAngle = 40 * std::numbers::pi / 180;
constexpr double kAllowedAngle = 18 * std::numbers::pi / 180;
constexpr double kCornerCosine = 0.85;  // of a curve's turning where refinement keeps a corner
constexpr double kTorusRadius = 0.35, kTubeRadius = 0.15;
constexpr int kCircleSamples = 720;

using Edge = std::array<int, 2>;

Edge ordered(int a, int b) { return a < b ? Edge{a, b} : Edge{b, a}; }

KnownPart part_of_mesh(const LoadedMesh& mesh) {
    KnownPart part;
    part.name = mesh.name;
    for (const auto v : mesh.mesh.vertices()) part.points.push_back(mesh.mesh.point(v));
    for (const auto f : mesh.mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh.mesh, f);
        part.triangles.push_back({a.idx(), b.idx(), c.idx()});
    }
    return part;
}

void mark_creases(KnownPart& part, const LoadedMesh& mesh) {
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const double angle = std::abs(arrays.dihedrals[e]);
        if (angle < kAllowedAngle) continue;
        if (angle >= kRequiredAngle || is_isolated(arrays, arrays.dihedrals, e))
            part.curve_edges.push_back(arrays.edge_vertices[e]);
    }
}

FeatureCurveNetwork network_of_edges(const MeshArrays& arrays, const std::vector<Edge>& edges,
                                     double least_angle) {
    std::map<Edge, int> edge_of_vertices;
    for (int e = 0; e < arrays.edge_count(); ++e)
        edge_of_vertices[ordered(arrays.edge_vertices[e][0], arrays.edge_vertices[e][1])] = e;
    std::vector<bool> is_marked(arrays.edge_count(), false);
    for (const auto& [a, b] : edges) {
        const auto found = edge_of_vertices.find(ordered(a, b));
        if (found == edge_of_vertices.end()) throw LogicError("known curves: no such edge");
        if (std::abs(arrays.dihedrals[found->second]) >= least_angle)
            is_marked[found->second] = true;
    }
    return trace_edges(arrays, is_marked, {}, "known").network;
}

/// Calls use(point, length) for short pieces of a network.
template <typename Use>
void for_pieces(const FeatureCurveNetwork& network, double step, Use use) {
    for (const NetworkArc& arc : network.arcs) {
        for (std::size_t i = 1; i < arc.samples.size(); ++i) {
            const Vec3& from = arc.samples[i - 1].position;
            const Vec3 way = arc.samples[i].position - from;
            const int count = std::max(1, static_cast<int>(std::ceil(way.norm() / step)));
            for (int k = 0; k < count; ++k)
                use(Vec3(from + (k + 0.5) / count * way), way.norm() / count);
        }
    }
}

/// Neighbours of each vertex along edges of a kind.
using Neighbors = std::vector<std::vector<int>>;

Vec3 refined_vertex(const KnownPart& part, int v, const std::vector<int>& on_curves,
                    const std::vector<int>& around) {
    const Vec3& p = part.points[v];
    if (on_curves.size() == 2) {
        const Vec3 in = (p - part.points[on_curves[0]]).normalized();
        const Vec3 out = (part.points[on_curves[1]] - p).normalized();
        if (in.dot(out) < kCornerCosine) return p;
        return 0.75 * p + 0.125 * (part.points[on_curves[0]] + part.points[on_curves[1]]);
    }
    if (!on_curves.empty() || around.empty()) return p;
    const auto n = static_cast<double>(around.size());
    const double share = around.size() == 3 ? 3.0 / 16 : 3 / (8 * n);
    Vec3 sum = (1 - n * share) * p;
    for (int w : around) sum += share * part.points[w];
    return sum;
}

}  // namespace

double KnownPart::mean_edge() const {
    double sum = 0;
    for (const auto& t : triangles)
        for (int i = 0; i < 3; ++i) sum += (points[t[i]] - points[t[(i + 1) % 3]]).norm();
    return sum / (3 * static_cast<double>(triangles.size()));
}

KnownPart model_part(const std::string& name, int face_count) {
    ModelOptions options;
    LoadedMesh mesh = make_model(name, options);
    for (int round = 0; round < 3; ++round) {
        options.resolution =
            std::min(0.2, options.resolution *
                              std::sqrt(static_cast<double>(mesh.mesh.n_faces()) / face_count));
        mesh = make_model(name, options);
    }
    KnownPart part = part_of_mesh(mesh);
    mark_creases(part, mesh);
    return part;
}

KnownPart cad_part(const std::filesystem::path& mesh_file) {
    const LoadedMesh mesh = read_mesh(mesh_file);
    KnownPart part = part_of_mesh(mesh);
    std::filesystem::path file = mesh_file;
    file.replace_extension(".cadedges.txt");
    if (!std::filesystem::exists(file)) {
        mark_creases(part, mesh);
        return part;
    }
    std::ifstream in(file);
    if (!in || !mesh.repairs.is_clean())
        throw InputError(file.string() + ": cannot be read, or the mesh needs repair");
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        if (line.empty() || line[0] == '#') continue;
        int a = -1, b = -1;
        const int count = static_cast<int>(part.points.size());
        if (!(std::istringstream(line) >> a >> b) || std::min(a, b) < 0 || std::max(a, b) >= count)
            throw InputError(file.string() + ":" + std::to_string(number) +
                             ": no pair of vertices");
        part.curve_edges.push_back({a, b});
    }
    return part;
}

KnownPart refined(const KnownPart& part) {
    const std::size_t count = part.points.size();
    std::map<Edge, std::array<int, 3>> edges;  // opposite vertices, then the new vertex
    for (const auto& t : part.triangles) {
        for (int i = 0; i < 3; ++i) {
            const Edge edge = ordered(t[i], t[(i + 1) % 3]);
            auto& entry = edges.try_emplace(edge, std::array{-1, -1, -1}).first->second;
            entry[entry[0] < 0 ? 0 : 1] = t[(i + 2) % 3];
        }
    }
    std::map<Edge, bool> is_curve;
    for (const auto& [a, b] : part.curve_edges) is_curve[ordered(a, b)] = true;
    for (const auto& [edge, entry] : edges)
        if (entry[1] < 0) is_curve.try_emplace(edge, false);
    Neighbors around(count), on_curves(count);
    KnownPart result;
    result.name = part.name;
    for (const auto& [edge, entry] : edges) {
        const bool is_kept = is_curve.contains(edge);
        for (int i = 0; i < 2; ++i) {
            around[edge[i]].push_back(edge[1 - i]);
            if (is_kept) on_curves[edge[i]].push_back(edge[1 - i]);
        }
    }
    for (std::size_t v = 0; v < count; ++v)
        result.points.push_back(refined_vertex(part, static_cast<int>(v), on_curves[v], around[v]));
    for (auto& [edge, entry] : edges) {
        const Vec3 ends = part.points[edge[0]] + part.points[edge[1]];
        const auto curve = is_curve.find(edge);
        const bool is_kept = curve != is_curve.end();
        entry[2] = static_cast<int>(result.points.size());
        result.points.push_back(
            is_kept ? Vec3(0.5 * ends)
                    : Vec3(0.375 * ends + 0.125 * (part.points[entry[0]] + part.points[entry[1]])));
        if (is_kept && curve->second)
            for (int v : edge) result.curve_edges.push_back({v, entry[2]});
    }
    for (const auto& t : part.triangles) {
        std::array<int, 3> middle{};
        for (int i = 0; i < 3; ++i) middle[i] = edges[ordered(t[i], t[(i + 1) % 3])][2];
        for (int i = 0; i < 3; ++i)
            result.triangles.push_back({t[i], middle[i], middle[(i + 2) % 3]});
        result.triangles.push_back(middle);
    }
    return result;
}

LoadedMesh noisy_mesh(const KnownPart& part, double noise, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&] { return (static_cast<double>(engine() >> 11) + 0.5) * 0x1p-53; };
    const double deviation = noise * part.mean_edge();
    std::vector<Vec3> points = part.points;
    for (Vec3& p : points) {
        for (int i = 0; i < 3 && noise > 0; ++i) {
            const double radius = std::sqrt(-2 * std::log(uniform()));
            p[i] += deviation * radius * std::cos(2 * std::numbers::pi * uniform());
        }
    }
    LoadedMesh mesh = mesh_from_soup(points, part.triangles);
    mesh.name = part.name;
    return mesh;
}

KnownCurves known_curves(const KnownPart& part) {
    const LoadedMesh mesh = noisy_mesh(part, 0, 1);
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    return {network_of_edges(arrays, part.curve_edges, kRequiredAngle),
            network_of_edges(arrays, part.curve_edges, 0)};
}

KnownCurves crest_circles() {
    KnownCurves known;
    const double offset = kTubeRadius * std::pow(2, -0.25);
    for (int circle = 0; circle < 4; ++circle) {
        const double radius = kTorusRadius + (circle % 2 == 0 ? offset : -offset);
        NetworkArc arc;
        for (int i = 0; i <= kCircleSamples; ++i) {
            const double turn = 2 * std::numbers::pi * (i % kCircleSamples) / kCircleSamples;
            arc.samples.emplace_back().position = Vec3(
                radius * std::cos(turn), radius * std::sin(turn), circle < 2 ? offset : -offset);
        }
        known.required.arcs.push_back(std::move(arc));
    }
    known.allowed = known.required;
    return known;
}

double share_near(const FeatureCurveNetwork& network, const FeatureCurveNetwork& other,
                  double tolerance) {
    const PolylineTree tree(other);
    double length = 0, near = 0;
    for_pieces(network, 0.25 * tolerance, [&](const Vec3& at, double piece) {
        length += piece;
        if (tree.closest(at, tolerance).arc >= 0) near += piece;
    });
    return length > 0 ? near / length : 1;
}

CurveScore score(const FeatureCurveNetwork& found, const KnownCurves& known, double tolerance) {
    CurveScore result;
    result.curve_count = found.arcs.size();
    result.length = found.total_length();
    result.precision = share_near(found, known.allowed, tolerance);
    result.recall = share_near(known.required, found, tolerance);
    return result;
}

}  // namespace fcn
