#include "features/mend_chains.h"

#include <gtest/gtest.h>

#include <numbers>

#include "features/mesh_arrays.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kHigh = 40 * kDegree;
constexpr int kSize = 16;  // squares along a side of the plane

/// A plane of squares cut in two, on which edges are marked by hand.
class MendChains : public ::testing::Test {
protected:
    MendChains() {
        std::vector<Vec3> points;
        std::vector<std::array<int, 3>> triangles;
        for (int y = 0; y <= kSize; ++y)
            for (int x = 0; x <= kSize; ++x) points.emplace_back(x, y, 0);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                triangles.push_back({id(x, y), id(x + 1, y), id(x + 1, y + 1)});
                triangles.push_back({id(x, y), id(x + 1, y + 1), id(x, y + 1)});
            }
        }
        arrays_ = mesh_arrays(mesh_from_soup(points, triangles).mesh);
        dihedrals_ = {std::vector<double>(arrays_.edge_count(), 0),
                      std::vector<bool>(arrays_.edge_count(), true),
                      {},
                      0};
        is_sharp_.assign(arrays_.edge_count(), false);
    }

    static int id(int x, int y) { return y * (kSize + 1) + x; }

    int edge(int a, int b) const {
        for (int e = 0; e < arrays_.edge_count(); ++e) {
            const auto [from, to] = arrays_.edge_vertices[e];
            if ((from == a && to == b) || (from == b && to == a)) return e;
        }
        ADD_FAILURE() << "no edge " << a << ' ' << b;
        return 0;
    }

    /// Marks a path with an angle in degrees.
    void draw(const std::vector<std::array<int, 2>>& path, double degrees, bool is_marked = true) {
        for (std::size_t i = 1; i < path.size(); ++i) {
            const int e = edge(id(path[i - 1][0], path[i - 1][1]), id(path[i][0], path[i][1]));
            dihedrals_.angles[e] = degrees * kDegree;
            is_sharp_[e] = is_marked;
        }
    }

    static std::vector<std::array<int, 2>> row(int y, int from, int to) {
        std::vector<std::array<int, 2>> path;
        for (int x = from; x <= to; ++x) path.push_back({x, y});
        return path;
    }

    std::vector<bool> mended() {
        std::vector<bool> result = is_sharp_;
        mend_chains(arrays_, dihedrals_, kHigh, result);
        return result;
    }

    /// Edges that are sharp in one and not in the other.
    static int difference(const std::vector<bool>& a, const std::vector<bool>& b) {
        int count = 0;
        for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
        return count;
    }

    MeshArrays arrays_;
    RobustDihedrals dihedrals_;
    std::vector<bool> is_sharp_;
};

TEST_F(MendChains, AGapAlongAWeakCreaseIsClosed) {
    draw(row(8, 0, kSize), 60);
    const std::vector<bool> whole = is_sharp_;
    draw(row(8, 6, 9), 10, false);
    EXPECT_EQ(difference(mended(), whole), 0);
}

TEST_F(MendChains, ChainsThatDoNotLookAtEachOtherStayApart) {
    draw(row(8, 0, 5), 60);
    draw(row(13, 9, kSize), 60);
    EXPECT_EQ(difference(mended(), is_sharp_), 0);
}

TEST_F(MendChains, NoGapIsClosedAgainstTheTurningOfTheSurface) {
    draw(row(8, 0, kSize), 60);
    draw(row(8, 6, 9), -30, false);
    EXPECT_EQ(difference(mended(), is_sharp_), 0);
}

TEST_F(MendChains, AWeakSpurGoesAndALongBranchStays) {
    draw(row(8, 0, kSize), 60);
    const std::vector<bool> crease = is_sharp_;
    draw({{5, 8}, {5, 9}, {5, 10}}, 30);
    EXPECT_EQ(difference(mended(), crease), 0);
    draw({{5, 8}, {5, 9}, {5, 10}, {5, 11}, {5, 12}, {5, 13}, {5, 14}, {5, 15}, {5, 16}}, 30);
    EXPECT_EQ(difference(mended(), is_sharp_), 0);
}

TEST_F(MendChains, OfTwoChainsAroundAFewFacesTheStrongerStays) {
    draw(row(8, 0, kSize), 60);
    draw(row(8, 6, 8), 20);
    draw({{6, 8}, {6, 9}, {7, 9}, {8, 9}, {8, 8}}, 45);
    const std::vector<bool> result = mended();
    EXPECT_FALSE(result[edge(id(6, 8), id(7, 8))]);
    EXPECT_FALSE(result[edge(id(7, 8), id(8, 8))]);
    EXPECT_EQ(difference(result, is_sharp_), 2);
}

TEST_F(MendChains, SmallFacesOfTheShapeStay) {
    // A strip one square wide that is closed at both ends, as the end of a thin wall.
    draw(row(8, 0, kSize), 80);
    draw(row(9, 0, kSize), 80);
    for (int x : {4, 6, 7}) draw({{x, 8}, {x, 9}}, 80);
    EXPECT_EQ(difference(mended(), is_sharp_), 0);
}

TEST_F(MendChains, CleanPlacesAreLeftAlone) {
    draw(row(8, 0, kSize), 60);
    draw(row(8, 6, 9), 10, false);
    draw({{3, 8}, {3, 9}}, 30);
    dihedrals_.is_noisy_edge.assign(arrays_.edge_count(), false);
    EXPECT_EQ(difference(mended(), is_sharp_), 0);
}

}  // namespace
}  // namespace fcn
