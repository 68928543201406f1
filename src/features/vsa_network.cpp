// From patches to feature curves. The borders of variational shape approximation are moved onto
// creases (border_cut.cpp) and traced; sharp creases that no border takes, because both sides fit
// the same proxy or the crease ends inside a patch, become arcs of their own, whose two patches are
// the same: an isolated sharp crease is never missing from the network. Then the arcs are smoothed
// where they do not run along creases (straighten.cpp).

#include <cmath>

#include "features/border_cut.h"
#include "features/edge_chains.h"
#include "features/sharp_edges.h"
#include "features/straighten.h"
#include "features/vsa.h"

namespace fcn {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kBorderCreaseHigh = 30 * kDegree;  // creases that attract and hold borders
constexpr double kBorderCreaseLow = 24 * kDegree;
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

std::vector<bool> border_creases(const MeshArrays& arrays, const std::vector<double>& angles,
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

}  // namespace

FeatureCurveNetwork detect_vsa(const LoadedMesh& mesh, const VsaOptions& options) {
    const MeshArrays arrays = mesh_arrays(mesh.mesh, options.threads);
    const VsaResult patches = segment_vsa(arrays, options);
    const std::vector<double> angles = robust_dihedrals(arrays, kBorderCreaseLow, options.threads);
    std::vector<int> patch_of_face = patches.patch_of_face;
    if (options.is_straightening) {
        patch_of_face =
            move_borders(arrays, angles, mesh.face_labels, patch_of_face, patches.proxy_normals);
    }
    std::vector<bool> is_marked = patch_borders(arrays, patch_of_face);
    if (options.crease_angle > 0) {
        SharpOptions creases;
        creases.high_angle = options.crease_angle;
        creases.low_angle = std::min(options.crease_angle, kOwnCreaseLow);
        const std::vector<bool> is_sharp = sharp_edges(arrays, angles, creases, kOwnCreaseEdges);
        for (int e = 0; e < arrays.edge_count(); ++e) is_marked[e] = is_marked[e] || is_sharp[e];
    }
    EdgeNetwork edges = trace_edges(arrays, is_marked, patch_of_face, "vsa");
    FeatureCurveNetwork network =
        options.is_straightening
            ? straighten(arrays, edges, border_creases(arrays, angles, mesh.face_labels))
            : std::move(edges.network);
    set_provenance(network, mesh);
    return network;
}

}  // namespace fcn
