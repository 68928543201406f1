#include "features/crest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "features/crest_measures.h"
#include "features/feature_meshes.h"
#include "features/features.h"
#include "features/local_fit.h"
#include "geometry/errors.h"
#include "geometry/models.h"
#include "support/shared_data.h"

namespace fcn {
namespace {

using testing::problems_of;

constexpr double kPi = std::numbers::pi;
constexpr double kRadius = 0.35, kTube = 0.15;  // of the model superellipse-torus
constexpr double kTruth = 8 * kPi * kRadius;

LoadedMesh model(const std::string& name, double resolution = 0.02) {
    ModelOptions options;
    options.resolution = resolution;
    return make_model(name, options);
}

LoadedMesh rebuilt(const LoadedMesh& mesh, const std::vector<int>& new_index,
                   const std::function<Vec3(const Vec3&)>& move) {
    std::vector<Vec3> points(mesh.mesh.n_vertices());
    for (const auto v : mesh.mesh.vertices()) points[new_index[v.idx()]] = move(mesh.mesh.point(v));
    std::vector<std::array<int, 3>> triangles;
    for (const auto f : mesh.mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh.mesh, f);
        triangles.push_back({new_index[a.idx()], new_index[b.idx()], new_index[c.idx()]});
    }
    return mesh_from_soup(points, triangles);
}

std::vector<int> same_order(const LoadedMesh& mesh) {
    std::vector<int> order(mesh.mesh.n_vertices());
    std::iota(order.begin(), order.end(), 0);
    return order;
}

/// Gaussian noise in all three directions, `share` of the diagonal.
LoadedMesh noisy(const LoadedMesh& mesh, double share, unsigned seed) {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> normal(0, share * bounding_box(mesh.mesh).diagonal());
    return rebuilt(mesh, same_order(mesh), [&](const Vec3& p) {
        return Vec3(p + Vec3(normal(engine), normal(engine), normal(engine)));
    });
}

double length_of_source(const FeatureCurveNetwork& network, const std::string& source) {
    double length = 0;
    for (const NetworkArc& arc : network.arcs) length += arc.source == source ? arc.length() : 0;
    return length;
}

/// Largest distance of the network's samples from the four crest circles.
double distance_from_truth(const FeatureCurveNetwork& network) {
    const double offset = kTube * std::pow(2, -0.25);
    double worst = 0;
    for (const NetworkArc& arc : network.arcs) {
        for (const ArcSample& sample : arc.samples) {
            const double radius = std::hypot(sample.position.x(), sample.position.y());
            worst = std::max(worst, std::hypot(std::abs(radius - kRadius) - offset,
                                               std::abs(sample.position.z()) - offset));
        }
    }
    return worst;
}

void expect_four_circles(const LoadedMesh& mesh, double scale = 1) {
    const auto network = detect_crest(mesh);
    EXPECT_EQ(network.arcs.size(), 4u);
    for (const NetworkArc& arc : network.arcs) {
        EXPECT_TRUE(arc.is_closed());
        EXPECT_EQ(arc.source, "crest-ridge");
    }
    EXPECT_NEAR(network.total_length() / (scale * kTruth), 1, 0.01);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
}

/// Curvature of the superellipse's profile at an angle, and its derivative by arc length, from the
/// implicit form f = x^4 + z^4: exact, but for the derivative's central difference.
double profile_curvature(double x, double z) {
    const double fx = 4 * x * x * x, fz = 4 * z * z * z;
    const double fxx = 12 * x * x, fzz = 12 * z * z;
    return (fxx * fz * fz + fzz * fx * fx) / std::pow(fx * fx + fz * fz, 1.5);
}

TEST(LocalFit, ProfileCurvatureOfASuperellipseAndItsDerivative) {
    const LoadedMesh mesh = model("superellipse-torus", 0.01);
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    const LocalFitter fitter(arrays, {});
    const auto fits = fitter.fit_all({.rings = 3});
    double kappa_error = 0, e_error = 0, kappa_scale = 0, e_scale = 0;
    for (int v = 0; v < arrays.vertex_count(); ++v) {
        ASSERT_TRUE(fits[v].is_valid);
        const Vec3& p = arrays.points[v];
        const double radius = std::hypot(p.x(), p.y());
        const auto curvature_at = [](double x, double z) {
            const double size = std::pow(x * x * x * x + z * z * z * z, 0.25) / kTube;
            return profile_curvature(x / size, z / size);
        };
        const double x = radius - kRadius, z = p.z();
        const double kappa = curvature_at(x, z);
        // Where the profile is the more curved direction.
        if (kappa < 2 * std::abs(x / std::hypot(x, z) / radius)) continue;
        const Eigen::Vector2d along =
            Eigen::Vector2d(-4 * z * z * z, 4 * x * x * x).normalized() * 1e-5;
        const double e = (curvature_at(x + along.x(), z + along.y()) -
                          curvature_at(x - along.x(), z - along.y())) /
                         2e-5;
        kappa_error += std::pow(fits[v].kappa_max - kappa, 2);
        e_error += std::pow(std::abs(fits[v].e_max) - std::abs(e), 2);
        kappa_scale += kappa * kappa;
        e_scale += e * e;
    }
    EXPECT_LT(kappa_error, 0.04 * 0.04 * kappa_scale);
    EXPECT_LT(e_error, 0.08 * 0.08 * e_scale);
}

TEST(LocalFit, ErrorsGrowWithNoise) {
    const LoadedMesh mesh = model("torus", 0.03);
    std::vector<double> medians;
    for (double share : {0.0, 0.002, 0.01}) {
        const LoadedMesh copy = noisy(mesh, share, 5);
        const MeshArrays arrays = mesh_arrays(copy.mesh);
        std::vector<double> errors;
        for (const VertexFit& fit : LocalFitter(arrays, {}).fit_all({.rings = 4}))
            errors.push_back(fit.e_error);
        std::nth_element(errors.begin(), errors.begin() + 500, errors.end());
        medians.push_back(errors[500]);
    }
    EXPECT_LT(1.5 * medians[0], medians[1]);
    EXPECT_LT(1.5 * medians[1], medians[2]);
}

TEST(Crest, FourCirclesOfASuperellipseTorus) {
    for (double resolution : {0.035, 0.02, 0.012}) {
        SCOPED_TRACE(resolution);
        const LoadedMesh mesh = model("superellipse-torus", resolution);
        expect_four_circles(mesh);
        EXPECT_LT(distance_from_truth(detect_crest(mesh)), 0.25 * resolution);
    }
}

TEST(Crest, FourCirclesWithNoise) {
    const LoadedMesh mesh = model("superellipse-torus");
    for (unsigned seed : {1u, 2u, 3u}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        expect_four_circles(noisy(mesh, 0.001, seed));
        expect_four_circles(noisy(mesh, 0.0003, seed));
    }
}

TEST(Crest, FourCirclesWithNoiseOfATenthAndAFifthOfAnEdge) {
    const double resolution = 0.02;
    const LoadedMesh mesh = model("superellipse-torus", resolution);
    const double diagonal = bounding_box(mesh.mesh).diagonal();
    for (double share : {0.1, 0.2}) {
        for (unsigned seed : {4u, 5u}) {
            SCOPED_TRACE("seed " + std::to_string(seed) + " noise " + std::to_string(share));
            const auto network = detect_crest(noisy(mesh, share * resolution / diagonal, seed));
            // At a fifth of an edge a circle may have a gap.
            if (share < 0.15) {
                EXPECT_EQ(network.arcs.size(), 4u);
            }
            EXPECT_LT(distance_from_truth(network), 1.5 * resolution);
            // The line lies on the noisy surface, and is longer for it.
            EXPECT_NEAR(network.total_length() / kTruth, 1, 0.5 * share);
        }
    }
}

// A line that follows every mesh edge up and down is 2% too long on the finer mesh.
TEST(Crest, LengthsAreRightWithNoiseOnFineMeshesToo) {
    for (double resolution : {0.03, 0.01}) {
        const auto network = detect_crest(noisy(model("superellipse-torus", resolution), 0.001, 1));
        EXPECT_EQ(network.arcs.size(), 4u);
        EXPECT_NEAR(network.total_length(), kTruth, 0.01 * kTruth) << "resolution " << resolution;
    }
}

TEST(Crest, NothingOnCyclidesAndPlanes) {
    for (const std::string name : {"torus", "sphere"}) {
        for (double share : {0.0, 0.0003, 0.001}) {
            for (double resolution : {0.045, 0.035, 0.02}) {
                SCOPED_TRACE(name + " " + std::to_string(share));
                EXPECT_EQ(detect_crest(noisy(model(name, resolution), share, 7)).arcs.size(), 0u);
            }
        }
    }
    for (double noise : {0.05, 0.2, 0.5}) {
        ModelOptions options;
        options.noise = noise;
        EXPECT_EQ(detect_crest(make_model("noisy-plane", options)).arcs.size(), 0u) << noise;
    }
    // The rims of a cylinder are sharp, its side is nothing.
    const auto cylinder = detect_crest(model("cylinder"));
    EXPECT_EQ(cylinder.arcs.size(), 2u);
    EXPECT_NEAR(length_of_source(cylinder, "sharp"), 2 * kPi, 0.01);
    CrestOptions smooth;
    smooth.is_sharp_first = false;
    smooth.min_length = 0.2;
    for (const NetworkArc& arc : detect_crest(model("cylinder"), smooth).arcs) {
        // Without creases the rims may come as crests: nothing runs along the side.
        for (const ArcSample& sample : arc.samples) {
            EXPECT_TRUE(sample.position.z() < 0.1 || sample.position.z() > 0.9);
        }
    }
}

TEST(Crest, DoesNotDependOnPlaceSizeOrOrder) {
    const LoadedMesh mesh = model("superellipse-torus", 0.03);
    const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, -0.5).normalized());
    expect_four_circles(rebuilt(mesh, same_order(mesh),
                                [&](const Vec3& p) { return Vec3(turn * p + Vec3(10, -3, 5)); }));
    for (double scale : {1 / kRadius, 1e-4, 1e4}) {
        SCOPED_TRACE(scale);
        expect_four_circles(
            rebuilt(mesh, same_order(mesh), [&](const Vec3& p) { return Vec3(scale * p); }), scale);
    }
    std::mt19937_64 engine(11);
    auto order = same_order(mesh);
    std::shuffle(order.begin(), order.end(), engine);
    const LoadedMesh shuffled = rebuilt(mesh, order, [](const Vec3& p) { return p; });
    expect_four_circles(shuffled);
    EXPECT_NEAR(detect_crest(shuffled).total_length(), detect_crest(mesh).total_length(), 1e-6);
}

