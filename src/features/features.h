#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// A mesh edge path becomes arcs: marks edges, this traces them into nodes and arcs. Nodes are
/// marked vertices of valence != 2, corners given by the caller, and one per closed chain.
/// `patch_of_face` (may be empty) fills arc.patches and splits arcs where the pair changes.
FeatureCurveNetwork network_from_edges(const Mesh& mesh, const std::vector<bool>& is_marked_edge,
                                       const std::vector<int>& patch_of_face,
                                       const std::string& source);

enum class SharpSign { Both, Convex, Concave };

struct SharpOptions {
    double high_angle = 0.6981317007977318;  ///< radians (40 degrees): an edge above it is a seed
    double low_angle = 0.3141592653589793;   ///< radians (18 degrees): chains continue above it
    SharpSign sign = SharpSign::Both;
    double min_length = 0;  ///< shorter connected chains are dropped; mesh units
    bool is_plain = false;  ///< every edge of high_angle and more; nothing above is looked at
};

/// Sharp edges by dihedral hysteresis, or by a plain threshold.
FeatureCurveNetwork detect_sharp(const LoadedMesh& mesh, const SharpOptions& options = {});

/// Edges whose dihedral angle is at least `angle` (radians, in (0, pi]) and no others; per edge.
/// Linear time.
std::vector<bool> edges_above(const Mesh& mesh, double angle);

/// Numbers of the parts into which marked edges divide the faces, from 0 in the order of their
/// first faces; per face. Linear time.
std::vector<int> patches_between(const Mesh& mesh, const std::vector<bool>& is_marked_edge);

struct VsaOptions {
    int patch_count = 100;
    int max_iterations = 40;       ///< of Lloyd clustering
    std::vector<int> seed_faces;   ///< optional; fixes the first seeds
    bool is_straightening = true;  ///< straighten the patch borders
    double min_patch_area = 0;     ///< relative to the mean patch; smaller ones dissolve
    /// Patches with less error per area are not split: about 0.06 degrees. detect_vsa() raises it
    /// to what noise leaves.
    double negligible_error = 1e-6;
    /// Radians (40 degrees): creases above it that no patch border takes become arcs of their own
    /// (both their patches are the same); 0 = none.
    double crease_angle = 0.6981317007977318;
    int threads = 1;
};

struct VsaResult {
    std::vector<int> patch_of_face;
    std::vector<Vec3> proxy_normals;
    double error = 0;  ///< sum of area * |n_f - N_patch|^2
    int iterations = 0;
};

/// Variational shape approximation, L2,1 metric (Cohen-Steiner, Alliez, Desbrun 2004).
VsaResult segment_vsa(const Mesh& mesh, const VsaOptions& options = {});

/// Patch borders of segment_vsa as a network, straightened, with patch ids on every arc.
FeatureCurveNetwork detect_vsa(const LoadedMesh& mesh, const VsaOptions& options = {});

enum class BoundaryPolicy { Keep, Adapt, Ignore };

/// Adds mesh boundaries (ArcKind::Boundary) and borders between face labels
/// (ArcKind::LabelBorder) to a detected network whose arcs run along mesh edges or across faces:
/// Keep pins them, Adapt adds them unpinned, Ignore adds nothing. Features that run along a
/// border are replaced by it; features that meet it get a node there. Corners of more than
/// corner_angle (radians) of a boundary become nodes.
FeatureCurveNetwork add_boundaries(const FeatureCurveNetwork& network, const LoadedMesh& mesh,
                                   BoundaryPolicy policy, double corner_angle = 0.7853981633974483);

}  // namespace fcn
