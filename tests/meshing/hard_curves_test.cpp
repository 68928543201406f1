#include "meshing/hard_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "meshing/coarse_layout.h"
#include "meshing/curve_clearance.h"
#include "meshing/curve_map.h"
#include "meshing/lines_on_curves.h"
#include "meshing/remesh_quads.h"
#include "meshing/seamless_map.h"
#include "sample_meshes.h"
#include "sample_networks.h"

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A rectangle as a domain whose horizontal edges at the given heights are arcs, with the field
/// along the axes.
struct Plane {
    QuadDomain domain;
    CrossField field;
};
Plane plane_with_lines(double a, double b, int m, int n, const std::vector<double>& heights) {
    Plane plane;
    Mesh& mesh = plane.domain.mesh;
    mesh = test::rectangle(a, b, m, n);
    plane.domain.edge_arc.assign(mesh.n_edges(), -1);
    plane.domain.edge_segment.assign(mesh.n_edges(), -1);
    plane.domain.edge_weight.assign(mesh.n_edges(), 0);
    plane.domain.face_label.assign(mesh.n_faces(), 0);
    plane.domain.vertex_place.assign(mesh.n_vertices(), 0);
    for (const EdgeHandle edge : mesh.edges()) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const Vec3& p = mesh.point(mesh.from_vertex_handle(h));
        const Vec3& q = mesh.point(mesh.to_vertex_handle(h));
        for (std::size_t i = 0; i < heights.size(); ++i)
            if (std::abs(p[1] - heights[i]) + std::abs(q[1] - heights[i]) < 1e-9)
                plane.domain.edge_arc[at(edge.idx())] = static_cast<int>(i);
    }
    for (const FaceHandle face : mesh.faces()) {
        const auto v = face_vertices(mesh, face);
        const Vec3 side = mesh.point(v[1]) - mesh.point(v[0]);
        plane.field.angles.push_back(-std::atan2(side[1], side[0]));
    }
    plane.field.turns = nearest_turns(mesh, plane.field.angles);
    return plane;
}

HardCurveOptions flat_options(double h) {
    HardCurveOptions options;
    options.edge_length = h;
    options.least_fold_degrees = 0;
    return options;
}

QuadMapOptions guidance_of(const QuadDomain& domain, const std::vector<HardCurve>& curves,
                           double h) {
    QuadMapOptions guidance;
    guidance.edge_length = h;
    guidance.is_hard.assign(domain.mesh.n_edges(), 0);
    for (const HardCurve& curve : curves)
        for (const int edge : curve.edges) guidance.is_hard[at(edge)] = 1;
    return guidance;
}

TEST(HardCurves, OfAPlaneGetALineEach) {
    // Without them there would be 6 rows of quads over 6.2, and lines at multiples of 6.2 / 6.
    const Plane plane = plane_with_lines(4, 6.2, 12, 31, {1.6, 4.6});
    const auto curves = find_hard_curves(plane.domain, plane.field, flat_options(1));
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_EQ(curves[0].edges.size(), 12U);
    const QuadMapResult map =
        make_quad_map(plane.domain.mesh, plane.field, guidance_of(plane.domain, curves, 1));
    ASSERT_EQ(map.fault, "");
    const QuadExtraction quads = extract_quads(plane.domain.mesh, map.map);
    ASSERT_EQ(quads.fault, "");
    std::vector<int> edges;
    for (const HardCurve& curve : curves)
        edges.insert(edges.end(), curve.edges.begin(), curve.edges.end());
    const LinesOnCurves lines = lines_on_curves(plane.domain, edges, quads);
    EXPECT_EQ(lines.edges.size(), 8U);
    for (const QuadFeatureEdge& edge : lines.edges)
        for (const int v : {edge.from, edge.to}) {
            EXPECT_NEAR(quads.mesh.points[at(v)][1], edge.arc == 0 ? 1.6 : 4.6, 1e-6);
            EXPECT_EQ(lines.arc[at(v)], edge.arc);
            EXPECT_FALSE(lines.is_corner[at(v)]);
        }
    // The soft map has none there.
    const QuadMapResult soft =
        make_quad_map(plane.domain.mesh, plane.field, guidance_of(plane.domain, {}, 1));
    ASSERT_EQ(soft.fault, "");
    const QuadExtraction other = extract_quads(plane.domain.mesh, soft.map);
    EXPECT_TRUE(lines_on_curves(plane.domain, edges, other).edges.empty());
}

