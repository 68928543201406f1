#include "meshing/cross_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <sstream>

#include "geometry/errors.h"
#include "geometry/models.h"
#include "meshing/field_design.h"
#include "meshing/field_file.h"
#include "meshing/quad_holes.h"
#include "meshing/sample_meshes.h"
#include "meshing/sample_networks.h"
#include "meshing/singularity_refinement.h"

namespace fcn {
namespace {

using test::rectangle;

constexpr double kQuarter = std::numbers::pi / 2;

int euler(const Mesh& mesh) {
    return static_cast<int>(mesh.n_vertices()) - static_cast<int>(mesh.n_edges()) +
           static_cast<int>(mesh.n_faces());
}

int index_sum(const Mesh& mesh, const CrossField& field) {
    const std::vector<int> indices = vertex_indices(mesh, field);
    return std::accumulate(indices.begin(), indices.end(), 0);
}

/// The surface of unit cubes that `is_full` says, in a grid of i x j x k.
LoadedMesh blocks(int i, int j, int k, const std::function<bool(int, int, int)>& is_full, int n) {
    const auto is_inside = [&](int x, int y, int z) {
        return x >= 0 && y >= 0 && z >= 0 && x < i && y < j && z < k && is_full(x, y, z);
    };
    std::vector<std::array<Vec3, 4>> quads;
    for (int x = 0; x < i; ++x) {
        for (int y = 0; y < j; ++y) {
            for (int z = 0; z < k; ++z) {
                if (!is_inside(x, y, z)) continue;
                const auto p = [&](int a, int b, int c) { return Vec3(x + a, y + b, z + c); };
                if (!is_inside(x - 1, y, z))
                    quads.push_back({p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)});
                if (!is_inside(x + 1, y, z))
                    quads.push_back({p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)});
                if (!is_inside(x, y - 1, z))
                    quads.push_back({p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)});
                if (!is_inside(x, y + 1, z))
                    quads.push_back({p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0)});
                if (!is_inside(x, y, z - 1))
                    quads.push_back({p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)});
                if (!is_inside(x, y, z + 1))
                    quads.push_back({p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)});
            }
        }
    }
    return test::from_grids(quads, n);
}

LoadedMesh loaded(Mesh mesh) {
    LoadedMesh result;
    result.mesh = std::move(mesh);
    return result;
}

/// Radians between the cross of a face and a direction in it.
double deviation(const Mesh& mesh, const CrossField& field, FaceHandle face, const Vec3& to) {
    const Vec3 a = arm_direction(mesh, field, face);
    const Vec3 b = face_normal(mesh, face).cross(a);
    return std::abs(std::remainder(std::atan2(to.dot(b), to.dot(a)), kQuarter));
}

QuadDomain domain_of(const LoadedMesh& input, const FeatureCurveNetwork& network, double h) {
    QuadDomainOptions options;
    options.edge_length = h / 3;
    return make_quad_domain(input, network, options);
}

FieldDesign design(const QuadDomain& domain, double h) {
    FieldOptions options;
    options.edge_length = h;
    return design_field(domain, options);
}

// Any angles at all have turns, and the indices of these sum to 4 times the Euler characteristic.
TEST(CrossField, IndexTheoremForAnyAngles) {
    const std::vector<Mesh> meshes{
        test::sphere(1, 3),
        rectangle(2, 1, 9, 5),
        make_model("torus", {.resolution = 0.1}).mesh,
        make_model("thin-wall", {.resolution = 0.1}).mesh,
        blocks(
            5, 3, 1, [](int x, int y, int) { return y != 1 || x % 2 == 0; }, 2)
            .mesh,
        blocks(
            4, 2, 1, [](int x, int, int) { return x != 1; }, 3)
            .mesh};
    const unsigned seed = 7;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> angle(-10, 10);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        SCOPED_TRACE("mesh " + std::to_string(i));
        CrossField field;
        for (std::size_t f = 0; f < meshes[i].n_faces(); ++f) field.angles.push_back(angle(random));
        field.turns = nearest_turns(meshes[i], field.angles);
        EXPECT_EQ(first_fault(meshes[i], field), "");
        EXPECT_EQ(index_sum(meshes[i], field), 4 * euler(meshes[i]));
        // Other arms of the same crosses change turns, not indices.
        CrossField other = field;
        for (double& a : other.angles) a += kQuarter * static_cast<double>(random() % 4);
        other.turns = nearest_turns(meshes[i], other.angles);
        EXPECT_EQ(vertex_indices(meshes[i], field), vertex_indices(meshes[i], other));
    }
}

