// Quads along a cross field, the road of Gehre, Lim, Kobbelt 2016 (section 6.2): domain
// (quad_domain.h), field (field_design.h; Ebke, Campen, Bommes, Kobbelt 2014), map with whole
// numbers at singularities (quad_map.h; Bommes, Zimmer, Kobbelt 2009), exact extraction
// (quad_extraction.h; Ebke, Bommes, Campen, Kobbelt 2013). Each step says whether it succeeded.
// What it may fail of is mostly that singularities are too close for quads of the length, so the
// next attempt takes a shorter one. In the end vertices move onto curves and the surface; where
// curves spoil quads they are left alone.
#include "meshing/quads_by_field.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "geometry/errors.h"
#include "meshing/baselines.h"
#include "meshing/quad_curves.h"
#include "meshing/quad_faults.h"
#include "meshing/quad_field.h"
#include "meshing/quad_fitting.h"
#include "meshing/quad_holes.h"
#include "meshing/quad_smoothing.h"
#include "meshing/quad_tips.h"
#include "meshing/singularity_refinement.h"

namespace fcn {
namespace {

constexpr int kAttempts = 4;
constexpr double kShrinking = 0.9;
/// Triangles of the domain are this share of a quad's edge, longer where there were too many.
constexpr double kFineShare = 1.0 / 3, kCoarseShare = 0.5;
constexpr double kFilledLoop = 3;  ///< in edge lengths: such loops are closed for the map
constexpr int kCurveRounds = 4;
constexpr double kLeastJacobian = 0.2;   ///< of quads; worse ones are bad
constexpr double kWorstJacobian = 0.02;  ///< of quads on lines of the grid
constexpr double kFewCurves = 0.97;      ///< of the edges on folds that should be lines of the grid
/// Rows are divided where quads are this far from the surface, in edge lengths, up to this many
/// times the quads that fit.
constexpr double kRowTolerance = 0.35, kMostQuads = 1.3;
constexpr double kManyTriangles = 60000;

class Stopwatch {
public:
    /// Since it was made, or asked before.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double domain_edge_length(double area, double edge_length) {
    // An equilateral triangle of edge 1 has an area of sqrt(3) / 4.
    const double longest = kCoarseShare * edge_length, shortest = kFineShare * edge_length;
    const double sparse = std::sqrt(area / kManyTriangles * 4 / std::sqrt(3.0));
    return std::clamp(sparse, shortest, longest);
}

class FieldAttempt {
public:
    FieldAttempt(const LoadedMesh& input, const FeatureCurveNetwork& network,
                 const QuadOptions& options, const QuadSteps& steps,
                 const ReferenceSurface& reference)
        : input_(input),
          network_(network),
          options_(options),
          steps_(steps),
          reference_(reference) {
        for (const FaceHandle face : input.mesh.faces()) area_ += face_area(input.mesh, face);
    }

