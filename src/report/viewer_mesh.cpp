// A mesh in few bytes. Faces are written in the order of a walk from neighbour to neighbour and
// vertices in the order in which the faces need them first, so that most corners are "the next new
// vertex" or one met shortly before: each is written as the distance to the next new one, as Chun
// proposed for meshes on the web (WebGL Models: End-to-End, 2012). Meshes that are too large are
// decimated by quadric error metrics (Garland and Heckbert 1997, through OpenMesh).
#include "report/viewer_mesh.h"

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

namespace fcn {
namespace {

struct OrderedMesh {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> corners;  ///< distances to the next new vertex
};

class FaceWalk {
public:
    explicit FaceWalk(const Mesh& mesh)
        : mesh_(mesh), number_(mesh.n_vertices(), -1), is_seen_(mesh.n_faces(), false) {}

    OrderedMesh run() {
        for (const FaceHandle seed : mesh_.faces()) {
            if (is_seen_[index(seed)]) continue;
            is_seen_[index(seed)] = true;
            open_.push_back(seed);
            while (!open_.empty()) {
                const FaceHandle face = open_.back();
                open_.pop_back();
                visit(face);
            }
        }
        return std::move(result_);
    }

private:
    static std::size_t index(FaceHandle face) { return static_cast<std::size_t>(face.idx()); }

    void visit(FaceHandle face) {
        for (const VertexHandle vertex : face_vertices(mesh_, face)) {
            const int next = static_cast<int>(result_.points.size());
            int& number = number_[static_cast<std::size_t>(vertex.idx())];
            if (number < 0) {
                number = next;
                result_.points.push_back(mesh_.point(vertex));
                result_.corners.push_back(0);
            } else {
                result_.corners.push_back(static_cast<std::uint32_t>(next - number));
            }
        }
        for (const FaceHandle neighbour : mesh_.ff_range(face)) {
            if (is_seen_[index(neighbour)]) continue;
            is_seen_[index(neighbour)] = true;
            open_.push_back(neighbour);
        }
    }

    const Mesh& mesh_;
    std::vector<int> number_;
    std::vector<bool> is_seen_;
    std::vector<FaceHandle> open_;
    OrderedMesh result_;
};

Mesh decimated(Mesh mesh, std::size_t face_limit) {
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
    mesh.request_face_normals();
    mesh.update_face_normals();
    using Decimater = OpenMesh::Decimater::DecimaterT<Mesh>;
    Decimater decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
    decimater.add(quadric);
    decimater.add(flipping);
    decimater.module(quadric).unset_max_err();
    if (decimater.initialize()) decimater.decimate_to_faces(0, face_limit);
    mesh.garbage_collection();
    return mesh;
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
    const OrderedMesh ordered = mesh.n_faces() > face_limit
                                    ? FaceWalk(decimated(mesh, face_limit)).run()
                                    : FaceWalk(mesh).run();
    nlohmann::json header{{"name", name},
                          {"faces", mesh.n_faces()},
                          {"shown", ordered.corners.size() / 3},
                          {"points", block.add_points(ordered.points, grid)},
                          {"corners", block.add_numbers(ordered.corners)}};
    if (quality != nullptr) header["quality"] = quality_json(*quality);
    return header;
}

}  // namespace fcn
