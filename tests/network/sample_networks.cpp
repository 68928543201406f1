#include "network/sample_networks.h"

#include <cmath>
#include <numbers>
#include <random>

namespace fcn::testing {
namespace {

std::vector<Vec3> straight(const Vec3& a, const Vec3& b, int samples) {
    std::vector<Vec3> points;
    for (int k = 0; k < samples; ++k) points.push_back(a + (b - a) * k / (samples - 1));
    points.back() = b;
    return points;
}

}  // namespace

int NetworkBuilder::node_at(const Vec3& position) {
    for (std::size_t n = 0; n < network_.nodes.size(); ++n)
        if (network_.nodes[n].position == position) return static_cast<int>(n);
    network_.nodes.push_back({position, {}});
    return static_cast<int>(network_.nodes.size()) - 1;
}

NetworkBuilder& NetworkBuilder::arc(const std::vector<Vec3>& points, std::array<int, 2> patches) {
    NetworkArc arc;
    arc.nodes[0] = node_at(points.front());
    arc.nodes[1] = node_at(points.back());
    for (const Vec3& point : points) arc.samples.push_back({point, {}});
    arc.patches = patches;
    arc.source = "import";
    network_.arcs.push_back(arc);
    return *this;
}

FeatureCurveNetwork y_junction() {
    NetworkBuilder builder;
    for (int k = 0; k < 3; ++k) {
        const double angle = 2 * std::numbers::pi * k / 3;
        builder.arc(straight(Vec3::Zero(), {std::cos(angle), std::sin(angle), 0}, 4));
    }
    return builder.build();
}

FeatureCurveNetwork t_junction() {
    return NetworkBuilder()
        .arc(straight({-1, 0, 0}, {0, 0, 0}, 3), {0, 1})
        .arc(straight({0, 0, 0}, {2, 0, 0}, 3), {0, 2})
        .arc(straight({0, 0, 0}, {0, -4, 0}, 3), {1, 2})
        .build();
}

FeatureCurveNetwork cube(int samples) {
    // Patch of side "coordinate axis = value": 2 axis + value.
    NetworkBuilder builder;
    for (int axis = 0; axis < 3; ++axis)
        for (int u = 0; u < 2; ++u)
            for (int v = 0; v < 2; ++v) {
                const int first = (axis + 1) % 3, second = (axis + 2) % 3;
                Vec3 from = Vec3::Zero(), to = Vec3::Zero();
                from[first] = to[first] = u;
                from[second] = to[second] = v;
                to[axis] = 1;
                builder.arc(straight(from, to, samples), {2 * first + u, 2 * second + v});
            }
    return builder.build();
}

FeatureCurveNetwork circle(int count, const Vec3& center, double radius) {
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k) {
        const double angle = 2 * std::numbers::pi * k / count;
        points.push_back(center + radius * Vec3(std::cos(angle), std::sin(angle), 0));
    }
    points.push_back(points.front());
    return NetworkBuilder().arc(points).build();
}

FeatureCurveNetwork figure_eight(int count) {
    NetworkBuilder builder;
    for (int half = 0; half < 2; ++half) {
        std::vector<Vec3> points{Vec3::Zero()};
        for (int k = 1; k < count; ++k) {
            const double t = std::numbers::pi * (half + static_cast<double>(k) / count);
            points.push_back({std::sin(t), std::sin(t) * std::cos(t), 0});
        }
        points.push_back(Vec3::Zero());
        builder.arc(points);
    }
    return builder.build();
}

FeatureCurveNetwork two_loops() {
    FeatureCurveNetwork network = circle(8);
    const FeatureCurveNetwork other = circle(20, {5, 0, 1}, 2);
    network.nodes.push_back(other.nodes[0]);
    network.arcs.push_back(other.arcs[0]);
    network.arcs[1].nodes = {1, 1};
    return network;
}

FeatureCurveNetwork lasso() {
    const FeatureCurveNetwork loop = circle(64);  // starts at (1, 0, 0) heading for +y
    std::vector<Vec3> points;
    for (const ArcSample& sample : loop.arcs[0].samples) points.push_back(sample.position);
    return NetworkBuilder().arc(points).arc({{1, -3, 0}, {1, -1, 0}, {1, 0, 0}}).build();
}

