#include "meshing/remesh.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <map>
#include <random>
#include <set>

#include "geometry/errors.h"
#include "meshing/measure.h"
#include "remesh_checks.h"
#include "sample_meshes.h"
#include "sample_networks.h"

namespace fcn {
namespace {

using test::area_of;
using test::expect_segments_are_edges;
using test::expect_sound;
using test::nearest_vertex;

constexpr double kCrease = 0.7;  ///< radians

TEST(Remesh, CubeKeepsItsEdgesAsSegments) {
    const LoadedMesh mesh = test::cube(17);
    for (const double rmin : {0.05, 0.1, 0.3}) {
        const FeatureCurveNetwork network =
            test::cut_evenly(test::crease_network(mesh.mesh, kCrease), rmin);
        ASSERT_EQ(network.arcs.size(), 12U);
        RemeshOptions options;
        options.edge_length = 1.2 * rmin;
        const RemeshResult result = remesh_triangles(mesh, network, options);
        EXPECT_TRUE(result.warnings.empty()) << result.warnings.front();
        expect_sound(mesh, network, result);
        expect_segments_are_edges(network, result, options.edge_length);
        EXPECT_EQ(result.feature_edges.size(), network.segments.size());
        // With all its edges kept the cube is exact: same surface, area 6.
        EXPECT_NEAR(area_of(result.mesh.mesh), 6, 1e-6);
        EXPECT_LT(measure_distance(result.mesh.mesh, mesh.mesh, 0.05).hausdorff, 1e-9);
        EXPECT_GT(measure_triangles(result.mesh.mesh).min_angle_degrees, 15);
    }
}

TEST(Remesh, PartsSmallerThanAnEdgeSurvive) {
    constexpr double kLength = 0.2;
    const std::uint64_t seed = 5;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> extent(0.01, 0.25);
    const Mesh piece = test::cube(2).mesh;
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    constexpr int kParts = 60;
    for (int part = 0; part < kParts; ++part) {
        const int first = static_cast<int>(points.size());
        const Vec3 size(extent(engine), extent(engine), extent(engine));
        for (const VertexHandle vertex : piece.vertices())
            points.emplace_back(size.cwiseProduct(piece.point(vertex)) + Vec3(part, 0, 0));
        for (const FaceHandle face : piece.faces()) {
            const auto v = face_vertices(piece, face);
            triangles.push_back({first + v[0].idx(), first + v[1].idx(), first + v[2].idx()});
        }
    }
    const LoadedMesh mesh = mesh_from_soup(points, triangles);
    RemeshOptions options;
    options.edge_length = kLength;
    for (const bool is_protecting : {true, false}) {
        options.is_protecting = is_protecting;
        const RemeshResult result = remesh_triangles(mesh, {}, options);
        EXPECT_TRUE(result.warnings.empty()) << result.warnings.front();
        // 2 for each part: none has vanished or opened.
        EXPECT_EQ(test::euler(result.mesh.mesh), 2 * kParts);
        EXPECT_EQ(test::boundary_edges(result.mesh.mesh), 0U);
    }
}

TEST(Remesh, CoarseCubeIsRefined) {
    const LoadedMesh mesh = test::cube(1);
    const FeatureCurveNetwork network =
        test::cut_evenly(test::crease_network(mesh.mesh, kCrease), 0.1);
    RemeshOptions options;
    options.edge_length = 0.12;
    const RemeshResult result = remesh_triangles(mesh, network, options);
    EXPECT_TRUE(result.warnings.empty());
    expect_sound(mesh, network, result);
    expect_segments_are_edges(network, result, options.edge_length);
    EXPECT_NEAR(area_of(result.mesh.mesh), 6, 1e-6);
}

TEST(Remesh, ChordsOfACurvedRimBecomeSingleEdges) {
    const LoadedMesh mesh = test::cylinder(0.5, 96, 24);
    const FeatureCurveNetwork creases = test::crease_network(mesh.mesh, kCrease);
    ASSERT_EQ(creases.arcs.size(), 2U);
    for (const double rmin : {0.06, 0.15, 0.35}) {
        const FeatureCurveNetwork network = test::cut_evenly(creases, rmin);
        RemeshOptions options;
        options.edge_length = 1.2 * rmin;
        const RemeshResult result = remesh_triangles(mesh, network, options);
        EXPECT_TRUE(result.warnings.empty()) << "rmin " << rmin << ": " << result.warnings.front();
        expect_sound(mesh, network, result);
        expect_segments_are_edges(network, result, options.edge_length);
    }
}

TEST(Remesh, InitialNetworkIsCutIntoEvenPieces) {
    const LoadedMesh mesh = test::cylinder(0.5, 96, 24);
    const FeatureCurveNetwork network = test::crease_network(mesh.mesh, kCrease);
    RemeshOptions options;
    options.edge_length = 0.15;
    const RemeshResult result = remesh_triangles(mesh, network, options);
    EXPECT_TRUE(result.warnings.empty());
    expect_sound(mesh, network, result);
    std::size_t pieces = 0;
    for (const NetworkArc& arc : network.arcs)
        pieces += static_cast<std::size_t>(std::lround(arc.length() / options.edge_length));
    EXPECT_EQ(result.feature_edges.size(), pieces);
    for (const auto& [a, b] : result.feature_edges) {
        const double length =
            (result.mesh.mesh.point(VertexHandle(a)) - result.mesh.mesh.point(VertexHandle(b)))
                .norm();
        EXPECT_NEAR(length, options.edge_length, 0.1 * options.edge_length);
    }
}

TEST(Remesh, LongSegmentIsSplitOnce) {
    LoadedMesh mesh;
    mesh.mesh = test::rectangle(1, 1, 20, 20);
    FeatureCurveNetwork network;
    network.scale = 0.1;
    const auto node = [&](double x) { network.nodes.push_back({{x, 0.503, 0}, {}}); };
    node(0.4);
    node(0.6);  // 2 rmin = 1.67 L
    NetworkArc arc;
    arc.nodes = {0, 1};
    arc.samples = {{network.nodes[0].position, {}}, {network.nodes[1].position, {}}};
    network.arcs.push_back(arc);
    network.segments.push_back({{0, 1}, 0, 0, 1, 1, true});
    RemeshOptions options;
    options.edge_length = 0.12;
    const RemeshResult result = remesh_triangles(mesh, network, options);
    EXPECT_TRUE(result.warnings.empty());
    expect_sound(mesh, network, result);
    EXPECT_EQ(result.feature_edges.size(), 2U);
    EXPECT_LE(nearest_vertex(result.mesh.mesh, {0.5, 0.503, 0}), 1e-9);
}

TEST(Remesh, CurvesThatRunTogetherBeforeTheirNodeEndInIt) {
    // A node beside a vertex of the mesh, and three curves that come from the vertex's far side.
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> share(-1, 1);
    std::size_t broken = 0;
    for (int trial = 0; trial < 60; ++trial) {
        LoadedMesh mesh;
        mesh.mesh = test::rectangle(1, 1, 20, 20);
        FeatureCurveNetwork network;
        network.scale = 0.1;
        const Vec3 beside(0.5 + 0.003 * share(engine), 0.5 + 0.003 * share(engine), 0);
        network.nodes.push_back({beside, {}});
        const Vec3 away = (Vec3(0.5, 0.5, 0) - beside).normalized();
        for (const double turn : {-1.0, 0.0, 1.0}) {
            const Vec3 end =
                beside + 0.12 * (away + turn * Vec3(-away.y(), away.x(), 0)).normalized();
            const int node = static_cast<int>(network.nodes.size());
            network.nodes.push_back({end, {}});
            NetworkArc arc;
            arc.nodes = {0, node};
            arc.samples = {{beside, {}}, {end, {}}};
            network.segments.push_back({{0, node}, static_cast<int>(network.arcs.size()), 0, 1});
            network.arcs.push_back(arc);
        }
        RemeshOptions options;
        options.edge_length = 0.12;
        const RemeshResult result = remesh_triangles(mesh, network, options);
        expect_sound(mesh, network, result);
        broken += result.broken_segments.size();
    }
    // Of 180; where no collapse is left that keeps the mesh sound a segment stays in pieces.
    EXPECT_LE(broken, 6U);
}

TEST(Remesh, BoundaryIsKeptWithoutANetwork) {
    LoadedMesh mesh;
    mesh.mesh = test::rectangle(1, 0.7, 30, 30);
    RemeshOptions options;
    options.edge_length = 0.1;
    const RemeshResult result = remesh_triangles(mesh, {}, options);
    expect_sound(mesh, {}, result);
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0.7, 0), Vec3(0, 0.7, 0)})
        EXPECT_LE(nearest_vertex(result.mesh.mesh, corner), 1e-12);
    for (const EdgeHandle edge : result.mesh.mesh.edges()) {
        if (!result.mesh.mesh.is_boundary(edge)) continue;
        const Vec3 middle = result.mesh.mesh.calc_edge_midpoint(edge);
        EXPECT_NEAR(std::min({middle[0], middle[1], 1 - middle[0], 0.7 - middle[1]}), 0, 1e-12);
    }
    EXPECT_NEAR(area_of(result.mesh.mesh), 0.7, 1e-9);
    EXPECT_TRUE(result.feature_edges.empty());
}

