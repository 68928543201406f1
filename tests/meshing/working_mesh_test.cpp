#include "meshing/working_mesh.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/surface_queries.h"
#include "meshing/reference_surface.h"
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
