// Variational shape approximation, L2,1 metric (Cohen-Steiner, Alliez, Desbrun 2004), multilevel.
//
// Large meshes are first coarsened into a few ten connected clusters of faces per patch, which
// loses nothing in the error (see vsa_items.h). On that graph regions are split where it gains
// most, in batches that grow with their number, with exchange of border items after each batch;
// then teleports, and Lloyd floods from the best fitted items as long as they help. The patches of
// the faces are refined by the same exchange. Departures from the paper and why: vsa_partition.cpp.
//
// Fewer patches than asked for come out only where the mesh has no more error to split (every
// patch is flat), or fewer faces; more only where it has more connected components.

#include "features/vsa.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "features/features.h"
#include "features/vsa_partition.h"
#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr int kMinCoarseItems = 2500;
constexpr int kItemsPerPatch = 70;
constexpr std::array<double, 2> kBatchShares{0.2, 0.4};  // regions split at once
constexpr int kCoarseSweeps = 30;
constexpr int kFineSweeps = 100;
constexpr int kDissolveRounds = 5;
constexpr double kLloydGain = 1e-4;  // relative; a smaller gain ends the iteration

void check_options(const MeshArrays& arrays, const VsaOptions& options) {
    if (options.patch_count < 1) {
        throw InputError("VSA: patch count must be >= 1, got " +
                         std::to_string(options.patch_count));
    }
    if (options.max_iterations < 0) {
        throw InputError("VSA: iterations must be >= 0, got " +
                         std::to_string(options.max_iterations));
    }
    if (!(options.negligible_error >= 0)) {
        throw InputError("VSA: negligible error must be >= 0, got " +
                         std::to_string(options.negligible_error));
    }
    if (!(options.min_patch_area >= 0)) {
        throw InputError("VSA: minimum patch area must be >= 0, got " +
                         std::to_string(options.min_patch_area));
    }
    for (int face : options.seed_faces) {
        if (face < 0 || face >= arrays.face_count()) {
            throw InputError("VSA: seed face " + std::to_string(face) + " is not one of the " +
                             std::to_string(arrays.face_count()) + " faces");
        }
    }
}

std::vector<int> unique_seeds(const VsaOptions& options) {
    std::vector<int> seeds;
    for (int face : options.seed_faces) {
        if (static_cast<int>(seeds.size()) == options.patch_count) break;
        if (std::find(seeds.begin(), seeds.end(), face) == seeds.end()) seeds.push_back(face);
    }
    return seeds;
}

void grow_to(RegionPartition& partition, int patch_count, double batch_share) {
    while (partition.region_count() < patch_count) {
        const int batch =
            std::max(1, static_cast<int>(std::ceil(batch_share * partition.region_count())));
        const int added =
            partition.split_best(std::min(batch, patch_count - partition.region_count()));
        if (added == 0) break;
        partition.refine(kCoarseSweeps);
    }
}

/// Teleports and Lloyd floods until neither lowers the error; returns the number of rounds.
/// Whatever does not lower the error is undone.
int relax(RegionPartition& partition, int fixed_count, int max_iterations) {
    const int count = partition.region_count();
    const auto attempt = [&](const auto& change) {
        const double before = partition.error();
        const std::vector<int> regions = partition.region_of_item();
        change();
        partition.refine(kCoarseSweeps);
        if (partition.error() >= before) partition.assign(regions, count);
    };
    int iterations = 0;
    while (iterations < max_iterations) {
        ++iterations;
        const double before = partition.error();
        attempt([&] { partition.teleport(fixed_count); });
        partition.search_teleports(fixed_count);
        attempt([&] { partition.flood(partition.best_items()); });
        if (partition.error() >= (1 - kLloydGain) * before) break;
    }
    return iterations;
}

