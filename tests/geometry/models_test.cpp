#include "geometry/models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "geometry/errors.h"
#include "geometry/manifold_check.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using namespace fcn::testing;

constexpr double kDegree = M_PI / 180;

struct Expectation {
    const char* name;
    long euler;
    double volume;  ///< of the shape that the mesh approximates, 0 where there is no simple form
};

class Models : public ::testing::TestWithParam<Expectation> {};

void expect_well_made(const LoadedMesh& model, const Expectation& expected, double resolution) {
    expect_manifold(model);
    EXPECT_TRUE(model.repairs.is_clean());
    EXPECT_EQ(model.name, expected.name);
    EXPECT_EQ(euler_characteristic(model.mesh), expected.euler);
    const bool is_open = std::string(expected.name) == "noisy-plane";
    EXPECT_EQ(boundary_edge_count(model.mesh) > 0, is_open);
    EXPECT_TRUE(is_open || volume(model.mesh) > 0.0);
    EXPECT_GT(smallest_angle(model.mesh), 15 * kDegree);
    for (const auto edge : model.mesh.edges()) {
        EXPECT_LT(model.mesh.calc_edge_length(edge), 2.2 * resolution);
    }
}

TEST_P(Models, AreClosedAndWellShaped) {
    const Expectation expected = GetParam();
    const ModelOptions options;
    const LoadedMesh model = make_model(expected.name, options);
    expect_well_made(model, expected, options.resolution);
    if (expected.volume > 0) {
        EXPECT_NEAR(volume(model.mesh) / expected.volume, 1, 5e-3);
    }
    const double diagonal = bounding_box(model.mesh).diagonal();
    EXPECT_GT(diagonal, 0.5);
    EXPECT_LT(diagonal, 2.5);
}

TEST_P(Models, WithOtherOptions) {
    for (const auto& [resolution, spacing, count] :
         {std::tuple(0.05, 0.1, 5), std::tuple(0.03, 0.02, 12), std::tuple(0.04, 0.08, 3)}) {
        SCOPED_TRACE("resolution " + std::to_string(resolution) + " count " +
                     std::to_string(count));
        ModelOptions options;
        options.resolution = resolution;
        options.spacing = spacing;
        options.count = count;
        expect_well_made(make_model(GetParam().name, options), GetParam(), resolution);
    }
}

TEST_P(Models, AreTheSameEveryTime) {
    ModelOptions options;
    options.noise = 0.1;
    const LoadedMesh one = make_model(GetParam().name, options);
    EXPECT_EQ(one.hash, make_model(GetParam().name, options).hash);
    options.seed = 2;
    EXPECT_NE(one.hash, make_model(GetParam().name, options).hash);
}

INSTANTIATE_TEST_SUITE_P(
    All, Models,
    ::testing::Values(Expectation{"skyscraper", 2, 0}, Expectation{"ribs", 2, 0},
                      Expectation{"step", 2, 0.5 * (0.4 + 0.5 * 0.05)},
                      Expectation{"steps", 2, 0.5 * 0.05 * 0.05 * 36}, Expectation{"gear", 0, 0},
                      Expectation{"octaflower", 2, 0}, Expectation{"thin-wall", 2, 0},
                      Expectation{"noisy-plane", 1, 0}, Expectation{"box", 2, 0.48},
                      Expectation{"cylinder", 2, M_PI / 4},
                      Expectation{"torus", 0, 2 * M_PI* M_PI * 0.35 * 0.15 * 0.15},
                      Expectation{"superellipse-torus", 0, 0.183480},
                      Expectation{"sphere", 2, M_PI / 6}),
    [](const auto& instance) {
        std::string name = instance.param.name;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    });

/// Total length of edges whose dihedral angle lies within a degree of the given one.
double crease_length(const Mesh& mesh, double degrees) {
    double sum = 0;
    for (const auto edge : mesh.edges()) {
        if (std::abs(dihedral_angle(mesh, edge) - degrees * kDegree) < kDegree) {
            sum += mesh.calc_edge_length(edge);
        }
    }
    return sum;
}

