// Tips that quads miss. A quad mesh that is smooth on a horn ends below its tip, and nothing in the
// shape of quads pulls it up; the distance to the surface is large there although every vertex lies
// on it. So the farthest points of the surface, one within a quad's length, take the nearest free
// vertex, and smoothing leaves it there.
#include "meshing/quad_tips.h"

#include <algorithm>
#include <array>

#include "meshing/quad_shape.h"

namespace fcn {
namespace {

constexpr double kSpacing = 1;  ///< in h: between points that are reached for
constexpr double kReach = 2;    ///< in h: of a vertex that is moved

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct FarPoint {
    double distance = 0;
    Vec3 position = Vec3::Zero();
};

std::vector<FarPoint> far_points(const QuadMesh& mesh, const Mesh& surface, double least,
                                 double spacing) {
    std::vector<std::array<Vec3, 3>> corners;
    for (const auto& triangle : cut_into_triangles(mesh))
        corners.push_back({mesh.points[at(triangle[0])], mesh.points[at(triangle[1])],
                           mesh.points[at(triangle[2])]});
    const ReferenceSurface quads(corners);
    std::vector<FarPoint> all;
    int hint = -1;
    for (const VertexHandle v : surface.vertices()) {
        const ReferencePoint near =
            quads.closest(surface.point(v), Vec3::Zero(), 100 * least, hint);
        hint = near.face;
        if (near.face >= 0 && near.distance > least)
            all.push_back({near.distance, surface.point(v)});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const FarPoint& a, const FarPoint& b) { return a.distance > b.distance; });
    std::vector<FarPoint> chosen;
    for (const FarPoint& point : all)
        if (std::none_of(chosen.begin(), chosen.end(), [&](const FarPoint& other) {
                return (other.position - point.position).norm() < spacing;
            }))
            chosen.push_back(point);
    return chosen;
}

}  // namespace

std::vector<bool> vertices_of_bad_quads(const QuadMesh& mesh, double least_jacobian) {
    std::vector<bool> is_bad(mesh.points.size(), false);
    for (const auto& face : mesh.faces) {
        QuadCorners quad;
        for (std::size_t i = 0; i < 4; ++i) quad[i] = mesh.points[at(face[i])];
        if (scaled_jacobian(quad) >= least_jacobian) continue;
        for (const int v : face) is_bad[at(v)] = true;
    }
    return is_bad;
}

int reach_tips(QuadMesh& mesh, const QuadConstraints& constraints, const Mesh& surface,
               const ReferenceSurface& reference, const QuadTipOptions& options) {
    const double h = options.smoothing.edge_length;
    QuadConstraints pinned = constraints;
    int moved = 0;
    for (int round = 0; round < options.rounds; ++round) {
        const std::vector<bool> was_bad = vertices_of_bad_quads(mesh, options.least_jacobian);
        std::vector<int> pins;
        QuadMesh trial = mesh;
        for (const FarPoint& point : far_points(mesh, surface, options.far * h, kSpacing * h)) {
            int best = -1;
            double least = kReach * h;
            for (int v = 0; v < static_cast<int>(mesh.points.size()); ++v) {
                const double distance = (mesh.points[at(v)] - point.position).norm();
                if (pinned.curve[at(v)] != QuadConstraints::kFree || distance >= least) continue;
                least = distance;
                best = v;
            }
            if (best < 0) continue;
            pinned.curve[at(best)] = QuadConstraints::kFixed;
            trial.points[at(best)] = point.position;
            pins.push_back(best);
        }
        if (pins.empty()) break;
        smooth_quads(trial, pinned, reference, options.smoothing);
        const std::vector<bool> is_bad = vertices_of_bad_quads(trial, options.least_jacobian);
        bool is_worse = false;
        for (std::size_t v = 0; v < is_bad.size(); ++v)
            is_worse = is_worse || (is_bad[v] && !was_bad[v]);
        if (!is_worse) {
            mesh = std::move(trial);
            moved += static_cast<int>(pins.size());
            continue;
        }
        // Those that did no harm come again in the next round, the others never.
        for (const int v : pins)
            pinned.curve[at(v)] = is_bad[at(v)] ? QuadConstraints::kFixed : QuadConstraints::kFree;
    }
    return moved;
}

}  // namespace fcn