    /// Returns the mesh if the attempt's reason stays empty.
    QuadMesh run(double edge_length, FieldQuads& quads) {
        QuadAttempt& attempt = quads.attempts.emplace_back();
        attempt.edge_length = edge_length;
        const auto fail = [&](const char* step, const std::string& reason) {
            attempt.step = step;
            attempt.reason = reason;
            return QuadMesh{};
        };
        Stopwatch watch;
        attempt.step = "domain";
        QuadDomain domain = make_domain(edge_length);
        attempt.domain = watch.lap();
        attempt.triangles = domain.mesh.n_faces();
        attempt.step = "field";
        FieldDesign field = make_field(domain, edge_length);
        attempt.field = watch.lap();
        attempt.singularities = static_cast<int>(field.singularities.size());
        if (!field.failure.empty()) return fail("field", field.failure);
        attempt.step = "map";
        const RefinedField first = refine_singularities(domain, field);
        FieldMap map = make_map(first, domain, field, edge_length);
        attempt.singularities = static_cast<int>(field.singularities.size());
        attempt.map = watch.lap();
        if (!map.failure.empty()) return fail("map", map.failure);
        QuadMesh mesh = read_quads(domain, map, attempt);
        if (!attempt.reason.empty() && !map.hard_edges.empty()) {
            attempt.reason.clear();
            domain = first.domain;
            field = first.design;
            const FieldMap soft = steps_.soft_map(domain, field, edge_length);
            attempt.map += watch.lap();
            if (!soft.failure.empty()) return fail("map", soft.failure);
            mesh = read_quads(domain, soft, attempt);
        }
        if (!attempt.reason.empty()) return {};
        label_faces(mesh);
        attempt.step.clear();
        quads.curve_deviation_degrees = field.curve_deviation_degrees;
        quads.field = quad_field(domain, field);
        return mesh;
    }

private:
    /// The quads of a map, on curves and surface; the reason in the attempt if there are none.
    QuadMesh read_quads(const QuadDomain& domain, const FieldMap& map, QuadAttempt& attempt) const {
        Stopwatch watch;
        attempt.step = "extraction";
        RowOptions rows;
        rows.tolerance = kRowTolerance * attempt.edge_length;
        rows.most_quads = static_cast<std::size_t>(kMostQuads * area_ /
                                                   (attempt.edge_length * attempt.edge_length));
        QuadExtraction extraction = steps_.extraction(domain.mesh, map.map, rows);
        attempt.extraction += watch.lap();
        attempt.reason = extraction.fault;
        if (!attempt.reason.empty()) return {};
        const int closed = static_cast<int>(domain.filled_holes.size());
        if (open_holes(extraction.mesh, domain.filled_holes) < closed) {
            attempt.reason = "short boundary loops that cannot be opened again";
            return {};
        }
        attempt.step = "smoothing";
        const LinesOnCurves lines = lines_on_curves(domain, map.hard_edges, extraction);
        const int inverted = smooth(extraction.mesh, lines, attempt.edge_length);
        attempt.smoothing += watch.lap();
        if (inverted > 0) attempt.reason = std::to_string(inverted) + " inverted corners";
        return std::move(extraction.mesh);
    }

    QuadDomain make_domain(double edge_length) const {
        QuadDomainOptions options;
        options.edge_length = domain_edge_length(area_, edge_length);
        options.filled_loop = kFilledLoop * edge_length;
        options.is_guided = options_.guidance != QuadGuidance::None;
        options.reference = &reference_;
        return steps_.domain(input_, network_, options);
    }

    FieldDesign make_field(const QuadDomain& domain, double edge_length) const {
        FieldOptions options;
        options.edge_length = edge_length;
        return steps_.field(domain, options);
    }

    /// The map, and the domain and field that it is of. Where curves gave way, or there is no map,
    /// singularities are moved out of the way and it is tried once more.
    FieldMap make_map(const RefinedField& first, QuadDomain& domain, FieldDesign& field,
                      double edge_length) const {
        FieldMap map = steps_.map(first.domain, first.design, edge_length);
        RefinedField best = first;
        FieldDesign cleared = field;
        if ((map.kept_share < kFewCurves || !map.failure.empty()) &&
            steps_.clearance(domain, cleared, edge_length) > 0) {
            RefinedField other = refine_singularities(domain, cleared);
            FieldMap second = steps_.map(other.domain, other.design, edge_length);
            const bool is_better = !map.failure.empty() || second.kept_share > map.kept_share;
            if (second.failure.empty() && is_better) {
                best = std::move(other);
                map = std::move(second);
            }
        }
        domain = std::move(best.domain);
        field = std::move(best.design);
        return map;
    }

    /// Returns the number of inverted corners. Arcs that spoil quads are left out.
    int smooth(QuadMesh& mesh, const LinesOnCurves& lines, double edge_length) const {
        if (steps_.smoothing) return steps_.smoothing(mesh);
        QuadCurveOptions curves;
        curves.edge_length = edge_length;
        curves.is_left_out.assign(network_.arcs.size(), options_.guidance == QuadGuidance::None);
        curves.lines = lines;
        curves.is_free.assign(network_.arcs.size(), false);
        QuadFitOptions fit;
        fit.smoothing.edge_length = edge_length;
        fit.smoothing.rounds = options_.smoothing_rounds;
        const std::vector<Vec3> samples = sample_points(input_.mesh, edge_length / 2);
        for (int round = 0;; ++round) {
            QuadMesh trial = mesh;
            const QuadConstraints constraints =
                move_to_curves(trial, input_.mesh, network_, curves);
            fit_quads(trial, constraints, samples, reference_, fit);
            if (round < kCurveRounds && leave_out_bad_arcs(trial, curves)) continue;
            if (round == kCurveRounds) {
                curves.is_left_out.assign(network_.arcs.size(), true);
                if (count_inverted_corners(trial) > 0)
                    curves.is_free.assign(network_.arcs.size(), true);
            } else {
                if (count_inverted_corners(trial) == 0)
                    reach_tips(trial, constraints, samples, reference_, fit);
                mesh = std::move(trial);
                return count_inverted_corners(mesh);
            }
        }
    }