TEST(Remesh, LabelsTravelAndTheirBordersStay) {
    const LoadedMesh mesh = test::cube(12, true);
    ASSERT_EQ(mesh.face_labels.size(), mesh.mesh.n_faces());
    for (const bool has_network : {true, false}) {
        const FeatureCurveNetwork network =
            has_network ? test::cut_evenly(test::crease_network(mesh.mesh, kCrease), 0.1)
                        : FeatureCurveNetwork{};
        RemeshOptions options;
        options.edge_length = 0.12;
        const RemeshResult result = remesh_triangles(mesh, network, options);
        expect_sound(mesh, network, result);
        ASSERT_EQ(result.mesh.face_labels.size(), result.mesh.mesh.n_faces());
        std::map<int, double> area;
        for (const FaceHandle face : result.mesh.mesh.faces()) {
            const int label = result.mesh.face_labels[static_cast<std::size_t>(face.idx())];
            area[label] += face_area(result.mesh.mesh, face);
            // Sides in the order of the sample: z = 0, z = 1, y = 0, y = 1, x = 0, x = 1.
            const Vec3 middle = result.mesh.mesh.calc_face_centroid(face);
            ASSERT_TRUE(label >= 0 && label < 6);
            EXPECT_NEAR(middle[2 - label / 2], label % 2, 1e-9);
        }
        for (int label = 0; label < 6; ++label) EXPECT_NEAR(area[label], 1, 1e-6);
    }
}

