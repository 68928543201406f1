// Symmetries against groups that are known: of boxes, gears, and of copies of a shape that has
// no symmetry at all.

#include "features/symmetry.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <numeric>
#include <random>

#include "features/feature_meshes.h"
#include "features/features.h"
#include "geometry/models.h"

namespace fcn {
namespace {

using testing::kDegree;
using testing::problems_of;

/// Faces divided into `steps` squared triangles each.
LoadedMesh divided(const std::vector<Vec3>& corners, const std::vector<std::array<int, 3>>& faces,
                   int steps) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const auto& [a, b, c] : faces) {
        std::map<std::pair<int, int>, int> index;
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; i + j <= steps; ++j) {
                index[{i, j}] = static_cast<int>(points.size());
                points.push_back((corners[a] * (steps - i - j) + corners[b] * i + corners[c] * j) /
                                 steps);
            }
        }
        for (int i = 0; i < steps; ++i) {
            for (int j = 0; i + j < steps; ++j) {
                triangles.push_back({index[{i, j}], index[{i + 1, j}], index[{i, j + 1}]});
                if (i + j + 1 < steps)
                    triangles.push_back(
                        {index[{i + 1, j}], index[{i + 1, j + 1}], index[{i, j + 1}]});
            }
        }
    }
    return mesh_from_soup(points, triangles, {}, {.weld_tolerance = 1e-9});
}

/// A tetrahedron whose six edges all differ in length, and images of it.
LoadedMesh tetrahedra(const std::vector<Isometry>& copies, int steps = 12) {
    const std::vector<Vec3> corners{{0, 0, 0}, {1.0, 0.1, 0.05}, {0.2, 0.75, 0.1}, {0.3, 0.2, 0.5}};
    const std::vector<std::array<int, 3>> faces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    std::vector<Vec3> all;
    std::vector<std::array<int, 3>> triangles;
    for (const Isometry& copy : copies) {
        const int first = static_cast<int>(all.size());
        for (const Vec3& corner : corners) all.push_back(copy(corner));
        for (auto [a, b, c] : faces) {
            if (copy.is_improper()) std::swap(b, c);
            triangles.push_back({first + a, first + b, first + c});
        }
    }
    return divided(all, triangles, steps);
}

/// Moves every vertex by a normal distribution of `share` of the mean edge length.
void add_noise(LoadedMesh& mesh, double share) {
    double sum = 0;
    for (const EdgeHandle edge : mesh.mesh.edges()) sum += mesh.mesh.calc_edge_length(edge);
    const double deviation = share * sum / static_cast<double>(mesh.mesh.n_edges());
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0, deviation);
    for (const VertexHandle vertex : mesh.mesh.vertices()) {
        const Vec3 shift(normal(random), normal(random), normal(random));
        mesh.mesh.set_point(vertex, mesh.mesh.point(vertex) + shift);
    }
}

void transform(LoadedMesh& mesh, const Eigen::Matrix3d& linear, const Vec3& translation) {
    for (const VertexHandle vertex : mesh.mesh.vertices())
        mesh.mesh.set_point(vertex, linear * mesh.mesh.point(vertex) + translation);
}

