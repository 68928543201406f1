// What a person sees (DESIGN 4.12), by measures that share nothing with the adaptation: creases
// that run far from all others are whole, and no crumbs lie about. The measures themselves are
// tested on networks where the answer is known.

#include <gtest/gtest.h>

#include <string>

#include "adaptation/adaptation.h"
#include "features/features.h"
#include "geometry/models.h"
#include "labeling_mip/mip_solvers.h"
#include "support/shared_data.h"
#include "visible_creases.h"

namespace fcn::test {
namespace {

/// The network with every arc of the given one as segments between its samples.
FeatureCurveNetwork with_segments(FeatureCurveNetwork network, double rmin) {
    network.scale = rmin;
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        const NetworkArc& arc = network.arcs[a];
        int previous = arc.nodes[0];
        for (std::size_t k = 1; k < arc.samples.size(); ++k) {
            int next = arc.nodes[1];
            if (k + 1 < arc.samples.size()) {
                next = static_cast<int>(network.nodes.size());
                network.nodes.push_back({arc.samples[k].position, arc.samples[k].surface});
            }
            NetworkSegment segment;
            segment.nodes = {previous, next};
            segment.arc = static_cast<int>(a);
            segment.first_sample = static_cast<int>(k) - 1;
            segment.last_sample = static_cast<int>(k);
            network.segments.push_back(segment);
            previous = next;
        }
    }
    return network;
}

TEST(VisibleCreases, MeasuresOfABox) {
    const LoadedMesh box = make_model("box");
    const FeatureCurveNetwork edges = detect_sharp(box);
    ASSERT_EQ(edges.arcs.size(), 12u);
    const double rmin = 0.02 * bounding_box(box.mesh).diagonal();
    const FeatureCurveNetwork whole = with_segments(edges, rmin);
    double length = 0, covered = 0;
    for (const auto& crease : experiments::isolated_creases(box, whole, rmin)) {
        length += crease.length;
        covered += crease.covered;
    }
    // Isolated: all but 1.5 rmin at either end of each edge.
    EXPECT_NEAR(length, edges.total_length() - 12 * 3 * rmin, 12 * 0.25 * rmin);
    EXPECT_NEAR(covered, length, 1e-9);
    EXPECT_EQ(experiments::count_crumbs(edges, whole, rmin), 0);
    FeatureCurveNetwork one_less = edges;
    one_less.arcs.pop_back();
    const auto creases = experiments::isolated_creases(box, with_segments(one_less, rmin), rmin);
    EXPECT_EQ(std::ranges::count_if(creases, [](const auto& c) { return c.covered == 0; }), 1);
    // A stub in the middle of an edge, 2 rmin long, is a crumb.
    FeatureCurveNetwork stub = edges;
    stub.arcs.resize(1);
    const Vec3 a = stub.arcs[0].samples.front().position, b = stub.arcs[0].samples.back().position;
    const Vec3 middle = (a + b) / 2, along = (b - a).normalized() * rmin;
    stub.nodes = {{middle - along, {}}, {middle + along, {}}};
    stub.arcs[0].nodes = {0, 1};
    stub.arcs[0].samples = {{middle - along, {}}, {middle + along, {}}};
    EXPECT_EQ(experiments::count_crumbs(edges, with_segments(stub, rmin), rmin), 1);
}

struct VisibleCase {
    std::string mesh;  ///< a model, or a file of the shared meshes
    double scale;      ///< rmin, share of the diagonal
    int patches;       ///< 0 = sharp edges
};

class VisibleOn : public ::testing::TestWithParam<VisibleCase> {};

TEST_P(VisibleOn, IsolatedCreasesAreWholeAndNoCrumbsRemain) {
    const VisibleCase& test = GetParam();
    LoadedMesh mesh;
    if (test.mesh.find('.') == std::string::npos) {
        mesh = make_model(test.mesh);
    } else {
        const auto shared = testing::shared_data();
        if (!shared) GTEST_SKIP() << "needs " << test.mesh << " of the shared meshes";
        mesh = read_mesh((*shared / "meshes" / test.mesh).string());
    }
    VsaOptions vsa;
    vsa.patch_count = test.patches;
    const FeatureCurveNetwork initial = add_boundaries(
        test.patches == 0 ? detect_sharp(mesh) : detect_vsa(mesh, vsa), mesh, BoundaryPolicy::Keep);
    AdaptationOptions options;
    options.rmin = test.scale * bounding_box(mesh.mesh).diagonal();
    options.solver = labeling::all_solvers().find("auto");
    options.solve.work_limit = 20'000'000;
    const AdaptationResult result = adapt_network(mesh, initial, options);
    const auto creases = experiments::isolated_creases(mesh, result.network, options.rmin);
    EXPECT_FALSE(creases.empty());
    for (const auto& crease : creases) {
        EXPECT_GE(crease.covered, 0.98 * crease.length)
            << "near " << crease.uncovered_at.transpose();
    }
    EXPECT_EQ(experiments::count_crumbs(initial, result.network, options.rmin), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Parts, VisibleOn,
    ::testing::Values(VisibleCase{"box", 0.05, 0}, VisibleCase{"steps", 0.02, 0},
                      VisibleCase{"steps", 0.04, 60}, VisibleCase{"ribs", 0.02, 0},
                      VisibleCase{"ribs", 0.05, 0}, VisibleCase{"gear", 0.02, 0},
                      VisibleCase{"gear", 0.06, 0}, VisibleCase{"skyscraper", 0.02, 0},
                      VisibleCase{"skyscraper", 0.05, 0}, VisibleCase{"fandisk.off", 0.03, 0},
                      VisibleCase{"fandisk.off", 0.03, 100}, VisibleCase{"fandisk.off", 0.02, 200},
                      VisibleCase{"anchor_dense.off", 0.03, 0},
                      VisibleCase{"CrankArm.off", 0.03, 0}),
    [](const auto& test) {
        return test.param.mesh.substr(0, test.param.mesh.find_first_of("._-")) + "_" +
               std::to_string(test.index);
    });

}  // namespace
}  // namespace fcn::test