TEST(Remesh, PlainRemeshingIgnoresTheNetwork) {
    const LoadedMesh mesh = test::cube(10);
    const FeatureCurveNetwork network =
        test::cut_evenly(test::crease_network(mesh.mesh, kCrease), 0.1);
    RemeshOptions options;
    options.edge_length = 0.12;
    options.is_protecting = false;
    const RemeshResult result = remesh_triangles(mesh, network, options);
    expect_sound(mesh, {}, result);
    EXPECT_TRUE(result.feature_edges.empty());
}

TEST(Remesh, SameResultOnAnyNumberOfThreads) {
    const LoadedMesh mesh = test::cylinder(0.5, 64, 16);
    const FeatureCurveNetwork network =
        test::cut_evenly(test::crease_network(mesh.mesh, kCrease), 0.1);
    RemeshOptions options;
    options.edge_length = 0.12;
    const auto with = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return remesh_triangles(mesh, network, options);
    };
    const RemeshResult one = with(1), many = with(4);
    EXPECT_EQ(one.mesh.hash, many.mesh.hash);
    EXPECT_NE(one.mesh.hash, 0U);
    EXPECT_EQ(one.feature_edges, many.feature_edges);
}

/// Straight lines between random points of a square, some of which cross, touch or coincide.
FeatureCurveNetwork random_lines(std::mt19937_64& engine, int count) {
    // Coordinates on a lattice as coarse as the mesh, so that lines hit vertices and run in edges.
    const auto coordinate = [&] { return static_cast<double>(engine() % 41) / 40; };
    FeatureCurveNetwork network;
    for (int i = 0; i < count; ++i) {
        const Vec3 from(coordinate(), coordinate(), 0), to(coordinate(), coordinate(), 0);
        if ((to - from).norm() < 0.05) continue;
        const int first = static_cast<int>(network.nodes.size());
        network.nodes.push_back({from, {}});
        network.nodes.push_back({to, {}});
        NetworkArc arc;
        arc.nodes = {first, first + 1};
        const int steps = 1 + static_cast<int>(engine() % 30);
        for (int k = 0; k <= steps; ++k) {
            const double t = static_cast<double>(k) / steps;
            arc.samples.push_back({(1 - t) * from + t * to, {}});
        }
        network.arcs.push_back(arc);
    }
    return network;
}

TEST(Remesh, SurvivesCurvesThatCrossTouchAndCoincide) {
    LoadedMesh mesh;
    mesh.mesh = test::rectangle(1, 1, 20, 20);
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        const FeatureCurveNetwork network = random_lines(engine, 1 + static_cast<int>(seed % 12));
        RemeshOptions options;
        options.edge_length = 0.02 + 0.02 * static_cast<double>(engine() % 8);
        options.iterations = 3;
        const RemeshResult result = remesh_triangles(mesh, network, options);
        expect_sound(mesh, network, result);
        EXPECT_NEAR(area_of(result.mesh.mesh), 1, 1e-9);
        for (const std::string& warning : result.warnings) {
            EXPECT_EQ(warning.find("could not be embedded"), std::string::npos) << warning;
            EXPECT_EQ(warning.find("CGAL"), std::string::npos) << warning;
        }
    }
}

