// The scale-aware cross field of Ebke, Campen, Bommes, Kobbelt 2014 with the network of Gehre, Lim,
// Kobbelt 2016 (section 6.2) as soft guides: smooth connection (face_connection.h), guides
// (field_guides.h), a field by diffusion (field_smoothing.h), then its turns are fixed, pairs of
// singularities that are too close are cancelled (singularity_merging.h), and the angles are
// relaxed once more (matched_field.h), on the surface as it is: what was smoothed away has done its
// work when the singularities are known, and the map will live on the surface.
#include "meshing/field_design.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include "geometry/errors.h"
#include "meshing/field_smoothing.h"

namespace fcn {
namespace {

constexpr double kStrong = 0.5;        ///< importance of curves whose singularities are meant
constexpr double kKeptMerging = 0.45;  ///< of the distance of merging, for these
constexpr double kApart = 0.6;         ///< of h: how far quarters of one vertex are taken apart

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::vector<FieldGuide> collect_guides(const QuadDomain& domain, const FieldOptions& options) {
    const double h = options.edge_length;
    std::vector<FieldGuide> guides;
    const auto append = [&](const std::vector<FieldGuide>& more) {
        guides.insert(guides.end(), more.begin(), more.end());
    };
    if (options.boundary_strength > 0)
        append(boundary_guides(domain.mesh, h, options.boundary_strength));
    if (options.curve_strength > 0) append(curve_guides(domain, h, options.curve_strength));
    if (options.curvature_strength > 0)
        append(curvature_guides(domain.mesh, h, options.curvature_strength));
    return guides;
}

/// Vertices of curves of at least this importance.
std::vector<bool> curve_vertices(const QuadDomain& domain, double importance) {
    std::vector<bool> is_on_curve(domain.mesh.n_vertices(), false);
    for (const EdgeHandle edge : domain.mesh.edges()) {
        if (domain.edge_arc[at(edge.idx())] < 0 || domain.edge_weight[at(edge.idx())] < importance)
            continue;
        for (const unsigned side : {0u, 1u})
            is_on_curve[at(
                domain.mesh.to_vertex_handle(domain.mesh.halfedge_handle(edge, side)).idx())] =
                true;
    }
    return is_on_curve;
}

double curve_deviation(const QuadDomain& domain, const CrossField& field) {
    double sum = 0, total = 0;
    for (const EdgeHandle edge : domain.mesh.edges()) {
        if (domain.edge_arc[at(edge.idx())] < 0) continue;
        const double length = domain.mesh.calc_edge_length(edge);
        for (const unsigned side : {0u, 1u}) {
            const HalfedgeHandle h = domain.mesh.halfedge_handle(edge, side);
            if (domain.mesh.is_boundary(h)) continue;
            const double angle = field.angles[at(domain.mesh.face_handle(h).idx())];
            sum += length * std::abs(std::remainder(angle - halfedge_angle(domain.mesh, h),
                                                    std::numbers::pi / 2));
            total += length;
        }
    }
    return total > 0 ? sum / total * 180 / std::numbers::pi : 0;
}

}  // namespace

FieldDesign design_field(const QuadDomain& domain, const FieldOptions& options) {
    if (!(options.edge_length > 0) || !std::isfinite(options.edge_length))
        throw InputError("cross field: edge length must be > 0, it is " +
                         std::to_string(options.edge_length));
    const auto start = std::chrono::steady_clock::now();
    const double h = options.edge_length;
    ConnectionOptions connecting;
    connecting.smoothing = options.smoothing * h;
    if (options.curve_strength > 0) connecting.is_kept = curve_vertices(domain, 0);
    const FaceConnection connection = connect_faces(domain.mesh, connecting);
    const std::vector<FieldGuide> guides = collect_guides(domain, options);
    FieldSmoothingOptions smoothing;
    smoothing.edge_length = h;
    smoothing.seed = options.seed;
    FieldDesign design;
    std::vector<double> angles = smooth_field(connection, guides, smoothing);
    if (angles.size() != domain.mesh.n_faces()) {
        design.failure = "the equations of the cross field cannot be solved";
        return design;
    }
    MatchedField matched = match_arms(domain.mesh, connection, std::move(angles));
    MergingOptions merging;
    merging.distance = options.merging * h;
    merging.kept_distance = kKeptMerging * merging.distance;
    if (options.curve_strength > 0) merging.is_kept = curve_vertices(domain, kStrong);
    design.merged_pairs = merge_singularities(domain.mesh, connection, merging, matched);
    separate_quarters(domain.mesh, connection, kApart * h, matched);
    const FaceConnection exact = connect_faces(domain.mesh);
    reconnect(connection, exact, matched);
    if (!straighten(exact, guides, matched))
        design.failure = "the angles of the cross field cannot be solved for";
    design.field = std::move(matched.field);
    design.singularities = inner_singularities(domain.mesh, matched.indices);
    if (vertex_indices(domain.mesh, design.field) != matched.indices)
        design.failure = "the cross field bends too much between neighbouring faces";
    design.close_pairs = close_pairs(domain.mesh, design.singularities, h);
    design.curve_deviation_degrees = curve_deviation(domain, design.field);
    design.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return design;
}

}  // namespace fcn
