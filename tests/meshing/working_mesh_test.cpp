#include "meshing/working_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>

#include "geometry/surface_queries.h"
#include "meshing/crossing_guard.h"
#include "meshing/reference_surface.h"
#include "meshing/remeshing_steps.h"
#include "meshing/self_intersections.h"
#include "meshing/size_sources.h"
#include "sample_meshes.h"

namespace fcn {
namespace {

WorkingMesh make(const Mesh& mesh, const std::vector<int>& labels = {}) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const VertexHandle v : mesh.vertices()) points.push_back(mesh.point(v));
    for (const FaceHandle f : mesh.faces()) {
        const auto v = face_vertices(mesh, f);
        triangles.push_back({v[0].idx(), v[1].idx(), v[2].idx()});
    }
    return {points, triangles, labels};
}

/// Vertices - edges + faces, and boundary edges.
std::array<int, 2> topology(const WorkingMesh& mesh) {
    int euler = 0, boundary = 0;
    for (int v = 0; v < mesh.vertex_end(); ++v) euler += mesh.is_vertex_alive(v);
    for (int f = 0; f < mesh.face_end(); ++f) euler += mesh.is_face_alive(f);
    for (int h = 0; h < mesh.halfedge_end(); ++h) {
        if (!mesh.is_first(h)) continue;
        --euler;
        boundary += mesh.twin(h) < 0;
    }
    return {euler, boundary};
}

/// Everything that can be seen of a mesh.
std::vector<double> contents(const WorkingMesh& mesh) {
    std::vector<double> all;
    for (int v = 0; v < mesh.vertex_end(); ++v) {
        all.push_back(mesh.out(v));
        for (int i = 0; i < 3; ++i) all.push_back(mesh.point(v)[i]);
    }
    for (int h = 0; h < mesh.halfedge_end(); ++h) {
        all.push_back(mesh.is_halfedge_alive(h) ? mesh.from(h) : -1);
        if (!mesh.is_halfedge_alive(h)) continue;
        all.push_back(mesh.twin(h));
        all.push_back(static_cast<double>(mesh.role(h)));
    }
    return all;
}

/// One random change where it is allowed.
void change(WorkingMesh& mesh, std::mt19937_64& engine) {
    const int h = static_cast<int>(engine() % static_cast<std::uint64_t>(mesh.halfedge_end()));
    if (!mesh.is_halfedge_alive(h)) return;
    switch (engine() % 4) {
        case 0:
            mesh.split(h, 0.5 * (mesh.point(mesh.from(h)) + mesh.point(mesh.to(h))));
            return;
        case 1:
            if (mesh.can_flip(h)) mesh.flip(h);
            return;
        case 2:
            mesh.set_point(mesh.from(h), mesh.point(mesh.to(h)));
            return;
        default: {
            const int vanishing = engine() % 2 == 0 ? mesh.from(h) : mesh.to(h);
            if (mesh.can_collapse(h, vanishing)) mesh.collapse(h, vanishing);
        }
    }
}

TEST(WorkingMesh, RandomChangesKeepItAManifoldOfTheSameTopology) {
    const std::vector<Mesh> meshes{test::rectangle(1, 1, 4, 5), test::sphere(1, 2),
                                   test::cube(3).mesh, test::rectangle(1, 1, 1, 1)};
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        WorkingMesh mesh = make(meshes[seed % meshes.size()]);
        const auto before = topology(mesh);
        for (int i = 0; i < 300; ++i) {
            change(mesh, engine);
            ASSERT_EQ(mesh.first_fault(), "") << "after change " << i;
        }
        EXPECT_EQ(topology(mesh)[0], before[0]);
        EXPECT_EQ(topology(mesh)[1] == 0, before[1] == 0);
        mesh.compact();
        EXPECT_EQ(mesh.first_fault(), "");
        EXPECT_EQ(topology(mesh)[0], before[0]);
    }
}

TEST(WorkingMesh, UndoBringsEverythingBack) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        WorkingMesh mesh = make(test::rectangle(1, 1, 4, 5));
        for (int i = 0; i < 30; ++i) change(mesh, engine);
        const auto before = contents(mesh);
        const auto checkpoint = mesh.start_recording();
        for (int i = 0; i < 30; ++i) change(mesh, engine);
        mesh.undo(checkpoint);
        EXPECT_EQ(contents(mesh), before);
        EXPECT_EQ(mesh.first_fault(), "");
    }
}

