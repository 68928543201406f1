// Tips that quads miss. A quad mesh that is smooth on a horn ends below its tip, and nothing in the
// shape of quads pulls it up. So the farthest points of the surface, one within a quad's length,
// take a free vertex of the quad nearest to them each, and what is around it is smoothed.
#include "meshing/quad_tips.h"

#include <algorithm>

#include "meshing/quad_faults.h"
#include "meshing/quad_shape.h"

namespace fcn {
namespace {

constexpr double kSpacing = 0.7;  ///< in h: between points that are reached for in one round
constexpr int kMovedRings = 2;    ///< around a vertex that reaches
constexpr int kRounds = 5, kLocalRounds = 10;
constexpr double kGain = 0.1;  ///< in h: by which a point comes nearer at least

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class TipReacher {
public:
    TipReacher(QuadMesh& mesh, const QuadConstraints& constraints, const std::vector<Vec3>& samples,
               const ReferenceSurface& reference, const QuadFitOptions& options)
        : mesh_(mesh),
          constraints_(constraints),
          samples_(samples),
          reference_(reference),
          options_(options) {}

    int run() {
        int moved = 0;
        for (int round = 0; round < kRounds; ++round) {
            std::vector<Vec3> tried;
            const int before = moved;
            for (const FarPoint& point :
                 far_points(mesh_, samples_, reference_, options_.tolerance * h())) {
                if (std::any_of(tried.begin(), tried.end(), [&](const Vec3& other) {
                        return (other - point.position).norm() < kSpacing * h();
                    }))
                    continue;
                tried.push_back(point.position);
                moved += reach(point);
            }
            if (moved == before) break;
        }
        return moved;
    }

private:
    double h() const { return options_.smoothing.edge_length; }

    bool reach(const FarPoint& point) {
        std::vector<int> candidates;
        for (const int v : mesh_.faces[at(point.quad)])
            if (constraints_.curve[at(v)] == QuadConstraints::kFree) candidates.push_back(v);
        std::stable_sort(candidates.begin(), candidates.end(), [&](int a, int b) {
            return (mesh_.points[at(a)] - point.position).norm() <
                   (mesh_.points[at(b)] - point.position).norm();
        });
        return std::any_of(candidates.begin(), candidates.end(),
                           [&](int v) { return try_vertex(v, point); });
    }

    bool try_vertex(int v, const FarPoint& point) {
        std::vector<bool> is_near(mesh_.points.size(), false);
        is_near[at(v)] = true;
        std::vector<int> faces;
        for (int ring = 0; ring <= kMovedRings; ++ring) {
            const std::vector<bool> before = is_near;
            faces.clear();
            for (int f = 0; f < static_cast<int>(mesh_.faces.size()); ++f) {
                const auto& face = mesh_.faces[at(f)];
                if (std::none_of(face.begin(), face.end(), [&](int w) { return before[at(w)]; }))
                    continue;
                faces.push_back(f);
                if (ring < kMovedRings)
                    for (const int w : face) is_near[at(w)] = true;
            }
        }
        QuadConstraints local = constraints_;
        for (std::size_t w = 0; w < is_near.size(); ++w)
            if (!is_near[w]) local.curve[w] = QuadConstraints::kFixed;
        local.curve[at(v)] = QuadConstraints::kFixed;
        const std::vector<Vec3> before = mesh_.points;
        const double worst = worst_of(faces);
        const double far = distance_of(faces, point.position);
        mesh_.points[at(v)] = point.position;
        QuadSmoothingOptions smoothing = options_.smoothing;
        smoothing.rounds = kLocalRounds;
        smooth_quads(mesh_, local, reference_, smoothing);
        if (worst_of(faces) >= std::min(worst, options_.least_jacobian) &&
            distance_of(faces, point.position) < far - kGain * h()) {
            constraints_.curve[at(v)] = QuadConstraints::kFixed;
            return true;
        }
        mesh_.points = before;
        return false;
    }

    double worst_of(const std::vector<int>& faces) const {
        double worst = 1;
        for (const int f : faces) {
            QuadCorners quad;
            for (std::size_t i = 0; i < 4; ++i) quad[i] = mesh_.points[at(mesh_.faces[at(f)][i])];
            worst = std::min(worst, scaled_jacobian(quad));
        }
        return worst;
    }

    /// The farthest sample around `place` from these faces.
    double distance_of(const std::vector<int>& faces, const Vec3& place) const {
        QuadMesh part;
        part.points = mesh_.points;
        for (const int f : faces) part.faces.push_back(mesh_.faces[at(f)]);
        std::vector<Vec3> near;
        for (const Vec3& sample : samples_)
            if ((sample - place).norm() < 1.5 * h()) near.push_back(sample);
        const std::vector<FarPoint> far = far_points(part, near, reference_, 0);
        return far.empty() ? 0 : far.front().distance;
    }

    QuadMesh& mesh_;
    QuadConstraints constraints_;
    const std::vector<Vec3>& samples_;
    const ReferenceSurface& reference_;
    const QuadFitOptions& options_;
};

}  // namespace

int reach_tips(QuadMesh& mesh, const QuadConstraints& constraints, const std::vector<Vec3>& samples,
               const ReferenceSurface& reference, const QuadFitOptions& options) {
    return TipReacher(mesh, constraints, samples, reference, options).run();
}

}  // namespace fcn
