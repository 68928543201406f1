#include "features/wire.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <queue>
#include <random>

#include "features/feature_meshes.h"
#include "features/features.h"
#include "features/wire_search.h"
#include "geometry/errors.h"
#include "geometry/models.h"
#include "geometry/surface_queries.h"

namespace fcn {
namespace {

using testing::folded_strip;
using testing::height_field;
using testing::kDegree;
using testing::problems_of;

WireRequest wire(std::vector<Vec3> points, bool is_closed = false, bool is_pinned = false) {
    WireRequest request;
    request.points = std::move(points);
    request.is_closed = is_closed;
    request.is_pinned = is_pinned;
    request.place = "test: /wires/0";
    return request;
}

WireOptions isotropic() {
    WireOptions options;
    options.attraction = 0;
    return options;
}

std::map<int, int> valence_counts(const FeatureCurveNetwork& network) {
    std::map<int, int> counts;
    for (int valence : network.valences()) ++counts[valence];
    return counts;
}

/// A prism of n sides and radius 1 without caps: unrolled it is a plane.
LoadedMesh prism(int sides, int rows) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (int y = 0; y <= rows; ++y) {
        for (int k = 0; k < sides; ++k) {
            const double angle = 2 * std::numbers::pi * k / sides;
            points.emplace_back(std::cos(angle), std::sin(angle), 4.0 * y / rows);
        }
    }
    for (int y = 0; y < rows; ++y) {
        for (int k = 0; k < sides; ++k) {
            const int a = y * sides + k, b = y * sides + (k + 1) % sides;
            triangles.push_back({a, b, b + sides});
            triangles.push_back({a, b + sides, a + sides});
        }
    }
    return mesh_from_soup(points, triangles);
}

TEST(Wire, IsStraightOnAPlane) {
    const LoadedMesh mesh = height_field(30, 30, [](double, double) { return 0.0; });
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> place(0.5, 29.5);
        const Vec3 a(place(random), place(random), 0), b(place(random), place(random), 0);
        for (const WireOptions& options : {WireOptions(), isotropic()}) {
            const FeatureCurveNetwork network = detect_wires(mesh, {wire({a, b})}, options);
            EXPECT_EQ(problems_of(network, mesh.mesh), "") << "seed " << seed;
            ASSERT_EQ(network.arcs.size(), 1u) << "seed " << seed;
            EXPECT_EQ(network.arcs[0].source, "wire");
            EXPECT_LE(network.total_length(), (b - a).norm() * 1.001) << "seed " << seed;
            EXPECT_GE(network.total_length(), (b - a).norm() * (1 - 1e-9)) << "seed " << seed;
        }
    }
}

TEST(Wire, IsAsLongAsOnTheUnrolledPrism) {
    const int sides = 40;
    const LoadedMesh mesh = prism(sides, 31);
    const double width = 2 * std::sin(std::numbers::pi / sides);
    for (int turn : {0, 5, 11, 18}) {
        for (double height : {0.3, 1.7, 3.5}) {
            const double angle = 2 * std::numbers::pi * turn / sides;
            const Vec3 a(1, 0, 0.2), b(std::cos(angle), std::sin(angle), 0.2 + height);
            const double exact = std::hypot(turn * width, height);
            const FeatureCurveNetwork network = detect_wires(mesh, {wire({a, b})}, isotropic());
            EXPECT_GE(network.total_length(), exact * (1 - 1e-9)) << turn << " " << height;
            EXPECT_LE(network.total_length(), exact * 1.001) << turn << " " << height;
        }
    }
}

