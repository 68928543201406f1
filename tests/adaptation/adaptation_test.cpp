// The adaptation as a whole, on networks drawn on a flat square (where every expected outcome can
// be worked out by hand) and on the parametric models; the conformity checker is the judge.

#include "adaptation/adaptation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "adaptation/conformity.h"
#include "features/features.h"
#include "geometry/errors.h"
#include "geometry/models.h"
#include "geometry/surface_queries.h"
#include "labeling_mip/mip_solvers.h"
#include "network/network_io.h"
#include "support/small_meshes.h"

namespace fcn::test {
namespace {

AdaptationOptions options_at(double rmin) {
    AdaptationOptions options;
    options.rmin = rmin;
    options.solver = labeling::all_solvers().find("auto");
    options.solve.work_limit = 3'000'000;
    options.is_recording_problems = true;
    return options;
}

/// Network of polylines over a unit square (z = 0); arcs meet where their end points are equal.
struct Drawing {
    LoadedMesh mesh = testing::square_soup(20).load();
    FeatureCurveNetwork network;

    int node(const Vec3& p) {
        for (std::size_t v = 0; v < network.nodes.size(); ++v) {
            if (network.nodes[v].position == p) return static_cast<int>(v);
        }
        network.nodes.push_back({p, SurfaceQueries(mesh.mesh).closest(p).surface});
        return static_cast<int>(network.nodes.size()) - 1;
    }

    NetworkArc& add(const std::vector<Vec3>& points) {
        const SurfaceQueries queries(mesh.mesh);
        NetworkArc arc;
        arc.nodes = {node(points.front()), node(points.back())};
        for (const Vec3& p : points) arc.samples.push_back({p, queries.closest(p).surface});
        arc.source = "drawn";
        network.arcs.push_back(std::move(arc));
        network.diagonal = std::sqrt(2.0);
        return network.arcs.back();
    }

