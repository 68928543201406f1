// The checker's surface distances, closest points and box tree against closed forms, fine graphs
// and brute force.

#include "adaptation/conformity_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <random>

#include "adaptation/conformity_boxes.h"
#include "adaptation/conformity_geodesic.h"
#include "adaptation/conformity_measures.h"
#include "networks.h"

namespace fcn::conformity {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    int below(int count) { return static_cast<int>(engine_() % count); }

private:
    std::mt19937_64 engine_;
};

Foot foot_in(const FlatMesh& mesh, int face, double u, double v) {
    Foot foot;
    foot.face = face;
    const auto& [a, b, c] = mesh.faces[face];
    foot.position = (1 - u - v) * mesh.points[a] + u * mesh.points[b] + v * mesh.points[c];
    return foot;
}

/// Dijkstra on the graph of `per_edge` points on every edge, complete in every face, with both feet
/// linked to the points of their faces: a path on the surface, a little longer than the shortest.
double graph_distance(const FlatMesh& mesh, const Foot& from, const Foot& to, int per_edge) {
    if (from.face == to.face) return (from.position - to.position).norm();
    std::vector<Vec3> nodes = mesh.points;
    std::vector<std::vector<int>> nodes_of(mesh.faces.size());
    for (int h = 0; h < 3 * mesh.face_count(); ++h) {
        nodes_of[h / 3].push_back(mesh.origin(h));
        const int twin = mesh.twins[h];
        if (twin >= 0 && twin < h) continue;
        for (int i = 1; i <= per_edge; ++i) {
            const double t = i / (per_edge + 1.0);
            const int index = static_cast<int>(nodes.size());
            nodes.emplace_back((1 - t) * mesh.points[mesh.origin(h)] +
                               t * mesh.points[mesh.target(h)]);
            nodes_of[h / 3].push_back(index);
            if (twin >= 0) nodes_of[twin / 3].push_back(index);
        }
    }
    const int source = static_cast<int>(nodes.size());
    nodes.push_back(from.position);
    nodes.push_back(to.position);
    nodes_of[from.face].push_back(source);
    nodes_of[to.face].push_back(source + 1);
    std::vector<std::vector<int>> faces_of(nodes.size());
    for (int f = 0; f < mesh.face_count(); ++f) {
        for (const int node : nodes_of[f]) faces_of[node].push_back(f);
    }
    std::vector<double> distance(nodes.size(), kInfinity);
    using Item = std::pair<double, int>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    distance[source] = 0;
    queue.emplace(0.0, source);
    while (!queue.empty()) {
        const auto [d, node] = queue.top();
        queue.pop();
        if (d > distance[node]) continue;
        if (node == source + 1) return d;
        for (const int f : faces_of[node]) {
            for (const int other : nodes_of[f]) {
                const double longer = d + (nodes[other] - nodes[node]).norm();
                if (longer >= distance[other]) continue;
                distance[other] = longer;
                queue.emplace(longer, other);
            }
        }
    }
    return kInfinity;
}

Mesh cube() {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) points.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
    return test::make_mesh(points, {{0, 2, 3},
                                    {0, 3, 1},
                                    {4, 5, 7},
                                    {4, 7, 6},
                                    {0, 1, 5},
                                    {0, 5, 4},
                                    {2, 6, 7},
                                    {2, 7, 3},
                                    {0, 4, 6},
                                    {0, 6, 2},
                                    {1, 3, 7},
                                    {1, 7, 5}});
}

TEST(Geodesics, Cube) {
    const Surface surface(cube());
    Geodesics geodesics(surface);
    const auto distance = [&](const Vec3& a, const Vec3& b) {
        return geodesics.distance(surface.project(a, 0), surface.project(b, 0), 10);
    };
    EXPECT_NEAR(distance({0, 0, 0}, {1, 1, 1}), std::sqrt(5.0), 1e-12) << "opposite corners";
    EXPECT_NEAR(distance({0.5, 0.5, 0}, {0.5, 0.5, 1}), 2.0, 1e-12) << "opposite centres";
    EXPECT_NEAR(distance({0.5, 0.5, 0}, {0.5, 1, 0.5}), 1.0, 1e-12) << "neighbouring centres";
    EXPECT_NEAR(distance({0, 0, 0}, {0, 1, 1}), std::sqrt(2.0), 1e-12) << "a face's diagonal";
    EXPECT_NEAR(distance({0, 0, 0}, {1, 0, 0}), 1.0, 1e-12) << "an edge";
    EXPECT_NEAR(distance({0.2, 0.3, 0}, {0.2, 0.3, 0}), 0.0, 1e-12);
    // Unfolded over the edge x = 1: (0.3, 0.6) to (1 + 0.4, 0.1).
    EXPECT_NEAR(distance({0.3, 0.6, 0}, {1, 0.1, 0.4}), std::hypot(1.1, 0.5), 1e-12);
}