/// Length of everything that is bent by more than two degrees but not by about a right angle.
double odd_crease_length(const Mesh& mesh) {
    double sum = 0;
    for (const auto edge : mesh.edges()) {
        const double angle = std::abs(dihedral_angle(mesh, edge));
        if (angle > 2 * kDegree && std::abs(angle - 90 * kDegree) > kDegree) {
            sum += mesh.calc_edge_length(edge);
        }
    }
    return sum;
}

TEST(ModelCreases, Box) {
    const Mesh mesh = make_model("box").mesh;
    EXPECT_NEAR(crease_length(mesh, 90), 4 * (1 + 0.8 + 0.6), 1e-9);
    EXPECT_EQ(odd_crease_length(mesh), 0);
}

TEST(ModelCreases, Skyscraper) {
    const ModelOptions options;
    const Mesh mesh = make_model("skyscraper", options).mesh;
    EXPECT_EQ(odd_crease_length(mesh), 0);
    // Concave: around the foot of every tier but the first. The set-backs are 1, 1/4, 2, 1/2, 4, 1
    // and 1/4 spacings.
    const double width = bounding_box(mesh).max.x();
    double concave = 0;
    double inset = 0;
    for (double depth : {1.0, 0.25, 2.0, 0.5, 4.0, 1.0, 0.25}) {
        inset += depth * options.spacing;
        concave += 4 * (width - 2 * inset);
    }
    EXPECT_NEAR(crease_length(mesh, -90), concave, 1e-9);
}

TEST(ModelCreases, Ribs) {
    ModelOptions options;
    options.count = 5;
    const Mesh mesh = make_model("ribs", options).mesh;
    EXPECT_EQ(odd_crease_length(mesh), 0);
    EXPECT_NEAR(crease_length(mesh, -90), 5 * 2 * (0.5 + 0.5 * options.spacing), 1e-9);
}

TEST(ModelCreases, Holes) {
    for (const int count : {1, 2, 7, 20}) {
        SCOPED_TRACE(count);
        ModelOptions options;
        options.count = count;
        const LoadedMesh model = make_model("holes", options);
        // As many handles as holes, each with four concave creases at its corners.
        expect_well_made(model, {"holes", 2 - 2 * count, 0}, options.resolution);
        EXPECT_EQ(odd_crease_length(model.mesh), 0);
        EXPECT_NEAR(crease_length(model.mesh, -90), 4 * count * options.spacing, 1e-9);
    }
}

TEST(ModelCreases, Steps) {
    const ModelOptions options;
    const Mesh mesh = make_model("steps", options).mesh;
    EXPECT_EQ(odd_crease_length(mesh), 0);
    EXPECT_NEAR(crease_length(mesh, -90), 0.5 * (options.count - 1), 1e-9);
}

TEST(ModelCreases, ThinWall) {
    const ModelOptions options;
    const Mesh mesh = make_model("thin-wall", options).mesh;
    EXPECT_EQ(odd_crease_length(mesh), 0);
    // `count` strips on either side, each half a spacing by 0.4.
    EXPECT_NEAR(crease_length(mesh, -90), 2 * options.count * 2 * (0.4 + 0.5 * options.spacing),
                1e-9);
    const BoundingBox box = bounding_box(mesh);
    EXPECT_NEAR(box.max.y() - box.min.y(), 0.6 * options.spacing, 1e-12);
}

TEST(ModelCreases, Gear) {
    ModelOptions options;
    options.count = 7;
    const Mesh mesh = make_model("gear", options).mesh;
    // Upright creases at two tips and two roots per tooth: neither flat nor square to the faces.
    double upright = 0;
    double flat_rims = 0;
    for (const auto edge : mesh.edges()) {
        const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
        const Vec3 run = mesh.point(mesh.to_vertex_handle(halfedge)) -
                         mesh.point(mesh.from_vertex_handle(halfedge));
        const double angle = std::abs(dihedral_angle(mesh, edge));
        const bool is_upright = std::hypot(run.x(), run.y()) < 1e-12;
        if (is_upright && angle > 30 * kDegree) upright += run.norm();
        if (!is_upright && angle > 30 * kDegree) {
            EXPECT_NEAR(angle, M_PI / 2, 1e-9);
            EXPECT_NEAR(run.z(), 0, 1e-12);
            flat_rims += run.norm();
        }
    }
    EXPECT_NEAR(upright, 4 * options.count * 0.2, 1e-9);
    EXPECT_GT(flat_rims, 2 * 2 * M_PI * (0.15 + 0.45));
}