TEST(CrossField, FramesUnfoldAcrossEdges) {
    const Mesh mesh = test::sphere(1, 2);
    for (const HalfedgeHandle h : mesh.halfedges()) {
        // The direction of the edge itself is the same on both sides.
        const HalfedgeHandle across = mesh.opposite_halfedge_handle(h);
        EXPECT_NEAR(std::remainder(halfedge_angle(mesh, h) + frame_rotation(mesh, h) -
                                       halfedge_angle(mesh, across) - std::numbers::pi,
                                   2 * std::numbers::pi),
                    0, 1e-12);
        const FaceHandle face = mesh.face_handle(h);
        CrossField field;
        field.angles.assign(mesh.n_faces(), halfedge_angle(mesh, h));
        EXPECT_LT((arm_direction(mesh, field, face) - mesh.calc_edge_vector(h).normalized()).norm(),
                  1e-12);
    }
}

TEST(CrossField, FaultsAreFound) {
    const Mesh mesh = rectangle(1, 1, 2, 2);
    CrossField field{std::vector<double>(mesh.n_faces(), 0.0), {}};
    EXPECT_NE(first_fault(mesh, field), "");
    field.turns = nearest_turns(mesh, field.angles);
    EXPECT_EQ(first_fault(mesh, field), "");
    for (const HalfedgeHandle h : mesh.halfedges()) {
        CrossField broken = field;
        broken.turns[static_cast<std::size_t>(h.idx())] += 1;
        EXPECT_NE(first_fault(mesh, broken), "");
    }
    field.angles[1] = std::nan("");
    EXPECT_NE(first_fault(mesh, field), "");
}

TEST(FieldDesign, RectangleIsAGrid) {
    const QuadDomain domain = domain_of(loaded(rectangle(3, 2, 6, 4)), {}, 0.3);
    const FieldDesign result = design(domain, 0.3);
    ASSERT_EQ(result.failure, "");
    EXPECT_TRUE(result.singularities.empty());
    for (const FaceHandle face : domain.mesh.faces())
        EXPECT_LT(deviation(domain.mesh, result.field, face, Vec3::UnitX()), 1e-3);
    const std::vector<int> indices = vertex_indices(domain.mesh, result.field);
    EXPECT_EQ(std::count(indices.begin(), indices.end(), 1), 4);  // the corners
    EXPECT_EQ(std::count(indices.begin(), indices.end(), 0),
              static_cast<long>(domain.mesh.n_vertices()) - 4);
}

TEST(FieldDesign, BoxHasItsCornersAsSingularities) {
    const LoadedMesh box = test::cube(4);
    const FeatureCurveNetwork network = test::crease_network(box.mesh, 0.5);
    const QuadDomain domain = domain_of(box, network, 0.2);
    const FieldDesign result = design(domain, 0.2);
    ASSERT_EQ(result.singularities.size(), 8u);
    for (const Singularity& s : result.singularities) {
        EXPECT_EQ(s.index, 1);
        const Vec3 p = domain.mesh.point(VertexHandle(s.vertex));
        EXPECT_LT((p - Vec3(std::round(p[0]), std::round(p[1]), std::round(p[2]))).norm(), 1e-9);
    }
    EXPECT_LT(result.curve_deviation_degrees, 0.1);
    EXPECT_EQ(index_sum(domain.mesh, result.field), 8);
}

TEST(FieldDesign, CylinderIsStraight) {
    const LoadedMesh input = test::cylinder(0.3, 40, 8);
    const QuadDomain domain = domain_of(input, test::crease_network(input.mesh, 0.5), 0.12);
    const FieldDesign result = design(domain, 0.12);
    ASSERT_EQ(result.failure, "");
    for (const FaceHandle face : domain.mesh.faces())
        if (std::abs(face_normal(domain.mesh, face)[2]) < 0.1) {
            EXPECT_LT(deviation(domain.mesh, result.field, face, Vec3::UnitZ()), 0.15);
        }
    EXPECT_LT(result.curve_deviation_degrees, 2);
}

