// A mesh in few bytes. Faces are written in the order of a walk from neighbour to neighbour and
// vertices in the order in which the faces need them first, so that most corners are "the next new
// vertex" or one met shortly before: each is written as the distance to the next new one, as Chun
// proposed for meshes on the web (WebGL Models: End-to-End, 2012).
#include "report/viewer_mesh.h"

#include <algorithm>
#include <tuple>

#include "report/viewer_decimation.h"

namespace fcn {
namespace {

struct OrderedMesh {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> corners;  ///< distances to the next new vertex
};

/// Of faces with as many corners as `Polygon` has places.
template <typename Polygon>
class FaceWalk {
public:
    FaceWalk(const std::vector<Vec3>& points, const std::vector<Polygon>& polygons)
        : points_(points),
          polygons_(polygons),
          number_(points.size(), -1),
          is_seen_(polygons.size(), false),
          first_(points.size() + 1, 0),
          faces_(std::tuple_size_v<Polygon> * polygons.size()) {
        for (const Polygon& polygon : polygons)
            for (const int vertex : polygon) ++first_[static_cast<std::size_t>(vertex) + 1];
        for (std::size_t v = 0; v < points.size(); ++v) first_[v + 1] += first_[v];
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t face = 0; face < polygons.size(); ++face)
            for (const int vertex : polygons[face])
                faces_[next[static_cast<std::size_t>(vertex)]++] = face;
    }

    OrderedMesh run() {
        for (std::size_t seed = 0; seed < polygons_.size(); ++seed) {
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
        for (const int vertex : polygons_[face]) {
            const int next = static_cast<int>(result_.points.size());
            int& number = number_[static_cast<std::size_t>(vertex)];
            if (number < 0) {
                number = next;
                result_.points.push_back(points_[static_cast<std::size_t>(vertex)]);
                result_.corners.push_back(0);
            } else {
                result_.corners.push_back(static_cast<std::uint32_t>(next - number));
            }
        }
        const Polygon& corners = polygons_[face];
        for (std::size_t k = 0; k < corners.size(); ++k)
            open_neighbours(corners[k], corners[(k + 1) % corners.size()]);
    }

    void open_neighbours(int from, int to) {
        const auto v = static_cast<std::size_t>(from);
        for (std::size_t i = first_[v]; i < first_[v + 1]; ++i) {
            const std::size_t face = faces_[i];
            if (is_seen_[face] || std::ranges::count(polygons_[face], to) == 0) continue;
            is_seen_[face] = true;
            open_.push_back(face);
        }
    }

    const std::vector<Vec3>& points_;
    const std::vector<Polygon>& polygons_;
    std::vector<int> number_;
    std::vector<bool> is_seen_;
    std::vector<std::size_t> first_, faces_;  ///< the faces of vertex v: from first_[v] on
    std::vector<std::size_t> open_;
    OrderedMesh result_;
};

nlohmann::json quality_json(const QuadQuality& quality) {
    return {{"mean_scaled_jacobian", short_number(quality.mean_scaled_jacobian)},
            {"min_scaled_jacobian", short_number(quality.min_scaled_jacobian)},
            {"irregular", short_number(quality.share_irregular)},
            {"inverted_corners", quality.inverted_corners}};
}

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
    const OrderedMesh ordered = FaceWalk(shown.points, shown.triangles).run();
    nlohmann::json header{{"name", name},
                          {"faces", mesh.n_faces()},
                          {"shown", ordered.corners.size() / 3},
                          {"points", block.add_points(ordered.points, grid)},
                          {"corners", block.add_numbers(ordered.corners)}};
    if (quality != nullptr) header["quality"] = quality_json(*quality);
    return header;
}

nlohmann::json add_quads(BlockWriter& block, const QuadMesh& mesh, const std::string& name,
                         const PointGrid& grid, std::size_t face_limit,
                         const QuadQuality& quality) {
    const std::vector<std::array<int, 3>> triangles = cut_into_triangles(mesh);
    nlohmann::json header;
    if (triangles.size() > face_limit) {
        header = add_mesh(block, triangle_mesh(mesh), name, grid, face_limit, nullptr);
    } else {
        std::vector<std::array<int, 4>> faces = mesh.faces;
        for (std::size_t f = 0; f < faces.size(); ++f)
            std::rotate(faces[f].begin(), std::ranges::find(faces[f], triangles[2 * f][0]),
                        faces[f].end());
        const OrderedMesh ordered = FaceWalk(mesh.points, faces).run();
        header = {{"name", name},
                  {"sides", 4},
                  {"shown", faces.size()},
                  {"points", block.add_points(ordered.points, grid)},
                  {"corners", block.add_numbers(ordered.corners)}};
    }
    header["faces"] = mesh.faces.size();
    header["quality"] = quality_json(quality);
    return header;
}

}  // namespace fcn
