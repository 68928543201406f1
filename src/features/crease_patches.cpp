// With fewer patches than a part has facets, variational shape approximation lets patches run over
// creases: a narrow facet is shared out between its neighbours, with a border across it that means
// nothing once the creases are in the network themselves. Cut along the creases, each patch falls
// into parts. The largest keeps the patch; every other part joins the neighbouring part on its own
// side of the creases that raises the error least, if by less than the error of a mean patch, and
// otherwise becomes a patch: its border runs along creases only, so no curve is added by that.

#include "features/crease_patches.h"

#include <algorithm>

namespace fcn {
namespace {

struct Part {
    std::vector<int> faces;
    Vec3 normal = Vec3::Zero();  ///< integral over the part
    double area = 0;
    int patch = -1;
    bool is_main = false;
    double error() const { return 2 * std::max(0.0, area - normal.norm()); }
};

double merge_cost(const Part& one, const Part& other) {
    Part both;
    both.normal = one.normal + other.normal;
    both.area = one.area + other.area;
    return both.error() - one.error() - other.error();
}

std::vector<Part> parts_between(const MeshArrays& arrays, const std::vector<bool>& is_crease_edge,
                                const std::vector<int>& patch, std::vector<int>& part_of_face) {
    std::vector<Part> parts;
    part_of_face.assign(arrays.face_count(), -1);
    for (int start = 0; start < arrays.face_count(); ++start) {
        if (part_of_face[start] >= 0) continue;
        Part part;
        part.patch = patch[start];
        part.faces.push_back(start);
        part_of_face[start] = static_cast<int>(parts.size());
        for (std::size_t i = 0; i < part.faces.size(); ++i) {
            const int f = part.faces[i];
            part.normal += arrays.areas[f] * arrays.normals[f];
            part.area += arrays.areas[f];
            for (int k = 0; k < 3; ++k) {
                const int g = arrays.face_neighbors[f][k];
                if (g < 0 || part_of_face[g] >= 0 || patch[g] != part.patch) continue;
                if (is_crease_edge[arrays.face_edges[f][k]]) continue;
                part_of_face[g] = part_of_face[start];
                part.faces.push_back(g);
            }
        }
        parts.push_back(std::move(part));
    }
    return parts;
}

void mark_main_parts(std::vector<Part>& parts, int patch_count) {
    std::vector<int> main(patch_count, -1);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        int& best = main[parts[i].patch];
        if (best < 0 || parts[i].area > parts[best].area) best = static_cast<int>(i);
    }
    for (int i : main) {
        if (i >= 0) parts[i].is_main = true;
    }
}

/// The neighbour across edges that are no creases that it costs least to join; -1: none in budget.
int cheapest_neighbor(const MeshArrays& arrays, const std::vector<bool>& is_crease_edge,
                      const std::vector<Part>& parts, const std::vector<int>& part_of_face,
                      int part, double budget) {
    int best = -1;
    double best_cost = budget;
    for (int f : parts[part].faces) {
        for (int k = 0; k < 3; ++k) {
            const int g = arrays.face_neighbors[f][k];
            if (g < 0 || part_of_face[g] == part) continue;
            if (is_crease_edge[arrays.face_edges[f][k]]) continue;
            const int other = part_of_face[g];
            const double cost = merge_cost(parts[part], parts[other]);
            if (cost < best_cost || (cost == best_cost && best >= 0 && other < best)) {
                best_cost = cost;
                best = other;
            }
        }
    }
    return best;
}

}  // namespace

void end_patches_at_creases(const MeshArrays& arrays, const std::vector<bool>& is_crease_edge,
                            VsaResult& patches) {
    const int patch_count = static_cast<int>(patches.proxy_normals.size());
    std::vector<int> part_of_face;
    std::vector<Part> parts =
        parts_between(arrays, is_crease_edge, patches.patch_of_face, part_of_face);
    if (static_cast<int>(parts.size()) == patch_count) return;
    mark_main_parts(parts, patch_count);
    const double budget = patches.error / patch_count;
    // Smallest first: crumbs disappear into what they belong to before that is judged itself.
    std::vector<std::pair<double, int>> order;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!parts[i].is_main) order.push_back({parts[i].area, static_cast<int>(i)});
    }
    std::sort(order.begin(), order.end());
    for (const auto& [area, i] : order) {
        const int into = cheapest_neighbor(arrays, is_crease_edge, parts, part_of_face, i, budget);
        if (into < 0) continue;
        Part& target = parts[into];
        for (int f : parts[i].faces) part_of_face[f] = into;
        target.faces.insert(target.faces.end(), parts[i].faces.begin(), parts[i].faces.end());
        target.normal += parts[i].normal;
        target.area += parts[i].area;
        parts[i] = {};
    }
    for (Part& part : parts) {
        if (part.faces.empty()) continue;
        if (!part.is_main) {
            part.patch = static_cast<int>(patches.proxy_normals.size());
            patches.proxy_normals.push_back(Vec3::Zero());
        }
        patches.proxy_normals[part.patch] = part.normal.normalized();
        for (int f : part.faces) patches.patch_of_face[f] = part.patch;
    }
}

}  // namespace fcn