TEST(FieldDesign, IndexTheoremOnSurfaces) {
    struct Case {
        const char* name;
        LoadedMesh mesh;
        int euler;
    };
    const std::vector<Case> cases{
        {"sphere", loaded(test::sphere(1, 3)), 2},
        {"torus", make_model("torus", {.resolution = 0.05}), 0},
        {"two holes",
         blocks(
             5, 3, 1, [](int x, int y, int) { return y != 1 || x % 2 == 0; }, 1),
         -2},
        {"two spheres",
         blocks(
             3, 1, 1, [](int x, int, int) { return x != 1; }, 1),
         4},
        {"disk", loaded(rectangle(1, 1, 4, 4)), 1}};
    for (const Case& one : cases) {
        SCOPED_TRACE(one.name);
        const double h = 0.05 * bounding_box(one.mesh.mesh).diagonal();
        const QuadDomain domain = domain_of(one.mesh, {}, h);
        EXPECT_EQ(euler(domain.mesh), one.euler);
        const FieldDesign result = design(domain, h);
        EXPECT_EQ(result.failure, "");
        EXPECT_EQ(first_fault(domain.mesh, result.field), "");
        EXPECT_EQ(index_sum(domain.mesh, result.field), 4 * one.euler);
        EXPECT_EQ(result.close_pairs, 0);
    }
}

/// A curve across the square at 30 degrees to its sides.
FeatureCurveNetwork slanted_curve() {
    FeatureCurveNetwork network;
    const Vec3 from(0.2, 0.3, 0), to(0.8, 0.3 + 0.6 * std::tan(std::numbers::pi / 6), 0);
    network.nodes = {{from, {}}, {to, {}}};
    NetworkArc arc;
    arc.nodes = {0, 1};
    for (int i = 0; i <= 10; ++i) arc.samples.push_back({from + (to - from) * i / 10, {}});
    network.arcs.push_back(arc);
    return network;
}

TEST(FieldDesign, FollowsACurve) {
    const LoadedMesh square = loaded(rectangle(1, 1, 8, 8));
    const double h = 0.06;
    const QuadDomain domain = domain_of(square, slanted_curve(), h);
    ASSERT_GT(std::count(domain.edge_arc.begin(), domain.edge_arc.end(), 0), 20);
    FieldOptions options;
    options.edge_length = h;
    const FieldDesign guided = design_field(domain, options);
    EXPECT_LT(guided.curve_deviation_degrees, 3);
    options.curve_strength = 0;
    const FieldDesign unguided = design_field(domain, options);
    EXPECT_NEAR(unguided.curve_deviation_degrees, 30, 1);
    EXPECT_EQ(index_sum(domain.mesh, guided.field), 4);
}