TEST(Geodesics, LimitAndUnconnectedParts) {
    const Surface surface(cube());
    Geodesics geodesics(surface);
    const Foot a = surface.project({0.5, 0.5, 0}, 0);
    const Foot b = surface.project({0.5, 0.5, 1}, 0);
    EXPECT_EQ(geodesics.distance(a, b, 2 - 1e-9), kInfinity);
    EXPECT_NEAR(geodesics.distance(a, b, 2 + 1e-9), 2.0, 1e-12);

    const Surface two(
        test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
                        {{0, 1, 2}, {3, 4, 5}}));
    Geodesics apart(two);
    EXPECT_EQ(apart.distance(two.project({0.2, 0.2, 0}, 0), two.project({0.2, 0.2, 1}, 0), 1e9),
              kInfinity);
}

TEST(Geodesics, PlaneIsEuclidean) {
    Random random(5);
    const Mesh mesh = test::sheet(12, 9, [&](int i, int j) {
        const bool is_inner = i > 0 && i < 12 && j > 0 && j < 9;
        const double shake = is_inner ? 0.3 : 0.0;
        return Vec3(i + random.uniform(-shake, shake), j + random.uniform(-shake, shake), 0);
    });
    const Surface surface(mesh);
    Geodesics geodesics(surface);
    for (int i = 0; i < 300; ++i) {
        Vec3 a(random.uniform(0, 12), random.uniform(0, 9), 0);
        const Vec3 b(random.uniform(0, 12), random.uniform(0, 9), 0);
        if (i % 3 == 0) a = surface.mesh().points[random.below(130)];  // from a vertex
        const Foot from = surface.project(a, 1e-9);
        const Foot to = surface.project(b, 1e-9);
        EXPECT_NEAR(geodesics.distance(from, to, 100), (a - b).norm(), 1e-9)
            << "seed 5, pair " << i;
        const double section = surface.section_length(from, to, 100);
        EXPECT_NEAR(section, (a - b).norm(), 1e-9) << "seed 5, pair " << i;
    }
}

TEST(Geodesics, PrismUnrolls) {
    // A regular 24-gon prism: unrolled it is a plane; twice around is never shorter than once.
    constexpr int kSides = 24;
    constexpr int kRows = 6;
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> faces;
    for (int j = 0; j <= kRows; ++j) {
        for (int i = 0; i < kSides; ++i) {
            const double angle = 2 * std::numbers::pi * i / kSides;
            points.emplace_back(std::cos(angle), std::sin(angle), 0.5 * j);
        }
    }
    for (int j = 0; j < kRows; ++j) {
        for (int i = 0; i < kSides; ++i) {
            const int a = j * kSides + i, b = j * kSides + (i + 1) % kSides;
            faces.push_back({a, b, b + kSides});
            faces.push_back({a, b + kSides, a + kSides});
        }
    }
    const Surface surface(test::make_mesh(points, faces));
    Geodesics geodesics(surface);
    const double side = 2 * std::sin(std::numbers::pi / kSides);
    Random random(6);
    for (int round = 0; round < 200; ++round) {
        const auto pick = [&] {
            Eigen::Vector2d flat(random.uniform(0, kSides), random.uniform(0, 3));
            if (round % 4 == 0) flat = {random.below(kSides), 0.5 * random.below(kRows + 1)};
            return flat;
        };
        const Eigen::Vector2d a = pick(), b = pick();
        const auto place = [&](const Eigen::Vector2d& flat) {
            const int i = static_cast<int>(flat.x()) % kSides;
            const double t = flat.x() - std::floor(flat.x());
            Vec3 p = (1 - t) * points[i] + t * points[(i + 1) % kSides];
            p.z() = flat.y();
            return p;
        };
        double around = std::abs(a.x() - b.x());
        around = side * std::min(around, kSides - around);
        const Foot from = surface.project(place(a), 1e-9);
        const Foot to = surface.project(place(b), 1e-9);
        EXPECT_NEAR(geodesics.distance(from, to, 100), std::hypot(around, a.y() - b.y()), 1e-9)
            << "seed 6, round " << round;
    }
}