    NetworkArc& add_circle(const Vec3& center, double radius) {
        constexpr int kCorners = 64;
        std::vector<Vec3> points;
        for (int k = 0; k <= kCorners; ++k) {
            const double angle = 2 * M_PI * (k % kCorners) / kCorners;
            points.push_back(center + radius * Vec3(std::cos(angle), std::sin(angle), 0));
        }
        return add(points);
    }
};

ConformityReport check(const FeatureCurveNetwork& network, const AdaptationOptions& options,
                       const Mesh* mesh = nullptr) {
    ConformityOptions conformity;
    conformity.rmin = options.rmin;
    conformity.ratio = options.ratio;
    conformity.is_quad_target = options.target == ElementType::Quad;
    return check_conformity(network, conformity, mesh);
}

/// Recomputes what a blocker claims: with the dropped label in and its blockers out, the problem is
/// violated or its value is no larger.
void expect_blockers_hold(const AdaptationResult& result) {
    for (const DroppedPiece& piece : result.network.dropped) {
        if (piece.label < 0) continue;
        const labeling::LabelingProblem& problem = result.report.problems[piece.iteration - 1];
        labeling::Solution changed = result.report.solutions[piece.iteration - 1];
        const labeling::Value before = changed.value;
        ASSERT_EQ(changed.labels[piece.label], 0);
        changed.labels[piece.label] = 1;
        for (const Blocker& blocker : piece.blockers) {
            EXPECT_EQ(changed.labels[blocker.label], 1) << "a blocker that was not kept";
            changed.labels[blocker.label] = 0;
            const double units = problem.units_per_one();
            EXPECT_NEAR(blocker.weight * units, static_cast<double>(problem.weight(blocker.label)),
                        1e-3);
            EXPECT_EQ(blocker.conflict == "rule", !problem.in_conflict(piece.label, blocker.label));
        }
        const labeling::SolutionCheck check = check_solution(problem, changed);
        EXPECT_TRUE(!check.is_feasible || check.value <= before)
            << "piece of arc " << piece.origin_arc << " could have been kept";
        ASSERT_EQ(piece.margin.has_value(), check.is_feasible);
        if (check.is_feasible) {
            EXPECT_NEAR(*piece.margin * problem.units_per_one(),
                        static_cast<double>(before - check.value), 1e-3);
        }
    }
}

double length_of_origin(const FeatureCurveNetwork& network, int origin) {
    double length = 0;
    for (const NetworkArc& arc : network.arcs) {
        for (std::size_t k = 0; k + 1 < arc.samples.size(); ++k) {
            if (arc.origins[k] != origin) continue;
            length += (arc.samples[k + 1].position - arc.samples[k].position).norm();
        }
    }
    return length;
}

TEST(Adaptation, KeepsWhatConformsAlready) {
    Drawing drawing;
    drawing.add({{0.1, 0.2, 0}, {0.9, 0.2, 0}});
    drawing.add({{0.1, 0.8, 0}, {0.9, 0.8, 0}});
    const AdaptationOptions options = options_at(0.1);
    const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
    EXPECT_EQ(result.report.status, AdaptationStatus::Converged);
    EXPECT_TRUE(result.network.dropped.empty());
    EXPECT_NEAR(result.report.final_length, 1.6, 1e-12);
    EXPECT_TRUE(check(result.network, options).is_conforming());
    EXPECT_TRUE(validate(result.network, drawing.mesh.mesh).empty());
}

TEST(Adaptation, OneOfTwoCloseParallelLinesGoes) {
    for (const double gap : {0.2, 0.5, 0.9, 1.05}) {
        Drawing drawing;
        const double rmin = 0.1;
        drawing.add({{0.1, 0.4, 0}, {0.9, 0.4, 0}});
        drawing.add({{0.1, 0.4 + gap * rmin, 0}, {0.9, 0.4 + gap * rmin, 0}});
        const AdaptationOptions options = options_at(rmin);
        const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
        EXPECT_EQ(result.report.status, AdaptationStatus::Converged);
        EXPECT_TRUE(check(result.network, options).is_conforming()) << gap;
        // Closer than h = 0.66 rmin no two stretches of both lines can face each other.
        if (gap < 0.66) {
            EXPECT_LE(result.report.final_length, 0.8 + 1e-9);
        }
        if (gap > 1) {
            EXPECT_NEAR(result.report.final_length, 1.6, 1e-9);
        }
        EXPECT_GE(result.report.final_length, 0.7);
        expect_blockers_hold(result);
    }
}

TEST(Adaptation, CloseJunctionsThatNoShortArcJoins) {
    Drawing drawing;
    const double rmin = 0.1;
    // Two stars of three whose centres are 0.8 rmin apart and that point away from each other.
    const Vec3 left(0.46, 0.5, 0), right(0.54, 0.5, 0);
    drawing.add({left, {0.05, 0.5, 0}});
    drawing.add({left, {0.3, 0.95, 0}});
    drawing.add({left, {0.3, 0.05, 0}});
    drawing.add({right, {0.95, 0.5, 0}});
    drawing.add({right, {0.7, 0.95, 0}});
    drawing.add({right, {0.7, 0.05, 0}});
    const AdaptationOptions options = options_at(rmin);
    const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
    EXPECT_GE(result.report.iterations.front().vertex_conflicts, 1u);
    EXPECT_TRUE(check(result.network, options).is_conforming());
    expect_blockers_hold(result);
    EXPECT_GE(result.report.coverage, 0.0);
}

TEST(Adaptation, ShortArcCollapsesIntoACrossing) {
    Drawing drawing;
    const double rmin = 0.1;
    // Figure 6 (a): an H with a short bar; its four arms enclose right angles.
    const Vec3 u(0.47, 0.5, 0), v(0.53, 0.5, 0);
    drawing.add({u, v});
    drawing.add({u, {0.1, 0.87, 0}});
    drawing.add({u, {0.1, 0.13, 0}});
    drawing.add({v, {0.9, 0.87, 0}});
    drawing.add({v, {0.9, 0.13, 0}});
    const AdaptationOptions options = options_at(rmin);
    const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
    EXPECT_TRUE(check(result.network, options).is_conforming());
    EXPECT_EQ(std::ranges::count(result.network.valences(), 4), 1) << "the bar's ends are one node";
    EXPECT_EQ(result.network.arcs.size(), 4u);
}

TEST(Adaptation, ShortArcIsFusedIntoItsLine) {
    Drawing drawing;
    const double rmin = 0.1;
    // Figure 6 (b): a long line with two parallel arms 0.5 rmin apart. The arms cannot both stay;
    // with one of them gone, the piece between them is part of the line again.
    const Vec3 u(0.48, 0.3, 0), v(0.53, 0.3, 0);
    drawing.add({{0.05, 0.3, 0}, u});
    drawing.add({u, v});
    drawing.add({v, {0.95, 0.3, 0}});
    drawing.add({u, {0.48, 0.9, 0}});
    drawing.add({v, {0.53, 0.9, 0}});
    const AdaptationOptions options = options_at(rmin);
    const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
    EXPECT_TRUE(check(result.network, options).is_conforming());
    EXPECT_EQ(std::ranges::count(result.network.valences(), 3), 1);
    double on_line = 0;
    for (const NetworkArc& arc : result.network.arcs) {
        for (std::size_t k = 0; k + 1 < arc.samples.size(); ++k) {
            const Vec3 &a = arc.samples[k].position, &b = arc.samples[k + 1].position;
            if (std::abs(a.y() - 0.3) < 1e-9 && std::abs(b.y() - 0.3) < 1e-9) {
                on_line += (b - a).norm();
            }
        }
    }
    EXPECT_NEAR(on_line, 0.9, 1e-9) << "the line is whole";
    expect_blockers_hold(result);
}

TEST(Adaptation, SmallLoopIsDroppedWithItsReasonOrPinnedAndReported) {
    for (const bool is_pinned : {false, true}) {
        Drawing drawing;
        drawing.add_circle({0.3, 0.3, 0}, 0.04).pin = is_pinned ? Pin::Keep : Pin::None;
        drawing.add_circle({0.7, 0.7, 0}, 0.1);
        const AdaptationOptions options = options_at(0.1);
        const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
        EXPECT_TRUE(check(result.network, options).is_conforming());
        if (is_pinned) {
            EXPECT_EQ(result.network.arcs.size(), 2u);
            EXPECT_EQ(result.report.warnings.size(), 1u);
            EXPECT_GT(check(result.network, options).input_forced, 0u);
        } else {
            ASSERT_EQ(result.network.arcs.size(), 1u);
            ASSERT_EQ(result.network.dropped.size(), 1u);
            EXPECT_EQ(result.network.dropped[0].reason, "closed arc without three segments");
        }
    }
}

TEST(Adaptation, PinnedPinholeStaysATriangle) {
    // Corners closer together than the samples of the adaptation, one of them nearly on a line; as
    // one closed arc, and as two arcs.
    const Vec3 a(0.3, 0.3, 0), b(0.3003, 0.3, 0), c(0.30015, 0.30001, 0);
    for (const bool is_one_arc : {true, false}) {
        Drawing drawing;
        if (is_one_arc) {
            drawing.add({a, b, c, a}).pin = Pin::Keep;
        } else {
            drawing.add({a, b}).pin = Pin::Keep;
            drawing.add({b, c, a}).pin = Pin::Keep;
        }
        drawing.add_circle({0.7, 0.7, 0}, 0.1);
        const AdaptationResult result =
            adapt_network(drawing.mesh, drawing.network, options_at(0.1));
        ASSERT_EQ(result.network.arcs.size(), 2U);
        const auto& arcs = result.network.arcs;
        EXPECT_EQ(std::min(arcs[0].samples.size(), arcs[1].samples.size()), 4U);
        EXPECT_EQ(validate(result.network), std::vector<std::string>{});
        EXPECT_NO_THROW(network_from_json(network_to_json(result.network), "pinhole"));
    }
}

TEST(Adaptation, FeaturesYieldToPinnedCurves) {
    Drawing drawing;
    drawing.add({{0.1, 0.5, 0}, {0.9, 0.5, 0}}).pin = Pin::Keep;
    drawing.add({{0.1, 0.53, 0}, {0.9, 0.53, 0}});
    drawing.add({{0.1, 0.9, 0}, {0.9, 0.9, 0}});
    drawing.network.arcs[2].pin = Pin::Drop;
    const AdaptationOptions options = options_at(0.1);
    const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
    EXPECT_NEAR(length_of_origin(result.network, 0), 0.8, 1e-9);
    EXPECT_EQ(length_of_origin(result.network, 1), 0.0);
    EXPECT_EQ(length_of_origin(result.network, 2), 0.0);
    EXPECT_TRUE(check(result.network, options).is_conforming());
    expect_blockers_hold(result);
}

TEST(Adaptation, PinnedCurvesMayViolateAndAreLeftOutOfTheVerdict) {
    Drawing drawing;
    drawing.add({{0.1, 0.5, 0}, {0.9, 0.5, 0}}).pin = Pin::Keep;
    drawing.add({{0.1, 0.52, 0}, {0.9, 0.52, 0}}).pin = Pin::Keep;
    const AdaptationOptions options = options_at(0.1);
    const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
    const ConformityReport report = check(result.network, options);
    EXPECT_TRUE(report.is_conforming());
    EXPECT_GT(report.input_forced, 0u);
    EXPECT_NEAR(result.report.final_length, 1.6, 1e-9);
}

TEST(Adaptation, SymmetricPartnersShareTheirFate) {
    Drawing drawing;
    const double rmin = 0.1;
    drawing.add({{0.1, 0.2, 0}, {0.9, 0.2, 0}});
    drawing.add({{0.1, 0.8, 0}, {0.9, 0.8, 0}});
    // Stands in the way of the lower partner's middle only.
    drawing.add({{0.35, 0.23, 0}, {0.65, 0.23, 0}}).pin = Pin::Keep;
    SymmetryOrbit orbit;
    orbit.members.resize(2);
    orbit.members[0].arc = 0;
    orbit.members[1].arc = 1;
    orbit.members[1].linear = Vec3(1, -1, 1).asDiagonal();
    orbit.members[1].translation = {0, 1, 0};
    drawing.network.orbits.push_back(orbit);
    AdaptationOptions options = options_at(rmin);
    const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
    EXPECT_TRUE(result.report.warnings.empty());
    const labeling::LabelingProblem& problem = result.report.problems.front();
    EXPECT_LT(static_cast<std::size_t>(problem.label_count()),
              result.report.iterations.front().segments)
        << "partners share labels";
    // After the first labeling the partners are images of each other.
    std::map<int, std::set<long>> dropped;
    for (const DroppedPiece& piece : result.network.dropped) {
        if (piece.iteration != 1) continue;
        dropped[piece.origin_arc].insert(std::lround(piece.polyline.front().x() * 1e6));
    }
    EXPECT_EQ(dropped[0], dropped[1]);
    EXPECT_TRUE(check(result.network, options).is_conforming());
}

TEST(Adaptation, WholeCurvesStayOrGoWhole) {
    Drawing drawing;
    drawing.add({{0.1, 0.3, 0}, {0.9, 0.3, 0}});
    drawing.add({{0.1, 0.34, 0}, {0.5, 0.34, 0}});
    drawing.add({{0.1, 0.7, 0}, {0.9, 0.7, 0}});
    AdaptationOptions options = options_at(0.1);
    options.unit = LabelUnit::Curve;
    for (const AdaptationMode mode : {AdaptationMode::Best, AdaptationMode::Paper}) {
        options.mode = mode;
        const AdaptationResult result = adapt_network(drawing.mesh, drawing.network, options);
        EXPECT_NEAR(length_of_origin(result.network, 0), 0.8, 1e-9);
        EXPECT_EQ(length_of_origin(result.network, 1), 0.0) << "the shorter one goes, whole";
        EXPECT_NEAR(length_of_origin(result.network, 2), 0.8, 1e-9);
    }
}

TEST(Adaptation, RefusesBadOptionsWithAWord) {
    Drawing drawing;
    drawing.add({{0.1, 0.3, 0}, {0.9, 0.3, 0}});
    const auto expect_refused = [&](auto change) {
        AdaptationOptions options = options_at(0.1);
        change(options);
        EXPECT_THROW(adapt_network(drawing.mesh, drawing.network, options), InputError);
    };
    expect_refused([](AdaptationOptions& o) { o.rmin = 0; });
    expect_refused([](AdaptationOptions& o) { o.rmin = std::nan(""); });
    expect_refused([](AdaptationOptions& o) { o.rmin = 1e-9; });
    expect_refused([](AdaptationOptions& o) { o.ratio = 1.0; });
    expect_refused([](AdaptationOptions& o) { o.ratio = 1.74; });
    expect_refused([](AdaptationOptions& o) { o.lambda0 = -1; });
    expect_refused([](AdaptationOptions& o) { o.alpha_sym = 0; });
    expect_refused([](AdaptationOptions& o) { o.smooth_power = 0; });
    expect_refused([](AdaptationOptions& o) { o.ortho_radius = -1; });
    expect_refused([](AdaptationOptions& o) { o.solver = nullptr; });
    drawing.network.arcs[0].nodes[1] = 7;
    expect_refused([](AdaptationOptions&) {});
}

struct ModelCase {
    const char* model;
    double scale;  ///< of the diagonal
    ElementType target;
    double ratio;
};

class AdaptationOnModels : public ::testing::TestWithParam<ModelCase> {};

TEST_P(AdaptationOnModels, ConformsStrictlyAndIsTheSameOnTwoThreads) {
    const ModelCase& test_case = GetParam();
    ModelOptions model_options;
    model_options.resolution = 0.03;
    const LoadedMesh mesh = make_model(test_case.model, model_options);
    FeatureCurveNetwork network = add_boundaries(detect_sharp(mesh), mesh, BoundaryPolicy::Keep);
    AdaptationOptions options = options_at(test_case.scale * bounding_box(mesh.mesh).diagonal());
    options.target = test_case.target;
    options.ratio = test_case.ratio;
    const AdaptationResult result = adapt_network(mesh, network, options);
    EXPECT_EQ(result.report.status, AdaptationStatus::Converged);
    const ConformityReport report = check(result.network, options, &mesh.mesh);
    EXPECT_TRUE(report.is_conforming()) << report.counted << " violations";
    EXPECT_TRUE(validate(result.network, mesh.mesh).empty());
    expect_blockers_hold(result);
    options.threads = 2;
    const AdaptationResult again = adapt_network(mesh, network, options);
    EXPECT_EQ(network_to_json(result.network), network_to_json(again.network));
}

INSTANTIATE_TEST_SUITE_P(
    Models, AdaptationOnModels,
    ::testing::Values(ModelCase{"ribs", 0.02, ElementType::Triangle, 1.5},
                      ModelCase{"ribs", 0.05, ElementType::Quad, 1.5},
                      ModelCase{"steps", 0.03, ElementType::Triangle, 1.35},
                      ModelCase{"skyscraper", 0.04, ElementType::Triangle, 1.5},
                      ModelCase{"gear", 0.03, ElementType::Triangle, 1.14},
                      ModelCase{"octaflower", 0.06, ElementType::Triangle, 1.5},
                      ModelCase{"thin-wall", 0.03, ElementType::Triangle, 1.5},
                      ModelCase{"box", 0.1, ElementType::Triangle, 1.05}),
    [](const auto& test) {
        std::string name = std::string(test.param.model) + "_" + std::to_string(test.index);
        std::ranges::replace(name, '-', '_');
        return name;
    });

TEST(Adaptation, ThinWallsAreExemptOnlyWhenAsked) {
    // Two sheets that face away from each other, 0.3 rmin apart, a line in the middle of each.
    const double rmin = 0.1, gap = 0.03;
    testing::Soup soup = testing::square_soup(20);
    const int count = static_cast<int>(soup.points.size());
    const auto upper = soup.triangles;
    for (int v = 0; v < count; ++v) soup.points.push_back(soup.points[v] - Vec3(0, 0, gap));
    for (const auto& t : upper) {
        soup.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
    }
    Drawing drawing;
    drawing.mesh = soup.load();
    drawing.add({{0.1, 0.52, 0}, {0.9, 0.52, 0}});
    drawing.add({{0.1, 0.52, -gap}, {0.9, 0.52, -gap}});
    AdaptationOptions options = options_at(rmin);
    const AdaptationResult exempt = adapt_network(drawing.mesh, drawing.network, options);
    options.thin_walls = ThinWalls::Conflict;
    const AdaptationResult strict = adapt_network(drawing.mesh, drawing.network, options);
    EXPECT_FALSE(exempt.report.exempt.empty());
    EXPECT_TRUE(strict.report.exempt.empty());
    EXPECT_NEAR(exempt.report.final_length, 1.6, 1e-9);
    EXPECT_LE(strict.report.final_length, 0.8 + 1e-9);
    const Mesh& mesh = drawing.mesh.mesh;
    EXPECT_TRUE(check(exempt.network, options, &mesh).is_conforming());
    EXPECT_FALSE(check(exempt.network, options).is_conforming()) << "without a mesh nothing is";
    EXPECT_TRUE(check(strict.network, options).is_conforming());
}

TEST(Adaptation, ArcsThatCutThroughASphereComeBackToItsSurface) {
    ModelOptions model_options;
    model_options.resolution = 0.1;
    const LoadedMesh mesh = make_model("sphere", model_options);
    const SurfaceQueries queries(mesh.mesh);
    const Vec3 center = (bounding_box(mesh.mesh).min + bounding_box(mesh.mesh).max) / 2;
    // Samples on the surface, 45 degrees apart: the straight pieces run inside.
    FeatureCurveNetwork network;
    NetworkArc arc;
    for (int k = 0; k <= 4; ++k) {
        const double angle = k * std::numbers::pi / 4;
        const Vec3 direction(std::cos(angle), std::sin(angle), 0.3);
        const ClosestPoint at = queries.closest(center + 10 * direction);
        arc.samples.push_back({at.position, at.surface});
        if (k % 4 == 0) network.nodes.push_back({at.position, at.surface});
    }
    arc.nodes = {0, 1};
    network.arcs.push_back(arc);
    AdaptationOptions options = options_at(0.1 * bounding_box(mesh.mesh).diagonal());
    const AdaptationResult result = adapt_network(mesh, network, options);
    ASSERT_GT(result.network.segments.size(), 3u);
    EXPECT_TRUE(validate(result.network, mesh.mesh).empty());
    EXPECT_TRUE(check(result.network, options, &mesh.mesh).is_conforming());
}

TEST(Adaptation, PaperModeEndsAndSaysWhatRemains) {
    const LoadedMesh mesh = make_model("skyscraper");
    AdaptationOptions options = options_at(0.03 * bounding_box(mesh.mesh).diagonal());
    options.mode = AdaptationMode::Paper;
    const AdaptationResult result = adapt_network(mesh, detect_sharp(mesh), options);
    EXPECT_EQ(result.report.status, AdaptationStatus::Converged);
    EXPECT_TRUE(validate(result.network, mesh.mesh).empty());
    const ConformityReport report = check(result.network, options, &mesh.mesh);
    EXPECT_EQ(report.counted == 0, report.is_conforming());
    EXPECT_GT(result.report.coverage, 0.3);
}

}  // namespace
}  // namespace fcn::test