TEST(Remesh, PeerKeepsTheSameSegments) {
    const LoadedMesh mesh = test::cube(17);
    const FeatureCurveNetwork network =
        test::cut_evenly(test::crease_network(mesh.mesh, kCrease), 0.1);
    RemeshOptions options;
    options.edge_length = 0.12;
    const RemeshResult result = remesh_with_cgal(mesh, network, options);
    EXPECT_TRUE(result.warnings.empty());
    expect_sound(mesh, network, result);
    expect_segments_are_edges(network, result, options.edge_length);
}

TEST(Remesh, AnglesOnCylindersAreGood) {
    const LoadedMesh mesh = test::cylinder(0.5, 96, 24);
    const FeatureCurveNetwork creases = test::crease_network(mesh.mesh, kCrease);
    for (const double rmin : {0.04, 0.09, 0.2}) {
        RemeshOptions options;
        options.edge_length = 1.2 * rmin;
        const FeatureCurveNetwork network = test::cut_evenly(creases, rmin);
        const RemeshResult result = remesh_triangles(mesh, network, options);
        EXPECT_GT(measure_triangles(result.mesh.mesh).min_angle_degrees, 30) << "rmin " << rmin;
        EXPECT_TRUE(result.forced_faces.empty());
        options.is_improving_angles = false;
        const RemeshResult rough = remesh_triangles(mesh, network, options);
        EXPECT_LE(measure_triangles(rough.mesh.mesh).min_angle_degrees,
                  measure_triangles(result.mesh.mesh).min_angle_degrees + 1e-9);
    }
}

TEST(Remesh, SizingByCurvatureStaysInTheInterval) {
    // A plate with a round hump: fine on the hump, coarse on the plate.
    LoadedMesh mesh;
    mesh.mesh = test::rectangle(4, 4, 120, 120);
    for (const VertexHandle v : mesh.mesh.vertices()) {
        Vec3 p = mesh.mesh.point(v);
        p[2] = 0.4 * std::exp(-8 * ((p[0] - 2) * (p[0] - 2) + (p[1] - 2) * (p[1] - 2)));
        mesh.mesh.set_point(v, p);
    }
    RemeshOptions options;
    options.edge_length = 0.15;
    const std::size_t uniform = remesh_triangles(mesh, {}, options).mesh.mesh.n_faces();
    options.curvature_tolerance = 0.02;
    const RemeshResult sized = remesh_triangles(mesh, {}, options);
    EXPECT_LT(sized.mesh.mesh.n_faces(), uniform);
    double near = 0, far = 0;
    int near_count = 0, far_count = 0;
    for (const EdgeHandle edge : sized.mesh.mesh.edges()) {
        if (sized.mesh.mesh.is_boundary(edge)) continue;
        const Vec3 p = sized.mesh.mesh.calc_edge_midpoint(edge) - Vec3(2, 2, 0);
        const double distance = std::hypot(p[0], p[1]);
        const double length = sized.mesh.mesh.calc_edge_length(edge);
        if (distance < 0.3) near += length, ++near_count;
        if (distance > 1.4 && distance < 1.9) far += length, ++far_count;
    }
    ASSERT_GT(near_count, 0);
    ASSERT_GT(far_count, 0);
    EXPECT_LT(near / near_count, 0.85 * far / far_count);
}