TEST(Geodesics, BendsAroundASlit) {
    // A square sheet cut from its left border to the middle: vertices along the cut are doubled.
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> faces;
    const auto index = [](int i, int j) { return j * 5 + i; };
    for (int j = 0; j < 5; ++j) {
        for (int i = 0; i < 5; ++i) points.emplace_back(i, j, 0);
    }
    points.emplace_back(0, 2, 0);  // upper copies of (0, 2) and (1, 2)
    points.emplace_back(1, 2, 0);
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            const auto at = [&](int x, int y) {
                return j >= 2 && y == 2 && x < 2 ? 25 + x : index(x, y);
            };
            faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    const Surface surface(test::make_mesh(points, faces));
    Geodesics geodesics(surface);
    const Vec3 tip(2, 2, 0);
    const auto expect = [&](const Vec3& a, const Vec3& b, double expected) {
        const Foot from = surface.project(a, 0), to = surface.project(b, 0);
        EXPECT_NEAR(geodesics.distance(from, to, 100), expected, 1e-12);
    };
    const Vec3 below(0.3, 1.7, 0), above(0.4, 2.6, 0);
    expect(below, above, (below - tip).norm() + (above - tip).norm());
    expect(below, {3.5, 2.2, 0}, (below - Vec3(3.5, 2.2, 0)).norm());
}

TEST(Geodesics, RoughTerrainAgainstAFineGraph) {
    double total_error = 0;
    int pair_count = 0;
    for (int round = 0; round < 8; ++round) {
        SCOPED_TRACE("seed " + std::to_string(100 + round));
        Random random(100 + round);
        const double height = 0.2 + 0.25 * round;  // up to needles
        const Mesh mesh = test::sheet(7, 7, [&](int i, int j) {
            return Vec3(i + random.uniform(-0.3, 0.3), j + random.uniform(-0.3, 0.3),
                        random.uniform(0, height));
        });
        const Surface surface(mesh);
        Geodesics geodesics(surface);
        for (int pair = 0; pair < 12; ++pair) {
            const auto pick = [&] {
                double u = random.uniform(0, 1), v = random.uniform(0, 1);
                if (u + v > 1) u = 1 - u, v = 1 - v;
                if (pair % 3 == 1) u = v = 0;
                if (pair % 3 == 2) v = 0;
                return foot_in(surface.mesh(), random.below(surface.mesh().face_count()), u, v);
            };
            const Foot from = pick(), to = pick();
            const double graph = graph_distance(surface.mesh(), from, to, 40);
            const double exact = geodesics.distance(from, to, 1e6);
            EXPECT_LE(exact, graph + 1e-9);
            EXPECT_GE(exact, graph * (1 - 0.025)) << "the graph is finer than that";
            total_error += graph > 0 ? 1 - exact / graph : 0.0;
            ++pair_count;
            EXPECT_NEAR(exact, geodesics.distance(to, from, 1e6), 1e-9);
            EXPECT_NEAR(exact, geodesics.distance(from, to, exact + 1e-6), 1e-9);
            EXPECT_GE(surface.section_length(from, to, 1e6), exact - 1e-9) << "an upper bound";
        }
    }
    // Far pairs cross many edges and the graph's error is of second order there.
    EXPECT_LE(total_error / pair_count, 0.001);
}

