// Smoothing slides quads down from horns and ears, although every vertex stays on the surface,
// since nothing in the shape of quads holds them there. The map has spread the vertices over all of
// the surface, so each free one is on a leash to where the map put it. Leashes get longer around
// quads that are bad, which have to move to be mended, and shorter where the surface is lost.
#include "meshing/quad_fitting.h"

#include <algorithm>

#include "meshing/quad_faults.h"
#include "meshing/quad_shape.h"

namespace fcn {
namespace {

constexpr double kLongestLeash = 4;  ///< in h
constexpr int kReleasedRings = 2, kHeldRings = 1;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void grow(const QuadMesh& mesh, int rings, std::vector<bool>& is_in) {
    for (int ring = 0; ring < rings; ++ring) {
        const std::vector<bool> before = is_in;
        for (const auto& face : mesh.faces)
            if (std::any_of(face.begin(), face.end(), [&](int v) { return before[at(v)]; }))
                for (const int v : face) is_in[at(v)] = true;
    }
}

class Fitter {
public:
    Fitter(QuadMesh& mesh, const QuadConstraints& constraints, const std::vector<Vec3>& samples,
           const ReferenceSurface& reference, const QuadFitOptions& options)
        : mesh_(mesh),
          constraints_(constraints),
          samples_(samples),
          reference_(reference),
          options_(options) {
        constraints_.home = mesh.points;
        constraints_.leash.assign(mesh.points.size(), options.leash * h());
    }

    int run() {
        const std::vector<Vec3> start = mesh_.points;
        State best;
        for (int round = 0;; ++round) {
            smooth_quads(mesh_, constraints_, reference_, options_.smoothing);
            const State state = judge();
            if (round == 0 || state.is_better_than(best)) best = state;
            if (round == options_.rounds || (state.bad == 0 && state.far.empty())) break;
            change_leashes(state);
        }
        if (best.inverted > 0) {
            mesh_.points = start;
            constraints_.leash.assign(start.size(), kLongestLeash * h());
            smooth_quads(mesh_, constraints_, reference_, options_.smoothing);
            const State state = judge();
            if (state.is_better_than(best)) best = state;
        }
        mesh_.points = std::move(best.points);
        return best.inverted;
    }

private:
    struct State {
        std::vector<Vec3> points;
        std::vector<FarPoint> far;
        int inverted = 0, bad = 0;
        double distance = 0;  ///< over the tolerance
        bool is_better_than(const State& other) const {
            if (inverted != other.inverted) return inverted < other.inverted;
            return distance + 0.05 * bad < other.distance + 0.05 * other.bad;
        }
    };

    double h() const { return options_.smoothing.edge_length; }

    State judge() const {
        State state;
        state.points = mesh_.points;
        state.inverted = count_inverted_corners(mesh_);
        for (const bool is_bad : vertices_of_bad_quads(mesh_, options_.least_jacobian))
            state.bad += is_bad;
        state.far = far_points(mesh_, samples_, reference_, options_.tolerance * h());
        if (!state.far.empty()) state.distance = state.far.front().distance / h();
        return state;
    }

    void change_leashes(const State& state) {
        std::vector<bool> is_released = vertices_of_bad_quads(mesh_, options_.least_jacobian);
        grow(mesh_, kReleasedRings, is_released);
        std::vector<bool> is_held(mesh_.points.size(), false);
        for (const FarPoint& point : state.far)
            for (const int v : mesh_.faces[at(point.quad)]) is_held[at(v)] = true;
        grow(mesh_, kHeldRings, is_held);
        for (std::size_t v = 0; v < is_held.size(); ++v) {
            double& leash = constraints_.leash[v];
            if (is_released[v]) {
                leash = std::min(2 * leash, kLongestLeash * h());
            } else if (is_held[v]) {
                leash /= 2;
                pull_home(v);
            }
        }
    }

    /// Back to the leash's end, on the surface.
    void pull_home(std::size_t v) {
        if (constraints_.curve[v] != QuadConstraints::kFree) return;
        const Vec3 away = mesh_.points[v] - constraints_.home[v];
        const double distance = away.norm();
        if (distance <= constraints_.leash[v]) return;
        const Vec3 end = constraints_.home[v] + constraints_.leash[v] / distance * away;
        const ReferencePoint near = reference_.closest(end, Vec3::Zero(), h(), -1);
        if (near.face >= 0) mesh_.points[v] = near.position;
    }

    QuadMesh& mesh_;
    QuadConstraints constraints_;
    const std::vector<Vec3>& samples_;
    const ReferenceSurface& reference_;
    const QuadFitOptions& options_;
};

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

int fit_quads(QuadMesh& mesh, const QuadConstraints& constraints, const std::vector<Vec3>& samples,
              const ReferenceSurface& reference, const QuadFitOptions& options) {
    return Fitter(mesh, constraints, samples, reference, options).run();
}

}  // namespace fcn