TEST(Crest, LengthOfTheTorusOfRadiusOne) {
    const LoadedMesh mesh = model("superellipse-torus");
    const LoadedMesh large =
        rebuilt(mesh, same_order(mesh), [](const Vec3& p) { return Vec3(p / kRadius); });
    EXPECT_NEAR(detect_crest(large).total_length(), 25.13, 0.2513);
}

TEST(Crest, TurnedInsideOutRidgesAreRavines) {
    const LoadedMesh mesh = model("superellipse-torus");
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const auto v : mesh.mesh.vertices()) points.push_back(mesh.mesh.point(v));
    for (const auto f : mesh.mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh.mesh, f);
        triangles.push_back({a.idx(), c.idx(), b.idx()});
    }
    const LoadedMesh inside_out = mesh_from_soup(points, triangles);
    CrestOptions options;
    options.kind = CrestKind::Ravines;
    EXPECT_NEAR(length_of_source(detect_crest(inside_out, options), "crest-ravine"), kTruth,
                0.01 * kTruth);
    EXPECT_EQ(detect_crest(mesh, options).arcs.size(), 0u);
    options.kind = CrestKind::Ridges;
    EXPECT_EQ(detect_crest(inside_out, options).arcs.size(), 0u);
}

TEST(Crest, OpenPatchesAndSeveralComponents) {
    const LoadedMesh whole = model("superellipse-torus");
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const double shift : {0.0, 2.0}) {
        const int first = static_cast<int>(points.size());
        for (const auto v : whole.mesh.vertices())
            points.push_back(whole.mesh.point(v) + Vec3(shift, 0, 0));
        for (const auto f : whole.mesh.faces()) {
            const auto [a, b, c] = face_vertices(whole.mesh, f);
            if (whole.mesh.point(a).y() < 0.02) continue;
            triangles.push_back({first + a.idx(), first + b.idx(), first + c.idx()});
        }
    }
    const LoadedMesh mesh = mesh_from_soup(points, triangles);
    const auto network = detect_crest(mesh);
    EXPECT_EQ(network.arcs.size(), 8u);
    EXPECT_NEAR(network.total_length(), kTruth, 0.05 * kTruth);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    const auto bounded = add_boundaries(network, mesh, BoundaryPolicy::Keep);
    EXPECT_EQ(problems_of(bounded, mesh.mesh), "");
}

