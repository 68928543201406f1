// From patches to feature curves. Sharp creases are arcs of the network in any case, also where no
// patch border takes them because both sides fit the same proxy or the crease ends inside a patch:
// an isolated sharp crease is never missing. So patches that spill over a crease are ended there
// (crease_patches.cpp), the other borders are moved onto weaker creases (border_cut.cpp), all are
// traced, and the arcs are smoothed where they do not run along creases (straighten.cpp). On a
// noisy mesh all of this works on filtered normals, and patches end up no flatter than noise
// allows: what noise leaves is flat.

#include <algorithm>
#include <cmath>

#include "features/border_cut.h"
#include "features/crease_patches.h"
#include "features/edge_chains.h"
#include "features/sharp_edges.h"
#include "features/straighten.h"
#include "features/vsa.h"

namespace fcn {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kBorderCreaseHigh = 30 * kDegree;  // creases that attract and hold borders
constexpr double kBorderCreaseLow = 24 * kDegree;
constexpr double kFacetHigh = 40 * kDegree;  // a crease even where the like run beside it
constexpr double kNoiseShare = 16;           // of what noise leaves: negligible in a patch
constexpr int kBorderCreaseEdges = 3;
constexpr double kOwnCreaseLow = 28 * kDegree;  // how far a crease of its own continues
constexpr int kOwnCreaseEdges = 5;

std::vector<bool> patch_borders(const MeshArrays& arrays, const std::vector<int>& patch_of_face) {
    std::vector<bool> is_border(arrays.edge_count(), false);
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const auto [f, g] = arrays.edge_faces[e];
        is_border[e] = f >= 0 && g >= 0 && patch_of_face[f] != patch_of_face[g];
    }
    return is_border;
}

/// Angles without those of facets: of edges that are not sharp and have the like beside them.
RobustDihedrals crease_angles(const MeshArrays& arrays, RobustDihedrals dihedrals) {
    std::vector<double>& angles = dihedrals.angles;
    std::vector<int> facets;
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const double angle = std::abs(angles[e]);
        if (angle < kBorderCreaseLow || angle >= kFacetHigh) continue;
        if (!is_isolated(arrays, angles, e)) facets.push_back(e);
    }
    for (int e : facets) angles[e] = 0;
    return dihedrals;
}

std::vector<bool> border_creases(const MeshArrays& arrays, const RobustDihedrals& angles,
                                 const std::vector<int>& face_labels) {
    SharpOptions options;
    options.high_angle = kBorderCreaseHigh;
    options.low_angle = kBorderCreaseLow;
    std::vector<bool> is_crease = sharp_edges(arrays, angles, options, kBorderCreaseEdges);
    for (int e = 0; e < arrays.edge_count() && !face_labels.empty(); ++e) {
        const auto [f, g] = arrays.edge_faces[e];
        if (f >= 0 && g >= 0 && face_labels[f] != face_labels[g]) is_crease[e] = true;
    }
    return is_crease;
}

std::vector<bool> own_creases(const MeshArrays& arrays, const RobustDihedrals& angles,
                              double crease_angle) {
    if (!(crease_angle > 0)) return std::vector<bool>(arrays.edge_count(), false);
    SharpOptions options;
    options.high_angle = crease_angle;
    options.low_angle = std::min(crease_angle, kOwnCreaseLow);
    return sharp_edges(arrays, angles, options, kOwnCreaseEdges);
}

}  // namespace

FeatureCurveNetwork detect_vsa(const LoadedMesh& mesh, const VsaOptions& options) {
    MeshArrays arrays = mesh_arrays(mesh.mesh, options.threads);
    const RobustDihedrals angles = robust_dihedrals(arrays, kBorderCreaseLow, options.threads);
    VsaOptions segmentation = options;
    if (!angles.normals.empty()) {
        arrays.normals = angles.normals;
        segmentation.negligible_error =
            std::max(options.negligible_error, kNoiseShare * angles.residual);
    }
    VsaResult patches = segment_vsa(arrays, segmentation);
    const RobustDihedrals sharp = crease_angles(arrays, angles);
    const std::vector<bool> is_own = own_creases(arrays, angles, options.crease_angle);
    end_patches_at_creases(arrays, is_own, patches);
    if (options.is_straightening) {
        patches.patch_of_face = move_borders(arrays, sharp.angles, mesh.face_labels,
                                             patches.patch_of_face, patches.proxy_normals);
    }
    std::vector<bool> is_marked = patch_borders(arrays, patches.patch_of_face);
    for (int e = 0; e < arrays.edge_count(); ++e) is_marked[e] = is_marked[e] || is_own[e];
    EdgeNetwork edges = trace_edges(arrays, is_marked, patches.patch_of_face, "vsa");
    FeatureCurveNetwork network = std::move(edges.network);
    if (options.is_straightening) {
        std::vector<bool> is_crease = border_creases(arrays, sharp, mesh.face_labels);
        for (int e = 0; e < arrays.edge_count(); ++e) is_crease[e] = is_crease[e] || is_own[e];
        edges.network = std::move(network);
        network = straighten(arrays, edges, is_crease);
    }
    set_provenance(network, mesh);
    return network;
}

}  // namespace fcn