TEST(HardCurves, AreThoseThatTheFieldFollows) {
    Plane plane = plane_with_lines(4, 3, 12, 9, {1});
    for (double& angle : plane.field.angles) angle += std::numbers::pi / 4;
    EXPECT_TRUE(find_hard_curves(plane.domain, plane.field, flat_options(1)).empty());
    plane = plane_with_lines(4, 3, 12, 9, {1});
    HardCurveOptions options = flat_options(1);
    options.least_fold_degrees = 25;  // the plane does not fold
    EXPECT_TRUE(find_hard_curves(plane.domain, plane.field, options).empty());
    options = flat_options(5);  // shorter than a quad
    EXPECT_TRUE(find_hard_curves(plane.domain, plane.field, options).empty());
}

TEST(HardCurves, LeaveACurveThatRunsIntoAnotherInItsDirection) {
    // Row by row a staircase of diagonals leaves the line at the left end, 18 degrees from it.
    Plane plane = plane_with_lines(6, 3, 18, 27, {1});
    Mesh& mesh = plane.domain.mesh;
    for (const EdgeHandle edge : mesh.edges()) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        Vec3 p = mesh.point(mesh.from_vertex_handle(h)), q = mesh.point(mesh.to_vertex_handle(h));
        if (p[0] > q[0]) std::swap(p, q);
        if (std::abs(q[0] - p[0] - 1.0 / 3) < 1e-9 && std::abs(p[1] - 1 - p[0] / 3) < 1e-9 &&
            std::abs(q[1] - 1 - q[0] / 3) < 1e-9)
            plane.domain.edge_arc[at(edge.idx())] = 1;
    }
    ASSERT_GT(std::count(plane.domain.edge_arc.begin(), plane.domain.edge_arc.end(), 1), 9);
    const auto curves = find_hard_curves(plane.domain, plane.field, flat_options(1));
    double nearest = 1e300;
    std::size_t on_line = 0;
    for (const HardCurve& curve : curves)
        for (const int edge : curve.edges) {
            const HalfedgeHandle h = mesh.halfedge_handle(EdgeHandle(edge), 0);
            on_line += curve.arc == 0;
            for (const VertexHandle v : {mesh.from_vertex_handle(h), mesh.to_vertex_handle(h)})
                if (curve.arc == 1) nearest = std::min(nearest, mesh.point(v)[1] - 1);
        }
    EXPECT_EQ(on_line, 18U);
    EXPECT_GE(nearest, 0.6 - 1e-9);
}

