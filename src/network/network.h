#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// Why an arc is in the network at all.
enum class ArcKind { Feature, Boundary, LabelBorder };

/// The user's (or the boundary's) word on an arc: forced in, forced out, or free.
enum class Pin { None, Keep, Drop };

/// A dense sample of an arc: a position on the surface.
struct ArcSample {
    Vec3 position = Vec3::Zero();
    SurfacePoint surface;  ///< face = -1 when unknown (imported without a mesh)
};

struct NetworkNode {
    Vec3 position = Vec3::Zero();
    SurfacePoint surface;
};

/// A maximal chain of the network between two extraordinary nodes, or a closed one.
struct NetworkArc {
    std::array<int, 2> nodes{-1, -1};  ///< ends; equal for a closed arc
    /// Dense polyline from node to node, both ends included, at least 2 samples (4 when closed:
    /// the last repeats the first).
    std::vector<ArcSample> samples;
    /// Per sample interval (samples - 1 entries) the arc of the *initial* network it came from;
    /// empty in an initial network (then each interval's origin is the arc itself).
    std::vector<int> origins;
    int curve = -1;                      ///< supporting curve, index into curves; -1 unknown
    std::array<int, 2> patches{-1, -1};  ///< patch left and right of the arc; -1 unknown
    ArcKind kind = ArcKind::Feature;
    Pin pin = Pin::None;
    std::string source;  ///< detector: "sharp", "vsa", "boundary", "import", ...
    /// Length-weighted mean signed dihedral angle over the arc, radians, > 0 convex; 0 unknown.
    double dihedral = 0;
    double length() const;
    bool is_closed() const { return nodes[0] == nodes[1]; }
};

/// A straight piece of a resampled arc between two nodes.
struct NetworkSegment {
    std::array<int, 2> nodes{-1, -1};
    int arc = -1;
    int first_sample = 0;  ///< in arc.samples; first_sample < last_sample
    int last_sample = 0;
    double weight = 0;     ///< w(e), real units
    bool is_long = false;  ///< longer than rmax on purpose, at most one an arc
};

/// Arcs that continue each other through nodes.
struct NetworkCurve {
    std::vector<int> arcs;          ///< in order along the curve
    std::vector<bool> is_reversed;  ///< per arc
    bool is_closed = false;
    double length = 0;
};

/// Arc `arc` is the image of the orbit's first member under x -> linear * x + translation.
struct OrbitMember {
    int arc = -1;
    Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
    Vec3 translation = Vec3::Zero();
    bool is_reversed = false;  ///< the image runs against the member's own direction
};

struct SymmetryOrbit {
    std::vector<OrbitMember> members;  ///< the first is the representative (identity)
};

/// A label that was kept against a dropped piece.
struct Blocker {
    int label = -1;        ///< of the problem of DroppedPiece::iteration, 0-based
    int origin_arc = -1;   ///< arc of the initial network; -1: the label of a node
    double weight = 0;     ///< of the label, real units
    std::string conflict;  ///< "angle", "distance", "crossing", "nodes", or "rule"
    /// Angle in radians, or distance in mesh units, between the two; 0 for a rule.
    double measured = 0;
    bool operator==(const Blocker&) const = default;
};

/// A piece of the initial network that adaptation did not keep.
struct DroppedPiece {
    std::vector<Vec3> polyline;
    int origin_arc = -1;  ///< arc of the initial network
    int iteration = 0;    ///< 1-based; 0 = before the first labeling
    int label = -1;       ///< label in that iteration's problem, 0-based; -1 none
    std::string reason;   ///< "conflict", "rule", "short arc", "closed arc without three segments",
                          ///< "pinned out", "crumb"
    std::vector<Blocker> blockers;  ///< ascending labels
    double weight = 0;              ///< w(e), real units
    /// What the objective would lose, in real units, with this label in and its blockers out (with
    /// their bonuses); none where that breaks a rule, or where there was no label.
    std::optional<double> margin;
};

/// Feature curve network on a mesh (Gehre, Lim, Kobbelt 2016, Definition 1). An initial network
/// has nodes and arcs; an adapted one also has segments, and every arc is a chain of them.
struct FeatureCurveNetwork {
    std::string mesh_name;
    std::uint64_t mesh_hash = 0;
    std::string units;
    double diagonal = 0;  ///< of the mesh's bounding box
    double scale = 0;     ///< rmin of an adapted network; 0 in an initial one
    double ratio = 0;     ///< rho of an adapted network
    std::vector<NetworkNode> nodes;
    std::vector<NetworkArc> arcs;
    std::vector<NetworkSegment> segments;
    std::vector<NetworkCurve> curves;
    std::vector<SymmetryOrbit> orbits;
    std::vector<DroppedPiece> dropped;
    /// Of an adapted network: the supporting curve of each arc of the initial one.
    std::vector<int> origin_curves;
    std::vector<std::string> notes;  ///< what a user must know: short boundary loops, ...

    bool is_adapted() const { return !segments.empty() || scale > 0; }
    double total_length() const;  ///< of all arcs' dense polylines
    /// Number of arc ends at each node (a closed arc counts twice at its node).
    std::vector<int> valences() const;
};

/// Problems that validate() can find; empty = all invariants hold: indices in range; arc ends
/// coincide with their nodes; samples finite, consecutive ones distinct; closed arcs closed;
/// segments of an arc tile its samples in order and meet at shared nodes; barycentric coordinates
/// valid; every node is used; curves chain through shared nodes; orbit members exist, once each.
std::vector<std::string> validate(const FeatureCurveNetwork& network);
/// With the mesh: also faces in range and positions within 1e-6 diagonals of the surface point.
std::vector<std::string> validate(const FeatureCurveNetwork& network, const Mesh& mesh);

/// Merges arcs through every node of exactly two arc ends unless their kind, pin or source
/// differ, patches are lost, one is part of an orbit, or the result would be no valid arc (closed
/// with fewer than 4 samples, two long segments); drops unused nodes. Deterministic. Expects a
/// network that passes validate().
FeatureCurveNetwork merge_regular_nodes(const FeatureCurveNetwork& network);

struct CurveOptions {
    /// Without patch ids an arc is continued only while it turns less than this (radians).
    double max_turning = 0.7853981633974483;
    /// Tangents are taken over this length from the node (mesh units; 0 = first sample).
    double tangent_length = 0;
};

/// The paper's supporting curves (section 5.3.1): each arc is extended at both ends by the arc
/// that continues it most straightly, while that one borders a patch of the starting arc
/// (VSA: this stops at T-nodes); without patch ids while it turns less than max_turning. Fills
/// `curves` and arc.curve with a partition into mutually continuing chains.
void find_curves(FeatureCurveNetwork& network, const CurveOptions& options = {});

/// Length and closedness of each arc's own extended curve (not a partition: each arc starts its
/// own extension, as L(e) and Loop(e) ask).
struct SupportingCurve {
    double length = 0;
    bool is_loop = false;  ///< closed arc, or an extension that returns to its start
};
std::vector<SupportingCurve> supporting_curves(const FeatureCurveNetwork& network,
                                               const CurveOptions& options = {});

}  // namespace fcn
