#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "geometry/errors.h"
#include "network/network_io.h"
#include "network/sample_networks.h"

namespace fcn {
namespace {

using namespace fcn::testing;
namespace fs = std::filesystem;

/// A folder of its own for each test, gone afterwards.
class Formats : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() / ("network_formats_" + std::string(info->name()) +
                                               "_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    FeatureCurveNetwork round_trip(const FeatureCurveNetwork& network, const std::string& name,
                                   NetworkDetail detail, const LoadedMesh* mesh = nullptr) {
        const fs::path path = folder_ / name;
        write_network(path, network, detail, mesh);
        return read_network(path, mesh ? &mesh->mesh : nullptr);
    }

    fs::path folder_;
};

const std::vector<std::string> kArcFormats{"n.ply", "n.vtp",           "n.mesh",
                                           "n.msh", "n.polylines.txt", "n.ply.gz"};
const std::vector<std::string> kAllFormats{"n.ply",           "n.vtp", "n.mesh",  "n.msh",
                                           "n.polylines.txt", "n.obj", "n.OBJ.gz"};

std::vector<FeatureCurveNetwork> hand_made() {
    return {y_junction(), t_junction(), cube(),    circle(),      figure_eight(),
            two_loops(),  lasso(),      circle(3), adapted_cube()};
}

/// Arcs as the segments' ends.
std::vector<std::vector<Vec3>> segment_polylines(const FeatureCurveNetwork& network) {
    std::vector<std::vector<Vec3>> all(network.arcs.size());
    for (std::size_t a = 0; a < network.arcs.size(); ++a)
        all[a].push_back(network.nodes[network.arcs[a].nodes[0]].position);
    for (const NetworkSegment& segment : network.segments)
        all[segment.arc].push_back(network.nodes[segment.nodes[1]].position);
    return all;
}

TEST_F(Formats, ArcsSurviveWhereTheFormatCarriesThem) {
    for (const std::string& name : kArcFormats)
        for (const FeatureCurveNetwork& network : hand_made()) {
            SCOPED_TRACE(name + ", " + std::to_string(network.arcs.size()) + " arcs");
            const auto back = round_trip(network, name, NetworkDetail::DenseArcs);
            EXPECT_EQ(polylines(back), polylines(network));
            EXPECT_FALSE(back.is_adapted());
        }
}

TEST_F(Formats, GeometryAndJunctionsSurviveEverywhere) {
    for (const std::string& name : kAllFormats)
        for (const FeatureCurveNetwork& network : hand_made()) {
            SCOPED_TRACE(name);
            const auto back = round_trip(network, name, NetworkDetail::DenseArcs);
            EXPECT_EQ(intervals(back), intervals(network));
            const auto sorted_valences = [](const FeatureCurveNetwork& n) {
                std::vector<int> v = n.valences();
                std::erase_if(v, [](int valence) { return valence == 2 || valence == 0; });
                std::sort(v.begin(), v.end());
                return v;
            };
            EXPECT_EQ(sorted_valences(back), sorted_valences(network));
        }
}

TEST_F(Formats, RandomNetworksSurvive) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const int nodes = 4 + static_cast<int>(seed % 20);
        const FeatureCurveNetwork network = random_network(seed, nodes, 25);
        for (const std::string& name : kAllFormats) {
            SCOPED_TRACE(name + " seed " + std::to_string(seed));
            const auto back = round_trip(network, name, NetworkDetail::DenseArcs);
            EXPECT_EQ(intervals(back), intervals(network));
            if (std::find(kArcFormats.begin(), kArcFormats.end(), name) != kArcFormats.end()) {
                EXPECT_EQ(polylines(back), polylines(network));
            }
        }
    }
}

TEST_F(Formats, SegmentsAreWrittenByTheirEnds) {
    const FeatureCurveNetwork network = adapted_cube();
    for (const std::string& name : kArcFormats) {
        SCOPED_TRACE(name);
        const auto back = round_trip(network, name, NetworkDetail::Segments);
        EXPECT_EQ(polylines(back), segment_polylines(network));
    }
    // Without segments the dense arcs are written.
    const auto back = round_trip(cube(), "n.ply", NetworkDetail::Segments);
    EXPECT_EQ(polylines(back), polylines(cube()));
}

TEST_F(Formats, JsonIsAlwaysWhole) {
    const FeatureCurveNetwork network = adapted_cube();
    for (const char* name : {"n.fcn.json", "n.fcn.json.gz"})
        for (NetworkDetail detail : {NetworkDetail::DenseArcs, NetworkDetail::Segments})
            EXPECT_EQ(network_to_json(round_trip(network, name, detail)), network_to_json(network));
}

