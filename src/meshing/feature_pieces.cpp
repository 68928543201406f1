// What of a network becomes an edge of the mesh. A segment of a network adapted to rmin = L / 1.2
// lies in [0.8 L, 4/3 L] (ratio up to 5/3), the interval in which incremental remeshing (Botsch,
// Kobbelt 2004) neither splits nor collapses, so a segment is an edge; only the allowed long ones
// are cut. An initial network has no segments; its arcs are cut as evenly as L allows, which is
// what a mesher does with curves it is told to keep.
#include "meshing/feature_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/errors.h"

namespace fcn {
namespace {

class PieceCutter {
public:
    PieceCutter(const FeatureCurveNetwork& network, double edge_length, const Mesh& mesh,
                const ReferenceSurface& reference)
        : network_(network), edge_length_(edge_length), mesh_(mesh), reference_(reference) {
        tolerance_ = 1e-6 * bounding_box(mesh).diagonal();
    }

    FeaturePieces cut() {
        for (const NetworkNode& node : network_.nodes)
            result_.stations.push_back(
                {node.position, on_surface(node.position, node.surface), false});
        if (network_.segments.empty()) {
            for (std::size_t arc = 0; arc < network_.arcs.size(); ++arc) cut_arc(arc);
        } else {
            for (std::size_t i = 0; i < network_.segments.size(); ++i) cut_segment(i);
        }
        for (const FeaturePiece& piece : result_.pieces)
            for (const int end : {piece.from, piece.to})
                result_.stations[static_cast<std::size_t>(end)].is_used = true;
        return std::move(result_);
    }

private:
    void cut_arc(std::size_t index) {
        const NetworkArc& arc = network_.arcs[index];
        check_nodes(arc.nodes, "arc", index);
        if (arc.samples.size() < 2)
            throw InputError("network: arc " + std::to_string(index) +
                             " has fewer than two samples");
        const int fewest = arc.is_closed() ? 3 : 1;
        const int count = std::max(
            fewest, static_cast<int>(std::min(1e6, std::round(arc.length() / edge_length_))));
        cut_samples(arc, 0, arc.samples.size() - 1, arc.nodes, count, -1, static_cast<int>(index));
    }

    void cut_segment(std::size_t index) {
        const NetworkSegment& segment = network_.segments[index];
        check_nodes(segment.nodes, "segment", index);
        if (segment.arc < 0 || segment.arc >= static_cast<int>(network_.arcs.size()))
            throw InputError("network: segment " + std::to_string(index) + " names no arc");
        const NetworkArc& arc = network_.arcs[static_cast<std::size_t>(segment.arc)];
        const bool is_in_arc = segment.first_sample >= 0 &&
                               segment.first_sample < segment.last_sample &&
                               segment.last_sample < static_cast<int>(arc.samples.size());
        if (!is_in_arc)
            throw InputError("network: segment " + std::to_string(index) +
                             " has samples outside its arc");
        const Vec3 from = network_.nodes[static_cast<std::size_t>(segment.nodes[0])].position;
        const Vec3 to = network_.nodes[static_cast<std::size_t>(segment.nodes[1])].position;
        const double longest = 4.0 / 3 * edge_length_ * (1 - 1e-9);
        const int count =
            std::max(1, static_cast<int>(std::min(1e6, std::ceil((to - from).norm() / longest))));
        cut_samples(arc, static_cast<std::size_t>(segment.first_sample),
                    static_cast<std::size_t>(segment.last_sample), segment.nodes, count,
                    static_cast<int>(index), segment.arc);
    }

    void check_nodes(const std::array<int, 2>& nodes, const char* what, std::size_t index) const {
        for (const int node : nodes)
            if (node < 0 || node >= static_cast<int>(network_.nodes.size()))
                throw InputError(std::string("network: ") + what + " " + std::to_string(index) +
                                 " names no node");
    }

    /// Cuts samples [first, last] of an arc into `count` pieces of equal arc length.
    void cut_samples(const NetworkArc& arc, std::size_t first, std::size_t last,
                     const std::array<int, 2>& nodes, int count, int segment, int arc_index) {
        std::vector<double> reached{0};  // arc length at each sample
        for (std::size_t i = first + 1; i <= last; ++i)
            reached.push_back(reached.back() +
                              (arc.samples[i].position - arc.samples[i - 1].position).norm());
        int from = nodes[0];
        std::size_t next = 1;
        for (int k = 1; k <= count; ++k) {
            FeaturePiece piece{from, -1, {}, segment, arc_index, arc.kind != ArcKind::Feature};
            const double end = reached.back() * k / count;
            const double slack = 1e-9 * reached.back();
            for (; next + 1 < reached.size() && reached[next] < end - slack; ++next)
                piece.points.push_back(sample_point(arc.samples[first + next]));
            if (k == count) {
                piece.to = nodes[1];
            } else {
                const double span = std::max(reached[next] - reached[next - 1], 1e-300);
                const double t = std::clamp((end - reached[next - 1]) / span, 0.0, 1.0);
                piece.to = add_station((1 - t) * arc.samples[first + next - 1].position +
                                       t * arc.samples[first + next].position);
                if (t >= 1 - 1e-9 && next + 1 < reached.size()) ++next;
            }
            from = piece.to;
            result_.pieces.push_back(std::move(piece));
        }
    }

    int add_station(const Vec3& near) {
        const SurfacePoint place = closest(near);
        result_.stations.push_back({position(mesh_, place), place, false});
        return static_cast<int>(result_.stations.size()) - 1;
    }

    SurfacePoint sample_point(const ArcSample& sample) const {
        return on_surface(sample.position, sample.surface);
    }

    /// The point's own place on the surface, or the closest one where it has none (imported) or
    /// its place belongs to another mesh.
    SurfacePoint on_surface(const Vec3& point, const SurfacePoint& place) const {
        if (!point.allFinite()) throw InputError("network: a point is not finite");
        const bool is_placed = place.face >= 0 && place.face < static_cast<int>(mesh_.n_faces()) &&
                               place.barycentric.allFinite() && place.barycentric.minCoeff() >= 0 &&
                               (position(mesh_, place) - point).norm() <= tolerance_;
        return is_placed ? place : closest(point);
    }

    SurfacePoint closest(const Vec3& point) const {
        const ReferencePoint near =
            reference_.closest(point, Vec3::Zero(), std::numeric_limits<double>::max(), -1);
        const FaceHandle face(near.face);
        const auto v = face_vertices(mesh_, face);
        const Vec3 &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]);
        const Vec3 normal = (b - a).cross(c - a);
        const double square = normal.squaredNorm();
        SurfacePoint result{near.face, {1, 0, 0}};
        if (!(square > 0)) return result;
        const double wb =
            std::clamp(normal.dot((near.position - a).cross(c - a)) / square, 0.0, 1.0);
        const double wc =
            std::clamp(normal.dot((b - a).cross(near.position - a)) / square, 0.0, 1 - wb);
        result.barycentric = {1 - wb - wc, wb, wc};
        return result;
    }

    const FeatureCurveNetwork& network_;
    double edge_length_;
    const Mesh& mesh_;
    const ReferenceSurface& reference_;
    double tolerance_ = 0;
    FeaturePieces result_;
};

}  // namespace

FeaturePieces cut_into_pieces(const FeatureCurveNetwork& network, double edge_length,
                              const Mesh& mesh, const ReferenceSurface& reference) {
    return PieceCutter(network, edge_length, mesh, reference).cut();
}

}  // namespace fcn