TEST(CurveMap, GivesWayWhereAMapFails) {
    const Plane plane = plane_with_lines(6, 6, 18, 18, {2, 4});
    CurveMapOptions options;
    options.edge_length = 1;
    QuadDomain folded = plane.domain;  // by height, so that both lines are folds
    for (const VertexHandle v : folded.mesh.vertices()) {
        Vec3 p = folded.mesh.point(v);
        p[2] = std::abs(p[1] - 2) + std::abs(p[1] - 4);
        folded.mesh.set_point(v, p);
    }
    CrossField field;
    for (const FaceHandle face : folded.mesh.faces()) {
        const auto v = face_vertices(folded.mesh, face);
        const Vec3 x = (folded.mesh.point(v[1]) - folded.mesh.point(v[0])).normalized();
        const Vec3 y = face_normal(folded.mesh, face).cross(x);
        field.angles.push_back(std::atan2(y[0], x[0]));
    }
    field.turns = nearest_turns(folded.mesh, field.angles);
    const CurveMap whole = map_with_curves(folded, field, options);
    ASSERT_EQ(whole.result.fault, "");
    EXPECT_EQ(whole.kept_edges, 36U);
    EXPECT_EQ(whole.rounds, 1);

    // A fault at a place of one curve costs that curve its middle, once.
    int place = -1;
    for (const VertexHandle v : folded.mesh.vertices())
        if ((folded.mesh.point(v).head<2>() - Vec2(3, 4)).norm() < 1e-9) place = v.idx();
    ASSERT_GE(place, 0);
    int calls = 0;
    options.make_map = [&](const Mesh& mesh, const CrossField& f, const QuadMapOptions& guidance) {
        if (++calls > 1) return make_quad_map(mesh, f, guidance);
        QuadMapResult result;
        result.fault = "forced";
        result.fault_vertices = {place};
        return result;
    };
    const CurveMap shorter = map_with_curves(folded, field, options);
    ASSERT_EQ(shorter.result.fault, "");
    EXPECT_EQ(shorter.rounds, 2);
    EXPECT_LT(shorter.kept_edges, 36U);
    EXPECT_GE(shorter.kept_edges, 28U);
    EXPECT_EQ(shorter.curves.size(), 3U);

    // If nothing helps, all curves are soft, and the map is that without hard ones.
    options.make_map = [](const Mesh& mesh, const CrossField& f, const QuadMapOptions& guidance) {
        if (guidance.is_hard.empty()) return make_quad_map(mesh, f, guidance);
        QuadMapResult result;
        result.fault = "forced";
        for (const VertexHandle v : mesh.vertices()) result.fault_vertices.push_back(v.idx());
        return result;
    };
    const CurveMap soft = map_with_curves(folded, field, options);
    ASSERT_EQ(soft.result.fault, "");
    EXPECT_EQ(soft.kept_edges, 0U);
    EXPECT_EQ(soft.found_edges, 36U);
    options.make_map = make_quad_map;
    options.is_hard = false;
    EXPECT_EQ(soft.result.map.uv, map_with_curves(folded, field, options).result.map.uv);
}

/// Quads of a surface with its creases as a network: how long the edges on it are in all.
double length_on_creases(const LoadedMesh& input, double h, std::size_t& irregular,
                         std::set<double>& heights) {
    const FeatureCurveNetwork network = test::crease_network(input.mesh, 0.5);
    QuadOptions options;
    options.edge_length = h;
    const QuadResult result = remesh_quads(input, network, options);
    EXPECT_EQ(result.tier, QuadTier::Field) << result.reason;
    EXPECT_EQ(result.inverted_corners, 0);
    EXPECT_EQ(check_topology(result.mesh).fault, "");
    std::vector<int> valence(result.mesh.points.size(), 0);
    for (const auto& face : result.mesh.faces)
        for (const int v : face) ++valence[at(v)];
    irregular =
        valence.size() - at(static_cast<int>(std::count(valence.begin(), valence.end(), 4)));
    double length = 0;
    for (const QuadFeatureEdge& edge : result.mesh.feature_edges) {
        const Vec3 &p = result.mesh.points[at(edge.from)], &q = result.mesh.points[at(edge.to)];
        length += (p - q).norm();
        heights.insert(std::round(p[2] * 1e6) / 1e6);
    }
    return length;
}

TEST(HardCurves, OfABoxAreItsEdges) {
    LoadedMesh box = test::cube(8);
    for (const VertexHandle v : box.mesh.vertices())
        box.mesh.set_point(v, box.mesh.point(v).cwiseProduct(Vec3(1.13, 0.87, 0.71)));
    std::size_t irregular = 0;
    std::set<double> heights;
    EXPECT_NEAR(length_on_creases(box, 0.2, irregular, heights), 4 * (1.13 + 0.87 + 0.71), 1e-6);
    EXPECT_EQ(irregular, 8U);
}

TEST(HardCurves, OfACylinderAreItsRims) {
    const LoadedMesh cylinder = test::cylinder(0.5, 48, 8);
    std::size_t irregular = 0;
    std::set<double> heights;
    const double length = length_on_creases(cylinder, 0.17, irregular, heights);
    EXPECT_EQ(heights, (std::set<double>{0, 1}));
    // Two polygons of at least 12 sides in circles
    EXPECT_GT(length, 2 * 12 * std::sin(std::numbers::pi / 12));
    EXPECT_LE(length, 2 * std::numbers::pi);
}

