#include "geometry/surface_queries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "geometry/errors.h"
#include "geometry/models.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using namespace fcn::testing;

/// Distance to a triangle by dense search over its edges and the foot on its plane.
double brute_distance(const Mesh& mesh, FaceHandle face, const Vec3& p) {
    const auto corners = face_vertices(mesh, face);
    double best = 1e300;
    for (int i = 0; i < 3; ++i) {
        const Vec3& a = mesh.point(corners[i]);
        const Vec3 run = mesh.point(corners[(i + 1) % 3]) - a;
        const double t = std::clamp(run.dot(p - a) / run.squaredNorm(), 0.0, 1.0);
        best = std::min(best, (a + t * run - p).norm());
    }
    const Vec3 normal = face_normal(mesh, face);
    const double height = normal.dot(p - mesh.point(corners[0]));
    const Vec3 foot = p - height * normal;
    bool is_inside = true;
    for (int i = 0; i < 3; ++i) {
        const Vec3& a = mesh.point(corners[i]);
        const Vec3 run = mesh.point(corners[(i + 1) % 3]) - a;
        is_inside = is_inside && run.cross(foot - a).dot(normal) >= 0;
    }
    return is_inside ? std::min(best, std::abs(height)) : best;
}

/// Signed volumes decide whether a segment in general position meets a triangle.
bool brute_meets(const Mesh& mesh, FaceHandle face, const Vec3& p, const Vec3& q) {
    const auto corners = face_vertices(mesh, face);
    const Vec3& a = mesh.point(corners[0]);
    const Vec3& b = mesh.point(corners[1]);
    const Vec3& c = mesh.point(corners[2]);
    const auto volume_of = [](const Vec3& o, const Vec3& x, const Vec3& y, const Vec3& z) {
        return (x - o).cross(y - o).dot(z - o);
    };
    if (volume_of(a, b, c, p) * volume_of(a, b, c, q) > 0) return false;
    const double u = volume_of(p, q, a, b);
    const double v = volume_of(p, q, b, c);
    const double w = volume_of(p, q, c, a);
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

LoadedMesh wrinkled_torus() {
    ModelOptions options;
    options.resolution = 0.06;
    options.noise = 0.3;
    return make_model("torus", options);
}

TEST(SurfaceQueries, ClosestPointAgainstBruteForce) {
    const LoadedMesh torus = wrinkled_torus();
    const SurfaceQueries queries(torus.mesh);
    Randomness random(17);
    for (int i = 0; i < 1000; ++i) {
        Vec3 p = random.point(-0.7, 0.7);
        if (i % 10 == 0) p = torus.mesh.point(VertexHandle(random.index(torus.mesh.n_vertices())));
        const ClosestPoint found = queries.closest(p);
        double best = 1e300;
        for (const auto face : torus.mesh.faces()) {
            best = std::min(best, brute_distance(torus.mesh, face, p));
        }
        EXPECT_NEAR(found.distance, best, 1e-12);
        EXPECT_NEAR((found.position - p).norm(), found.distance, 1e-15);
        EXPECT_EQ(found.position, position(torus.mesh, found.surface));
        EXPECT_GE(found.surface.barycentric.minCoeff(), 0.0);
        EXPECT_NEAR(found.surface.barycentric.sum(), 1.0, 1e-14);
        const bool is_on_vertex = i % 10 == 0;
        EXPECT_EQ(found.distance == 0.0, is_on_vertex);
    }
}

TEST(SurfaceQueries, WithinReachIsTheClosestOrNothing) {
    const LoadedMesh torus = wrinkled_torus();
    const SurfaceQueries queries(torus.mesh);
    Randomness random(19);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p = random.point(-0.7, 0.7);
        const ClosestPoint closest = queries.closest(p);
        for (double reach : {0.0, 0.5 * closest.distance, closest.distance, 0.1, 10.0}) {
            const auto found = queries.closest_within(p, reach);
            ASSERT_EQ(found.has_value(), closest.distance <= reach) << "reach " << reach;
            if (!found) continue;
            EXPECT_EQ(found->surface.face, closest.surface.face);
            EXPECT_EQ(found->position, closest.position);
        }
    }
    EXPECT_FALSE(queries.closest_within({0, 0, 0}, -1));
    EXPECT_THROW(queries.closest_within({std::nan(""), 0, 0}, 1), InputError);
}

TEST(SurfaceQueries, TiesGoToTheLowestFace) {
    const LoadedMesh cube = cube_soup().load();
    const SurfaceQueries queries(cube.mesh);
    EXPECT_EQ(queries.closest({0, 0, 0}).surface.face, 0);
    EXPECT_EQ(queries.closest({0.5, 0.5, 0.5}).surface.face, 0);
    EXPECT_EQ(queries.closest({2, 1, 1}).surface.face, 2);
}