/// A long roof whose top is rounded: one ridge, from boundary to boundary.
double roof(double x) { return 12 - std::sqrt(9 + (x - 20) * (x - 20)); }

TEST(Crest, RidgeOfARoundedRoof) {
    const LoadedMesh mesh = testing::height_field(40, 60, [](double x, double) { return roof(x); });
    const auto network = detect_crest(mesh);
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_NEAR(network.arcs[0].length(), 60, 3);
    for (const ArcSample& sample : network.arcs[0].samples) {
        EXPECT_NEAR(sample.position.x(), 20, 0.1);
    }
}

TEST(Crest, ThinWallsKeepTheirSidesApart) {
    // Two roofs back to back, a twentieth of an edge apart, that share no vertex.
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const bool is_below : {false, true}) {
        const int first = static_cast<int>(points.size());
        const LoadedMesh sheet =
            testing::height_field(40, 60, [](double x, double) { return roof(x); });
        for (const auto v : sheet.mesh.vertices())
            points.push_back(sheet.mesh.point(v) - Vec3(0, 0, is_below ? 0.05 : 0));
        for (const auto f : sheet.mesh.faces()) {
            const auto [a, b, c] = face_vertices(sheet.mesh, f);
            triangles.push_back(
                is_below ? std::array{first + a.idx(), first + c.idx(), first + b.idx()}
                         : std::array{first + a.idx(), first + b.idx(), first + c.idx()});
        }
    }
    const auto network = detect_crest(mesh_from_soup(points, triangles));
    ASSERT_EQ(network.arcs.size(), 2u);
    EXPECT_NE(network.arcs[0].source, network.arcs[1].source);
    for (const NetworkArc& arc : network.arcs) EXPECT_NEAR(arc.length(), 60, 3);
}

