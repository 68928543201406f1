#include <gtest/gtest.h>

#include <map>

#include "features/feature_meshes.h"
#include "features/features.h"
#include "geometry/errors.h"
#include "geometry/models.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

VsaResult segment(const LoadedMesh& mesh, int patch_count, int threads = 1) {
    VsaOptions options;
    options.patch_count = patch_count;
    options.threads = threads;
    return segment_vsa(mesh.mesh, options);
}

/// Error from the patch ids alone.
double error_of(const Mesh& mesh, const std::vector<int>& patch) {
    std::map<int, Vec3> normals;
    for (const auto f : mesh.faces()) {
        normals.try_emplace(patch[f.idx()], Vec3::Zero()).first->second +=
            face_area(mesh, f) * face_normal(mesh, f);
    }
    double error = 0;
    for (const auto f : mesh.faces()) {
        error += face_area(mesh, f) *
                 (face_normal(mesh, f) - normals.at(patch[f.idx()]).normalized()).squaredNorm();
    }
    return error;
}

int part_count(const Mesh& mesh, const std::vector<int>& patch) {
    std::vector<bool> is_seen(mesh.n_faces(), false);
    int count = 0;
    for (const auto start : mesh.faces()) {
        if (is_seen[start.idx()]) continue;
        ++count;
        std::vector<FaceHandle> stack{start};
        is_seen[start.idx()] = true;
        while (!stack.empty()) {
            const FaceHandle f = stack.back();
            stack.pop_back();
            for (auto it = mesh.cff_iter(f); it.is_valid(); ++it) {
                if (is_seen[it->idx()] || patch[it->idx()] != patch[f.idx()]) continue;
                is_seen[it->idx()] = true;
                stack.push_back(*it);
            }
        }
    }
    return count;
}

void expect_partition(const LoadedMesh& mesh, const VsaResult& result) {
    ASSERT_EQ(result.patch_of_face.size(), mesh.mesh.n_faces());
    const int count = static_cast<int>(result.proxy_normals.size());
    std::vector<int> faces(count, 0);
    for (int patch : result.patch_of_face) {
        ASSERT_GE(patch, 0);
        ASSERT_LT(patch, count);
        ++faces[patch];
    }
    for (int n : faces) EXPECT_GT(n, 0);
    EXPECT_EQ(part_count(mesh.mesh, result.patch_of_face), count) << "a patch is not connected";
    EXPECT_NEAR(result.error, error_of(mesh.mesh, result.patch_of_face),
                1e-9 * testing::total_area(mesh.mesh));
}

TEST(Vsa, BoxIsSixPlanes) {
    const LoadedMesh mesh = make_model("box");
    const VsaResult result = segment(mesh, 6);
    EXPECT_EQ(result.proxy_normals.size(), 6u);
    EXPECT_LT(result.error, 1e-12);
    expect_partition(mesh, result);
}

TEST(Vsa, FivePlanesOfARidge) {
    // Five strips that meet in four folds.
    const LoadedMesh mesh = testing::height_field(25, 12, [](double x, double) {
        const double knots[6] = {0, 2, -1, 4, 3, 8};
        const int piece = std::min(4, static_cast<int>(x / 5));
        return knots[piece] + (knots[piece + 1] - knots[piece]) * (x - 5 * piece) / 5;
    });
    const VsaResult result = segment(mesh, 5);
    EXPECT_EQ(result.proxy_normals.size(), 5u);
    EXPECT_LT(result.error, 1e-12 * testing::total_area(mesh.mesh));
    expect_partition(mesh, result);
}

TEST(Vsa, FlatPatchesAreNotSplitForNothing) {
    const LoadedMesh mesh = make_model("box");
    EXPECT_EQ(segment(mesh, 100).proxy_normals.size(), 6u);
}

TEST(Vsa, GivesExactlyTheNumberAskedFor) {
    for (const std::string name : {"sphere", "torus", "octaflower", "cylinder"}) {
        const LoadedMesh mesh = make_model(name);
        for (int count : {1, 2, 7, 60}) {
            const VsaResult result = segment(mesh, count);
            EXPECT_EQ(result.proxy_normals.size(), static_cast<std::size_t>(count)) << name;
            expect_partition(mesh, result);
        }
    }
}

