// Sharp edges of parts whose curves are known, with noise.

#include <gtest/gtest.h>

#include "features/features.h"
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
