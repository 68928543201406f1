// Smoothing of quads one vertex at a time, each seeing where the ones before it went. The first
// proposal is the centre of the neighbours (Laplace), which evens out lengths; where it does not
// help, a step down the slope of the energy follows. The energy is the sum over the corners of the
// quads around the vertex of (a^2 + b^2) / (2 a b sine) for the two edges a, b of the corner, the
// inverse mean ratio of Knupp 2001, "Algebraic mesh quality metrics": 1 for a square's corner,
// large for one that is nearly flat. Inverted corners have a finite energy above that of all others
// which grows with how far they are turned over, so that the same steps untangle. Quads that face
// away from the surface are turned over as a whole: their own area vectors do not tell. Proposals
// end on the surface or on the vertex's curve before they are judged; what is not on its curve yet
// may get worse to reach it, as long as no corner turns over.
#include "meshing/quad_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshing/quad_shape.h"

namespace fcn {
namespace {

constexpr double kFlatSine = 0.02;  ///< corners below count as nearly inverted
constexpr double kBehind = -0.1;    ///< cosine to the surface's normal below which quads face back
constexpr double kReach = 2;        ///< in h: farther the surface is not looked for
constexpr double kRest = 1e-3;      ///< in h: shorter moves are none
constexpr int kMaxHalvings = 4;
constexpr double kSlopeStep = 1e-4;   ///< in h, for differences
constexpr double kLongestStep = 0.3;  ///< in h, down the slope

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Energy of one corner with sine s and edges of length a, b.
double corner_energy(double s, double a, double b) {
    constexpr double kInverted = 1e3;
    if (s < kFlatSine) return kInverted * (1 + kFlatSine - s);
    return std::min(kInverted, (a * a + b * b) / (2 * a * b * s));
}

class Smoother {
public:
    Smoother(QuadMesh& mesh, const QuadConstraints& constraints, const ReferenceSurface& reference,
             const QuadSmoothingOptions& options)
        : mesh_(mesh), constraints_(constraints), reference_(reference), options_(options) {
        begin_.assign(mesh.points.size() + 1, 0);
        for (const auto& face : mesh.faces)
            for (const int v : face) ++begin_[at(v) + 1];
        for (std::size_t v = 0; v < mesh.points.size(); ++v) begin_[v + 1] += begin_[v];
        corners_.resize(4 * mesh.faces.size());
        std::vector<int> next(begin_.begin(), begin_.end() - 1);
        for (int c = 0; c < static_cast<int>(corners_.size()); ++c)
            corners_[at(next[at(vertex(c))]++)] = c;
        place_.assign(mesh.points.size(), -1);
        is_on_curve_.assign(mesh.points.size(), true);
        for (int v = 0; v < vertex_count(); ++v)
            if (curve(v) >= 0) is_on_curve_[at(v)] = is_near(on_curve(v, point(v)), point(v));
    }

    int run() {
        for (int round = 0; round < options_.rounds; ++round) {
            bool is_moved = false;
            for (int v = 0; v < vertex_count(); ++v)
                if (curve(v) != QuadConstraints::kFixed) is_moved = move(v) || is_moved;
            if (!is_moved) break;
        }
        return static_cast<int>(std::count(is_on_curve_.begin(), is_on_curve_.end(), false));
    }

private:
    struct Judgement {
        double energy = 0;
        double worst = 1;  ///< sine
    };

    int vertex_count() const { return static_cast<int>(mesh_.points.size()); }
    int vertex(int corner) const { return mesh_.faces[at(corner / 4)][at(corner % 4)]; }
    const Vec3& point(int v) const { return mesh_.points[at(v)]; }
    int curve(int v) const { return constraints_.curve[at(v)]; }
    Vec3 on_curve(int v, const Vec3& p) const {
        return closest_on_polyline(constraints_.curves[at(curve(v))], p);
    }
    bool is_near(const Vec3& a, const Vec3& b) const {
        return (a - b).norm() <= 1e-6 * options_.edge_length;
    }

