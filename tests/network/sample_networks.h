#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn::testing {

/// Builds networks from node positions and polylines; nodes are where the polylines' ends are.
class NetworkBuilder {
public:
    /// Adds an arc through the points; a node is shared where positions are equal.
    NetworkBuilder& arc(const std::vector<Vec3>& points, std::array<int, 2> patches = {-1, -1});
    FeatureCurveNetwork build() const { return network_; }

private:
    int node_at(const Vec3& position);
    FeatureCurveNetwork network_;
};

/// Three arcs from the origin at 120 degrees, no patches.
FeatureCurveNetwork y_junction();
/// A straight bar (arcs 0, 1; patches 0|1 and 0|2) and a stem (arc 2; patches 1|2).
FeatureCurveNetwork t_junction();
/// The 12 edges of the unit cube with the 6 sides as patches, `samples` samples an arc.
FeatureCurveNetwork cube(int samples = 5);
/// A regular polygon of `count` corners as one closed arc of valence 2.
FeatureCurveNetwork circle(int count = 12, const Vec3& center = Vec3::Zero(), double radius = 1);
/// A lemniscate: two closed arcs through one node that continue each other straight.
FeatureCurveNetwork figure_eight(int count = 32);
/// Two circles without a common node.
FeatureCurveNetwork two_loops();
/// A circle with a straight tail that leaves it tangentially.
FeatureCurveNetwork lasso();
/// The cube, adapted: segments, curves, an orbit, dropped pieces, notes: every field is set.
FeatureCurveNetwork adapted_cube();

/// Random points on a lattice joined by random polylines: loops, parallel and closed arcs, random
/// patches, kinds, pins and sources. Valid; the same for the same seed on every machine.
FeatureCurveNetwork random_network(std::uint64_t seed, int node_count, int arc_count);

/// The unit cube's surface, each side cut into count x count squares of two triangles; the edges of
/// cube(count + 1) are edges of it.
LoadedMesh cube_mesh(int count = 4);

using Coordinates = std::array<double, 3>;
/// Every sample interval of the network's arcs, undirected, with its multiplicity: its geometry.
std::map<std::pair<Coordinates, Coordinates>, int> intervals(const FeatureCurveNetwork& network);

/// The positions of each arc's samples.
std::vector<std::vector<Vec3>> polylines(const FeatureCurveNetwork& network);

}  // namespace fcn::testing