TEST(WorkingMesh, CurvesAreNeitherFlippedNorLost) {
    // Two labels: the border between them stays one closed curve whatever happens.
    const Mesh sphere = test::sphere(1, 2);
    std::vector<int> labels;
    for (const FaceHandle face : sphere.faces()) {
        Vec3 center = Vec3::Zero();
        for (const VertexHandle v : face_vertices(sphere, face)) center += sphere.point(v);
        labels.push_back(center[2] > 0 ? 1 : 0);
    }
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        WorkingMesh mesh = make(sphere, labels);
        for (int i = 0; i < 300; ++i) change(mesh, engine);
        int marked = 0;
        for (int h = 0; h < mesh.halfedge_end(); ++h) {
            if (!mesh.is_first(h)) continue;
            marked += mesh.is_marked(h);
            EXPECT_EQ(mesh.is_marked(h), mesh.label(WorkingMesh::face(h)) !=
                                             mesh.label(WorkingMesh::face(mesh.twin(h))));
        }
        EXPECT_GE(marked, 3);
    }
}

TEST(SizeSources, LimitIsTheLeastOverAllSources) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        std::uniform_real_distribution<double> place(-5, 5), size(0.1, 1);
        SizeSources sources(1);
        const auto point = [&] { return Vec3(place(engine), place(engine), place(engine)); };
        for (int i = 0; i < 60; ++i) sources.add(point(), size(engine));
        for (int i = 0; i < 500; ++i) {
            const Vec3 p = point();
            double least = std::numeric_limits<double>::infinity();
            for (const auto& [position, own] : sources.sources())
                least = std::min(least, own + SizeSources::kGrowth * (position - p).norm());
            if (least < SizeSources::kFarthest)
                EXPECT_EQ(sources.limit(p), least);
            else
                EXPECT_FALSE(sources.is_near(p));
        }
    }
}

TEST(SelfIntersections, FoldedPairsAreFoundInEveryPlane) {
    // Rounding takes rotated points out of their plane.
    std::mt19937_64 engine(11);
    std::uniform_real_distribution<double> share(-1, 1);
    for (int trial = 0; trial < 1000; ++trial) {
        const Vec3 axis = Vec3(share(engine), share(engine), share(engine)).normalized();
        const Eigen::AngleAxisd rotation(3 * share(engine), axis);
        const Vec3 shift = 100 * Vec3(share(engine), share(engine), share(engine));
        const auto place = [&](double x, double y, double z) {
            return Vec3(rotation * Vec3(x, y, z) + shift);
        };
        const Vec3 a = place(0, 0, 0), b = place(1, 0, 0), c = place(share(engine), 1, 0);
        const auto cross_with = [&](const Vec3& d) {
            return do_triangles_cross({0, 1, 2}, {a, b, c}, {1, 0, 3}, {b, a, d});
        };
        EXPECT_TRUE(cross_with(place(share(engine), 0.7, 0))) << trial;
        EXPECT_FALSE(cross_with(place(share(engine), -0.7, 0))) << trial;
        EXPECT_FALSE(cross_with(place(share(engine), 0.7, 1e-3))) << trial;
    }
}

TEST(SplitLongEdges, EndsBesideAnEdgeThatIsLeft) {
    // Flat triangles on both sides of an edge whose middle is the corner of two features, and a
    // source of short edges at its end.
    std::mt19937_64 engine(5);
    std::uniform_real_distribution<double> share(0, 1);
    for (int trial = 0; trial < 2000; ++trial) {
        const auto flat = [&] { return std::pow(10, -2 - 3 * share(engine)); };
        const std::vector<Vec3> points{{0, 0, 0},
                                       {3, 0, 0},
                                       {1.5 + 0.01 * share(engine), flat(), 0},
                                       {3 * share(engine), -flat(), 0}};
        EdgeTarget target;
        target.length = 1 + 2 * share(engine);
        target.sources = SizeSources(target.length);
        target.sources.add(points[1], 0.5 + 0.4 * share(engine));
        WorkingMesh mesh(points, {{0, 1, 2}, {1, 0, 3}}, {});
        mesh.set_role(1, EdgeRole::Feature);
        mesh.set_role(2, EdgeRole::Feature);
        // The sum of all lengths is below 12, and no edge shorter than half is split: a tree of
        // splits has at most 3 levels below each of 5 edges, each of which adds two edges more.
        EXPECT_LT(split_long_edges(mesh, target), 500U) << trial;
    }
}