TEST(Surface, ClosestPointAgainstAllFaces) {
    Random random(9);
    const Mesh mesh = test::sheet(10, 10, [&](int i, int j) {
        return Vec3(i, j * (1 + 0.3 * j), random.uniform(0, 2));  // sizes vary tenfold
    });
    const Surface surface(mesh);
    const FlatMesh& flat = surface.mesh();
    for (int i = 0; i < 25; ++i) {
        const Vec3 p(random.uniform(-3, 13), random.uniform(-3, 45), random.uniform(-3, 5));
        double best = kInfinity;
        for (int f = 0; f < flat.face_count(); ++f) {
            // The closest point minimises a convex function: nested ternary search.
            const auto at = [&](double u, double v) {
                return (foot_in(flat, f, u, v * (1 - u)).position - p).norm();
            };
            const auto inner = [&](double u) {
                double low = 0, high = 1;
                for (int k = 0; k < 60; ++k) {
                    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
                    (at(u, a) < at(u, b) ? high : low) = at(u, a) < at(u, b) ? b : a;
                }
                return at(u, (low + high) / 2);
            };
            const auto& [a, b, c] = flat.faces[f];
            Vec3 centre = (flat.points[a] + flat.points[b] + flat.points[c]) / 3;
            double radius = 0;
            for (const int v : {a, b, c})
                radius = std::max(radius, (flat.points[v] - centre).norm());
            if ((centre - p).norm() - radius > best) continue;
            double low = 0, high = 1;
            for (int k = 0; k < 60; ++k) {
                const double u = low + (high - low) / 3, v = high - (high - low) / 3;
                const bool is_left = inner(u) < inner(v);
                (is_left ? high : low) = is_left ? v : u;
            }
            best = std::min(best, inner((low + high) / 2));
        }
        EXPECT_NEAR((surface.project(p, 0).position - p).norm(), best, 1e-6)
            << "seed 9, point " << i;
    }
}

TEST(Surface, NormalsOfFacesEdgesAndVertices) {
    const Surface surface(cube());
    const double tolerance = 1e-3;
    const auto normal = [&](const Vec3& p) { return surface.project(p, tolerance).normal; };
    EXPECT_NEAR((normal({0.3, 0.4, 1}) - Vec3(0, 0, 1)).norm(), 0, 1e-12);
    EXPECT_NEAR((normal({0.3, 0, 0.6}) - Vec3(0, -1, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((normal({0.5, 1, 1}) - Vec3(0, 1, 1).normalized()).norm(), 0, 1e-12);
    EXPECT_NEAR((normal({0.5, 1, 1 - 0.9e-3}) - Vec3(0, 1, 1).normalized()).norm(), 0, 1e-12);
    EXPECT_NEAR((normal({0.5, 1, 1 - 1.1e-3}) - Vec3(0, 1, 0)).norm(), 0, 1e-12);
    // Weighted by angle, whatever the diagonals.
    EXPECT_NEAR((normal({1, 1, 1}) - Vec3(1, 1, 1).normalized()).norm(), 0, 1e-12);
    EXPECT_NEAR((normal({0, 0, 0}) + Vec3(1, 1, 1).normalized()).norm(), 0, 1e-12);
}

TEST(BoxTree, AgainstAllPairs) {
    for (int round = 0; round < 40; ++round) {
        SCOPED_TRACE("seed " + std::to_string(round));
        Random random(round);
        std::vector<Box> boxes(random.below(60));
        for (Box& box : boxes) {
            const Vec3 at(random.uniform(0, 10), random.uniform(0, 10), random.uniform(0, 10));
            box.add(at);
            // One in five is long.
            const double size = random.below(5) == 0 ? 10 : 0.5;
            box.add(Vec3(at + size * Vec3(random.uniform(0, 1), random.uniform(0, 1), 0)));
        }
        const BoxTree tree(boxes);
        Box query;
        query.add(Vec3(random.uniform(0, 10), random.uniform(0, 10), random.uniform(0, 10)));
        const double reach = random.uniform(0, 4);
        std::vector<int> found, expected;
        tree.within(query, reach, [&](int item) { found.push_back(item); });
        std::sort(found.begin(), found.end());
        int closest = -1;
        for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
            if (boxes[i].distance(query.low) <= reach) expected.push_back(i);
            if (closest < 0 || boxes[i].distance(query.low) < boxes[closest].distance(query.low)) {
                closest = i;
            }
        }
        EXPECT_EQ(found, expected);
        EXPECT_EQ(tree.closest(query.low, [&](int i) { return boxes[i].distance(query.low); }),
                  closest);
    }
}

}  // namespace
}  // namespace fcn::conformity
