#include "meshing/quad_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/models.h"
#include "meshing/coarse_layout.h"
#include "meshing/field_design.h"
#include "meshing/foldover_energy.h"
#include "meshing/integer_elimination.h"
#include "meshing/quad_extraction.h"
#include "meshing/sample_meshes.h"
#include "meshing/seamless_map.h"
#include "meshing/untangling.h"

namespace fcn {
namespace {

/// The field whose arms lie along a direction that is given at each face's centre.
template <class Direction>
CrossField field_along(const Mesh& mesh, Direction&& direction) {
    CrossField field;
    for (const FaceHandle face : mesh.faces()) {
        const auto v = face_vertices(mesh, face);
        const Vec3 centre = (mesh.point(v[0]) + mesh.point(v[1]) + mesh.point(v[2])) / 3;
        const Vec3 x = (mesh.point(v[1]) - mesh.point(v[0])).normalized();
        const Vec3 y = face_normal(mesh, face).cross(x), d = direction(centre);
        field.angles.push_back(std::atan2(d.dot(y), d.dot(x)));
    }
    field.turns = nearest_turns(mesh, field.angles);
    return field;
}

QuadMapResult map_of(const Mesh& mesh, const CrossField& field, double h) {
    QuadMapOptions options;
    options.edge_length = h;
    return make_quad_map(mesh, field, options);
}

/// Map and quads of a surface with the field that is made for it.
void expect_quads(const LoadedMesh& input, double h, int euler_characteristic) {
    QuadDomainOptions domain_options;
    domain_options.edge_length = h / 3;
    const QuadDomain domain = make_quad_domain(input, {}, domain_options);
    FieldOptions field_options;
    field_options.edge_length = h;
    const FieldDesign design = design_field(domain, field_options);
    ASSERT_EQ(design.failure, "");
    const QuadMapResult result = map_of(domain.mesh, design.field, h);
    ASSERT_EQ(result.fault, "");
    EXPECT_TRUE(corner_map_faults(domain.mesh, result.map).is_none());
    EXPECT_EQ(result.statistics.singular_vertices, static_cast<int>(design.singularities.size()));
    const QuadExtraction quads = extract_quads(domain.mesh, result.map);
    ASSERT_EQ(quads.fault, "");
    EXPECT_EQ(check_topology(quads.mesh).euler_characteristic, euler_characteristic);
    const auto again = map_of(domain.mesh, design.field, h);
    EXPECT_EQ(result.map.uv, again.map.uv);
}

TEST(IntegerElimination, FindsAllIntegerSolutions) {
    // 2 a + 3 b + 5 c = 0: the lattice of its solutions has the determinant |(2, 3, 5)|.
    IntegerElimination elimination({true, true, true});
    elimination.add({{0, 2}, {1, 3}, {2, 5}});
    const EliminatedUnknowns solved = elimination.finish();
    ASSERT_EQ(solved.is_integer, (std::vector<bool>{true, true}));
    const Eigen::MatrixXd basis = solved.basis;
    EXPECT_TRUE((Eigen::RowVector3d(2, 3, 5) * basis).isZero(0));
    EXPECT_NEAR((basis.transpose() * basis).determinant(), 4 + 9 + 25, 1e-9);
}

TEST(IntegerElimination, RandomEquationsHold) {
    const unsigned seed = 7;
    std::mt19937 random(seed);
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto draw = [&](int low, int high) {
        return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
    };
    for (int round = 0; round < 50; ++round) {
        const int count = draw(3, 12);
        std::vector<bool> is_integer;
        for (int i = 0; i < count; ++i) is_integer.push_back(draw(0, 2) > 0);
        IntegerElimination elimination(is_integer);
        std::vector<std::vector<IntegerElimination::Term>> equations;
        for (int e = draw(1, count / 2); e > 0; --e) {
            std::vector<IntegerElimination::Term> terms;
            for (int i = 0; i < count; ++i)
                if (const int c = draw(-2, 2); c != 0 && draw(0, 1) == 1)
                    terms.push_back({i, static_cast<double>(c)});
            equations.push_back(terms);
            elimination.add(terms);
        }
        const EliminatedUnknowns solved = elimination.finish();
        Eigen::VectorXd free(static_cast<int>(solved.is_integer.size()));
        for (int i = 0; i < free.size(); ++i) free[i] = draw(-5, 5);
        const Eigen::VectorXd values = solved.basis * free;
        for (const auto& terms : equations) {
            double sum = 0;
            for (const auto& term : terms) sum += term.coefficient * values[term.unknown];
            EXPECT_NEAR(sum, 0, 1e-9);
        }
    }
}

TEST(FoldoverEnergy, DerivativesAreThoseOfTheValue) {
    const unsigned seed = 3;
    std::mt19937 random(seed);
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::uniform_real_distribution<double> draw(-1, 1);
    for (int round = 0; round < 100; ++round) {
        Eigen::Vector4d jacobian;
        for (int i = 0; i < 4; ++i) jacobian[i] = (i % 3 == 0 ? 1 : 0) + draw(random);
        const double epsilon = 0.3;
        const FoldoverEnergy energy = foldover_energy(jacobian, epsilon);
        EXPECT_NEAR(energy.value, foldover_value(jacobian, epsilon), 1e-9 * energy.value);
        for (int i = 0; i < 4; ++i) {
            const Eigen::Vector4d step = 1e-5 * Eigen::Vector4d::Unit(i);
            const double slope = (foldover_value(jacobian + step, epsilon) -
                                  foldover_value(jacobian - step, epsilon)) /
                                 2e-5;
            EXPECT_NEAR(energy.gradient[i], slope, 1e-4 * (1 + std::abs(slope)));
        }
        EXPECT_GE(energy.hessian.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(),
                  -1e-6 * energy.hessian.norm());
    }
}

TEST(QuadMap, OfAPlaneIsTheGrid) {
    const Mesh mesh = test::rectangle(4, 3, 13, 9);
    const CrossField field = field_along(mesh, [](const Vec3&) { return Vec3(1, 0, 0); });
    const QuadMapResult result = map_of(mesh, field, 1);
    ASSERT_EQ(result.fault, "");
    for (const FaceHandle face : mesh.faces()) {
        const auto corners = face_vertices(mesh, face);
        const auto& uv = result.map.uv[static_cast<std::size_t>(face.idx())];
        for (std::size_t i = 1; i < 3; ++i) {
            const Vec3 side = mesh.point(corners[i]) - mesh.point(corners[0]);
            EXPECT_NEAR((uv[i] - uv[0]).norm(), side.norm(), 1e-6);
        }
    }
    EXPECT_EQ(extract_quads(mesh, result.map).mesh.faces.size(), 12U);
}

TEST(CornerMap, EachFaultIsFound) {
    const Mesh mesh = test::rectangle(4, 3, 8, 6);
    CornerMap map;
    for (const FaceHandle face : mesh.faces()) {
        const auto corners = face_vertices(mesh, face);
        auto& uv = map.uv.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) uv[i] = mesh.point(corners[i]).head<2>();
    }
    ASSERT_TRUE(corner_map_faults(mesh, map).is_none());
    CornerMap changed = map;
    for (auto& uv : changed.uv)
        for (Vec2& p : uv) p = turned(p, 1) + Vec2(7, -2);
    EXPECT_TRUE(corner_map_faults(mesh, changed).is_none());
    for (auto& uv : changed.uv)
        for (Vec2& p : uv) p[0] += 0.5;
    CornerMapFaults faults = corner_map_faults(mesh, changed);
    EXPECT_EQ(faults.free_boundary, 16U);  // two sides of eight edges
    EXPECT_EQ(faults.fractional_corners, 4U);
    EXPECT_EQ(faults.open_edges + faults.turned_over_faces, 0U);
    changed = map;
    for (auto& uv : changed.uv)
        for (Vec2& p : uv) p[0] = -p[0];
    EXPECT_EQ(corner_map_faults(mesh, changed).turned_over_faces, mesh.n_faces());
    changed = map;
    changed.uv[50][0] += Vec2(std::ldexp(1, -40), 0);
    EXPECT_EQ(corner_map_faults(mesh, changed).open_edges, 2U);
    changed = map;
    for (Vec2& p : changed.uv[50]) p += Vec2(0.25, 0);
    EXPECT_EQ(corner_map_faults(mesh, changed).fractional_edges, 3U);
    // A triangle whose area is 2^-60 of its sides' product, and the same turned over.
    const double tiny = std::ldexp(1, -30);
    EXPECT_EQ(image_orientation({Vec2(0, 0), Vec2(1, 1), Vec2(1 + tiny, 1 + 2 * tiny)}), 1);
    EXPECT_EQ(image_orientation({Vec2(0, 0), Vec2(1 + tiny, 1), Vec2(1, 1 - tiny)}), -1);
    EXPECT_EQ(image_orientation({Vec2(0, 0), Vec2(3, 1), Vec2(6, 2)}), 0);
}

TEST(QuadMap, OfARectangleBetweenWholeNumbersIsStretched) {
    const Mesh mesh = test::rectangle(4.3, 2.6, 13, 9);
    const CrossField field = field_along(mesh, [](const Vec3&) { return Vec3(0, 1, 0); });
    const QuadMapResult result = map_of(mesh, field, 1);
    ASSERT_EQ(result.fault, "");
    EXPECT_EQ(extract_quads(mesh, result.map).mesh.faces.size(), 12U);
}

TEST(QuadMap, OfAnOpenCylinder) {
    Mesh mesh = test::rectangle(1, 1, 1, 1);
    mesh.clear();
    const int count = 24, rings = 8;
    for (int j = 0; j <= rings; ++j)
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * std::numbers::pi * i / count;
            mesh.add_vertex({std::cos(angle), std::sin(angle), j / 3.0});
        }
    const auto at = [&](int i, int j) {
        return mesh.vertex_handle(static_cast<unsigned>(j * count + i % count));
    };
    for (int j = 0; j < rings; ++j)
        for (int i = 0; i < count; ++i) {
            mesh.add_face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.add_face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    const CrossField field = field_along(mesh, [](const Vec3&) { return Vec3(0, 0, 1); });
    const QuadMapResult result = map_of(mesh, field, 0.5);
    ASSERT_EQ(result.fault, "");
    // 6.27 around, 2.67 high
    EXPECT_EQ(extract_quads(mesh, result.map).mesh.faces.size(), 13U * 5);
}

TEST(QuadMap, OfModelsGivesQuads) {
    ModelOptions options;
    options.resolution = 0.06;
    for (const auto& [name, euler] :
         {std::pair{"sphere", 2}, {"torus", 0}, {"box", 2}, {"cylinder", 2}}) {
        SCOPED_TRACE(name);
        const LoadedMesh model = make_model(name, options);
        expect_quads(model, 0.08 * bounding_box(model.mesh).diagonal(), euler);
    }
}

TEST(QuadMap, TooFewQuadsForTheSingularitiesIsSaid) {
    // Eight singular vertices of a cube keep apart however long quads should be, or it is a fault.
    const LoadedMesh cube = test::cube(6);
    QuadDomainOptions domain_options;
    domain_options.edge_length = 0.15;
    const QuadDomain domain = make_quad_domain(cube, {}, domain_options);
    FieldOptions field_options;
    field_options.edge_length = 0.4;
    const FieldDesign design = design_field(domain, field_options);
    ASSERT_EQ(design.failure, "");
    const QuadMapResult result = map_of(domain.mesh, design.field, 3);
    if (result.fault.empty())
        EXPECT_GE(extract_quads(domain.mesh, result.map).mesh.faces.size(), 6U);
    else
        EXPECT_NE(result.fault.find("turned over"), std::string::npos);
}

TEST(QuadMap, BadInputIsAFault) {
    EXPECT_NE(map_of(Mesh(), {}, 1).fault, "");
    const Mesh mesh = test::rectangle(1, 1, 2, 2);
    const CrossField field = field_along(mesh, [](const Vec3&) { return Vec3(1, 0, 0); });
    EXPECT_NE(map_of(mesh, field, 0).fault, "");
    EXPECT_NE(map_of(mesh, field, std::nan("")).fault, "");
    CrossField broken = field;
    for (const HalfedgeHandle h : mesh.halfedges())
        if (!mesh.is_boundary(mesh.edge_handle(h))) {
            broken.turns[static_cast<std::size_t>(h.idx())] = 1;
            break;
        }
    EXPECT_NE(map_of(mesh, broken, 0.3).fault, "");
}

TEST(CoarseLayout, TrianglesHaveTheAreaOfTheMap) {
    const LoadedMesh model = make_model("torus", {.resolution = 0.08});
    QuadDomainOptions domain_options;
    domain_options.edge_length = 0.04;
    const QuadDomain domain = make_quad_domain(model, {}, domain_options);
    FieldOptions field_options;
    field_options.edge_length = 0.1;
    const FieldDesign design = design_field(domain, field_options);
    ASSERT_EQ(design.failure, "");
    const MapProblem problem = make_map_problem(domain.mesh, design.field, {0.1, {}, {}, {}});
    ASSERT_EQ(problem.fault, "");
    const QuadraticEnergy energy = reduced(alignment_energy(problem), problem);
    const std::vector<bool> none(problem.unknowns.is_integer.size(), false);
    const Eigen::VectorXd start =
        minimum(energy, none, Eigen::VectorXd::Zero(static_cast<int>(none.size())));
    const UntanglingResult map = untangle(problem, start, none);
    ASSERT_EQ(map.turned_over, 0U);
    double area = 0, layout_area = 0;
    const std::vector<double> dets = map_determinants(problem, map.values);
    for (std::size_t f = 0; f < dets.size(); ++f) area += dets[f] * problem.shapes[f].area;
    const CoarseLayout layout = make_coarse_layout(domain.mesh, problem, map.values);
    EXPECT_LT(layout.triangles.size(), dets.size() / 10);
    for (const LayoutTriangle& triangle : layout.triangles) {
        std::array<double, 4> side{};
        for (std::size_t k = 0; k < 4; ++k)
            for (const auto& [unknown, coefficient] : triangle.forms[k])
                side[k] += coefficient * map.values[unknown];
        const double twice_area = side[0] * side[3] - side[1] * side[2];
        EXPECT_GT(twice_area, 0);
        layout_area += twice_area / 2;
    }
    EXPECT_NEAR(layout_area, area, 1e-6 * area);
}

}  // namespace
}  // namespace fcn