TEST(Crest, RunsIntoTheCreaseItMeets) {
    // The rounded roof bends down at a crease: the ridge runs into it from both sides.
    const LoadedMesh mesh = testing::height_field(
        40, 60, [](double x, double y) { return roof(x) - std::max(0.0, 1.5 * (y - 40)); });
    const auto network = detect_crest(mesh);
    const auto valences = network.valences();
    EXPECT_EQ(*std::max_element(valences.begin(), valences.end()), 4)
        << "two halves of the ridge and two of the crease";
    EXPECT_GT(length_of_source(network, "sharp"), 35);
    EXPECT_GT(length_of_source(network, "crest-ridge"), 68);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
}

TEST(Crest, CreasesAloneAreThoseOfTheSharpDetector) {
    for (const std::string name : {"box", "steps", "gear"}) {
        const LoadedMesh mesh = model(name);
        const auto network = detect_crest(mesh);
        const auto sharp = detect_sharp(mesh);
        EXPECT_EQ(network.arcs.size(), sharp.arcs.size()) << name;
        EXPECT_NEAR(network.total_length(), sharp.total_length(), 1e-9) << name;
    }
}

TEST(Crest, DegenerateFaces) {
    // Needles and points of no area, kept as they are: no crash, a valid network.
    LoadedMesh mesh = model("superellipse-torus", 0.04);
    for (int i = 0; i < 40; ++i) {
        const auto edge = mesh.mesh.edge_handle(97 * i);
        const auto h = mesh.mesh.halfedge_handle(edge, 0);
        mesh.mesh.set_point(mesh.mesh.from_vertex_handle(h),
                            mesh.mesh.point(mesh.mesh.to_vertex_handle(h)));
    }
    const auto network = detect_crest(mesh);
    for (const NetworkArc& arc : network.arcs) {
        for (const ArcSample& sample : arc.samples) EXPECT_TRUE(sample.position.allFinite());
    }
    EXPECT_EQ(detect_crest(LoadedMesh{}).arcs.size(), 0u);
}

TEST(Crest, SameOnOneThreadAndTwo) {
    const LoadedMesh mesh = noisy(model("superellipse-torus", 0.03), 0.001, 3);
    CrestOptions options;
    const auto one = detect_crest(mesh, options);
    options.threads = 2;
    const auto two = detect_crest(mesh, options);
    ASSERT_EQ(one.arcs.size(), two.arcs.size());
    for (std::size_t a = 0; a < one.arcs.size(); ++a) {
        ASSERT_EQ(one.arcs[a].samples.size(), two.arcs[a].samples.size());
        for (std::size_t i = 0; i < one.arcs[a].samples.size(); ++i)
            EXPECT_EQ(one.arcs[a].samples[i].position, two.arcs[a].samples[i].position);
    }
}