/// Grows in batches of several sizes and keeps the best: where one gets stuck is chance.
void grow_best(RegionPartition& partition, int fixed_count, const VsaOptions& options) {
    const std::vector<int> start = partition.region_of_item();
    const int start_count = partition.region_count();
    std::vector<int> best;
    int best_count = 0;
    double best_error = std::numeric_limits<double>::infinity();
    for (double share : kBatchShares) {
        partition.assign(start, start_count);
        grow_to(partition, options.patch_count, share);
        relax(partition, fixed_count, std::min(1, options.max_iterations));
        if (partition.error() >= best_error) continue;
        best_error = partition.error();
        best = partition.region_of_item();
        best_count = partition.region_count();
    }
    partition.assign(best, best_count);
}

void dissolve_and_refill(RegionPartition& partition, double relative_area, double total_area,
                         int fixed_count, int patch_count) {
    for (int round = 0; round < kDissolveRounds; ++round) {
        const double area = relative_area * total_area / partition.region_count();
        if (partition.dissolve(area, fixed_count) == 0) return;
        grow_to(partition, patch_count, kBatchShares.front());
        partition.teleport(fixed_count);
        partition.refine(kCoarseSweeps);
    }
}

VsaResult describe(const MeshArrays& arrays, const RegionPartition& partition, int iterations) {
    VsaResult result;
    result.iterations = iterations;
    result.patch_of_face.resize(arrays.face_count());
    std::vector<int> id(partition.region_count(), -1);
    for (int f = 0; f < arrays.face_count(); ++f) {
        int& patch = id[partition.region_of_item()[f]];
        if (patch < 0) {
            patch = static_cast<int>(result.proxy_normals.size());
            result.proxy_normals.push_back(Vec3::Zero());
        }
        result.patch_of_face[f] = patch;
        result.proxy_normals[patch] += arrays.areas[f] * arrays.normals[f];
    }
    for (Vec3& normal : result.proxy_normals) normal.normalize();
    for (int f = 0; f < arrays.face_count(); ++f) {
        const Vec3 offset = arrays.normals[f] - result.proxy_normals[result.patch_of_face[f]];
        result.error += arrays.areas[f] * offset.squaredNorm();
    }
    return result;
}

}  // namespace

VsaResult segment_vsa(const MeshArrays& arrays, const VsaOptions& options) {
    check_options(arrays, options);
    if (arrays.face_count() == 0) return {};
    const ItemGraph faces = face_items(arrays);
    const std::vector<int> seeds = unique_seeds(options);
    const int fixed_count = static_cast<int>(seeds.size());
    const Coarsening coarse =
        coarsen(faces, std::max(kMinCoarseItems, kItemsPerPatch * options.patch_count), seeds,
                options.threads);
    std::vector<int> coarse_seeds;
    for (int face : seeds) coarse_seeds.push_back(coarse.item_of_item[face]);

    RegionPartition partition(coarse.graph, coarse_seeds, options.negligible_error);
    partition.flood(coarse_seeds);
    partition.refine(kCoarseSweeps);
    grow_best(partition, fixed_count, options);
    const int iterations = relax(partition, fixed_count, options.max_iterations);
    double total_area = 0;
    for (double area : arrays.areas) total_area += area;
    dissolve_and_refill(partition, options.min_patch_area, total_area, fixed_count,
                        options.patch_count);

    std::vector<int> region_of_face(arrays.face_count());
    for (int f = 0; f < arrays.face_count(); ++f) {
        region_of_face[f] = partition.region_of_item()[coarse.item_of_item[f]];
    }
    RegionPartition fine(faces, seeds);
    fine.assign(region_of_face, partition.region_count());
    fine.refine(kFineSweeps);
    fine.dissolve(options.min_patch_area * total_area / fine.region_count(), fixed_count);
    return describe(arrays, fine, iterations);
}

VsaResult segment_vsa(const Mesh& mesh, const VsaOptions& options) {
    return segment_vsa(mesh_arrays(mesh, options.threads), options);
}

}  // namespace fcn