TEST(FieldDesign, MergesOppositePairs) {
    const LoadedMesh square = loaded(rectangle(1, 1, 8, 8));
    const QuadDomain domain = domain_of(square, {}, 0.1);
    const FaceConnection connection = connect_faces(domain.mesh);
    std::vector<double> angles;
    for (const FaceHandle face : domain.mesh.faces()) {
        const HalfedgeHandle h = domain.mesh.halfedge_handle(face);
        const Vec3 along = domain.mesh.calc_edge_vector(h);
        angles.push_back(-std::atan2(along[1], along[0]));
    }
    MatchedField straight = match_arms(domain.mesh, connection, angles);
    ASSERT_TRUE(inner_singularities(domain.mesh, straight.indices).empty());
    // Turning a link makes a pair of opposite singularities at the ends of its edge.
    MatchedField twisted = straight;
    std::size_t link = 0;
    const auto end = [&](int i) {
        const HalfedgeHandle h(connection.links[link].halfedge);
        return i == 0 ? domain.mesh.from_vertex_handle(h) : domain.mesh.to_vertex_handle(h);
    };
    while (domain.mesh.is_boundary(end(0)) || domain.mesh.is_boundary(end(1))) ++link;
    turn_link(domain.mesh, connection, link, 1, twisted);
    const std::vector<Singularity> pair = inner_singularities(domain.mesh, twisted.indices);
    ASSERT_EQ(pair.size(), 2u);
    EXPECT_EQ(pair[0].index + pair[1].index, 0);
    EXPECT_EQ(close_pairs(domain.mesh, pair, 0.1), 1);
    const std::vector<bool> is_kept(domain.mesh.n_vertices(), true);
    EXPECT_EQ(merge_singularities(domain.mesh, connection, {0.1, 0.001, is_kept}, twisted), 0);
    EXPECT_EQ(merge_singularities(domain.mesh, connection, {0.1, 0.1, {}}, twisted), 1);
    EXPECT_TRUE(inner_singularities(domain.mesh, twisted.indices).empty());
    // What is turned more than once comes apart and back together.
    turn_link(domain.mesh, connection, link, 2, twisted);
    EXPECT_EQ(separate_quarters(domain.mesh, connection, 0.1, twisted), 2);
    const std::vector<Singularity> quarters = inner_singularities(domain.mesh, twisted.indices);
    EXPECT_EQ(quarters.size(), 4u);
    for (const Singularity& s : quarters) EXPECT_EQ(std::abs(s.index), 1);
    EXPECT_EQ(merge_singularities(domain.mesh, connection, {0.3, 0.3, {}}, twisted), 2);
    EXPECT_TRUE(inner_singularities(domain.mesh, twisted.indices).empty());
    ASSERT_TRUE(straighten(connection, {}, twisted));
    double largest = 0;
    for (const double bend : twisted.bends) largest = std::max(largest, std::abs(bend));
    EXPECT_LT(largest, 1e-6);
}

// Twice the faces around singularities, the same surface, field, and curves.
TEST(FieldDesign, RefinedAroundSingularities) {
    const LoadedMesh box = test::cube(4);
    const FeatureCurveNetwork network = test::crease_network(box.mesh, 0.5);
    const std::vector<QuadDomain> domains{domain_of(box, network, 0.25),
                                          domain_of(loaded(test::sphere(1, 3)), {}, 0.4)};
    for (const QuadDomain& domain : domains) {
        const FieldDesign before = design(domain, 0.25);
        ASSERT_FALSE(before.singularities.empty());
        const RefinedField after = refine_singularities(domain, before);
        const Mesh& mesh = after.domain.mesh;
        EXPECT_EQ(first_fault(mesh, after.design.field), "");
        EXPECT_EQ(euler(mesh), euler(domain.mesh));
        std::vector<int> indices = vertex_indices(domain.mesh, before.field);
        indices.resize(mesh.n_vertices(), 0);
        EXPECT_EQ(vertex_indices(mesh, after.design.field), indices);
        for (const Singularity& s : before.singularities)
            EXPECT_EQ(mesh.valence(VertexHandle(s.vertex)),
                      2 * domain.mesh.valence(VertexHandle(s.vertex)));
        double area = 0, length = 0;
        for (const FaceHandle face : mesh.faces()) area += face_area(mesh, face);
        for (const FaceHandle face : domain.mesh.faces()) area -= face_area(domain.mesh, face);
        EXPECT_NEAR(area, 0, 1e-9);
        for (const EdgeHandle edge : mesh.edges())
            if (after.domain.edge_arc[static_cast<std::size_t>(edge.idx())] >= 0)
                length += mesh.calc_edge_length(edge);
        EXPECT_NEAR(length, network.total_length() * (&domain == &domains[0] ? 1 : 0), 1e-6);
        // Every bend was there before, or lies inside a face.
        double largest = 0, largest_before = 0;
        for (const HalfedgeHandle h : mesh.halfedges())
            if (!mesh.is_boundary(mesh.edge_handle(h)))
                largest = std::max(largest, std::abs(arm_rotation(mesh, after.design.field, h)));
        for (const HalfedgeHandle h : domain.mesh.halfedges())
            if (!domain.mesh.is_boundary(domain.mesh.edge_handle(h)))
                largest_before =
                    std::max(largest_before, std::abs(arm_rotation(domain.mesh, before.field, h)));
        EXPECT_NEAR(largest, largest_before, 1e-9);
    }
}

