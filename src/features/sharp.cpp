// Sharp edges by hysteresis on the dihedral angle: an edge above the high angle seeds a chain,
// edges above the low angle continue it (the two thresholds of Canny's edge detector, on mesh
// edges). A weak edge continues a chain where no comparable edge runs beside it: facets of coarsely
// meshed holes and fillets are no creases, though they may meet one. On noisy edges that are not
// quite weak, beside which anything may run, it is enough to go on in about the same direction.
//
// The angles are those of robust_dihedrals, which noise does not pass for creases; what noise does
// to chains all the same is undone by mend_chains.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "features/edge_chains.h"
#include "features/mend_chains.h"
#include "features/rounded_edges.h"
#include "features/sharp_edges.h"
#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr double kContinuingCosine = 0.5;  // a chain turns by up to 60 degrees
constexpr int kSupportedEdges = 7;         // fewer may be noise if they end inside the surface
constexpr int kLeastEdges = 3;             // fewer are
constexpr double kSomeNoise = 0.4;         // of what makes a place noisy

/// Does `next` go on from `edge` beyond their common vertex without turning much?
bool is_continuing(const MeshArrays& arrays, int edge, int next, int vertex) {
    const auto away = [&](int e) {
        const auto [from, to] = arrays.edge_vertices[e];
        const Vec3 direction = arrays.points[to] - arrays.points[from];
        return Vec3((from == vertex ? direction : Vec3(-direction)).normalized());
    };
    return -away(edge).dot(away(next)) >= kContinuingCosine;
}

bool has_sign(double angle, SharpSign sign) {
    return sign == SharpSign::Both || (sign == SharpSign::Convex) == (angle > 0);
}

/// Seeds and what continues them.
std::vector<bool> grow_chains(const MeshArrays& arrays, const RobustDihedrals& dihedrals,
                              const SharpOptions& options) {
    const std::vector<double>& angles = dihedrals.angles;
    std::vector<bool> is_candidate(arrays.edge_count()), is_sharp(arrays.edge_count(), false);
    std::vector<int> queue;
    for (int e = 0; e < arrays.edge_count(); ++e) {
        is_candidate[e] =
            std::abs(angles[e]) >= options.low_angle && has_sign(angles[e], options.sign);
        if (!is_candidate[e] || std::abs(angles[e]) < options.high_angle) continue;
        is_sharp[e] = true;
        queue.push_back(e);
    }
    const double middle = (2 * options.low_angle + options.high_angle) / 3;
    const IndexRows at_vertex = edges_of_vertices(arrays, is_candidate);
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const int edge = queue[i];
        for (int v : arrays.edge_vertices[edge]) {
            for (const int* e = at_vertex.begin(v); e != at_vertex.end(v); ++e) {
                if (is_sharp[*e] || angles[*e] * angles[edge] < 0) continue;
                const bool is_straight = dihedrals.is_noisy_edge[*e] &&
                                         std::abs(angles[*e]) >= middle &&
                                         is_continuing(arrays, edge, *e, v);
                if (!is_straight && !is_isolated(arrays, angles, *e)) continue;
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
            is_crumb =
                (is_short && is_open) ||
                ((is_short || is_open) &&
                 is_noisy_place(arrays, arrays.edge_faces[chain[edge_count / 2]][0], kSomeNoise));
        }
        if (length >= min_length && edge_count >= min_edge_count && !is_crumb) continue;
        for (int e : chain) is_sharp[e] = false;
    }
}

}  // namespace

std::vector<bool> sharp_edges(const MeshArrays& arrays, const RobustDihedrals& dihedrals,
                              const SharpOptions& options, int min_edge_count) {
    std::vector<bool> is_sharp = grow_chains(arrays, dihedrals, options);
    mend_chains(arrays, dihedrals, options.high_angle, is_sharp);
    drop_rounded_edges(arrays, dihedrals, options.high_angle, is_sharp);
    drop_short_chains(arrays, dihedrals.angles, options.min_length, min_edge_count, is_sharp);
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
    if (options.is_plain) {
        FeatureCurveNetwork network =
            trace_edges(arrays, edges_above(mesh.mesh, options.high_angle), {}, "sharp").network;
        set_provenance(network, mesh);
        return network;
    }
    const RobustDihedrals angles = robust_dihedrals(arrays, options.low_angle);
    const EdgeNetwork edges =
        trace_edges(arrays, sharp_edges(arrays, angles, options), {}, "sharp");
    FeatureCurveNetwork network = straighten_noisy(arrays, angles, edges);
    set_provenance(network, mesh);
    return network;
}

}  // namespace fcn