    QuadCorners quad_with(int corner, const Vec3& p) const {
        QuadCorners quad;
        for (std::size_t i = 0; i < 4; ++i) quad[i] = point(mesh_.faces[at(corner / 4)][i]);
        quad[at(corner % 4)] = p;
        return quad;
    }

    /// `outward`: quads that face the other way count as turned over; zero: unknown.
    Judgement judge(int v, const Vec3& p, const Vec3& outward) const {
        Judgement result;
        for (int k = begin_[at(v)]; k < begin_[at(v) + 1]; ++k) {
            const QuadCorners quad = quad_with(corners_[at(k)], p);
            const Vec3 area = area_vector(quad);
            const double norm = area.norm();
            const double side = area.dot(outward) < kBehind * norm ? -1 : 1;
            const auto sines =
                corner_sines(quad, norm > 0 ? Vec3(side / norm * area) : Vec3::Zero());
            for (std::size_t i = 0; i < 4; ++i) {
                const double a = (quad[(i + 1) % 4] - quad[i]).norm();
                const double b = (quad[(i + 3) % 4] - quad[i]).norm();
                result.energy += corner_energy(sines[i], a, b);
                result.worst = std::min(result.worst, sines[i]);
            }
        }
        return result;
    }

    /// Centre of the neighbours, and the direction of the sum of the area vectors.
    std::pair<Vec3, Vec3> centre_and_normal(int v) const {
        Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
        for (int k = begin_[at(v)]; k < begin_[at(v) + 1]; ++k) {
            const QuadCorners quad = quad_with(corners_[at(k)], point(v));
            const std::size_t i = at(corners_[at(k)] % 4);
            centre += 0.5 * (quad[(i + 1) % 4] + quad[(i + 3) % 4]);
            normal += area_vector(quad);
        }
        const double norm = normal.norm();
        return {centre / (begin_[at(v) + 1] - begin_[at(v)]),
                norm > 0 ? Vec3(normal / norm) : normal};
    }

    /// The nearest point where the vertex may be; false: none within reach.
    bool land(int v, const Vec3& normal, Vec3& p, int& place) const {
        if (curve(v) >= 0) {
            p = on_curve(v, p);
            return true;
        }
        const ReferencePoint there =
            reference_.closest(p, normal, kReach * options_.edge_length, place_[at(v)]);
        if (there.face < 0) return false;
        p = there.position;
        place = there.face;
        return true;
    }

    /// Of the surface where a free vertex is, zero for others: curves run along creases.
    Vec3 outward(int v) const {
        return curve(v) == QuadConstraints::kFree && place_[at(v)] >= 0
                   ? reference_.normal(place_[at(v)])
                   : Vec3::Zero();
    }

    /// Whether a move takes a free vertex farther from its home than it may be.
    bool is_off_leash(int v, const Vec3& p) const {
        if (constraints_.home.empty() || curve(v) != QuadConstraints::kFree) return false;
        const Vec3& home = constraints_.home[at(v)];
        const double distance = (p - home).norm();
        return distance > constraints_.leash[at(v)] && distance > (point(v) - home).norm();
    }

    bool try_move(int v, const Vec3& normal, Vec3 p, const Judgement& before, bool may_worsen) {
        int place = -1;
        if (!land(v, normal, p, place) || is_off_leash(v, p)) return false;
        const Judgement after =
            judge(v, p, place >= 0 ? reference_.normal(place) : Vec3(Vec3::Zero()));
        if (after.worst < std::min(before.worst, options_.least_sine)) return false;
        if (!may_worsen && after.energy >= before.energy * (1 - 1e-6)) return false;
        const bool is_far = !is_near(p, point(v));
        mesh_.points[at(v)] = p;
        place_[at(v)] = place;
        is_on_curve_[at(v)] = true;
        return is_far;
    }

