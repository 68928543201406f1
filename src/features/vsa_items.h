#pragma once

#include <vector>

#include "features/mesh_arrays.h"

namespace fcn {

/// Connected pieces of a surface and who borders whom: single faces, or clusters of them. The
/// L2,1 error of any union of items about its own best proxy is 2 (area - |normal|), with area
/// and area-weighted normal summed over the items, so clusters lose nothing.
struct ItemGraph {
    std::vector<Vec3> normals;  ///< per item: integral of the unit normal
    std::vector<double> areas;
    IndexRows neighbors;  ///< ascending, no duplicates
    int size() const { return static_cast<int>(areas.size()); }
};

ItemGraph face_items(const MeshArrays& arrays);

struct Coarsening {
    ItemGraph graph;
    std::vector<int> item_of_item;  ///< per fine item its cluster
};

/// Merges neighbouring items into about `target_count` connected clusters, pairs with the least
/// error increase first, in rounds of mutual best pairs; `single_items` are merged with nothing.
/// Same result on any number of threads.
Coarsening coarsen(const ItemGraph& fine, int target_count,
                   const std::vector<int>& single_items = {}, int threads = 1);

}  // namespace fcn
