// Tracing of crest lines (Ohtake, Belyaev, Seidel 2004; Yoshizawa, Belyaev, Seidel 2005, section
// 3). A ridge is where the larger curvature has a maximum along its own direction and is the larger
// in magnitude, too: kappa_max > |kappa_min|, e_max = 0. Ravines are the ridges of the surface
// turned inside out. Between two vertices whose directions have been made to agree the derivative e
// changes its sign; that it is a maximum shows in e pointing from either vertex to the other. The
// crossing is where e, interpolated along the edge, vanishes. In a face with two crossings the line
// runs from one to the other, in a face with three it forks in the middle of them.

#include "features/crest_crossings.h"

#include <algorithm>
#include <cmath>

#include "features/crest_smoothing.h"

namespace fcn {
namespace {

/// One vertex as the kind of crest sees it.
struct Side {
    double kappa, other, e;
    Vec3 direction;
};

class CrestFinder {
public:
    CrestFinder(const MeshArrays& arrays, const std::vector<VertexFit>& fits, bool is_ravine)
        : arrays_(arrays), fits_(fits), is_ravine_(is_ravine) {}

    CrestGraph run() {
        std::vector<int> point_of_edge(arrays_.edge_count(), -1);
        for (int e = 0; e < arrays_.edge_count(); ++e) point_of_edge[e] = cross(e);
        for (int f = 0; f < arrays_.face_count(); ++f) {
            std::array<int, 3> found{};
            int count = 0;
            for (int e : arrays_.face_edges[f]) {
                if (point_of_edge[e] >= 0) found[count++] = point_of_edge[e];
            }
            if (count == 2) add_piece(found[0], found[1], f);
            if (count == 3) fork(found, f);
        }
        return std::move(graph_);
    }

private:
    Side side(int vertex) const {
        const VertexFit& fit = fits_[vertex];
        if (is_ravine_) return {-fit.kappa_min, -fit.kappa_max, -fit.e_min, fit.direction_min};
        return {fit.kappa_max, fit.kappa_min, fit.e_max, fit.direction_max};
    }

    /// The crossing of an edge; -1 none.
    int cross(int edge) {
        const auto [a, b] = arrays_.edge_vertices[edge];
        if (!fits_[a].is_valid || !fits_[b].is_valid) return -1;
        const Side one = side(a);
        Side two = side(b);
        if (!(one.kappa > std::abs(one.other)) || !(two.kappa > std::abs(two.other))) return -1;
        if (one.direction.dot(two.direction) < 0) {
            two.direction = -two.direction;
            two.e = -two.e;
        }
        if (!(one.e * two.e <= 0) || one.e == two.e) return -1;
        const Vec3 along = arrays_.points[b] - arrays_.points[a];
        if (!(one.e * along.dot(one.direction) > 0) && !(two.e * along.dot(two.direction) < 0)) {
            return -1;
        }
        const double t = std::abs(one.e) / (std::abs(one.e) + std::abs(two.e));
        CrestPoint point;
        place_on_edge(arrays_, edge, t, point);
        const auto mix = [&](double x, double y) { return (1 - t) * x + t * y; };
        point.kappa = mix(one.kappa, two.kappa);
        point.kappa_other = mix(one.other, two.other);
        // Interpolated, it would vanish where lines pass through vertices.
        point.cyclideness = 0.5 * (std::hypot(fits_[a].e_max, fits_[a].e_min) +
                                   std::hypot(fits_[b].e_max, fits_[b].e_min));
        point.drop = std::abs(one.e) + std::abs(two.e);
        point.run = std::abs(along.dot((one.direction + two.direction).normalized()));
        point.e_error = mix(fits_[a].e_error, fits_[b].e_error);
        point.radius = mix(fits_[a].radius, fits_[b].radius);
        graph_.points.push_back(point);
        return static_cast<int>(graph_.points.size()) - 1;
    }

    void add_piece(int a, int b, int face) {
        graph_.pieces.push_back({std::min(a, b), std::max(a, b)});
        graph_.piece_faces.push_back(face);
    }

    void fork(const std::array<int, 3>& ends, int face) {
        CrestPoint middle = graph_.points[ends[0]];
        middle.vertex = middle.edge = -1;
        const auto mean = [&](double CrestPoint::*member) {
            double sum = 0;
            for (int end : ends) sum += graph_.points[end].*member / 3;
            return sum;
        };
        for (double CrestPoint::*member :
             {&CrestPoint::kappa, &CrestPoint::kappa_other, &CrestPoint::cyclideness,
              &CrestPoint::drop, &CrestPoint::run, &CrestPoint::e_error, &CrestPoint::radius}) {
            middle.*member = mean(member);
        }
        middle.surface = {face, Vec3::Zero()};
        for (int end : ends) middle.surface.barycentric += on_face(graph_.points[end], face) / 3;
        middle.position = Vec3::Zero();
        for (int i = 0; i < 3; ++i) {
            middle.position +=
                middle.surface.barycentric[i] * arrays_.points[arrays_.face_vertices[face][i]];
        }
        const int index = static_cast<int>(graph_.points.size());
        graph_.points.push_back(middle);
        for (int end : ends) add_piece(end, index, face);
    }

    /// Barycentric coordinates on another face that holds the point.
    Vec3 on_face(const CrestPoint& point, int face) const {
        Vec3 result = Vec3::Zero();
        const auto& own = arrays_.face_vertices[point.surface.face];
        const auto& other = arrays_.face_vertices[face];
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) {
                if (own[i] == other[k]) result[k] = point.surface.barycentric[i];
            }
        }
        return result;
    }

    const MeshArrays& arrays_;
    const std::vector<VertexFit>& fits_;
    bool is_ravine_;
    CrestGraph graph_;
};

}  // namespace

CrestGraph find_crests(const MeshArrays& arrays, const std::vector<VertexFit>& fits,
                       bool is_ravine) {
    return CrestFinder(arrays, fits, is_ravine).run();
}

}  // namespace fcn
