// Sharp edges of parts whose curves are known, with noise.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "features/features.h"
#include "features/sharp_edges.h"
#include "geometry/models.h"
#include "known_curves.h"
#include "support/shared_data.h"

namespace fcn {
namespace {

void expect_found(const KnownPart& part, double noise, double precision, double recall,
                  double most_curves) {
    const KnownCurves known = known_curves(part);
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE(part.name + ", noise " + std::to_string(noise) + ", seed " +
                     std::to_string(seed));
        const FeatureCurveNetwork found = detect_sharp(noisy_mesh(part, noise, seed));
        const CurveScore s = score(found, known, 0.5 * part.mean_edge());
        EXPECT_GE(s.precision, precision);
        EXPECT_GE(s.recall, recall);
        EXPECT_LE(static_cast<double>(s.curve_count),
                  most_curves * static_cast<double>(known.required.arcs.size()));
    }
}

TEST(SharpWithNoise, CreasesOfModelsComeWhole) {
    for (const char* name : {"box", "cylinder", "steps", "gear", "ribs", "octaflower"}) {
        const KnownPart part = model_part(name, 8000);
        for (double noise : {0.0, 0.05, 0.1}) expect_found(part, noise, 0.99, 0.96, 1.25);
    }
}

TEST(SharpWithNoise, TwiceTheNoiseLosesLittle) {
    for (const char* name : {"box", "cylinder", "steps", "gear"})
        expect_found(model_part(name, 8000), 0.2, 0.93, 0.93, 1.5);
}

TEST(SharpWithNoise, FinerMeshesOfAPartGiveTheSameCreases) {
    for (const char* name : {"box", "gear", "steps"}) {
        const KnownPart coarse = model_part(name, 8000), fine = model_part(name, 40000);
        const auto a = detect_sharp(noisy_mesh(coarse, 0.1, 1));
        const auto b = detect_sharp(noisy_mesh(fine, 0.1, 2));
        const double tolerance = 0.5 * coarse.mean_edge();
        EXPECT_GE(share_near(a, b, tolerance), 0.98) << name;
        EXPECT_GE(share_near(b, a, tolerance), 0.98) << name;
    }
}

TEST(SharpWithNoise, SmoothSurfacesHaveNone) {
    for (const char* name : {"sphere", "torus"}) {
        const KnownPart part = model_part(name, 8000);
        for (double noise : {0.05, 0.1, 0.2})
            EXPECT_TRUE(detect_sharp(noisy_mesh(part, noise, 1)).arcs.empty())
                << name << " noise " << noise;
    }
    // A spike among fifty thousand vertices.
    EXPECT_TRUE(detect_sharp(noisy_mesh(model_part("sphere", 100000), 0.2, 1)).arcs.empty());
}

TEST(SharpWithNoise, LengthsAreThoseOfTheCreases) {
    for (const char* name : {"box", "cylinder", "steps", "gear", "ribs"}) {
        const KnownPart part = model_part(name, 8000);
        const double known = known_curves(part).required.total_length();
        for (double noise : {0.05, 0.1})
            EXPECT_NEAR(detect_sharp(noisy_mesh(part, noise, 1)).total_length(), known,
                        0.02 * known)
                << name << " noise " << noise;
    }
}

TEST(SharpWithNoise, VsaOfANoisyBoxIsSixPatches) {
    for (int faces : {6000, 20000}) {
        const KnownPart part = model_part("box", faces);
        const FeatureCurveNetwork found = detect_vsa(noisy_mesh(part, 0.1, 1));
        const CurveScore s = score(found, known_curves(part), 0.5 * part.mean_edge());
        EXPECT_EQ(s.curve_count, 12u);
        EXPECT_GE(s.precision, 0.99);
        EXPECT_GE(s.recall, 0.99);
    }
}

TEST(SharpWithNoise, StraighteningKeepsCornersAndCleanPlaces) {
    constexpr int kSize = 12;
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    const auto id = [](int x, int y) { return y * (kSize + 1) + x; };
    for (int y = 0; y <= kSize; ++y) {
        for (int x = 0; x <= kSize; ++x)
            points.emplace_back(x, y + (y > 0 && y < kSize ? 0.2 * (x % 2) : 0), 0);
    }
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            triangles.push_back({id(x, y), id(x + 1, y), id(x + 1, y + 1)});
            triangles.push_back({id(x, y), id(x + 1, y + 1), id(x, y + 1)});
        }
    }
    const MeshArrays arrays = mesh_arrays(mesh_from_soup(points, triangles).mesh);
    // Along a row that zigzags, then up a column.
    std::vector<bool> is_marked(arrays.edge_count(), false);
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const auto [a, b] = std::minmax(arrays.edge_vertices[e][0], arrays.edge_vertices[e][1]);
        const int x = a % (kSize + 1), y = a / (kSize + 1);
        is_marked[e] = (b == a + 1 && y == 6 && x > 0 && x < 6) ||
                       (b == a + kSize + 1 && x == 6 && y >= 6 && y < kSize - 1);
    }
    const EdgeNetwork edges = trace_edges(arrays, is_marked, {}, "sharp");
    ASSERT_EQ(edges.network.arcs.size(), 1u);
    RobustDihedrals dihedrals{arrays.dihedrals, std::vector<bool>(arrays.edge_count(), true),
                              arrays.normals, 0};
    const NetworkArc arc = straighten_noisy(arrays, dihedrals, edges).arcs[0];
    EXPECT_LT(arc.length(), edges.network.arcs[0].length() - 0.03);
    double to_corner = 1;
    for (const ArcSample& sample : arc.samples)
        to_corner = std::min(to_corner, (sample.position - arrays.points[id(6, 6)]).norm());
    EXPECT_EQ(to_corner, 0);
    dihedrals.is_noisy_edge.assign(arrays.edge_count(), false);
    const NetworkArc same = straighten_noisy(arrays, dihedrals, edges).arcs[0];
    EXPECT_EQ(same.length(), edges.network.arcs[0].length());
}