TEST(CoarseLayout, CoversBothSidesOfHardCurves) {
    const Plane plane = plane_with_lines(4, 6, 12, 30, {1.6, 4.6});
    const auto curves = find_hard_curves(plane.domain, plane.field, flat_options(1));
    const MapProblem problem =
        make_map_problem(plane.domain.mesh, plane.field, guidance_of(plane.domain, curves, 1));
    ASSERT_EQ(problem.fault, "");
    const std::vector<bool> none(problem.unknowns.is_integer.size(), false);
    const Eigen::VectorXd values = minimum(reduced(alignment_energy(problem), problem), none,
                                           Eigen::VectorXd::Zero(static_cast<int>(none.size())));
    const CoarseLayout layout = make_coarse_layout(plane.domain.mesh, problem, values);
    double twice_area = 0;
    for (const LayoutTriangle& triangle : layout.triangles) {
        std::array<double, 4> side{};
        for (std::size_t k = 0; k < 4; ++k)
            for (const auto& [unknown, coefficient] : triangle.forms[k])
                side[k] += coefficient * values[unknown];
        const double own = side[0] * side[3] - side[1] * side[2];
        EXPECT_GT(own, 0);
        twice_area += own;
    }
    EXPECT_NEAR(twice_area, 2 * 4 * 6, 1e-4);  // the equations are held off zero pivots
    EXPECT_LE(layout.triangles.size(), 12U);   // of three strips with four corners each
}

TEST(Clearance, MovesSingularitiesOffCurvesAndKeepsTheSumOfIndices) {
    const Plane plane = plane_with_lines(8, 8, 32, 32, {4});
    const Mesh& mesh = plane.domain.mesh;
    const FaceConnection connection = connect_faces(mesh);
    MatchedField matched = match_arms(mesh, connection, plane.field.angles);
    // A pair, 5 quads apart, each a quarter of a quad above the line.
    for (std::size_t i = 0; i < connection.links.size(); ++i) {
        const HalfedgeHandle h(connection.links[i].halfedge);
        const Vec3& p = mesh.point(mesh.from_vertex_handle(h));
        const Vec3& q = mesh.point(mesh.to_vertex_handle(h));
        const double from = std::min(p[0], q[0]), to = std::max(p[0], q[0]);
        if (std::abs(p[1] - 4.25) + std::abs(q[1] - 4.25) < 1e-9 && from > 1.49 && to < 6.51)
            turn_link(mesh, connection, i, p[0] < q[0] ? 1 : -1, matched);
    }
    const auto guides = boundary_guides(mesh, 1, 1e4);
    ASSERT_TRUE(straighten(connection, guides, matched));
    FieldDesign design;
    design.field = matched.field;
    design.singularities = inner_singularities(mesh, vertex_indices(mesh, design.field));
    ASSERT_EQ(design.singularities.size(), 2U);
    HardCurve line;
    for (const EdgeHandle edge : mesh.edges())
        if (plane.domain.edge_arc[at(edge.idx())] == 0) line.edges.push_back(edge.idx());
    ClearanceOptions options;
    options.edge_length = 1;
    EXPECT_EQ(clear_curves(plane.domain, {line}, options, design), 2);
    ASSERT_EQ(first_fault(mesh, design.field), "");
    const auto moved = inner_singularities(mesh, vertex_indices(mesh, design.field));
    ASSERT_EQ(moved.size(), 2U);
    EXPECT_EQ(moved[0].index + moved[1].index, 0);
    for (const Singularity& s : moved) {
        const double distance = std::abs(mesh.point(VertexHandle(s.vertex))[1] - 4);
        const bool is_on_line = distance < 1e-9;
        EXPECT_TRUE(is_on_line ? s.index < 0 : distance >= options.away);
    }
    // Nothing is near any more.
    EXPECT_EQ(clear_curves(plane.domain, {line}, options, design), 0);
}

}  // namespace
}  // namespace fcn