    /// No lines are moved any more onto arcs on whose vertices there is a bad quad; where there is
    /// a worse one, those that lay there from the beginning come free. Whether anything changes.
    bool leave_out_bad_arcs(const QuadMesh& mesh, QuadCurveOptions& curves) const {
        const std::vector<bool> is_bad = vertices_of_bad_quads(mesh, kLeastJacobian);
        const std::vector<bool> is_worse = vertices_of_bad_quads(mesh, kWorstJacobian);
        const std::vector<bool> before[] = {curves.is_left_out, curves.is_free};
        for (const QuadFeatureEdge& edge : mesh.feature_edges) {
            const auto arc = static_cast<std::size_t>(edge.arc);
            for (const int v : {edge.from, edge.to}) {
                if (is_worse[static_cast<std::size_t>(v)] && before[0][arc])
                    curves.is_free[arc] = true;
                if (is_bad[static_cast<std::size_t>(v)]) curves.is_left_out[arc] = true;
            }
        }
        return curves.is_left_out != before[0] || curves.is_free != before[1];
    }

    void label_faces(QuadMesh& mesh) const {
        mesh.face_labels.clear();
        if (input_.face_labels.empty()) return;
        for (const auto& face : mesh.faces) {
            Vec3 centre = Vec3::Zero();
            for (const int v : face) centre += 0.25 * mesh.points[static_cast<std::size_t>(v)];
            const auto corner = [&](std::size_t i) {
                return mesh.points[static_cast<std::size_t>(face[i])];
            };
            const Vec3 normal = (corner(2) - corner(0)).cross(corner(3) - corner(1));
            const double reach = (corner(2) - corner(0)).norm() + (corner(3) - corner(1)).norm();
            ReferencePoint near = reference_.closest(centre, normal.stableNormalized(), reach, -1);
            if (near.face < 0) near = reference_.closest(centre, Vec3::Zero(), 1e300, -1);
            mesh.face_labels.push_back(
                near.face < 0 ? 0 : input_.face_labels[static_cast<std::size_t>(near.face)]);
        }
    }

    const LoadedMesh& input_;
    const FeatureCurveNetwork& network_;
    const QuadOptions& options_;
    const QuadSteps& steps_;
    const ReferenceSurface& reference_;
    double area_ = 0;
};

}  // namespace

std::string FieldQuads::reason() const {
    std::string text;
    for (const QuadAttempt& attempt : attempts) {
        if (attempt.reason.empty()) continue;
        char length[32];
        std::snprintf(length, sizeof length, "%.3g", attempt.edge_length);
        text += (text.empty() ? "" : "; ") + ("edge length " + std::string(length)) + ", " +
                attempt.step + ": " + attempt.reason;
    }
    return text;
}

FieldQuads quads_by_field(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                          const QuadOptions& options, const QuadSteps& steps) {
    if (!(options.edge_length > 0) || !std::isfinite(options.edge_length))
        throw InputError("quads: edge length must be > 0, it is " +
                         std::to_string(options.edge_length));
    const std::unique_ptr<ReferenceSurface> own =
        options.reference ? nullptr : std::make_unique<ReferenceSurface>(mesh.mesh);
    const FeatureCurveNetwork guides = options.guidance == QuadGuidance::Threshold
                                           ? above_curvature(network, options.threshold)
                                           : network;
    FieldAttempt attempt(mesh, guides, options, steps,
                         options.reference ? *options.reference : *own);
    FieldQuads quads;
    double edge_length = options.edge_length;
    for (int i = 0; i < kAttempts && !quads.is_done(); ++i, edge_length *= kShrinking) {
        try {
            quads.mesh = attempt.run(edge_length, quads);
        } catch (const std::exception& error) {
            quads.attempts.back().reason = error.what();
        }
    }
    return quads;
}

}  // namespace fcn