TEST(SurfaceQueries, SegmentsAgainstBruteForce) {
    const LoadedMesh torus = wrinkled_torus();
    const SurfaceQueries queries(torus.mesh);
    Randomness random(18);
    std::size_t hit_count = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p = random.point(-0.6, 0.6);
        const Vec3 q = random.point(-0.6, 0.6);
        const std::vector<RayHit> hits = queries.intersect_segment(p, q);
        std::vector<int> found;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            found.push_back(hits[k].surface.face);
            EXPECT_LE(hits[k > 0 ? k - 1 : 0].distance, hits[k].distance);
            const Vec3 on_segment = p + hits[k].distance * (q - p).normalized();
            EXPECT_LT((on_segment - hits[k].position).norm(), 1e-9);
            EXPECT_EQ(hits[k].position, position(torus.mesh, hits[k].surface));
        }
        std::sort(found.begin(), found.end());
        std::vector<int> expected;
        for (const auto face : torus.mesh.faces()) {
            if (brute_meets(torus.mesh, face, p, q)) expected.push_back(face.idx());
        }
        EXPECT_EQ(found, expected);
        hit_count += hits.size();
        const auto first = queries.first_hit(p, 7 * (q - p));
        if (!hits.empty()) {
            ASSERT_TRUE(first.has_value());
            EXPECT_EQ(first->surface.face, hits.front().surface.face);
            EXPECT_NEAR(first->distance, hits.front().distance, 1e-9);
        } else if (first) {
            EXPECT_GE(first->distance, (q - p).norm() * (1 - 1e-9));
        }
    }
    EXPECT_GT(hit_count, 500U);
}

TEST(SurfaceQueries, NothingSlipsThroughEdgesAndCorners) {
    const LoadedMesh cube = cube_soup().load();
    const SurfaceQueries queries(cube.mesh);
    // Through the diagonal of a side, an edge, and a corner.
    EXPECT_EQ(queries.intersect_segment({0.5, 0.5, -1}, {0.5, 0.5, 0.5}).size(), 2U);
    EXPECT_EQ(queries.intersect_segment({-1, -1, 0.5}, {0.5, 0.5, 0.5}).size(), 2U + 0U);
    EXPECT_GE(queries.intersect_segment({-1, -1, -1}, {0.4, 0.4, 0.4}).size(), 3U);
    // A segment that ends on a face meets it; one inside a side's plane meets that side.
    EXPECT_EQ(queries.intersect_segment({0.2, 0.3, 5}, {0.2, 0.3, 1}).size(), 1U);
    const auto along = queries.intersect_segment({-1, 0.3, 1}, {0.5, 0.3, 1});
    ASSERT_FALSE(along.empty());
    EXPECT_NEAR(along.front().distance, 1.0, 1e-12);
    EXPECT_TRUE(queries.intersect_segment({-1, 0.3, 1.0000001}, {2, 0.3, 1.0000001}).empty());
}

TEST(SurfaceQueries, RaysStartBeyondTheLeastDistance) {
    const LoadedMesh cube = cube_soup().load();
    const SurfaceQueries queries(cube.mesh);
    const auto near = queries.first_hit({0.3, 0.2, -2}, {0, 0, 5});
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->distance, 2, 1e-12);
    const auto far = queries.first_hit({0.3, 0.2, -2}, {0, 0, 5}, 2.5);
    ASSERT_TRUE(far);
    EXPECT_NEAR(far->distance, 3, 1e-12);
    EXPECT_FALSE(queries.first_hit({0.3, 0.2, -2}, {0, 0, 5}, 3.5));
    EXPECT_FALSE(queries.first_hit({0.3, 0.2, -2}, {0, 0, -1}));
    // From a point of the surface itself: only what is behind it.
    const auto through = queries.first_hit({0.3, 0.2, 0}, {0, 0, 1});
    ASSERT_TRUE(through);
    EXPECT_NEAR(through->distance, 1, 1e-12);
}

TEST(SurfaceQueries, MayBeAskedFromManyThreads) {
    const LoadedMesh torus = wrinkled_torus();
    const SurfaceQueries queries(torus.mesh);
    std::vector<std::vector<double>> answers(4);
    std::vector<std::thread> threads;
    for (auto& answer : answers) {
        threads.emplace_back([&answer, &queries] {
            Randomness random(5);
            for (int i = 0; i < 200; ++i) {
                answer.push_back(queries.closest(random.point(-1, 1)).distance);
                answer.push_back(static_cast<double>(
                    queries.intersect_segment(random.point(-1, 1), random.point(-1, 1)).size()));
            }
        });
    }
    for (auto& thread : threads) thread.join();
    for (const auto& answer : answers) EXPECT_EQ(answer, answers.front());
}

TEST(SurfaceQueries, OneFaceAndNone) {
    const LoadedMesh single = mesh_from_soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    const SurfaceQueries queries(single.mesh);
    EXPECT_NEAR(queries.closest({0.2, 0.2, 3}).distance, 3, 1e-15);
    EXPECT_TRUE(queries.first_hit({0.2, 0.2, 3}, {0, 0, -1}));
    EXPECT_THROW(SurfaceQueries{Mesh()}, InputError);
    EXPECT_THROW(queries.closest({std::nan(""), 0, 0}), InputError);
    EXPECT_THROW(queries.first_hit({0, 0, 0}, {0, 0, 0}), InputError);
}

}  // namespace
}  // namespace fcn