TEST(CrossingGuard, RefusesExactlyTheMovesThatMakeTrianglesCross) {
    // Two sheets, one above the other; vertices of the lower one are moved up and down.
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const double height : {0.0, 0.1}) {
        const Mesh sheet = test::rectangle(1, 1, 6, 6);
        const int first = static_cast<int>(points.size());
        for (const VertexHandle v : sheet.vertices())
            points.push_back(sheet.point(v) + Vec3(0, 0, height));
        for (const FaceHandle f : sheet.faces()) {
            auto v = face_vertices(sheet, f);
            if (height > 0) std::swap(v[1], v[2]);
            triangles.push_back({first + v[0].idx(), first + v[1].idx(), first + v[2].idx()});
        }
    }
    std::vector<std::array<Vec3, 3>> corners;
    for (const auto& [a, b, c] : triangles)
        corners.push_back({points[static_cast<std::size_t>(a)], points[static_cast<std::size_t>(b)],
                           points[static_cast<std::size_t>(c)]});
    WorkingMesh mesh(points, triangles, {});
    const ReferenceSurface reference(corners);
    for (const double reach : {0.01, 0.11}) {
        mark_thin_places(mesh, reference, reach);
        for (int v = 0; v < mesh.vertex_end(); ++v) EXPECT_EQ(mesh.is_thin(v), reach > 0.1);
    }
    CrossingGuard guard(mesh, 0.2);
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> shift(-0.3, 0.3);
    int refused = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const int v = static_cast<int>(engine() % points.size());
        const Vec3 there =
            mesh.point(v) + Vec3(0.2 * shift(engine), 0.2 * shift(engine), shift(engine));
        const bool is_allowed = guard.allows_move(v, there);
        std::vector<Vec3> moved;
        for (int u = 0; u < mesh.vertex_end(); ++u) moved.push_back(mesh.point(u));
        moved[static_cast<std::size_t>(v)] = there;
        EXPECT_EQ(is_allowed, self_intersections(moved, triangles).empty()) << "trial " << trial;
        refused += !is_allowed;
        if (!is_allowed) continue;
        mesh.set_point(v, there);
        guard.update_star(v);
    }
    EXPECT_GT(refused, 20);
    EXPECT_LT(refused, 280);
}

TEST(ReferenceSurface, FacingAgreesWithTryingAll) {
    const Mesh mesh = test::sphere(1, 2);
    const ReferenceSurface reference(mesh);
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> place(-1.5, 1.5), reach(0.05, 1), cosine(-0.5, 0.9);
    for (int i = 0; i < 400; ++i) {
        const Vec3 point(place(engine), place(engine), place(engine));
        const Vec3 normal = Vec3(place(engine), place(engine), place(engine)).normalized();
        const double radius = reach(engine), least = cosine(engine);
        EXPECT_EQ(reference.is_any_facing(point, normal, radius, least),
                  reference.closest(point, normal, radius, -1, least).face >= 0);
    }
}

TEST(ReferenceSurface, AgreesWithTheExactTree) {
    const std::uint64_t seed = 3;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
    for (const Mesh& mesh : {test::sphere(1, 3), test::cube(5).mesh, test::rectangle(1, 1, 1, 1)}) {
        const ReferenceSurface surface(mesh);
        const SurfaceQueries oracle(mesh);
        for (int i = 0; i < 500; ++i) {
            const Vec3 p(coordinate(engine), coordinate(engine), coordinate(engine));
            const int hint = static_cast<int>(engine() % mesh.n_faces());
            const ReferencePoint near = surface.closest(p, Vec3::Zero(), 100, hint);
            EXPECT_NEAR(near.distance, oracle.closest(p).distance, 1e-12);
            EXPECT_NEAR((near.position - p).norm(), near.distance, 1e-12);
        }
        EXPECT_EQ(surface.closest(Vec3(9, 9, 9), Vec3::Zero(), 1, 0).face, -1);
    }
}

TEST(ReferenceSurface, LooksAtItsOwnSideOfAThinWall) {
    // Two plates back to back; a point next to the lower one that looks up belongs to the upper.
    const Mesh upper = test::rectangle(1, 1, 5, 5, 0.01);
    std::vector<std::array<Vec3, 3>> corners;
    for (const FaceHandle face : upper.faces()) {
        const auto v = face_vertices(upper, face);
        const Vec3 &a = upper.point(v[0]), &b = upper.point(v[1]), &c = upper.point(v[2]);
        corners.push_back({a, b, c});
        const Vec3 down(0, 0, -0.01);
        corners.push_back({a + down, c + down, b + down});
    }
    const ReferenceSurface surface(corners);
    const Vec3 p(0.3, 0.6, 0.001);
    EXPECT_NEAR(surface.closest(p, Vec3(0, 0, 1), 1, -1).position[2], 0.01, 1e-15);
    EXPECT_NEAR(surface.closest(p, Vec3(0, 0, -1), 1, -1).position[2], 0, 1e-15);
    EXPECT_NEAR(surface.closest(p, Vec3::Zero(), 1, -1).position[2], 0, 1e-15);
}

}  // namespace
}  // namespace fcn