TEST(ModelCreases, Octaflower) {
    ModelOptions options;
    options.resolution = 0.01;
    const Mesh mesh = make_model("octaflower", options).mesh;
    double rim = 0;
    double valleys = 0;
    for (const auto edge : mesh.edges()) {
        const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
        const Vec3& a = mesh.point(mesh.from_vertex_handle(halfedge));
        const Vec3& b = mesh.point(mesh.to_vertex_handle(halfedge));
        const double angle = dihedral_angle(mesh, edge);
        if (a.z() == 0 && b.z() == 0) {
            EXPECT_GT(angle, 60 * kDegree);
            rim += (b - a).norm();
        } else if (angle < -25 * kDegree) {
            // Valleys lie on the planes between petals.
            const double turn = std::atan2(a.y(), a.x()) / (M_PI / options.count);
            EXPECT_NEAR(std::abs(turn - 2 * std::floor(turn / 2)), 1, 1e-9);
            valleys += (b - a).norm();
        } else {
            EXPECT_LT(std::abs(angle), 30 * kDegree);
        }
    }
    EXPECT_GT(rim, 2 * M_PI * 0.4);
    // Eight valleys on either side, at least the outer third of each.
    EXPECT_GT(valleys, 16 * 0.15);
}

TEST(ModelCreases, CylinderRims) {
    const Mesh mesh = make_model("cylinder").mesh;
    double sharp = 0;
    for (const auto edge : mesh.edges()) {
        if (dihedral_angle(mesh, edge) > 80 * kDegree) sharp += mesh.calc_edge_length(edge);
    }
    EXPECT_NEAR(sharp, 2 * M_PI, 1e-2);
}

TEST(ModelOptions, NoiseHasItsDeviation) {
    for (const double noise : {0.0, 0.05}) {
        ModelOptions options;
        options.noise = noise;
        const Mesh mesh = make_model("noisy-plane", options).mesh;
        double sum = 0;
        for (const auto vertex : mesh.vertices()) sum += std::pow(mesh.point(vertex).z(), 2);
        const double deviation = std::sqrt(sum / static_cast<double>(mesh.n_vertices()));
        const double expected = (noise > 0 ? noise : 0.2) * options.resolution;
        EXPECT_NEAR(deviation / expected, 1, 0.05);
    }
}

TEST(ModelOptions, OutOfRangeIsRefusedWithAReason) {
    const auto refusal = [](const char* name, auto change) {
        fcn::ModelOptions options;
        change(options);
        try {
            make_model(name, options);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    using Options = fcn::ModelOptions;
    EXPECT_NE(refusal("cube", [](Options&) {}).find("skyscraper, ribs"), std::string::npos);
    EXPECT_NE(refusal("box", [](Options& o) { o.resolution = 0; }).find("resolution"),
              std::string::npos);
    EXPECT_NE(refusal("box", [](Options& o) { o.resolution = 1e-6; }).find("triangles"),
              std::string::npos);
    EXPECT_NE(refusal("ribs", [](Options& o) { o.spacing = -1; }).find("spacing"),
              std::string::npos);
    EXPECT_NE(refusal("ribs", [](Options& o) { o.spacing = 1e-7; }).find("triangles"),
              std::string::npos);
    EXPECT_NE(refusal("gear", [](Options& o) { o.count = 2; }).find("count"), std::string::npos);
    EXPECT_NE(refusal("gear", [](Options& o) { o.count = 90; }).find("no room"), std::string::npos);
    EXPECT_NE(refusal("box", [](Options& o) { o.noise = std::nan(""); }).find("noise"),
              std::string::npos);
}

TEST(ModelOptions, EveryListedModelCanBeMade) {
    ASSERT_FALSE(model_list().empty());
    std::set<std::string> names;
    for (const ModelInfo& info : model_list()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        fcn::ModelOptions options;
        options.resolution = 0.1;
        options.spacing = 0.1;
        EXPECT_GT(make_model(info.name, options).mesh.n_faces(), 0U) << info.name;
        EXPECT_FALSE(info.description.empty());
    }
}

}  // namespace
}  // namespace fcn