TEST_F(Formats, EmptyNetworksSurvive) {
    for (std::string name : kAllFormats) {
        SCOPED_TRACE(name);
        EXPECT_TRUE(round_trip({}, name, NetworkDetail::DenseArcs).arcs.empty());
    }
    const LoadedMesh mesh = cube_mesh(2);
    for (const char* name : {"n.sharp", "n.fl"})
        EXPECT_TRUE(round_trip({}, name, NetworkDetail::DenseArcs, &mesh).arcs.empty());
}

TEST_F(Formats, DroppedPiecesSurviveInPlyAndVtp) {
    const FeatureCurveNetwork network = adapted_cube();
    for (const char* name : {"n.ply", "n.vtp"})
        for (NetworkDetail detail : {NetworkDetail::DenseArcs, NetworkDetail::Segments}) {
            SCOPED_TRACE(name);
            const auto back = round_trip(network, name, detail);
            ASSERT_EQ(back.dropped.size(), network.dropped.size());
            for (std::size_t d = 0; d < back.dropped.size(); ++d) {
                EXPECT_EQ(back.dropped[d].polyline, network.dropped[d].polyline);
                EXPECT_EQ(back.dropped[d].origin_arc, network.dropped[d].origin_arc);
                EXPECT_EQ(back.dropped[d].weight, network.dropped[d].weight);
                if (std::string(name) == "n.vtp") {
                    EXPECT_EQ(back.dropped[d].reason, network.dropped[d].reason);
                }
            }
        }
}

TEST_F(Formats, WeightsStandInThePly) {
    write_network(folder_ / "n.ply", adapted_cube(), NetworkDetail::Segments);
    const std::string text = read_file(folder_ / "n.ply");
    EXPECT_NE(text.find(" 0.3333333333333333 0 1\n"), std::string::npos) << text;
    EXPECT_NE(text.find(" 12.5 3 0\n"), std::string::npos) << text;
}

TEST_F(Formats, MeshIndexFormats) {
    const LoadedMesh mesh = cube_mesh(4);
    const FeatureCurveNetwork network = cube(5);
    const auto fl = round_trip(network, "n.fl", NetworkDetail::DenseArcs, &mesh);
    EXPECT_EQ(polylines(fl), polylines(network));
    const auto sharp = round_trip(network, "n.sharp", NetworkDetail::DenseArcs, &mesh);
    EXPECT_EQ(intervals(sharp), intervals(network));
    EXPECT_EQ(sharp.arcs.size(), 12u);
    for (const NetworkArc& arc : sharp.arcs) EXPECT_NEAR(arc.dihedral, std::numbers::pi / 2, 1e-12);
    // 12 edges of 4 mesh edges, each once per face, all convex.
    const std::string text = read_file(folder_ / "n.sharp");
    EXPECT_EQ(text.substr(0, 3), "96\n");
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 97);
    EXPECT_EQ(text.find("\n0,"), std::string::npos);
}

TEST_F(Formats, FewSamplesOnAMeshEdgeAreNoObstacle) {
    // Samples inside mesh edges are passed over: 9 samples on 4 mesh edges an arc.
    const LoadedMesh mesh = cube_mesh(4);
    const auto back = round_trip(cube(9), "n.fl", NetworkDetail::DenseArcs, &mesh);
    EXPECT_EQ(polylines(back), polylines(cube(5)));
}

TEST_F(Formats, CurvesOffTheMeshEdgesAreRefused) {
    const LoadedMesh mesh = cube_mesh(4);
    const FeatureCurveNetwork across =
        NetworkBuilder().arc({{0, 0, 0}, {0.5, 0.25, 0}, {1, 0.5, 0}}).build();
    const FeatureCurveNetwork mid_edge =
        NetworkBuilder().arc({{0, 0, 0}, {0.25, 0, 0}, {0.3, 0, 0}}).build();
    const FeatureCurveNetwork coarse = NetworkBuilder().arc({{0, 0, 0}, {1, 0, 0}}).build();
    const FeatureCurveNetwork far = NetworkBuilder().arc({{0, 0, 0}, {0, 0, 2}}).build();
    for (const char* name : {"n.fl", "n.sharp"})
        for (const FeatureCurveNetwork& network : {across, mid_edge, coarse, far}) {
            EXPECT_THROW(write_network(folder_ / name, network, NetworkDetail::DenseArcs, &mesh),
                         InputError);
            EXPECT_FALSE(fs::exists(folder_ / name));
        }
    EXPECT_THROW(write_network(folder_ / "n.fl", cube(5), NetworkDetail::DenseArcs), InputError);
}

