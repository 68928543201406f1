#include "features/normal_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "known_curves.h"

namespace fcn {
namespace {

struct Case {
    MeshArrays clean, noisy;
    double displacement = 0;
};

Case make_case(const std::string& name, double noise, std::uint64_t seed) {
    const KnownPart part = model_part(name, 6000);
    return {mesh_arrays(noisy_mesh(part, 0, seed).mesh),
            mesh_arrays(noisy_mesh(part, noise, seed).mesh), noise * part.mean_edge()};
}

std::vector<bool> all_faces(const MeshArrays& arrays) {
    return std::vector<bool>(arrays.face_count(), true);
}

/// Share of the area whose normal is off by more than `most` radians.
double share_off(const MeshArrays& clean, const std::vector<Vec3>& normals, double most) {
    double area = 0, off = 0;
    for (int f = 0; f < clean.face_count(); ++f) {
        area += clean.areas[f];
        if (clean.normals[f].dot(normals[f]) < std::cos(most)) off += clean.areas[f];
    }
    return off / area;
}

// Half of the normals and more are off by 6 degrees before.
TEST(NormalFilter, BringsNormalsOfABoxBackAndKeepsItsCreases) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Case c = make_case("box", 0.1, seed);
        const FilteredNormals result = filtered_normals(c.noisy, all_faces(c.noisy));
        EXPECT_GT(share_off(c.clean, c.noisy.normals, 0.1), 0.5) << "seed " << seed;
        EXPECT_LT(share_off(c.clean, result.normals, 0.1), 0.05) << "seed " << seed;
        // Beside creases too: nothing is half way between two sides.
        EXPECT_LT(share_off(c.clean, result.normals, 0.4), 0.002) << "seed " << seed;
    }
}

TEST(NormalFilter, MeasuresTheNoise) {
    for (const char* name : {"box", "gear", "sphere"}) {
        for (double noise : {0.05, 0.1, 0.2}) {
            const Case c = make_case(name, noise, 1);
            const double measured = filtered_normals(c.noisy, all_faces(c.noisy)).displacement;
            EXPECT_NEAR(measured, c.displacement, 0.5 * c.displacement) << name << ' ' << noise;
        }
    }
}

TEST(NormalFilter, LeavesAloneWhatIsNotNoisy) {
    const Case c = make_case("box", 0.1, 1);
    std::vector<bool> is_noisy = all_faces(c.noisy);
    for (int f = 0; f < c.noisy.face_count(); f += 2) is_noisy[f] = false;
    const FilteredNormals result = filtered_normals(c.noisy, is_noisy);
    for (int f = 0; f < c.noisy.face_count(); f += 2)
        EXPECT_EQ(result.normals[f], c.noisy.normals[f]);
    const FilteredNormals clean = filtered_normals(c.clean, all_faces(c.clean));
    EXPECT_LT(clean.displacement, 1e-6 * c.displacement);
    EXPECT_EQ(share_off(c.clean, clean.normals, 1e-3), 0);
}

TEST(NormalFilter, DoesNotDependOnThreads) {
    const Case c = make_case("gear", 0.1, 1);
    const FilteredNormals one = filtered_normals(c.noisy, all_faces(c.noisy), {.threads = 1});
    const FilteredNormals two = filtered_normals(c.noisy, all_faces(c.noisy), {.threads = 2});
    EXPECT_EQ(one.normals, two.normals);
}

TEST(NormalFilter, NormalsStayFiniteOnDegenerateFaces) {
    // A fan around the origin with faces of no area, which readers would have repaired.
    MeshArrays arrays = mesh_arrays(noisy_mesh(model_part("sphere", 500), 0.2, 1).mesh);
    for (int f = 0; f < arrays.face_count(); f += 3) {
        arrays.areas[f] = 0;
        arrays.normals[f] = Vec3::Zero();
    }
    for (const Vec3& n : filtered_normals(arrays, all_faces(arrays)).normals)
        EXPECT_TRUE(n.allFinite());
    arrays.areas.assign(arrays.areas.size(), 0);
    for (const Vec3& n : filtered_normals(arrays, all_faces(arrays)).normals)
        EXPECT_TRUE(n.allFinite());
}

}  // namespace
}  // namespace fcn
