#include "meshing/quads_by_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "geometry/errors.h"
#include "geometry/mesh_curves.h"
#include "meshing/quad_field.h"
#include "meshing/quad_smoothing.h"
#include "sample_maps.h"
#include "sample_meshes.h"
#include "sample_networks.h"

namespace fcn {
namespace {

/// Steps that give a cube of the given number of squares along each edge.
QuadSteps cube_steps(int squares) {
    const test::MappedMesh mapped =
        test::mapped_patches(test::quad_cube(), {4, squares, 0.2, true, 1});
    QuadSteps steps;
    steps.domain = [mapped](const LoadedMesh&, const FeatureCurveNetwork&,
                            const QuadDomainOptions&) {
        QuadDomain domain;
        domain.mesh = mapped.mesh;
        return domain;
    };
    steps.field = [](const QuadDomain&, const FieldOptions&) { return FieldDesign{}; };
    steps.map = [mapped](const QuadDomain&, const FieldDesign&, double) {
        return FieldMap{mapped.map, ""};
    };
    return steps;
}

QuadOptions cube_options() {
    QuadOptions options;
    options.edge_length = 1.0 / 3;
    return options;
}

TEST(QuadsByField, TakesTheFirstAttemptThatSucceeds) {
    const LoadedMesh cube = test::cube(4);
    const FieldQuads quads = quads_by_field(cube, {}, cube_options(), cube_steps(3));
    EXPECT_TRUE(quads.is_done());
    EXPECT_EQ(quads.reason(), "");
    ASSERT_EQ(quads.attempts.size(), 1u);
    EXPECT_EQ(quads.attempts[0].step, "");
    EXPECT_EQ(quads.attempts[0].triangles, 192u);
    EXPECT_EQ(quads.mesh.faces.size(), 54u);
    EXPECT_EQ(count_inverted_corners(quads.mesh), 0);
    EXPECT_TRUE(quads.mesh.face_labels.empty());
}

TEST(QuadsByField, TakesShorterEdgesAfterAFailure) {
    QuadSteps steps = cube_steps(3);
    std::vector<double> lengths;
    const auto map = steps.map;
    steps.map = [&](const QuadDomain& domain, const FieldDesign& field, double edge_length) {
        lengths.push_back(edge_length);
        return lengths.size() < 3 ? FieldMap{{}, "no map"} : map(domain, field, edge_length);
    };
    const FieldQuads quads = quads_by_field(test::cube(4), {}, cube_options(), steps);
    EXPECT_TRUE(quads.is_done());
    EXPECT_EQ(quads.mesh.faces.size(), 54u);
    ASSERT_EQ(lengths.size(), 3u);
    EXPECT_DOUBLE_EQ(lengths[1], 0.9 / 3);
    EXPECT_DOUBLE_EQ(lengths[2], 0.81 / 3);
    EXPECT_EQ(quads.reason(), "edge length 0.333, map: no map; edge length 0.3, map: no map");
}

/// Quads by Tier 0 after the step fails in every attempt; its name and reason are in the result.
void expect_fallback(const QuadSteps& steps, const std::string& step, const std::string& reason) {
    SCOPED_TRACE(step);
    const LoadedMesh cube = test::cube(4);
    const FieldQuads quads = quads_by_field(cube, {}, cube_options(), steps);
    EXPECT_FALSE(quads.is_done());
    EXPECT_TRUE(quads.mesh.faces.empty());
    ASSERT_EQ(quads.attempts.size(), 4u);
    for (const QuadAttempt& attempt : quads.attempts) {
        EXPECT_EQ(attempt.step, step);
        EXPECT_EQ(attempt.reason, reason);
    }
    const QuadResult result = remesh_quads(cube, {}, cube_options(), steps);
    EXPECT_EQ(result.tier, QuadTier::Pairing);
    EXPECT_FALSE(result.field);
    EXPECT_EQ(result.reason, quads.reason());
    EXPECT_EQ(result.inverted_corners, 0);
    const QuadTopology topology = check_topology(result.mesh);
    EXPECT_EQ(topology.fault, "");
    EXPECT_EQ(topology.euler_characteristic, 2);
}

TEST(QuadsByField, FallsBackWhicheverStepFails) {
    QuadSteps steps = cube_steps(3);
    steps.domain = [](const LoadedMesh&, const FeatureCurveNetwork&,
                      const QuadDomainOptions&) -> QuadDomain {
        throw std::runtime_error("no domain");
    };
    expect_fallback(steps, "domain", "no domain");
    steps = cube_steps(3);
    steps.field = [](const QuadDomain&, const FieldOptions&) {
        FieldDesign design;
        design.failure = "no field";
        return design;
    };
    expect_fallback(steps, "field", "no field");
    steps = cube_steps(3);
    steps.map = [](const QuadDomain&, const FieldDesign&, double) {
        return FieldMap{{}, "no map"};
    };
    expect_fallback(steps, "map", "no map");
    const auto map = cube_steps(3).map;
    steps.map = [map](const QuadDomain& domain, const FieldDesign& field, double edge_length) {
        FieldMap result = map(domain, field, edge_length);
        std::swap(result.map.uv[5][1], result.map.uv[5][2]);
        return result;
    };
    expect_fallback(steps, "extraction", "face 5: turned over");
    steps = cube_steps(3);
    steps.smoothing = [](QuadMesh&) { return 7; };
    expect_fallback(steps, "smoothing", "7 inverted corners");
}

TEST(QuadsByField, TakesTheSoftMapWhereQuadsOfTheFirstFail) {
    QuadSteps steps = cube_steps(3);
    const auto map = steps.map;
    steps.soft_map = map;
    steps.map = [map](const QuadDomain& domain, const FieldDesign& field, double edge_length) {
        FieldMap result = map(domain, field, edge_length);
        std::swap(result.map.uv[5][1], result.map.uv[5][2]);
        result.hard_edges = {0};
        return result;
    };
    steps.domain = [domain = steps.domain](const LoadedMesh& mesh,
                                           const FeatureCurveNetwork& network,
                                           const QuadDomainOptions& options) {
        QuadDomain result = domain(mesh, network, options);
        result.edge_arc.assign(result.mesh.n_edges(), -1);
        return result;
    };
    const FieldQuads quads = quads_by_field(test::cube(4), {}, cube_options(), steps);
    EXPECT_TRUE(quads.is_done());
    ASSERT_EQ(quads.attempts.size(), 1u);  // of the length that was asked for
    EXPECT_EQ(quads.mesh.faces.size(), 54u);
}

TEST(QuadsByField, MovesSingularitiesWhereCurvesGaveWay) {
    QuadSteps steps = cube_steps(3);
    int maps = 0, clearances = 0;
    const auto map = steps.map;
    steps.map = [&](const QuadDomain& d, const FieldDesign& field, double edge_length) {
        FieldMap result = map(d, field, edge_length);
        result.kept_share = ++maps == 1 ? 0.5 : 0.25;  // no better: the first stays
        return result;
    };
    steps.clearance = [&](const QuadDomain&, FieldDesign&, double) { return ++clearances; };
    EXPECT_TRUE(quads_by_field(test::cube(4), {}, cube_options(), steps).is_done());
    EXPECT_EQ(maps, 2);
    EXPECT_EQ(clearances, 1);
    maps = clearances = 0;
    steps.map = [&](const QuadDomain& d, const FieldDesign& field, double edge_length) {
        return ++maps == 1 ? FieldMap{{}, "no map"} : map(d, field, edge_length);
    };
    EXPECT_TRUE(quads_by_field(test::cube(4), {}, cube_options(), steps).is_done());
    EXPECT_EQ(maps, 2);
    maps = clearances = 0;
    steps.map = [&](const QuadDomain& d, const FieldDesign& field, double edge_length) {
        ++maps;
        return map(d, field, edge_length);
    };
    EXPECT_TRUE(quads_by_field(test::cube(4), {}, cube_options(), steps).is_done());
    EXPECT_EQ(maps, 1);
    EXPECT_EQ(clearances, 0);
}

TEST(QuadsByField, IsTheFirstTier) {
    const LoadedMesh cube = test::cube(4, true);
    const QuadResult result = remesh_quads(cube, {}, cube_options(), cube_steps(3));
    EXPECT_EQ(result.tier, QuadTier::Field);
    EXPECT_EQ(result.reason, "");
    EXPECT_EQ(result.mesh.faces.size(), 54u);
    ASSERT_EQ(result.mesh.face_labels.size(), 54u);
    std::map<int, int> counts;
    for (const int label : result.mesh.face_labels) ++counts[label];
    EXPECT_EQ(counts.size(), 6u);
    for (const auto& [label, count] : counts) EXPECT_EQ(count, 9);
    QuadOptions paired = cube_options();
    paired.best_tier = QuadTier::Pairing;
    const QuadResult other = remesh_quads(cube, {}, paired, cube_steps(3));
    EXPECT_EQ(other.tier, QuadTier::Pairing);
    EXPECT_FALSE(other.field);
    EXPECT_EQ(other.reason, "");
}

TEST(QuadsByField, WorksWithItsOwnSteps) {
    QuadOptions options;
    options.edge_length = 0.25;
    for (const bool is_open : {false, true}) {
        LoadedMesh mesh;
        mesh.mesh = is_open ? test::rectangle(2, 1, 16, 8) : test::cube(8).mesh;
        const QuadResult result = remesh_quads(mesh, {}, options);
        EXPECT_EQ(result.tier, QuadTier::Field) << result.reason;
        EXPECT_EQ(result.inverted_corners, 0);
        const QuadTopology quads = check_topology(result.mesh), wanted = topology_of(mesh.mesh);
        EXPECT_EQ(quads.fault, "");
        EXPECT_EQ(quads.euler_characteristic, wanted.euler_characteristic);
        EXPECT_EQ(quads.boundary_loops, wanted.boundary_loops);
        const QuadResult again = remesh_quads(mesh, {}, options);
        EXPECT_EQ(result.mesh.points, again.mesh.points);
        EXPECT_EQ(result.mesh.faces, again.mesh.faces);
    }
}

/// The largest angle in degrees between a direction and the nearest axis.
double degrees_off_axes(const Vec3& direction) {
    return std::acos(std::min(1.0, direction.cwiseAbs().maxCoeff())) * 180 / std::numbers::pi;
}

TEST(QuadsByField, KeepsTheFieldThatTheQuadsFollow) {
    QuadOptions options;
    options.edge_length = 0.25;
    const LoadedMesh cube = test::cube(8);
    const FeatureCurveNetwork network = test::crease_network(cube.mesh, 0.5);
    const QuadResult result = remesh_quads(cube, network, options);
    ASSERT_TRUE(result.field);
    const QuadField& field = *result.field;
    ASSERT_EQ(field.arms.size(), field.mesh.mesh.n_faces());
    int sum = 0;
    for (const QuadField::Singularity& singularity : field.singularities) {
        sum += singularity.index;
        EXPECT_TRUE(field.mesh.mesh.is_valid_handle(VertexHandle(singularity.vertex)));
    }
    EXPECT_EQ(sum, 8);
    double length = 0;
    for_each_curve_edge(field.mesh, [&](std::size_t, int from, int to) {
        length +=
            (field.mesh.mesh.point(VertexHandle(from)) - field.mesh.mesh.point(VertexHandle(to)))
                .norm();
    });
    EXPECT_NEAR(length, 12, 1e-9);
    // On both meshes arms are unit vectors in the faces' planes, and run along the cube's edges.
    for (const Mesh* mesh : {&field.mesh.mesh, &cube.mesh}) {
        const std::vector<Vec3> arms =
            mesh == &cube.mesh ? arms_on_faces(field, *mesh) : field.arms;
        ASSERT_EQ(arms.size(), mesh->n_faces());
        for (const FaceHandle face : mesh->faces()) {
            const Vec3& arm = arms[static_cast<std::size_t>(face.idx())];
            EXPECT_NEAR(arm.norm(), 1, 1e-9);
            EXPECT_NEAR(arm.dot(face_normal(*mesh, face)), 0, 1e-9);
            EXPECT_LT(degrees_off_axes(arm), 15);
        }
    }
}

TEST(QuadsByField, ArmsTurnWithTheFaceTheyAreSeenFrom) {
    // One face on the floor, its arm along x; seen from a wall that it shares an edge with.
    QuadField field;
    const auto corner = [](Mesh& mesh, double x, double y, double z) {
        return mesh.add_vertex(Vec3(x, y, z));
    };
    Mesh& floor = field.mesh.mesh;
    const VertexHandle a = corner(floor, 0, 0, 0), b = corner(floor, 1, 0, 0),
                       c = corner(floor, 0, 1, 0);
    floor.add_face(a, b, c);
    const double angle = 0.3;
    field.arms = {Vec3(std::cos(angle), std::sin(angle), 0)};
    Mesh wall;
    const VertexHandle d = corner(wall, 0, 0, 0), e = corner(wall, 1, 0, 0),
                       f = corner(wall, 0, 0, 1);
    wall.add_face(d, e, f);
    const std::vector<Vec3> arms = arms_on_faces(field, wall);
    ASSERT_EQ(arms.size(), 1u);
    EXPECT_LT((arms[0] - Vec3(std::cos(angle), 0, std::sin(angle))).norm(), 1e-12);
}

TEST(QuadsByField, RefusesABadLength) {
    QuadOptions options;
    for (const double length : {0.0, -1.0, std::nan("")}) {
        options.edge_length = length;
        EXPECT_THROW(quads_by_field(test::cube(4), {}, options, cube_steps(3)), InputError);
    }
}

}  // namespace
}  // namespace fcn
