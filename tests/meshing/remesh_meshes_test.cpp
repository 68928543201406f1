// Remeshing of scans and CAD parts, with networks nobody adapted: curves closer than the edge
// length, crumbs, slivers. What comes out must be a sound mesh all the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "remesh_checks.h"
#include "sample_networks.h"
#include "support/shared_data.h"

namespace fcn {
namespace {

std::vector<std::filesystem::path> mesh_files() {
    std::vector<std::filesystem::path> files;
    const auto data = testing::shared_data();
    if (!data) return files;
    for (const auto& entry : std::filesystem::directory_iterator(*data / "meshes"))
        if (entry.path().extension() == ".off" || entry.path().extension() == ".obj")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// Every third mesh, so that each is remeshed in one way.
void check_some(std::size_t first, double share, bool is_adapted) {
    const auto files = mesh_files();
    if (files.empty()) GTEST_SKIP() << "no shared meshes here";
    for (std::size_t i = first; i < files.size(); i += 3) {
        const auto& file = files[i];
        SCOPED_TRACE(file.filename().string());
        const LoadedMesh mesh = read_mesh(file);
        const double rmin = share * bounding_box(mesh.mesh).diagonal();
        FeatureCurveNetwork network = test::crease_network(mesh.mesh, 0.7);
        if (is_adapted) network = test::cut_evenly(network, rmin);
        RemeshOptions options;
        options.edge_length = 1.2 * rmin;
        options.iterations = 4;
        const RemeshResult result = remesh_triangles(mesh, network, options);
        test::expect_sound(mesh, network, result);
        for (const std::string& warning : result.warnings) {
            EXPECT_EQ(warning.find("could not be embedded"), std::string::npos) << warning;
            EXPECT_EQ(warning.find("CGAL"), std::string::npos) << warning;
            EXPECT_EQ(warning.find("not kept"), std::string::npos) << warning;
        }
    }
}

TEST(RemeshMeshes, CutArcsAtTwoPercent) { check_some(0, 0.02, true); }
TEST(RemeshMeshes, CutArcsAtSixPercent) { check_some(1, 0.06, true); }
TEST(RemeshMeshes, EveryCreaseAtThreePercent) { check_some(2, 0.03, false); }

}  // namespace
}  // namespace fcn