TEST(FieldDesign, Deterministic) {
    const LoadedMesh input = make_model("octaflower", {.resolution = 0.05});
    const FeatureCurveNetwork network = test::crease_network(input.mesh, 0.6);
    const double h = 0.05 * bounding_box(input.mesh).diagonal();
    const QuadDomain domain = domain_of(input, network, h);
    const FieldDesign a = design(domain, h), b = design(domain_of(input, network, h), h);
    EXPECT_EQ(a.field.angles, b.field.angles);
    EXPECT_EQ(a.field.turns, b.field.turns);
}

TEST(FieldDesign, RefusesBadLengths) {
    const QuadDomain domain = domain_of(loaded(rectangle(1, 1, 2, 2)), {}, 0.5);
    for (const double h : {0.0, -1.0, std::nan(""), HUGE_VAL})
        EXPECT_THROW(design(domain, h), InputError);
    QuadDomainOptions options;
    EXPECT_THROW(make_quad_domain(loaded(rectangle(1, 1, 2, 2)), {}, options), InputError);
}

TEST(FieldFile, ArmsComeBackFromText) {
    const QuadDomain domain = domain_of(loaded(test::sphere(1, 2)), {}, 0.4);
    const FieldDesign result = design(domain, 0.4);
    std::istringstream rosy(rosy_text(arm_directions(domain.mesh, result.field)));
    std::size_t faces = 0;
    int symmetry = 0;
    rosy >> faces >> symmetry;
    EXPECT_EQ(faces, domain.mesh.n_faces());
    EXPECT_EQ(symmetry, 4);
    for (const FaceHandle face : domain.mesh.faces()) {
        Vec3 v;
        ASSERT_TRUE(rosy >> v[0] >> v[1] >> v[2]);
        EXPECT_EQ(v, arm_direction(domain.mesh, result.field, face));
        EXPECT_NEAR(v.norm(), 1, 1e-12);
        EXPECT_NEAR(v.dot(face_normal(domain.mesh, face)), 0, 1e-12);
    }
    std::istringstream singular(singularity_text(domain.mesh, result.singularities));
    int vertex = 0, index = 0, sum = 0;
    Vec3 p;
    while (singular >> vertex >> index >> p[0] >> p[1] >> p[2]) {
        sum += index;
        EXPECT_EQ(p, domain.mesh.point(VertexHandle(vertex)));
    }
    EXPECT_EQ(sum, 8);
}

// No edge joins two curves without being part of one, no curve is lost.
TEST(QuadDomain, CurvesAreApart) {
    const LoadedMesh box = test::cube(3);
    const FeatureCurveNetwork network = test::cut_evenly(test::crease_network(box.mesh, 0.5), 0.25);
    const QuadDomain domain = domain_of(box, network, 0.3);
    std::vector<bool> is_on_curve(domain.mesh.n_vertices(), false);
    std::vector<double> length(network.arcs.size(), 0);
    const auto ends = [&](EdgeHandle edge) {
        const HalfedgeHandle h = domain.mesh.halfedge_handle(edge, 0);
        return std::array{domain.mesh.from_vertex_handle(h).idx(),
                          domain.mesh.to_vertex_handle(h).idx()};
    };
    for (const EdgeHandle edge : domain.mesh.edges()) {
        const auto e = static_cast<std::size_t>(edge.idx());
        if (domain.edge_arc[e] < 0) continue;
        for (const int v : ends(edge)) is_on_curve[static_cast<std::size_t>(v)] = true;
        length[static_cast<std::size_t>(domain.edge_arc[e])] += domain.mesh.calc_edge_length(edge);
        const NetworkSegment& segment =
            network.segments.at(static_cast<std::size_t>(domain.edge_segment[e]));
        EXPECT_EQ(segment.arc, domain.edge_arc[e]);
        EXPECT_GT(domain.edge_weight[e], 0);
    }
    for (std::size_t i = 0; i < length.size(); ++i)
        EXPECT_NEAR(length[i], network.arcs[i].length(), 1e-6);
    for (const EdgeHandle edge : domain.mesh.edges()) {
        const auto [a, b] = ends(edge);
        EXPECT_FALSE(is_on_curve[static_cast<std::size_t>(a)] &&
                     is_on_curve[static_cast<std::size_t>(b)] &&
                     domain.edge_arc[static_cast<std::size_t>(edge.idx())] < 0);
    }
    for (std::size_t i = 0; i < network.nodes.size(); ++i) {
        const int v = domain.node_vertex[i];
        if (v >= 0) {
            EXPECT_LT((domain.mesh.point(VertexHandle(v)) - network.nodes[i].position).norm(),
                      1e-9);
        }
    }
}