FeatureCurveNetwork adapted_cube() {
    FeatureCurveNetwork network = cube(5);
    network.mesh_name = "unit \"cube\" \\ \xc3\xbc";
    network.mesh_hash = 0xfedcba9876543210u;
    network.units = "mm";
    network.diagonal = std::sqrt(3.0);
    network.scale = 0.4;
    network.ratio = 1.5;
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        NetworkArc& arc = network.arcs[a];
        arc.kind = static_cast<ArcKind>(a % 3);
        arc.pin = static_cast<Pin>(a / 3 % 3);
        arc.source = a % 2 ? "sharp" : "vsa";
        arc.dihedral = 0.1 * static_cast<double>(a) - 1.0 / 3.0;
        arc.origins.assign(4, static_cast<int>(a));
        arc.origins[3] = static_cast<int>(20 + a);
        for (std::size_t s = 0; s < arc.samples.size(); ++s)
            arc.samples[s].surface = {static_cast<int>(a), Vec3(0.1, 0.2, 0.7)};
        const int middle = static_cast<int>(network.nodes.size());
        network.nodes.push_back({arc.samples[2].position, {static_cast<int>(a), {1, 0, 0}}});
        const double weight = 1.0 / (3.0 + static_cast<double>(a));
        network.segments.push_back(
            {{arc.nodes[0], middle}, static_cast<int>(a), 0, 2, weight, false});
        network.segments.push_back(
            {{middle, arc.nodes[1]}, static_cast<int>(a), 2, 4, 2 * weight, a % 4 == 0});
    }
    find_curves(network);
    OrbitMember image;
    image.arc = 1;
    image.linear << 0, 1, 0, 1, 0, 0, 0, 0, -1;
    image.translation = {0.1, -0.2, 1e-300};
    image.is_reversed = true;
    OrbitMember representative;
    representative.arc = 0;
    network.orbits.push_back({{representative, image}});
    network.dropped.push_back({{{0, 0, 2}, {1, 0, 2}, {1, 1, 2}},
                               3,
                               2,
                               17,
                               "conflict",
                               {{4, 2, 20.25, "distance", 0.125}, {5}},
                               12.5,
                               7.75});
    network.dropped.push_back({{{1, 1, 2}, {1, 2, 2}}, -1, 0, -1, "short arc", {}, 0, {}});
    network.origin_curves = {0, 0, 1, -1};
    network.notes = {"boundary loop 3 is too small", "second note"};
    return network;
}

FeatureCurveNetwork random_network(std::uint64_t seed, int node_count, int arc_count) {
    std::mt19937_64 engine(seed);
    const auto draw = [&](int bound) { return static_cast<int>(engine() % bound); };
    const auto coordinate = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    const auto point = [&] { return Vec3(coordinate(), coordinate(), coordinate()); };
    std::vector<Vec3> nodes;
    for (int n = 0; n < node_count; ++n) nodes.push_back(point());
    NetworkBuilder builder;
    const bool has_patches = draw(2) == 0;
    for (int a = 0; a < arc_count; ++a) {
        const int from = draw(node_count), to = draw(node_count);
        std::vector<Vec3> points{nodes[from]};
        const int inner = draw(5) + (from == to ? 2 : 1);
        for (int k = 0; k < inner; ++k) points.push_back(point());
        points.push_back(nodes[to]);
        builder.arc(points, has_patches ? std::array<int, 2>{draw(4), draw(5) - 1}
                                        : std::array<int, 2>{-1, -1});
    }
    FeatureCurveNetwork network = builder.build();
    for (NetworkArc& arc : network.arcs) {
        arc.kind = draw(4) == 0 ? ArcKind::Boundary : ArcKind::Feature;
        arc.pin = draw(4) == 0 ? Pin::Keep : Pin::None;
        arc.source = draw(4) == 0 ? "sharp" : "vsa";
        arc.dihedral = coordinate() - 0.5;
    }
    return network;
}

LoadedMesh cube_mesh(int count) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int i = 0; i < count; ++i)
                for (int j = 0; j < count; ++j) {
                    const int first = static_cast<int>(points.size());
                    for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                        Vec3 p;
                        p[axis] = side;
                        p[(axis + 1) % 3] = static_cast<double>(i + u) / count;
                        p[(axis + 2) % 3] = static_cast<double>(j + v) / count;
                        points.push_back(p);
                    }
                    for (int half = 1; half <= 2; ++half) {
                        std::array<int, 3> triangle{first, first + half, first + half + 1};
                        if (side == 0) std::swap(triangle[1], triangle[2]);  // outward normals
                        triangles.push_back(triangle);
                    }
                }
    return mesh_from_soup(points, triangles);
}

std::map<std::pair<Coordinates, Coordinates>, int> intervals(const FeatureCurveNetwork& network) {
    std::map<std::pair<Coordinates, Coordinates>, int> count;
    for (const NetworkArc& arc : network.arcs)
        for (std::size_t s = 1; s < arc.samples.size(); ++s) {
            const Vec3 &a = arc.samples[s - 1].position, &b = arc.samples[s].position;
            Coordinates p{a[0], a[1], a[2]}, q{b[0], b[1], b[2]};
            if (q < p) std::swap(p, q);
            ++count[{p, q}];
        }
    return count;
}

std::vector<std::vector<Vec3>> polylines(const FeatureCurveNetwork& network) {
    std::vector<std::vector<Vec3>> all;
    for (const NetworkArc& arc : network.arcs) {
        all.emplace_back();
        for (const ArcSample& sample : arc.samples) all.back().push_back(sample.position);
    }
    return all;
}

}  // namespace fcn::testing