TEST_F(Formats, SamplesArePlacedOnTheMesh) {
    const LoadedMesh mesh = cube_mesh(3);
    FeatureCurveNetwork off = circle(40, {0.5, 0.5, 1.01}, 0.3);
    write_network(folder_ / "n.obj", off, NetworkDetail::DenseArcs);
    const auto network = read_network(folder_ / "n.obj", &mesh.mesh);
    EXPECT_TRUE(validate(network, mesh.mesh).empty());
    EXPECT_DOUBLE_EQ(network.diagonal, std::sqrt(3.0));
    for (const ArcSample& sample : network.arcs[0].samples) {
        EXPECT_GE(sample.surface.face, 0);
        EXPECT_NEAR(sample.position[2], 1, 1e-12);
    }
}

TEST_F(Formats, NetworksOfAnotherMeshAreRefused) {
    const LoadedMesh mesh = cube_mesh(3);
    const double step = 0.05 * std::sqrt(3.0);
    for (const char* name : {"n.obj", "n.fcn.json"})
        for (const Vec3& center : {Vec3(0.5, 0.5, 1 + 1.1 * step), Vec3(0.5, 0.5, 0.5),
                                   Vec3(1e200, 0, 0), Vec3(-8, 0, 0)}) {
            write_network(folder_ / name, circle(40, center, 0.3), NetworkDetail::DenseArcs);
            try {
                read_network(folder_ / name, &mesh.mesh);
                ADD_FAILURE() << "accepted at " << center.transpose();
            } catch (const InputError& error) {
                EXPECT_NE(std::string(error.what()).find("wrong mesh?"), std::string::npos)
                    << error.what();
            }
        }
    write_network(folder_ / "n.obj", circle(40, {0.5, 0.5, 1 + 0.9 * step}, 0.3),
                  NetworkDetail::DenseArcs);
    EXPECT_NO_THROW(read_network(folder_ / "n.obj", &mesh.mesh));
}

TEST_F(Formats, ArcsThatVanishOnTheSurfaceAreNoted) {
    // A short arc that stands upright on the top side has no length there.
    const LoadedMesh mesh = cube_mesh(3);
    const FeatureCurveNetwork network = NetworkBuilder()
                                            .arc({{0.5, 0.5, 1.02}, {0.5, 0.5, 1.04}})
                                            .arc({{0.2, 0.5, 1}, {0.7, 0.5, 1}})
                                            .build();
    write_network(folder_ / "n.ply", network, NetworkDetail::DenseArcs);
    const auto back = read_network(folder_ / "n.ply", &mesh.mesh);
    EXPECT_EQ(back.arcs.size(), 1u);
    ASSERT_EQ(back.notes.size(), 1u);
    EXPECT_NE(back.notes[0].find("1 arcs"), std::string::npos);
}

TEST_F(Formats, SurfacePointsOfARenumberedMeshAreFoundAgain) {
    const LoadedMesh mesh = cube_mesh(4);
    const fs::path path = folder_ / "n.fcn.json";
    write_network(path, cube(5), NetworkDetail::DenseArcs);
    const FeatureCurveNetwork placed = read_network(path, &mesh.mesh);
    write_network(path, placed, NetworkDetail::DenseArcs);
    EXPECT_EQ(network_to_json(read_network(path, &mesh.mesh)), network_to_json(placed));
    const LoadedMesh finer = cube_mesh(5);
    const FeatureCurveNetwork moved = read_network(path, &finer.mesh);
    EXPECT_TRUE(validate(moved, finer.mesh).empty());
    EXPECT_EQ(polylines(moved), polylines(placed));
    ASSERT_EQ(moved.notes.size(), 1u);
    EXPECT_NE(moved.notes[0].find("did not fit"), std::string::npos);
}

TEST_F(Formats, TheSameBytesEachTime) {
    const FeatureCurveNetwork network = adapted_cube();
    const LoadedMesh mesh = cube_mesh(4);
    for (const char* name : {"n.ply", "n.vtp", "n.mesh", "n.msh", "n.polylines.txt", "n.obj",
                             "n.fl", "n.sharp", "n.fcn.json", "n.obj.gz"}) {
        const fs::path first = folder_ / ("a" + std::string(name)), second = folder_ / name;
        write_network(first, network, NetworkDetail::DenseArcs, &mesh);
        write_network(second, network, NetworkDetail::DenseArcs, &mesh);
        EXPECT_EQ(read_file(first), read_file(second)) << name;
    }
}

TEST_F(Formats, UnknownNamesAreRefused) {
    EXPECT_THROW(write_network(folder_ / "n.stl", cube(), NetworkDetail::DenseArcs), InputError);
    EXPECT_THROW(read_network(folder_ / "absent.ply"), InputError);
    std::ofstream(folder_ / "n.dat") << "1 2 3\n";
    EXPECT_THROW(read_network(folder_ / "n.dat"), InputError);
}

}  // namespace
}  // namespace fcn
