// Whatever the bytes, read_mesh gives an oriented manifold or an InputError.

#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "geometry/errors.h"
#include "geometry/mesh_io.h"

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr const char* kNames[] = {"a.off", "a.obj", "a.ply", "a.stl", "a.mesh", "a.msh", "a"};
    std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
    try {
        const fcn::LoadedMesh loaded = fcn::read_mesh(in, kNames[size % std::size(kNames)]);
        const fcn::Mesh& mesh = loaded.mesh;
        require(mesh.n_faces() > 0);
        require(loaded.face_labels.empty() || loaded.face_labels.size() == mesh.n_faces());
        for (const auto halfedge : mesh.halfedges()) {
            require(mesh.find_halfedge(mesh.from_vertex_handle(halfedge),
                                       mesh.to_vertex_handle(halfedge)) == halfedge);
        }
        for (const auto vertex : mesh.vertices()) {
            require(mesh.point(vertex).allFinite());
            require(mesh.is_manifold(vertex));
        }
        for (const auto face : mesh.faces()) require(fcn::face_area(mesh, face) > 0);
    } catch (const fcn::InputError&) {
        // The one way out for bad bytes.
    }
    return 0;
}