/// A rectangle without the faces in two squares of different size.
LoadedMesh rectangle_with_holes() {
    const Mesh whole = rectangle(2, 1, 40, 20);
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> faces;
    for (const VertexHandle v : whole.vertices()) points.push_back(whole.point(v));
    for (const FaceHandle face : whole.faces()) {
        const auto [a, b, c] = face_vertices(whole, face);
        const Vec3 p =
            (points[static_cast<std::size_t>(a.idx())] + points[static_cast<std::size_t>(b.idx())] +
             points[static_cast<std::size_t>(c.idx())]) /
            3;
        const bool is_small = std::abs(p[0] - 0.525) < 0.025 && std::abs(p[1] - 0.525) < 0.025;
        const bool is_large = std::abs(p[0] - 1.5) < 0.2 && std::abs(p[1] - 0.5) < 0.2;
        if (!is_small && !is_large) faces.push_back({a.idx(), b.idx(), c.idx()});
    }
    return mesh_from_soup(points, faces);
}

TEST(QuadDomain, ShortLoopsAreFilled) {
    const LoadedMesh input = rectangle_with_holes();
    ASSERT_EQ(euler(input.mesh), -1);
    FeatureCurveNetwork network = test::crease_network(input.mesh, 0.5);
    for (NetworkArc& arc : network.arcs) arc.kind = ArcKind::Boundary;
    QuadDomainOptions options;
    options.edge_length = 0.05;
    EXPECT_EQ(euler(make_quad_domain(input, network, options).mesh), -1);
    options.filled_loop = 0.3;
    const QuadDomain domain = make_quad_domain(input, network, options);
    EXPECT_EQ(euler(domain.mesh), 0);
    ASSERT_EQ(domain.filled_holes.size(), 1u);
    EXPECT_LT((domain.filled_holes[0] - Vec3(0.525, 0.525, 0)).norm(), 1e-9);
    for (const EdgeHandle edge : domain.mesh.edges()) {
        const int arc = domain.edge_arc[static_cast<std::size_t>(edge.idx())];
        EXPECT_EQ(arc >= 0, domain.mesh.is_boundary(edge));
        if (arc < 0) continue;
        // Arcs keep the numbers that the caller knows.
        const Vec3 p = domain.mesh.calc_edge_midpoint(edge);
        double nearest = 1;
        for (const ArcSample& sample : network.arcs[static_cast<std::size_t>(arc)].samples)
            nearest = std::min(nearest, (sample.position - p).norm());
        EXPECT_LT(nearest, 0.05);
    }
    // Quads that are left out make the holes again.
    QuadMesh quads;
    for (int j = 0; j <= 5; ++j)
        for (int i = 0; i <= 10; ++i) quads.points.push_back({0.2 * i, 0.2 * j, 0});
    for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 10; ++i) {
            const int v = 11 * j + i;
            quads.faces.push_back({v, v + 1, v + 12, v + 11});
        }
    EXPECT_EQ(open_holes(quads, domain.filled_holes), 1);
    const QuadTopology topology = check_topology(quads);
    EXPECT_EQ(topology.fault, "");
    EXPECT_EQ(topology.euler_characteristic, 0);
    EXPECT_EQ(topology.boundary_loops, 2);
    const int more = open_holes(quads, std::vector<Vec3>(50, Vec3(1, 0.5, 0)));
    EXPECT_LT(more, 50);  // there is room for a few
    EXPECT_EQ(check_topology(quads).fault, "");
    EXPECT_EQ(check_topology(quads).boundary_loops, 2 + more);
    // A component that is little more than a loop stays open.
    options.filled_loop = 100;
    EXPECT_EQ(euler(make_quad_domain(input, network, options).mesh), -1);
}

}  // namespace
}  // namespace fcn