/// A square tube of edge length one whose edges are rounded with a radius; open at both ends.
KnownPart rounded_tube(double radius) {
    constexpr double kSide = 16;
    constexpr int kLength = 60;
    std::vector<Vec3> profile;
    for (int side = 0; side < 4; ++side) {
        const double turn = side * std::numbers::pi / 2;
        const auto add = [&](double x, double y) {
            profile.emplace_back(std::cos(turn) * x - std::sin(turn) * y,
                                 std::sin(turn) * x + std::cos(turn) * y, 0);
        };
        const double half = kSide / 2, straight = kSide - 2 * radius;
        const int steps = static_cast<int>(std::round(straight));
        for (int i = 0; i < steps; ++i) add(half, radius - half + straight * i / steps);
        const int facets = static_cast<int>(std::round(radius * std::numbers::pi / 2));
        for (int i = 0; i < facets; ++i) {
            const double angle = i * std::numbers::pi / 2 / facets;
            add(half - radius + radius * std::cos(angle), half - radius + radius * std::sin(angle));
        }
    }
    KnownPart part;
    part.name = "tube of radius " + std::to_string(radius);
    const int count = static_cast<int>(profile.size());
    for (int z = 0; z <= kLength; ++z)
        for (const Vec3& p : profile) part.points.emplace_back(p.x(), p.y(), z);
    for (int z = 0; z < kLength; ++z) {
        for (int i = 0; i < count; ++i) {
            const int a = z * count + i, b = z * count + (i + 1) % count;
            part.triangles.push_back({a, b, b + count});
            part.triangles.push_back({a, b + count, a + count});
        }
    }
    return part;
}

TEST(SharpWithNoise, RoundedEdgesAreNone) {
    for (double noise : {0.05, 0.08, 0.1}) {
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
            SCOPED_TRACE("noise " + std::to_string(noise) + ", seed " + std::to_string(seed));
            const auto length = [&](double radius) {
                return detect_sharp(noisy_mesh(rounded_tube(radius), noise, seed)).total_length();
            };
            EXPECT_NEAR(length(0), 4 * 60, 0.03 * 4 * 60);
            for (double radius : {2, 3}) EXPECT_LE(length(radius), 0.1 * 4 * 60) << radius;
        }
    }
}

TEST(SharpWithNoise, CadPartsKeepTheirCurves) {
    const auto folder = testing::shared_data();
    if (!folder) GTEST_SKIP() << "no shared data";
    for (const char* name : {"frame.off", "CrankArm.off"}) {
        const KnownPart part = cad_part(*folder / "meshes" / name);
        expect_found(part, 0, 0.95, 0.98, 3);
        expect_found(part, 0.1, 0.95, 0.97, 3);
    }
}

}  // namespace
}  // namespace fcn