TEST(Remesh, ForcedCornersAreListed) {
    // A flat kite whose sharp corner has 20 degrees: no mesh of it has a larger one there.
    LoadedMesh mesh;
    const double half = 10.0 / 180 * 3.14159265358979323846;
    const VertexHandle a = mesh.mesh.add_vertex({0, 0, 0});
    const VertexHandle b = mesh.mesh.add_vertex({3, -3 * std::tan(half), 0});
    const VertexHandle c = mesh.mesh.add_vertex({4, 0, 0});
    const VertexHandle d = mesh.mesh.add_vertex({3, 3 * std::tan(half), 0});
    mesh.mesh.add_face(a, b, c);
    mesh.mesh.add_face(a, c, d);
    RemeshOptions options;
    options.edge_length = 0.2;
    const RemeshResult result =
        remesh_triangles(mesh, test::crease_network(mesh.mesh, kCrease), options);
    ASSERT_GE(result.forced_faces.size(), 1U);
    EXPECT_NEAR(measure_triangles(result.mesh.mesh).min_angle_degrees, 20, 1e-6);
    std::size_t under_30 = 0;
    for (const FaceHandle face : result.mesh.mesh.faces()) {
        const auto v = face_vertices(result.mesh.mesh, face);
        const auto side = [&](int i, int j) {
            return (result.mesh.mesh.point(v[static_cast<std::size_t>(i)]) -
                    result.mesh.mesh.point(v[static_cast<std::size_t>(j)]))
                .norm();
        };
        std::array<double, 3> s{side(0, 1), side(1, 2), side(2, 0)};
        std::sort(s.begin(), s.end());
        under_30 +=
            (s[1] * s[1] + s[2] * s[2] - s[0] * s[0]) / (2 * s[1] * s[2]) > 0.86602540378443865;
    }
    EXPECT_GE(under_30, result.forced_faces.size());
}

TEST(Remesh, TipsOfSpikesAreListed) {
    // A cone with 80 degrees of surface around its tip, which a curve ends in: of the three
    // triangles there, at least one has less than 30.
    constexpr int kSides = 48;
    constexpr double kPi = 3.14159265358979323846;
    const double radius = 80.0 / 360;
    LoadedMesh mesh;
    const VertexHandle tip = mesh.mesh.add_vertex({0, 0, std::sqrt(1 - radius * radius)});
    const VertexHandle base = mesh.mesh.add_vertex({0, 0, 0});
    std::vector<VertexHandle> ring;
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * kPi * i / kSides;
        ring.push_back(
            mesh.mesh.add_vertex({radius * std::cos(angle), radius * std::sin(angle), 0}));
    }
    for (std::size_t i = 0; i < kSides; ++i) {
        const VertexHandle a = ring[i], b = ring[(i + 1) % kSides];
        mesh.mesh.add_face(tip, a, b);
        mesh.mesh.add_face(base, b, a);
    }
    FeatureCurveNetwork network;
    NetworkArc arc;
    arc.nodes = {0, 1};
    for (const VertexHandle end : {tip, ring[0]}) {
        network.nodes.push_back({mesh.mesh.point(end), test::at_vertex(mesh.mesh, end)});
        arc.samples.push_back({mesh.mesh.point(end), test::at_vertex(mesh.mesh, end)});
    }
    network.arcs.push_back(arc);
    RemeshOptions options;
    options.edge_length = 0.15;
    const RemeshResult result = remesh_triangles(mesh, test::cut_evenly(network, 0.125), options);
    const Mesh& remesh = result.mesh.mesh;
    VertexHandle kept;
    for (const VertexHandle v : remesh.vertices())
        if ((remesh.point(v) - mesh.mesh.point(tip)).norm() < 1e-12) kept = v;
    ASSERT_TRUE(kept.is_valid());
    double around = 0;
    for (const HalfedgeHandle h : remesh.voh_range(kept))
        around += remesh.calc_sector_angle(remesh.prev_halfedge_handle(h));
    EXPECT_LT(around, kPi / 2);
    std::set<int> at_tip;
    for (const FaceHandle face : remesh.vf_range(kept)) at_tip.insert(face.idx());
    const std::set<int> forced(result.forced_faces.begin(), result.forced_faces.end());
    EXPECT_GE(forced.size(), 1U);
    for (const int face : forced) EXPECT_EQ(at_tip.count(face), 1U);
    for (const FaceHandle face : remesh.faces())
        for (const HalfedgeHandle h : remesh.fh_range(face))
            EXPECT_TRUE(remesh.calc_sector_angle(h) > kPi / 6 || forced.count(face.idx()) == 1)
                << "face " << face.idx();
}

TEST(Remesh, ImpossibleInputIsRefused) {
    const LoadedMesh mesh = test::cube(2);
    RemeshOptions options;
    EXPECT_THROW(remesh_triangles(mesh, {}, options), InputError);
    options.edge_length = -1;
    EXPECT_THROW(remesh_triangles(mesh, {}, options), InputError);
    options.edge_length = 1e-9;
    EXPECT_THROW(remesh_triangles(mesh, {}, options), InputError);
    options.edge_length = 0.3;
    EXPECT_THROW(remesh_triangles({}, {}, options), InputError);
    FeatureCurveNetwork network;
    network.segments.push_back({{0, 1}, 0, 0, 1, 1, false});
    EXPECT_THROW(remesh_triangles(mesh, network, options), InputError);
}

}  // namespace
}  // namespace fcn