struct Counts {
    int reflections = 0, rotations = 0, translations = 0;
    auto operator<=>(const Counts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Counts& counts) {
    return out << counts.reflections << " reflections, " << counts.rotations << " rotations, "
               << counts.translations << " translations";
}

/// Symmetries of the whole surface, not of most of it.
Counts whole(const std::vector<SurfaceSymmetry>& symmetries) {
    Counts counts;
    for (const SurfaceSymmetry& symmetry : symmetries) {
        if (symmetry.coverage < 0.97) continue;
        if (symmetry.kind == SymmetryKind::Reflection) ++counts.reflections;
        if (symmetry.kind == SymmetryKind::Rotation) ++counts.rotations;
        if (symmetry.kind == SymmetryKind::Translation) ++counts.translations;
    }
    return counts;
}

double distance_to(const NetworkArc& arc, const Vec3& point) {
    double best = 1e300;
    for (std::size_t k = 0; k + 1 < arc.samples.size(); ++k) {
        const Vec3 a = arc.samples[k].position;
        const Vec3 step = arc.samples[k + 1].position - a;
        const double t = std::clamp((point - a).dot(step) / step.squaredNorm(), 0.0, 1.0);
        best = std::min(best, (a + t * step - point).norm());
    }
    return best;
}

bool is_image(const NetworkArc& from, const NetworkArc& to, const Isometry& map, double slack) {
    const Isometry back = map.inverse();
    return std::ranges::all_of(from.samples,
                               [&](const ArcSample& sample) {
                                   return distance_to(to, map(sample.position)) <= slack;
                               }) &&
           std::ranges::all_of(to.samples, [&](const ArcSample& sample) {
               return distance_to(from, back(sample.position)) <= slack;
           });
}

/// Arcs that the generators of a known group exchange, as sorted lists; single arcs left out.
std::set<std::vector<int>> expected_orbits(const FeatureCurveNetwork& network,
                                           const std::vector<Isometry>& generators, double slack) {
    std::vector<int> root(network.arcs.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int a) {
        while (root[a] != a) a = root[a];
        return a;
    };
    for (const Isometry& map : generators) {
        for (std::size_t a = 0; a < root.size(); ++a) {
            const NetworkArc& arc = network.arcs[a];
            const Vec3 middle = map(arc.samples[arc.samples.size() / 2].position);
            for (std::size_t b = 0; b < root.size(); ++b) {
                if (distance_to(network.arcs[b], middle) <= slack &&
                    is_image(arc, network.arcs[b], map, slack))
                    root[find(static_cast<int>(a))] = find(static_cast<int>(b));
            }
        }
    }
    std::map<int, std::vector<int>> classes;
    for (std::size_t a = 0; a < root.size(); ++a)
        classes[find(static_cast<int>(a))].push_back(static_cast<int>(a));
    std::set<std::vector<int>> result;
    for (const auto& [representative, members] : classes)
        if (members.size() > 1) result.insert(members);
    return result;
}

std::set<std::vector<int>> found_orbits(const FeatureCurveNetwork& network) {
    std::set<std::vector<int>> result;
    for (const SymmetryOrbit& orbit : network.orbits) {
        std::vector<int> arcs;
        for (const OrbitMember& member : orbit.members) arcs.push_back(member.arc);
        std::ranges::sort(arcs);
        result.insert(arcs);
    }
    return result;
}

/// Every member is where its map takes the representative, in the direction that it says.
void expect_maps_hold(const FeatureCurveNetwork& network, double slack) {
    for (const SymmetryOrbit& orbit : network.orbits) {
        const NetworkArc& first = network.arcs[orbit.members[0].arc];
        for (const OrbitMember& member : orbit.members) {
            const NetworkArc& arc = network.arcs[member.arc];
            const Isometry map{member.linear, member.translation};
            EXPECT_TRUE(is_image(first, arc, map, slack)) << "arc " << member.arc;
            if (arc.is_closed()) continue;
            const Vec3 start = map(first.samples.front().position);
            const Vec3 expected =
                member.is_reversed ? arc.samples.back().position : arc.samples.front().position;
            EXPECT_LE((start - expected).norm(), 3 * slack) << "arc " << member.arc;
        }
    }
}

Isometry turn(double angle, const Vec3& axis) {
    return {Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(), Vec3::Zero()};
}

Isometry mirror_z(double height) { return reflection_between({0, 0, 0}, {0, 0, height}); }

TEST(SymmetryTest, BoxHasThreeMirrorsAndThreeHalfTurns) {
    const LoadedMesh box = make_model("box", {.resolution = 0.05});
    FeatureCurveNetwork network = detect_sharp(box);
    const auto symmetries = add_symmetry_orbits(network, box);
    EXPECT_EQ(whole(symmetries), (Counts{3, 3, 0}));
    EXPECT_EQ(symmetries.size(), 6u);
    EXPECT_EQ(network.orbits.size(), 3u);
    for (const SymmetryOrbit& orbit : network.orbits) EXPECT_EQ(orbit.members.size(), 4u);
    expect_maps_hold(network, 1e-3);
    EXPECT_EQ(problems_of(network, box.mesh), "");
}

struct GearCase {
    int teeth;
    double noise;  ///< of the mesh's edge length
};

std::ostream& operator<<(std::ostream& out, const GearCase& gear) {
    return out << gear.teeth << " teeth, noise " << gear.noise;
}

class Gears : public ::testing::TestWithParam<GearCase> {};

TEST_P(Gears, AllOrbitsAreFound) {
    const auto [teeth, noise] = GetParam();
    const LoadedMesh gear =
        make_model("gear", {.resolution = 0.05, .spacing = 0.04, .count = teeth, .noise = noise});
    FeatureCurveNetwork network = detect_sharp(gear);
    const auto symmetries = add_symmetry_orbits(network, gear);
    EXPECT_EQ(whole(symmetries), (Counts{teeth + 1, 2 * teeth - 1, 0}));
    const std::vector<Isometry> generators{turn(360 * kDegree / teeth, {0, 0, 1}), mirror_z(0.2),
                                           reflection_between({0, -1, 0}, {0, 1, 0})};
    EXPECT_EQ(found_orbits(network), expected_orbits(network, generators, 0.01));
    expect_maps_hold(network, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Teeth, Gears,
                         ::testing::Values(GearCase{5, 0}, GearCase{5, 0.01}, GearCase{8, 0},
                                           GearCase{13, 0.01}, GearCase{24, 0}),
                         [](const auto& test) {
                             return std::to_string(test.param.teeth) +
                                    (test.param.noise > 0 ? "_noisy" : "_clean");
                         });

TEST(SymmetryTest, MirroredCopiesPairUp) {
    const Isometry mirror = reflection_between({0.3, -1.2, 0.1}, {0.5, -0.2, 0.3});
    for (const double noise : {0.0, 0.01}) {
        LoadedMesh mesh = tetrahedra({{}, mirror});
        add_noise(mesh, noise);
        FeatureCurveNetwork network = detect_sharp(mesh);
        const auto symmetries = add_symmetry_orbits(network, mesh);
        EXPECT_EQ(whole(symmetries), (Counts{1, 0, 0})) << noise;
        EXPECT_EQ(network.orbits.size(), 6u) << noise;
        EXPECT_EQ(found_orbits(network), expected_orbits(network, {mirror}, 0.01));
        expect_maps_hold(network, 0.01);
    }
}

TEST(SymmetryTest, TurnedAndShiftedCopiesPairUp) {
    Isometry third = turn(120 * kDegree, {1, 2, 3});
    third.translation = Vec3(3, -1.5, 0);  // across the axis
    const LoadedMesh turned = tetrahedra({{}, third, third.after(third)});
    FeatureCurveNetwork network = detect_sharp(turned);
    EXPECT_EQ(whole(add_symmetry_orbits(network, turned)), (Counts{0, 2, 0}));
    EXPECT_EQ(found_orbits(network), expected_orbits(network, {third}, 0.01));
    EXPECT_EQ(network.orbits.size(), 6u);

    const Isometry shift{Eigen::Matrix3d::Identity(), Vec3(0.3, 1.1, -0.2)};
    const LoadedMesh shifted =
        tetrahedra({{}, shift, shift.after(shift), shift.after(shift.after(shift))});
    network = detect_sharp(shifted);
    const auto symmetries = add_symmetry_orbits(network, shifted);
    for (const SurfaceSymmetry& symmetry : symmetries) {
        EXPECT_EQ(symmetry.kind, SymmetryKind::Translation);
        EXPECT_NEAR(symmetry.coverage, 0.75, 0.03);  // the fourth copy leaves the surface
    }
    EXPECT_EQ(symmetries.size(), 2u);  // there and back
    EXPECT_EQ(network.orbits.size(), 6u);
    for (const SymmetryOrbit& orbit : network.orbits) EXPECT_EQ(orbit.members.size(), 4u);
}

TEST(SymmetryTest, NothingWhereThereIsNone) {
    const LoadedMesh mesh = tetrahedra({{}});
    FeatureCurveNetwork network = detect_sharp(mesh);
    ASSERT_EQ(network.arcs.size(), 6u);
    // The plane that halves a wedge exchanges its two faces, which is much of a tetrahedron.
    for (const SurfaceSymmetry& symmetry : add_symmetry_orbits(network, mesh))
        EXPECT_LT(symmetry.coverage, 0.7);
    EXPECT_TRUE(network.orbits.empty());
}

TEST(SymmetryTest, DoesNotDependOnPlaceSizeOrThreads) {
    LoadedMesh mesh = make_model("gear", {.resolution = 0.08, .spacing = 0.08, .count = 5});
    FeatureCurveNetwork network = detect_sharp(mesh);
    const auto plain = add_symmetry_orbits(network, mesh, {.threads = 1});
    const auto orbits = found_orbits(network);
    const auto more_threads = find_symmetries(mesh, network, {.threads = 3});
    ASSERT_EQ(plain.size(), more_threads.size());
    for (std::size_t k = 0; k < plain.size(); ++k) {
        EXPECT_EQ(plain[k].map.linear, more_threads[k].map.linear);
        EXPECT_EQ(plain[k].map.translation, more_threads[k].map.translation);
        EXPECT_EQ(plain[k].coverage, more_threads[k].coverage);
    }
    transform(mesh, 250 * turn(1.1, {3, -1, 2}).linear, {1000, -20, 7});
    network = detect_sharp(mesh);
    EXPECT_EQ(whole(add_symmetry_orbits(network, mesh)), whole(plain));
    EXPECT_EQ(found_orbits(network), orbits);
}

TEST(SymmetryTest, PinnedArcsPairOnlyWithTheirLike) {
    const LoadedMesh box = make_model("box", {.resolution = 0.1});
    FeatureCurveNetwork network = detect_sharp(box);
    network.arcs[0].pin = Pin::Keep;
    add_symmetry_orbits(network, box);
    for (const std::vector<int>& orbit : found_orbits(network))
        EXPECT_EQ(std::ranges::count(orbit, 0), 0);
}

TEST(SymmetryTest, MeshesWithoutFeaturesOrAreaAreNoTrouble) {
    const LoadedMesh sphere = make_model("sphere", {.resolution = 0.1});
    FeatureCurveNetwork nothing;
    EXPECT_NO_THROW(add_symmetry_orbits(nothing, sphere));
    EXPECT_TRUE(nothing.orbits.empty());
    const LoadedMesh triangle = mesh_from_soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    EXPECT_NO_THROW(add_symmetry_orbits(nothing, triangle));
    EXPECT_TRUE(find_symmetries(LoadedMesh{}, nothing).empty());
}

TEST(IsometryTest, FitsRecoverTheMapAndItsKind) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto vector = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    for (int round = 0; round < 200; ++round) {
        std::vector<Vec3> from;
        for (int k = 0; k < 8; ++k) from.push_back(vector());
        const Vec3 axis = vector().normalized();
        Isometry rotation = turn(0.3 + 2.5 * std::abs(unit(random)), axis);
        rotation.translation = axis.cross(vector());
        const std::vector<std::pair<SymmetryKind, Isometry>> maps{
            {SymmetryKind::Reflection, reflection_between(vector(), vector())},
            {SymmetryKind::Rotation, rotation},
            {SymmetryKind::Translation, {Eigen::Matrix3d::Identity(), axis}}};
        for (const auto& [kind, map] : maps) {
            std::vector<Vec3> to;
            for (const Vec3& point : from) to.push_back(map(point));
            EXPECT_LE(displacement_between(fit_symmetry(kind, from, to), map, {0, 0, 0}, 1), 1e-9);
            EXPECT_LE(
                displacement_between(fit_isometry(from, to, map.is_improper()), map, {0, 0, 0}, 1),
                1e-9);
            EXPECT_EQ(kind_of(map, {0, 0, 0}, 1, 1e-6), kind);
        }
        // The same turn with a shift along its axis is a screw, which is of no kind.
        Isometry screw = rotation;
        screw.translation += 0.5 * axis;
        EXPECT_FALSE(kind_of(screw, {0, 0, 0}, 1, 1e-3).has_value());
        const Isometry half = part_of_motion(rotation, 0.5);
        EXPECT_LE(displacement_between(half.after(half), rotation, {0, 0, 0}, 1), 1e-9);
    }
}

}  // namespace
}  // namespace fcn