TEST(Wire, RunsAlongMeridiansOfATorus) {
    const LoadedMesh mesh = make_model("torus");
    const BoundingBox box = bounding_box(mesh.mesh);
    const double tube = (box.max.z() - box.min.z()) / 2, ring = box.max.x() - tube;
    const double middle = (box.max.z() + box.min.z()) / 2;
    for (double degrees : {40.0, 90.0, 150.0}) {
        const double u = 0.37, v = degrees * kDegree;
        const auto at = [&](double angle) {
            const double r = ring + tube * std::cos(angle);
            return Vec3(r * std::cos(u), r * std::sin(u), middle + tube * std::sin(angle));
        };
        const FeatureCurveNetwork network = detect_wires(mesh, {wire({at(0), at(v)})}, isotropic());
        EXPECT_NEAR(network.total_length(), tube * v, 0.01 * tube * v) << degrees;
    }
}

TEST(Wire, FollowsACrease) {
    const LoadedMesh mesh = folded_strip(30, 40, 15, [](double) { return 60 * kDegree; });
    const Vec3 a(13, 2, 0), b(13, 38, 0);
    const auto distance_in_the_middle = [&](const WireOptions& options) {
        const FeatureCurveNetwork network = detect_wires(mesh, {wire({a, b})}, options);
        EXPECT_EQ(problems_of(network, mesh.mesh), "");
        double farthest = 0;
        for (const ArcSample& sample : network.arcs[0].samples)
            if (sample.position.y() > 8 && sample.position.y() < 32)
                farthest = std::max(farthest, std::abs(sample.position.x() - 15));
        return farthest;
    };
    EXPECT_LT(distance_in_the_middle({}), 1e-9);
    EXPECT_GT(distance_in_the_middle(isotropic()), 1.9);
}

TEST(Wire, SeedsBesideACreaseMakeNoSpurs) {
    const LoadedMesh mesh = folded_strip(30, 40, 15, [](double) { return 60 * kDegree; });
    WireOptions options;
    options.snap = 0.02;
    const FeatureCurveNetwork network =
        detect_wires(mesh, {wire({{14.3, 2.2, 0}, {14.7, 20.4, 0}, {14.4, 37.8, 0}})}, options);
    ASSERT_EQ(network.arcs.size(), 1u);
    for (const ArcSample& sample : network.arcs[0].samples)
        EXPECT_NEAR(sample.position.x(), 15, 1e-9);
    EXPECT_NEAR(network.total_length(), 37.8 - 2.2, 1e-6);
    // Given as they are, the middle one is visited.
    options.snap = 0;
    const FeatureCurveNetwork spurs =
        detect_wires(mesh, {wire({{14.3, 2.2, 0}, {14.7, 20.4, 0}, {14.4, 37.8, 0}})}, options);
    double closest = 1e300;
    for (const NetworkArc& arc : spurs.arcs)
        for (const ArcSample& sample : arc.samples)
            closest = std::min(closest, (sample.position - Vec3(14.7, 20.4, 0)).norm());
    EXPECT_LT(closest, 1e-9);
}

TEST(Wire, FollowsARoundedRidge) {
    // A ridge that no edge of the mesh follows: across the grid, rounded over several cells.
    const Vec3 along = Vec3(2, 5, 0).normalized(), across(along.y(), -along.x(), 0);
    const LoadedMesh mesh = height_field(40, 40, [&](double x, double y) {
        const double d = (Vec3(x, y, 0) - Vec3(20, 20, 0)).dot(across);
        return -std::sqrt(d * d + 1);
    });
    WireOptions options;
    options.length = 3;
    const SurfaceQueries queries(mesh.mesh);
    const auto seed = [&](double t) {
        const Vec3 p = Vec3(20, 20, 0) + t * along + 1.2 * across;
        return queries.closest(Vec3(p.x(), p.y(), -1.5)).position;
    };
    const FeatureCurveNetwork network = detect_wires(mesh, {wire({seed(-16), seed(16)})}, options);
    for (const ArcSample& sample : network.arcs[0].samples) {
        const Vec3 d = Vec3(sample.position.x(), sample.position.y(), 0) - Vec3(20, 20, 0);
        if (std::abs(d.dot(along)) < 9) {
            EXPECT_LT(std::abs(d.dot(across)), 0.5) << d.dot(along);
        }
    }
}

