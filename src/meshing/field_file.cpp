// Fields in the text formats that other programs read: N-RoSy vectors by face, and singular
// vertices. Numbers have the digits that give back the same double.
#include "meshing/field_file.h"

#include <cmath>

#include "geometry/text_writer.h"

namespace fcn {

Vec3 arm_direction(const Mesh& mesh, const CrossField& field, FaceHandle face) {
    const auto v = face_vertices(mesh, face);
    const Vec3 x = (mesh.point(v[1]) - mesh.point(v[0])).stableNormalized();
    const Vec3 y = face_normal(mesh, face).cross(x);
    const double angle = field.angles[static_cast<std::size_t>(face.idx())];
    return std::cos(angle) * x + std::sin(angle) * y;
}

std::vector<Vec3> arm_directions(const Mesh& mesh, const CrossField& field) {
    std::vector<Vec3> arms;
    arms.reserve(mesh.n_faces());
    for (const FaceHandle face : mesh.faces()) arms.push_back(arm_direction(mesh, field, face));
    return arms;
}

std::string rosy_text(const std::vector<Vec3>& arms) {
    TextWriter text;
    text << arms.size() << "\n4\n";
    for (const Vec3& arm : arms) text << arm << '\n';
    return text.take();
}

std::string singularity_text(const Mesh& mesh, const std::vector<Singularity>& singularities) {
    TextWriter text;
    for (const Singularity& s : singularities)
        text << s.vertex << ' ' << s.index << ' ' << mesh.point(VertexHandle(s.vertex)) << '\n';
    return text.take();
}

}  // namespace fcn
