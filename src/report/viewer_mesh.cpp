// A mesh in few bytes. Faces are written in the order of a walk from neighbour to neighbour and
// vertices in the order in which the faces need them first, so that most corners are "the next new
// vertex" or one met shortly before: each is written as the distance to the next new one, as Chun
// proposed for meshes on the web (WebGL Models: End-to-End, 2012).
#include "report/viewer_mesh.h"

#include <algorithm>

#include "report/viewer_decimation.h"

namespace fcn {
namespace {

struct OrderedMesh {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> corners;  ///< distances to the next new vertex
};

class FaceWalk {
public:
    explicit FaceWalk(const TriangleArrays& mesh)
        : mesh_(mesh),
          number_(mesh.points.size(), -1),
          is_seen_(mesh.triangles.size(), false),
          first_(mesh.points.size() + 1, 0),
          faces_(3 * mesh.triangles.size()) {
        for (const auto& triangle : mesh.triangles)
            for (const int vertex : triangle) ++first_[static_cast<std::size_t>(vertex) + 1];
        for (std::size_t v = 0; v < mesh.points.size(); ++v) first_[v + 1] += first_[v];
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
            for (const int vertex : mesh.triangles[face])
                faces_[next[static_cast<std::size_t>(vertex)]++] = face;
    }

    OrderedMesh run() {
        for (std::size_t seed = 0; seed < mesh_.triangles.size(); ++seed) {
            if (is_seen_[seed]) continue;
            is_seen_[seed] = true;
            open_.push_back(seed);
            while (!open_.empty()) {
                const std::size_t face = open_.back();
                open_.pop_back();
                visit(face);
            }
        }
        return std::move(result_);
    }

private:
    void visit(std::size_t face) {
        for (const int vertex : mesh_.triangles[face]) {
            const int next = static_cast<int>(result_.points.size());
            int& number = number_[static_cast<std::size_t>(vertex)];
            if (number < 0) {
                number = next;
                result_.points.push_back(mesh_.points[static_cast<std::size_t>(vertex)]);
                result_.corners.push_back(0);
            } else {
                result_.corners.push_back(static_cast<std::uint32_t>(next - number));
            }
        }
        for (std::size_t k = 0; k < 3; ++k)
            open_neighbours(mesh_.triangles[face][k], mesh_.triangles[face][(k + 1) % 3]);
    }

    void open_neighbours(int from, int to) {
        const auto v = static_cast<std::size_t>(from);
        for (std::size_t i = first_[v]; i < first_[v + 1]; ++i) {
            const std::size_t face = faces_[i];
            if (is_seen_[face] || std::ranges::count(mesh_.triangles[face], to) == 0) continue;
            is_seen_[face] = true;
            open_.push_back(face);
        }
    }

    const TriangleArrays& mesh_;
    std::vector<int> number_;
    std::vector<bool> is_seen_;
    std::vector<std::size_t> first_, faces_;  ///< the faces of vertex v: from first_[v] on
    std::vector<std::size_t> open_;
    OrderedMesh result_;
};

nlohmann::json quality_json(const TriangleQuality& quality) {
    return {{"min_angle", short_number(quality.min_angle_degrees)},
            {"mean_min_angle", short_number(quality.mean_min_angle_degrees)},
            {"under_15", short_number(quality.share_under_15)},
            {"under_30", short_number(quality.share_under_30)},
            {"min_edge", short_number(quality.min_edge)}};
}

}  // namespace

nlohmann::json add_mesh(BlockWriter& block, const Mesh& mesh, const std::string& name,
                        const PointGrid& grid, std::size_t face_limit,
                        const TriangleQuality* quality) {
    const TriangleArrays shown = decimate_for_display(triangle_arrays(mesh), face_limit);
    const OrderedMesh ordered = FaceWalk(shown).run();
    nlohmann::json header{{"name", name},
                          {"faces", mesh.n_faces()},
                          {"shown", ordered.corners.size() / 3},
                          {"points", block.add_points(ordered.points, grid)},
                          {"corners", block.add_numbers(ordered.corners)}};
    if (quality != nullptr) header["quality"] = quality_json(*quality);
    return header;
}

}  // namespace fcn