LoadedMesh transformed(const LoadedMesh& mesh, const Eigen::Affine3d& map) {
    LoadedMesh result = mesh;
    for (const VertexHandle v : result.mesh.vertices())
        result.mesh.set_point(v, map * mesh.mesh.point(v));
    return result;
}

TEST(Wire, DoesNotDependOnPoseAndSize) {
    const LoadedMesh mesh = make_model("octaflower");
    std::vector<Vec3> seeds;
    for (int v : {10, 400, 900, 1500}) seeds.push_back(mesh.mesh.point(VertexHandle(v)));
    const FeatureCurveNetwork expected = detect_wires(mesh, {wire(seeds)});
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.translate(Vec3(3, -2, 7));
    map.rotate(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()));
    for (double scale : {1.0, 250.0, 0.004}) {
        Eigen::Affine3d scaled = map;
        scaled.scale(scale);
        std::vector<Vec3> moved;
        for (const Vec3& p : seeds) moved.push_back(scaled * p);
        const LoadedMesh other = transformed(mesh, scaled);
        const FeatureCurveNetwork network = detect_wires(other, {wire(moved)});
        EXPECT_EQ(problems_of(network, other.mesh), "");
        // Rounding may choose another of two equal ways around a vertex, but none that is longer.
        EXPECT_NEAR(network.total_length() / scale, expected.total_length(),
                    1e-3 * expected.total_length());
        EXPECT_EQ(network.arcs.size(), expected.arcs.size());
    }
}

TEST(Wire, IsTheSameOnAnyNumberOfThreads) {
    const LoadedMesh mesh = make_model("octaflower");
    std::vector<FeatureCurveNetwork> networks;
    for (int threads : {1, 3}) {
        WireOptions options;
        options.threads = threads;
        WireRequest request;
        request.vertices = {3, 700, 1300};
        networks.push_back(detect_wires(mesh, {request}, options));
    }
    ASSERT_EQ(networks[0].arcs.size(), networks[1].arcs.size());
    for (std::size_t a = 0; a < networks[0].arcs.size(); ++a) {
        const auto &one = networks[0].arcs[a].samples, &other = networks[1].arcs[a].samples;
        ASSERT_EQ(one.size(), other.size());
        for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].position, other[k].position);
    }
}

/// Cost of the cheapest path along mesh edges, by relaxing every edge until nothing changes.
double edge_path_cost(const MeshArrays& arrays, const WireMetric& metric, int from, int to) {
    std::vector<double> cost(arrays.vertex_count(), 1e300);
    cost[from] = 0;
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (int e = 0; e < arrays.edge_count(); ++e) {
            const double step = arrays.edge_length(e) * metric.along(e);
            const auto [a, b] = arrays.edge_vertices[e];
            for (const auto& [u, v] : {std::pair(a, b), std::pair(b, a)}) {
                if (cost[u] + step >= cost[v]) continue;
                cost[v] = cost[u] + step;
                has_changed = true;
            }
        }
    }
    return cost[to];
}

