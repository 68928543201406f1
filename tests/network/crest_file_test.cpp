#include "network/crest_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "geometry/errors.h"
#include "network/network_io.h"
#include "network/sample_networks.h"

namespace fcn {
namespace {

/// Two components on the unit square: one of three points in a row, one across a gap.
const std::string kFile =
    "5 3 2\n"
    "0.1 0.2 0 0\n0.3 0.2 0 0\n0.5 0.2 0 0\n"
    "0.1 0.8 0 1\n0.9 0.8 0 1\n"
    "2.5 0.9 40\n0.5 0.7 3\n"
    "0 1 0\n1 2 1\n3 4 -1\n";

Mesh unit_square() {
    return mesh_from_soup({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}})
        .mesh;
}

class TemporaryFile {
public:
    TemporaryFile(const std::string& name, const std::string& content)
        : path_(std::filesystem::path(::testing::TempDir()) / name) {
        std::ofstream(path_) << content;
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

std::string complaint(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(CrestFile, ReadsPointsComponentsAndEdges) {
    const CrestFile file = read_crest_file(kFile, "ridges.txt");
    ASSERT_EQ(file.points.size(), 5u);
    EXPECT_EQ(file.points[4], Vec3(0.9, 0.8, 0));
    EXPECT_EQ(file.component_of_point, (std::vector<int>{0, 0, 0, 1, 1}));
    ASSERT_EQ(file.components.size(), 2u);
    EXPECT_EQ(file.components[0].ridgeness, 2.5);
    EXPECT_EQ(file.components[0].sphericalness, 0.9);
    EXPECT_EQ(file.components[1].cyclideness, 3);
    ASSERT_EQ(file.edges.size(), 3u);
    EXPECT_EQ(file.edges[1], (std::array{1, 2}));
    EXPECT_EQ(file.triangles, (std::vector<int>{0, 1, -1}));
}

TEST(CrestFile, ThresholdsLeaveOutComponents) {
    const CrestFile file = read_crest_file(kFile, "ridges.txt");
    EXPECT_EQ(crest_edges(file).edges.size(), 3u);
    EXPECT_EQ(crest_edges(file, {1, 0, 0}).edges.size(), 2u);
    EXPECT_EQ(crest_edges(file, {0, 0.8, 0}).edges.size(), 2u);
    EXPECT_EQ(crest_edges(file, {0, 0, 3}).edges.size(), 3u);
    EXPECT_EQ(crest_edges(file, {0, 0, 41}).edges.size(), 0u);
}

TEST(CrestFile, NameDecidesFormatAndKind) {
    EXPECT_TRUE(is_crest_file_name("a/ridges.txt"));
    EXPECT_TRUE(is_crest_file_name("Camel_Ravines.TXT"));
    EXPECT_TRUE(is_crest_file_name("ridges.txt.gz"));
    EXPECT_FALSE(is_crest_file_name("a.polylines.txt"));
    const auto network = network_from_content(kFile, "ridges.txt");
    ASSERT_EQ(network.arcs.size(), 2u);
    EXPECT_NEAR(network.total_length(), 0.4 + 0.8, 1e-12);

    const Mesh mesh = unit_square();
    for (const auto& [name, source] :
         {std::pair("ridges.txt", "crest-ridge"), std::pair("ravines.txt", "crest-ravine")}) {
        const TemporaryFile file(std::string("fcn_test_") + name, kFile);
        const auto placed = read_crest_network(file.path(), {}, mesh, 7);
        ASSERT_EQ(placed.arcs.size(), 2u);
        EXPECT_TRUE(validate(placed, mesh).empty());
        for (const NetworkArc& arc : placed.arcs) {
            EXPECT_EQ(arc.source, source);
            EXPECT_GE(arc.patches[0], 7);
            EXPECT_EQ(arc.patches[0], arc.patches[1]);
        }
        EXPECT_NE(placed.arcs[0].patches, placed.arcs[1].patches);
        EXPECT_TRUE(read_crest_network(file.path(), {0, 0, 41}, mesh, 0).arcs.empty());
    }
}

TEST(CrestFile, IsNotWritten) {
    const auto network = network_from_content(kFile, "ridges.txt");
    EXPECT_NE(complaint([&] {
                  write_network("out_ridges.txt", network, NetworkDetail::DenseArcs);
              }).find("read alone"),
              std::string::npos);
}

TEST(CrestFile, BrokenFilesAreRefusedWithTheLine) {
    const auto broken = [](std::size_t line, const std::string& replacement) {
        std::string text;
        std::size_t begin = 0;
        for (std::size_t number = 1; begin < kFile.size(); ++number) {
            const std::size_t end = kFile.find('\n', begin) + 1;
            text += number == line ? replacement + "\n" : kFile.substr(begin, end - begin);
            begin = end;
        }
        return complaint([&] { read_crest_file(text, "ridges.txt"); });
    };
    EXPECT_EQ(broken(1, "5 3 2"), "");
    for (const auto& [line, text] :
         std::vector<std::pair<std::size_t, std::string>>{{2, "0.1 nan 0 0"},
                                                          {2, "0.1 0.2 0 2"},
                                                          {2, "0.1 0.2 0 -1"},
                                                          {2, "0.1 x 0 0"},
                                                          {7, "2.5 inf 40"},
                                                          {9, "0 5 0"},
                                                          {9, "-1 1 0"},
                                                          {9, "0 1 -2"}}) {
        EXPECT_EQ(broken(line, text).rfind("ridges.txt:" + std::to_string(line) + ":", 0), 0u)
            << broken(line, text);
    }
    EXPECT_NE(broken(1, "-5 3 2"), "");
    EXPECT_NE(broken(1, "4000000000 3 2"), "");
    EXPECT_NE(broken(1, "5 4 2"), "") << "an edge is missing";
    EXPECT_NE(broken(1, "5 2 2"), "") << "more follows";
}

}  // namespace
}  // namespace fcn