    bool move(int v) {
        const auto [centre, normal] = centre_and_normal(v);
        if (!is_on_curve_[at(v)] && draw_to_curve(v)) return true;
        const Judgement before = judge(v, point(v), outward(v));
        // The first time a free vertex is seen it comes to the surface, whatever that costs.
        const bool is_afloat = curve(v) == QuadConstraints::kFree && place_[at(v)] < 0;
        Vec3 step = centre - point(v);
        step -= normal.dot(step) * normal;
        for (int halving = 0; halving <= kMaxHalvings; ++halving, step *= 0.5)
            if (step.norm() > kRest * options_.edge_length &&
                try_move(v, normal, point(v) + step, before, false))
                return true;
        if (is_afloat && try_move(v, normal, point(v), before, true)) return true;
        return descend(v, normal, before);
    }

    /// As far towards its curve as no corner turns over.
    bool draw_to_curve(int v) {
        const Vec3 from = point(v), to = on_curve(v, from);
        const double before = judge(v, from, Vec3::Zero()).worst;
        double share = 1;
        for (int halving = 0; halving <= kMaxHalvings; ++halving, share *= 0.5) {
            const Vec3 p = from + share * (to - from);
            const double worst = judge(v, p, Vec3::Zero()).worst;
            if (worst < std::min(before, kFlatSine)) continue;
            mesh_.points[at(v)] = p;
            is_on_curve_[at(v)] = share == 1;
            return true;
        }
        return false;
    }

    bool descend(int v, const Vec3& normal, const Judgement& before) {
        const double h = options_.edge_length;
        const Vec3 axis = normal.unitOrthogonal(), other = normal.cross(axis);
        const Vec3 facing = outward(v);
        Vec3 slope = Vec3::Zero();
        for (const Vec3& d : {axis, other}) {
            const double ahead = judge(v, point(v) + kSlopeStep * h * d, facing).energy;
            const double behind = judge(v, point(v) - kSlopeStep * h * d, facing).energy;
            slope += (ahead - behind) * d;
        }
        const double norm = slope.norm();
        if (!(norm > 0)) return false;
        Vec3 step = -kLongestStep * h / norm * slope;
        for (; step.norm() > 0.01 * h; step *= 0.5)
            if (try_move(v, normal, point(v) + step, before, false)) return true;
        return false;
    }

    QuadMesh& mesh_;
    const QuadConstraints& constraints_;
    const ReferenceSurface& reference_;
    const QuadSmoothingOptions& options_;
    std::vector<int> begin_, corners_;  ///< corners 4 f + i of each vertex
    std::vector<int> place_;            ///< face of the reference near the vertex, -1: unknown
    std::vector<bool> is_on_curve_;
};

}  // namespace

Vec3 closest_on_polyline(const std::vector<Vec3>& polyline, const Vec3& point) {
    Vec3 best = polyline.front();
    double least = (best - point).squaredNorm();
    for (std::size_t i = 1; i < polyline.size(); ++i) {
        const Vec3 along = polyline[i] - polyline[i - 1];
        const double square = along.squaredNorm();
        const double t =
            square > 0 ? std::clamp(along.dot(point - polyline[i - 1]) / square, 0.0, 1.0) : 0;
        const Vec3 near = polyline[i - 1] + t * along;
        const double distance = (near - point).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        best = near;
    }
    return best;
}

int count_inverted_corners(const QuadMesh& mesh) {
    int count = 0;
    for (const auto& face : mesh.faces) {
        QuadCorners quad;
        for (std::size_t i = 0; i < 4; ++i) quad[i] = mesh.points[at(face[i])];
        const Vec3 area = area_vector(quad);
        const double norm = area.norm();
        for (const double sine : corner_sines(quad, norm > 0 ? Vec3(area / norm) : Vec3::Zero()))
            count += sine <= 0;
    }
    return count;
}

QuadSmoothingResult smooth_quads(QuadMesh& mesh, const QuadConstraints& constraints,
                                 const ReferenceSurface& reference,
                                 const QuadSmoothingOptions& options) {
    QuadSmoothingResult result;
    result.inverted_before = count_inverted_corners(mesh);
    result.off_curve = Smoother(mesh, constraints, reference, options).run();
    result.inverted_after = count_inverted_corners(mesh);
    return result;
}

}  // namespace fcn