TEST(WireSearch, BandsLoseLittleAndEdgesAreNeverCheaper) {
    for (const char* name : {"octaflower", "ribs", "torus"}) {
        const LoadedMesh mesh = make_model(name);
        const MeshArrays arrays = mesh_arrays(mesh.mesh);
        for (double attraction : {0.0, 5.0}) {
            WireMetricOptions options;
            options.length = 0.03;
            options.attraction = attraction;
            const WireMetric metric(arrays, options);
            WireSearch whole(arrays, metric, {1'000'000'000}), band(arrays, metric, {0});
            const IndexRows faces = faces_of_vertices(arrays);
            const std::uint64_t seed = 5;
            std::mt19937_64 random(seed);
            for (int trial = 0; trial < 8; ++trial) {
                const int u = static_cast<int>(random() % arrays.points.size());
                const int v = static_cast<int>(random() % arrays.points.size());
                const auto point = [&](int vertex) {
                    return whole.point_at(
                        surface_point_of_vertex(arrays, vertex, *faces.begin(vertex)));
                };
                const WirePath best = whole.path(point(u), point(v));
                const WirePath fast = band.path(point(u), point(v));
                const double by_edges = edge_path_cost(arrays, metric, u, v);
                EXPECT_LE(best.cost, by_edges * (1 + 1e-9)) << name << " " << u << " " << v;
                EXPECT_LE(fast.cost, by_edges * (1 + 1e-9)) << name << " " << u << " " << v;
                EXPECT_LE(fast.cost, best.cost * 1.1) << name << " " << u << " " << v;
                const WirePath back = whole.path(point(v), point(u));
                EXPECT_NEAR(back.cost, best.cost, 0.01 * best.cost) << name << " " << u << " " << v;
            }
        }
    }
}

TEST(Wire, CrossingWiresGetAJunction) {
    const LoadedMesh mesh = height_field(20, 20, [](double, double) { return 0.0; });
    const FeatureCurveNetwork network =
        detect_wires(mesh, {wire({{2, 3, 0}, {18, 14, 0}}), wire({{3, 17, 0}, {15.3, 1, 0}}),
                            wire({{2, 3, 0}, {3, 17, 0}})});
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    // The third wire closes a ring through the ends of the others: no node stays there.
    EXPECT_EQ(valence_counts(network), (std::map<int, int>{{1, 2}, {4, 1}}));
    EXPECT_EQ(network.arcs.size(), 3u);
}

TEST(Wire, ClosedWireIsOneRing) {
    const LoadedMesh mesh = height_field(20, 20, [](double, double) { return 0.0; });
    const FeatureCurveNetwork network =
        detect_wires(mesh, {wire({{4, 4, 0}, {16, 5, 0}, {12, 15, 0}}, true, true)});
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_TRUE(network.arcs[0].is_closed());
    EXPECT_EQ(network.arcs[0].pin, Pin::Keep);
    const double exact = std::hypot(12, 1) + std::hypot(4, 10) + std::hypot(8, 11);
    EXPECT_NEAR(network.total_length(), exact, 1e-3 * exact);
}

TEST(Wire, GoingBackAddsNothing) {
    const LoadedMesh mesh = height_field(20, 20, [](double, double) { return 0.0; });
    const FeatureCurveNetwork network =
        detect_wires(mesh, {wire({{4, 4, 0}, {16, 4, 0}, {8, 4, 0}})});
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    EXPECT_NEAR(network.total_length(), 12, 1e-6);
}

TEST(Wire, BadSeedsAreRefused) {
    const LoadedMesh mesh = height_field(10, 10, [](double, double) { return 0.0; });
    const auto message = [&](const WireRequest& request) {
        try {
            detect_wires(mesh, {request});
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    const auto has = [&](const WireRequest& request, const std::string& part) {
        const std::string text = message(request);
        EXPECT_NE(text.find("test: /wires/0"), std::string::npos) << text;
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    has(wire({{1, 1, 0}, {5, 5, 3}}), "/points/1: (5");
    has(wire({{1, 1, 0}}), "needs 2");
    has(wire({}), "needs 2");
    has(wire({{1, 1, 0}, {5, 5, 0}}, true), "needs 3");
    has(wire({{1, 1, 0}, {1, 1, 0}}), "same point");
    has(wire({{1, 1, 0}, {5, 5, 0}, {5, 1, 0}, {1, 1, 0}}, true), "first seed");
    has(wire({{1, 1, 0}, {std::nan(""), 1, 0}}), "not finite");
    WireRequest vertices = wire({});
    vertices.vertices = {3, 100000};
    has(vertices, "vertex 100000 does not exist");
    WireOptions bad;
    bad.max_anisotropy = 0.5;
    EXPECT_THROW(detect_wires(mesh, {wire({{1, 1, 0}, {5, 5, 0}})}, bad), InputError);
}

TEST(Wire, ComponentsAreNotJoined) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (double x : {0.0, 5.0}) {
        const int first = static_cast<int>(points.size());
        points.insert(points.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
        triangles.push_back({first, first + 1, first + 2});
        triangles.push_back({first, first + 2, first + 3});
    }
    const LoadedMesh mesh = mesh_from_soup(points, triangles);
    try {
        detect_wires(mesh, {wire({{0.2, 0.1, 0}, {5.2, 0.1, 0}})});
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("different components"), std::string::npos);
    }
    EXPECT_NEAR(detect_wires(mesh, {wire({{0.2, 0.1, 0}, {0.3, 0.9, 0}})}).total_length(),
                std::hypot(0.1, 0.8), 1e-6);
}

TEST(WireSeeds, FilesAreReadOrRefused) {
    const auto read = [](const std::string& text) { return read_wires(text, "seeds.json"); };
    const auto wires = read(R"({"wires":[{"points":[[0,1,2],[3,4,5.5]],"closed":true},
                                         {"vertices":[7,8,9],"pin":true}]})");
    ASSERT_EQ(wires.size(), 2u);
    EXPECT_EQ(wires[0].points[1], Vec3(3, 4, 5.5));
    EXPECT_TRUE(wires[0].is_closed);
    EXPECT_FALSE(wires[0].is_pinned);
    EXPECT_EQ(wires[1].vertices, (std::vector<int>{7, 8, 9}));
    EXPECT_TRUE(wires[1].is_pinned);
    EXPECT_EQ(wires[1].place, "seeds.json: /wires/1");
    for (const std::string text :
         {"", "{", "[]", "{}", R"({"wires":[]})", R"({"wires":{}})", R"({"wires":[{}]})",
          R"({"wires":[{"points":[[0,1,2],[3,4,5]],"colsed":true}]})",
          R"({"wires":[{"points":[[0,1,2]],"vertices":[1,2]}]})",
          R"({"wires":[{"points":[[0,1],[3,4,5]]}]})",
          R"({"wires":[{"points":[[0,1,NaN],[3,4,5]]}]})",
          R"({"wires":[{"points":[[0,1,1e999],[3,4,5]]}]})",
          R"({"wires":[{"points":[[0,1,"2"],[3,4,5]]}]})", R"({"wires":[{"vertices":[-1,2]}]})",
          R"({"wires":[{"vertices":[1.5,2]}]})", R"({"wires":[{"vertices":[1,2],"pin":1}]})",
          R"({"wires":[{"vertices":[1,2]}],"name":"x"})"}) {
        try {
            read(text);
            FAIL() << "accepted: " << text;
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()).rfind("seeds.json: ", 0), 0u) << error.what();
        }
    }
}