TEST(Crest, EveryThresholdRemovesLinesOnly) {
    const LoadedMesh mesh = model("superellipse-torus", 0.03);
    const double all = detect_crest(mesh).total_length();
    const std::map<std::string, std::function<void(CrestOptions&)>> thresholds{
        {"ridgeness", [](CrestOptions& o) { o.min_ridgeness = 30; }},
        {"sphericalness", [](CrestOptions& o) { o.min_sphericalness = 0.99; }},
        {"cyclideness", [](CrestOptions& o) { o.min_cyclideness = 400; }},
        {"length", [](CrestOptions& o) { o.min_length = 2; }},
    };
    // Each tells the two long outer circles (or the two inner ones) from the others.
    const double outer = 4 * kPi * (kRadius + kTube * std::pow(2, -0.25));
    for (const auto& [name, set] : thresholds) {
        CrestOptions options;
        set(options);
        const auto network = detect_crest(mesh, options);
        EXPECT_EQ(network.arcs.size(), 2u) << name;
        const double expected = name == "sphericalness" ? kTruth - outer : outer;
        EXPECT_NEAR(network.total_length(), expected, 0.02 * all) << name;
    }
    for (double CrestOptions::*option :
         {&CrestOptions::min_significance, &CrestOptions::min_sharpness}) {
        CrestOptions options;
        options.*option = 1e6;
        EXPECT_EQ(detect_crest(mesh, options).arcs.size(), 0u);
    }
}

TEST(Crest, OptionsOutOfRangeAreRefused) {
    const LoadedMesh mesh = model("sphere", 0.1);
    for (const auto& [option, value] : std::vector<std::pair<double CrestOptions::*, double>>{
             {&CrestOptions::rings, 1},
             {&CrestOptions::rings, 1000},
             {&CrestOptions::radius, -1},
             {&CrestOptions::radius, NAN},
             {&CrestOptions::min_length, -1},
             {&CrestOptions::min_sphericalness, 2},
             {&CrestOptions::snap, 0.6},
             {&CrestOptions::gap, NAN}}) {
        CrestOptions options;
        options.*option = value;
        EXPECT_THROW(detect_crest(mesh, options), InputError) << value;
    }
}

TEST(Crest, ArcsOfOneLineAreOneCurve) {
    const auto folder = testing::shared_data();
    if (!folder) GTEST_SKIP() << "no shared data";
    const LoadedMesh mesh = read_mesh(*folder / "meshes" / "camel.off");
    FeatureCurveNetwork network = detect_crest(mesh);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    find_curves(network);
    const auto supporting = supporting_curves(network);
    std::map<int, double> length_of_line;
    for (const NetworkArc& arc : network.arcs) length_of_line[arc.patches[0]] += arc.length();
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        const NetworkArc& arc = network.arcs[a];
        if (arc.source == "sharp") continue;
        EXPECT_LE(supporting[a].length, length_of_line[arc.patches[0]] * (1 + 1e-9));
        for (int member : network.curves[arc.curve].arcs)
            EXPECT_EQ(network.arcs[member].patches, arc.patches);
    }
}

/// Two creases side by side are no rounded crest: a square tube with chamfers of one edge.
TEST(Crest, ChamfersAreCreases) {
    constexpr int kLength = 40, kSide = 10;
    std::vector<Vec3> profile;
    for (int side = 0; side < 4; ++side) {
        const double c = std::round(std::cos(side * kPi / 2)),
                     s = std::round(std::sin(side * kPi / 2));
        for (int i = 0; i <= kSide; ++i) {
            const double x = kSide / 2.0 + std::sqrt(0.5), y = i - kSide / 2.0;
            profile.emplace_back(c * x - s * y, s * x + c * y, 0);
        }
    }
    const int count = static_cast<int>(profile.size());
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (int z = 0; z <= kLength; ++z)
        for (const Vec3& p : profile) points.emplace_back(p.x(), p.y(), z);
    for (int z = 0; z < kLength; ++z) {
        for (int i = 0; i < count; ++i) {
            const int a = z * count + i, b = z * count + (i + 1) % count;
            triangles.push_back({a, b, b + count});
            triangles.push_back({a, b + count, a + count});
        }
    }
    const FeatureCurveNetwork found = detect_crest(mesh_from_soup(points, triangles));
    EXPECT_EQ(found.arcs.size(), 8u);
    EXPECT_NEAR(length_of_source(found, "sharp"), 8 * kLength, 1e-9);
}

}  // namespace
}  // namespace fcn
