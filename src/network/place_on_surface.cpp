// Imported curves come with coordinates only, or with faces of a mesh that has been renumbered
// since. The distance test comes first and begins with the bounding box, so that coordinates beyond
// all measure never reach the closest-point query.

#include "network/place_on_surface.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "geometry/errors.h"
#include "geometry/surface_queries.h"
#include "network/drop_unused_nodes.h"
#include "network/mesh_edges.h"

namespace fcn {
namespace {

/// In diagonals of the mesh.
constexpr double kFarthest = 0.05;
constexpr double kFits = 1e-6;
constexpr double kExact = 1e-9;
constexpr double kBarycentric = 1e-9;

class Placement {
public:
    Placement(FeatureCurveNetwork& network, const Mesh& mesh, const std::string& source)
        : network_(network),
          mesh_(mesh),
          source_(source),
          box_(bounding_box(mesh)),
          diagonal_(box_.diagonal()) {}

    void run() {
        if (mesh_.n_faces() == 0)
            throw InputError(source_ + ": the mesh that comes with it has no faces");
        check_box();
        queries_.emplace(mesh_);
        for (NetworkNode& node : network_.nodes) place(node.position, node.surface);
        for (NetworkArc& arc : network_.arcs) place_arc(arc);
        if (moved_count_ > 0)
            network_.notes.push_back("import: the surface coordinates of " +
                                     std::to_string(moved_count_) +
                                     " points did not fit the mesh; placed at the closest points");
        if (network_.segments.empty()) drop_vanished();
        for (NetworkArc& arc : network_.arcs)
            if (arc.dihedral == 0) arc.dihedral = dihedral_along(arc);
        if (network_.diagonal == 0) network_.diagonal = diagonal_;
    }

private:
    [[noreturn]] void reject(const Vec3& point, double distance) const {
        std::ostringstream out;
        out << source_ << ": point (" << point[0] << ", " << point[1] << ", " << point[2] << ") is "
            << distance << " away from the mesh, " << 100 * distance / diagonal_
            << "% of its diagonal (wrong mesh?)";
        throw InputError(out.str());
    }

    void check_point(const Vec3& point) const {
        const Vec3 outside = (box_.min - point).cwiseMax(point - box_.max).cwiseMax(Vec3::Zero());
        const double distance = outside.stableNorm();
        if (!(distance <= kFarthest * diagonal_)) reject(point, distance);
    }

    void check_box() const {
        for (const NetworkNode& node : network_.nodes) check_point(node.position);
        for (const NetworkArc& arc : network_.arcs)
            for (const ArcSample& sample : arc.samples) check_point(sample.position);
    }

    bool fits(const Vec3& point, const SurfacePoint& surface) const {
        return surface.face >= 0 && surface.face < static_cast<int>(mesh_.n_faces()) &&
               surface.barycentric.minCoeff() >= -kBarycentric &&
               std::abs(surface.barycentric.sum() - 1) <= kBarycentric &&
               (position(mesh_, surface) - point).norm() <= kFits * diagonal_;
    }

    void place(Vec3& point, SurfacePoint& surface) {
        if (fits(point, surface)) return;
        if (surface.face >= 0) ++moved_count_;
        const ClosestPoint closest = queries_->closest(point);
        if (!(closest.distance <= kFarthest * diagonal_)) reject(point, closest.distance);
        surface = closest.surface;
        if (closest.distance > kExact * diagonal_) point = closest.position;
    }

    void place_arc(NetworkArc& arc) {
        for (std::size_t s = 1; s + 1 < arc.samples.size(); ++s)
            place(arc.samples[s].position, arc.samples[s].surface);
        const auto end = [&](ArcSample& sample, int index) {
            const NetworkNode& node = network_.nodes[index];
            if (fits(sample.position, sample.surface) && sample.position == node.position) return;
            sample = {node.position, node.surface};
        };
        end(arc.samples.front(), arc.nodes[0]);
        end(arc.samples.back(), arc.nodes[1]);
        if (network_.segments.empty()) merge_samples(arc);
    }

    /// Segments refer to samples by number, so a network that has them keeps every sample.
    static void merge_samples(NetworkArc& arc) {
        std::size_t kept = 1;
        const std::size_t count = arc.samples.size();
        for (std::size_t s = 1; s < count; ++s) {
            if (arc.samples[s].position == arc.samples[kept - 1].position) {
                // The last sample is the node's and stays; the one before it gives way.
                if (s + 1 == count) arc.samples[kept - 1] = arc.samples[s];
                continue;
            }
            if (!arc.origins.empty()) arc.origins[kept - 1] = arc.origins[s - 1];
            arc.samples[kept++] = arc.samples[s];
        }
        arc.samples.resize(kept);
        if (!arc.origins.empty()) arc.origins.resize(kept - 1);
    }

    void drop_vanished() {
        const auto is_vanished = [](const NetworkArc& arc) {
            return arc.samples.size() < (arc.is_closed() ? 4u : 2u);
        };
        const std::size_t before = network_.arcs.size();
        if (std::none_of(network_.arcs.begin(), network_.arcs.end(), is_vanished)) return;
        std::erase_if(network_.arcs, is_vanished);
        network_.notes.push_back("import: dropped " +
                                 std::to_string(before - network_.arcs.size()) +
                                 " arcs that have no length on the surface");
        // What refers to arcs by number is lost with them.
        network_.curves.clear();
        network_.orbits.clear();
        for (NetworkArc& arc : network_.arcs) arc.curve = -1;
        drop_unused_nodes(network_);
    }

    /// Length-weighted mean over the intervals that lie on mesh edges, if these are most of it.
    double dihedral_along(const NetworkArc& arc) const {
        double length = 0, on_edges = 0, sum = 0;
        MeshPlace before = place_of(mesh_, arc.samples.front().surface);
        for (std::size_t s = 1; s < arc.samples.size(); ++s) {
            const MeshPlace place = place_of(mesh_, arc.samples[s].surface);
            const double step = (arc.samples[s].position - arc.samples[s - 1].position).norm();
            const EdgeHandle edge = common_edge(mesh_, before, place);
            length += step;
            if (edge.is_valid()) {
                on_edges += step;
                sum += step * dihedral_angle(mesh_, edge);
            }
            before = place;
        }
        return on_edges > 0.5 * length ? sum / on_edges : 0;
    }

    FeatureCurveNetwork& network_;
    const Mesh& mesh_;
    const std::string& source_;
    BoundingBox box_;
    double diagonal_;
    std::optional<SurfaceQueries> queries_;
    std::size_t moved_count_ = 0;
};

}  // namespace

void place_on_surface(FeatureCurveNetwork& network, const Mesh& mesh, const std::string& source) {
    Placement(network, mesh, source).run();
}

}  // namespace fcn