TEST(WireLinks, CloseTheGapOfACrease) {
    // The crease fades below what counts as sharp, but is still there.
    const auto faded = [](double depth, double width) {
        return folded_strip(30, 60, 15, [=](double y) {
            return (50 - depth * std::exp(-std::pow((y - 30) / width, 4))) * kDegree;
        });
    };
    WireOptions options;
    options.length = 4;
    const LoadedMesh mesh = faded(36, 5);
    const FeatureCurveNetwork sharp = detect_sharp(mesh);
    ASSERT_EQ(sharp.arcs.size(), 2u);
    const FeatureCurveNetwork links = link_loose_ends(mesh, sharp, options);
    EXPECT_EQ(problems_of(links, mesh.mesh), "");
    ASSERT_EQ(links.arcs.size(), 1u);
    for (const ArcSample& sample : links.arcs[0].samples) EXPECT_NEAR(sample.position.x(), 15, 0.6);
    // Where it fades to a plane nothing attracts a link.
    const LoadedMesh flat = faded(50, 9);
    const FeatureCurveNetwork pieces = detect_sharp(flat);
    ASSERT_EQ(pieces.arcs.size(), 2u);
    EXPECT_TRUE(link_loose_ends(flat, pieces, options, {0.5, 0.02}).arcs.empty());
}

}  // namespace
}  // namespace fcn