TEST(Vsa, EveryComponentHasAPatch) {
    const LoadedMesh mesh =
        testing::joined(testing::cube_soup(), testing::cube_soup(Vec3(3, 0, 0))).load();
    EXPECT_EQ(segment(mesh, 1).proxy_normals.size(), 2u);
    EXPECT_EQ(segment(mesh, 12).proxy_normals.size(), 12u);
}

TEST(Vsa, MorePatchesNeverFitWorse) {
    const LoadedMesh mesh = make_model("octaflower");
    double last = 1e300;
    for (int count : {5, 10, 20, 40, 80, 160}) {
        const double error = segment(mesh, count).error;
        EXPECT_LT(error, last) << count;
        last = error;
    }
}

TEST(Vsa, SphereIsNearTheTheoreticalError) {
    // Of all patches of an area the cap has the least error, 2 (area - |integral of the normal|);
    // n equal patches cannot beat n caps, and hexagonal ones come close.
    const LoadedMesh mesh = make_model("sphere");
    const double area = testing::total_area(mesh.mesh);
    const int count = 60;
    const double radius = std::sqrt(area / (4 * std::numbers::pi));
    const double share = 4 * std::numbers::pi / count;     // solid angle of a patch
    const double height = share / (2 * std::numbers::pi);  // of the cap, 1 - cos
    const double normal = share * (1 - height / 2);        // |integral of n| over the cap
    const double cap = 2 * (share - normal) * radius * radius;
    const double error = segment(mesh, count).error;
    EXPECT_GE(error, 0.99 * count * cap);
    EXPECT_LE(error, 1.15 * count * cap);
}

TEST(Vsa, SameOnOneThreadAndTwoAndTwice) {
    ModelOptions options;
    options.resolution = 0.008;
    const LoadedMesh mesh = make_model("octaflower", options);
    const VsaResult one = segment(mesh, 50, 1);
    const VsaResult two = segment(mesh, 50, 2);
    const VsaResult again = segment(mesh, 50, 1);
    EXPECT_GT(mesh.mesh.n_faces(), 20000u);  // so that coarsening takes part
    EXPECT_EQ(one.patch_of_face, two.patch_of_face);
    EXPECT_EQ(one.patch_of_face, again.patch_of_face);
    EXPECT_EQ(one.error, two.error);
}

TEST(Vsa, SeedFacesStayInDifferentPatches) {
    const LoadedMesh mesh = make_model("sphere");
    VsaOptions options;
    options.patch_count = 12;
    options.seed_faces = {0, 1, 2, 3, 100, 100};
    const VsaResult result = segment_vsa(mesh.mesh, options);
    EXPECT_EQ(result.proxy_normals.size(), 12u);
    std::set<int> patches;
    for (int face : {0, 1, 2, 3, 100}) patches.insert(result.patch_of_face[face]);
    EXPECT_EQ(patches.size(), 5u);
    expect_partition(mesh, result);
}

TEST(Vsa, SmallPatchesDissolve) {
    const LoadedMesh mesh = make_model("gear");
    VsaOptions options;
    options.patch_count = 80;
    options.min_patch_area = 0.3;
    const VsaResult result = segment_vsa(mesh.mesh, options);
    expect_partition(mesh, result);
    std::vector<double> areas(result.proxy_normals.size(), 0);
    for (const auto f : mesh.mesh.faces()) {
        areas[result.patch_of_face[f.idx()]] += face_area(mesh.mesh, f);
    }
    const double mean = testing::total_area(mesh.mesh) / static_cast<double>(areas.size());
    for (double area : areas) EXPECT_GE(area, 0.25 * mean);
}

TEST(Vsa, OptionsOutOfRangeAreRefused) {
    const LoadedMesh mesh = testing::cube_soup().load();
    VsaOptions options;
    options.patch_count = 0;
    EXPECT_THROW(segment_vsa(mesh.mesh, options), InputError);
    options = {};
    options.seed_faces = {12};
    EXPECT_THROW(segment_vsa(mesh.mesh, options), InputError);
    options = {};
    options.min_patch_area = -1;
    EXPECT_THROW(segment_vsa(mesh.mesh, options), InputError);
}

}  // namespace
}  // namespace fcn
