// Coarsening of the face graph before variational shape approximation. Each round every item picks
// the neighbour with which its union has the least L2,1 error increase per area; pairs that pick
// each other merge. Ties (flat areas) are broken by a hash of the pair, otherwise whole rows would
// pick along one direction and few pairs were mutual. Clusters stop growing at a few times the
// mean size, so that flat areas remain divisible, and never bend by more than the worst pair a
// round may take: the quarter of the most expensive pairs waits for the next round, which keeps
// creases out of the clusters while there is anything flatter to merge.

#include "features/vsa_items.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fcn {
namespace {

constexpr double kSizeFactor = 4;    // largest cluster, in mean clusters
constexpr double kKeptShare = 0.75;  // of the mutual pairs of a round
constexpr int kMaxRounds = 40;

std::uint64_t pair_hash(int a, int b) {
    std::uint64_t x = (static_cast<std::uint64_t>(std::min(a, b)) << 32) ^
                      static_cast<std::uint64_t>(std::max(a, b));
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ULL;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

/// Error increase of a union, relative to its area; 2 (1 - cos) of the mean normals in the limit.
double union_cost(const ItemGraph& graph, int a, int b) {
    const double area = graph.areas[a] + graph.areas[b];
    if (!(area > 0)) return 0;
    const double increase = graph.normals[a].norm() + graph.normals[b].norm() -
                            (graph.normals[a] + graph.normals[b]).norm();
    const double cost = 2 * std::max(0.0, increase) / area;
    return cost < 1e-12 ? 0 : cost;
}

struct Choice {
    int partner = -1;
    double cost = std::numeric_limits<double>::infinity();
    std::uint64_t hash = 0;
};

Choice best_partner(const ItemGraph& graph, const std::vector<int>& face_counts, int max_faces,
                    int item) {
    Choice best;
    for (const int* n = graph.neighbors.begin(item); n != graph.neighbors.end(item); ++n) {
        if (face_counts[item] + face_counts[*n] > max_faces) continue;
        const double cost = union_cost(graph, item, *n);
        const std::uint64_t hash = pair_hash(item, *n);
        if (cost < best.cost || (cost == best.cost && hash < best.hash)) best = {*n, cost, hash};
    }
    return best;
}

/// New ids for the merged items: `partner[i]` merges i with it, -1 keeps it alone.
std::vector<int> merged_ids(const std::vector<int>& partner, int& count) {
    std::vector<int> id(partner.size(), -1);
    count = 0;
    for (std::size_t i = 0; i < partner.size(); ++i) {
        if (id[i] >= 0) continue;
        id[i] = count;
        if (partner[i] >= 0) id[partner[i]] = count;
        ++count;
    }
    return id;
}

ItemGraph contract(const ItemGraph& fine, const std::vector<int>& id, int count) {
    ItemGraph coarse;
    coarse.normals.assign(count, Vec3::Zero());
    coarse.areas.assign(count, 0);
    std::vector<std::array<int, 2>> members(count, {-1, -1});
    for (int i = 0; i < fine.size(); ++i) {
        coarse.normals[id[i]] += fine.normals[i];
        coarse.areas[id[i]] += fine.areas[i];
        members[id[i]][members[id[i]][0] < 0 ? 0 : 1] = i;
    }
    coarse.neighbors.offsets.assign(1, 0);
    coarse.neighbors.offsets.reserve(count + 1);
    coarse.neighbors.values.reserve(fine.neighbors.values.size());
    std::vector<int>& values = coarse.neighbors.values;
    for (int c = 0; c < count; ++c) {
        const auto start = static_cast<std::ptrdiff_t>(values.size());
        for (int member : members[c]) {
            if (member < 0) continue;
            for (const int* n = fine.neighbors.begin(member); n != fine.neighbors.end(member);
                 ++n) {
                if (id[*n] != c) values.push_back(id[*n]);
            }
        }
        std::sort(values.begin() + start, values.end());
        values.erase(std::unique(values.begin() + start, values.end()), values.end());
        coarse.neighbors.offsets.push_back(static_cast<int>(values.size()));
    }
    return coarse;
}

/// The mutual best pairs of one round without the most expensive ones.
std::vector<int> mutual_pairs(const ItemGraph& graph, const std::vector<int>& face_counts,
                              int max_faces, int max_pairs) {
    std::vector<Choice> choices(graph.size());
    tbb::parallel_for(tbb::blocked_range<int>(0, graph.size(), 2048),
                      [&](const tbb::blocked_range<int>& range) {
                          for (int i = range.begin(); i < range.end(); ++i) {
                              choices[i] = best_partner(graph, face_counts, max_faces, i);
                          }
                      });
    struct Pair {
        double cost;
        std::uint64_t hash;
        int item;
    };
    std::vector<Pair> pairs;
    for (int i = 0; i < graph.size(); ++i) {
        const int p = choices[i].partner;
        if (p > i && choices[p].partner == i)
            pairs.push_back({choices[i].cost, choices[i].hash, i});
    }
    const auto kept = std::min<std::size_t>(
        max_pairs, static_cast<std::size_t>(std::ceil(kKeptShare * pairs.size())));
    std::nth_element(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(kept), pairs.end(),
                     [](const Pair& a, const Pair& b) {
                         return a.cost != b.cost ? a.cost < b.cost : a.hash < b.hash;
                     });
    std::vector<int> partner(graph.size(), -1);
    for (std::size_t k = 0; k < kept; ++k) {
        const int i = pairs[k].item, p = choices[i].partner;
        partner[i] = p;
        partner[p] = i;
    }
    return partner;
}

}  // namespace

ItemGraph face_items(const MeshArrays& arrays) {
    ItemGraph graph;
    const int count = arrays.face_count();
    graph.areas = arrays.areas;
    graph.normals.resize(count);
    graph.neighbors.offsets.assign(1, 0);
    graph.neighbors.offsets.reserve(count + 1);
    graph.neighbors.values.reserve(3 * static_cast<std::size_t>(count));
    for (int f = 0; f < count; ++f) {
        graph.normals[f] = arrays.areas[f] * arrays.normals[f];
        std::array<int, 3> row = arrays.face_neighbors[f];
        std::sort(row.begin(), row.end());
        for (int i = 0; i < 3; ++i) {
            if (row[i] >= 0 && (i == 0 || row[i] != row[i - 1])) {
                graph.neighbors.values.push_back(row[i]);
            }
        }
        graph.neighbors.offsets.push_back(static_cast<int>(graph.neighbors.values.size()));
    }
    return graph;
}

Coarsening coarsen(const ItemGraph& fine, int target_count, const std::vector<int>& single_items,
                   int threads) {
    Coarsening result;
    result.graph = fine;
    result.item_of_item.resize(fine.size());
    for (int i = 0; i < fine.size(); ++i) result.item_of_item[i] = i;
    if (target_count <= 0) return result;
    const int max_faces = std::max(2, static_cast<int>(kSizeFactor * fine.size() / target_count));
    std::vector<int> face_counts(fine.size(), 1);
    for (int item : single_items) face_counts[item] = max_faces;
    tbb::task_arena arena(std::max(1, threads));
    for (int round = 0; round < kMaxRounds && result.graph.size() > target_count; ++round) {
        std::vector<int> partner;
        arena.execute([&] {
            partner = mutual_pairs(result.graph, face_counts, max_faces,
                                   result.graph.size() - target_count);
        });
        int count = 0;
        const std::vector<int> id = merged_ids(partner, count);
        if (count == result.graph.size()) break;
        std::vector<int> counts(count, 0);
        for (int i = 0; i < result.graph.size(); ++i) counts[id[i]] += face_counts[i];
        face_counts = std::move(counts);
        result.graph = contract(result.graph, id, count);
        for (int& item : result.item_of_item) item = id[item];
    }
    return result;
}

}  // namespace fcn
