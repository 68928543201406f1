// Variational shape approximation against CGAL's with incremental seeding, in one run:
//   features_vsa_vs_cgal MESH:PATCHES[:SUBDIVISIONS] ...
// prints a table: mesh, faces, patches, seconds and error of both. Both get the same number of
// patches; the error of both is recomputed here from the patch ids alone, the sum over faces of
// area * |normal - patch normal|^2. CGAL runs first or second alternately, so that neither profits
// from warm memory.

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Variational_shape_approximation.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "features/features.h"
#include "geometry/errors.h"

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using VertexPoints = boost::property_map<CgalMesh, boost::vertex_point_t>::type;
using Approximation = CGAL::Variational_shape_approximation<CgalMesh, VertexPoints>;
namespace Seeding = CGAL::Surface_mesh_approximation;

struct Case {
    std::string path;
    int patch_count = 0;
    int subdivision_count = 0;
};

struct Outcome {
    double seconds = 0;
    double error = 0;
    int patch_count = 0;
};

Case parse_case(const std::string& text) {
    const std::size_t first = text.find(':');
    const std::size_t second = text.find(':', first == std::string::npos ? first : first + 1);
    if (first == std::string::npos) throw fcn::InputError("expected MESH:PATCHES, got " + text);
    Case result;
    result.path = text.substr(0, first);
    result.patch_count = std::stoi(text.substr(first + 1));
    if (second != std::string::npos) result.subdivision_count = std::stoi(text.substr(second + 1));
    return result;
}

/// Every face into four by its edge midpoints.
fcn::Mesh subdivided(const fcn::Mesh& mesh) {
    fcn::Mesh result;
    const int vertex_count = static_cast<int>(mesh.n_vertices());
    for (const auto vertex : mesh.vertices()) result.add_vertex(mesh.point(vertex));
    for (const auto edge : mesh.edges()) {
        const auto h = mesh.halfedge_handle(edge, 0);
        result.add_vertex(
            0.5 * (mesh.point(mesh.from_vertex_handle(h)) + mesh.point(mesh.to_vertex_handle(h))));
    }
    for (const auto face : mesh.faces()) {
        fcn::VertexHandle corner[3], middle[3];
        auto h = mesh.halfedge_handle(face);
        for (int i = 0; i < 3; ++i, h = mesh.next_halfedge_handle(h)) {
            corner[i] = mesh.from_vertex_handle(h);
            middle[i] = fcn::VertexHandle(vertex_count + mesh.edge_handle(h).idx());
        }
        for (int i = 0; i < 3; ++i) result.add_face(corner[i], middle[i], middle[(i + 2) % 3]);
        result.add_face(middle[0], middle[1], middle[2]);
    }
    return result;
}

double patch_error(const fcn::Mesh& mesh, const std::vector<int>& patch_of_face, int patch_count) {
    std::vector<fcn::Vec3> normals(patch_count, fcn::Vec3::Zero());
    for (const auto face : mesh.faces()) {
        normals[patch_of_face[face.idx()]] +=
            fcn::face_area(mesh, face) * fcn::face_normal(mesh, face);
    }
    for (fcn::Vec3& normal : normals) normal.normalize();
    double error = 0;
    for (const auto face : mesh.faces()) {
        error += fcn::face_area(mesh, face) *
                 (fcn::face_normal(mesh, face) - normals[patch_of_face[face.idx()]]).squaredNorm();
    }
    return error;
}

template <typename Run>
Outcome timed(const fcn::Mesh& mesh, Run run) {
    const auto start = std::chrono::steady_clock::now();
    const std::pair<std::vector<int>, int> patches = run();
    Outcome outcome;
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.patch_count = patches.second;
    outcome.error = patch_error(mesh, patches.first, patches.second);
    return outcome;
}

Outcome run_ours(const fcn::Mesh& mesh, int patch_count) {
    return timed(mesh, [&] {
        fcn::VsaOptions options;
        options.patch_count = patch_count;
        const fcn::VsaResult result = fcn::segment_vsa(mesh, options);
        return std::pair(result.patch_of_face, static_cast<int>(result.proxy_normals.size()));
    });
}

CgalMesh cgal_mesh(const fcn::Mesh& mesh) {
    CgalMesh result;
    for (const auto vertex : mesh.vertices()) {
        const fcn::Vec3& p = mesh.point(vertex);
        result.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
    }
    for (const auto face : mesh.faces()) {
        const auto corners = fcn::face_vertices(mesh, face);
        result.add_face(CgalMesh::Vertex_index(corners[0].idx()),
                        CgalMesh::Vertex_index(corners[1].idx()),
                        CgalMesh::Vertex_index(corners[2].idx()));
    }
    return result;
}

Outcome run_cgal(const fcn::Mesh& mesh, int patch_count) {
    CgalMesh surface = cgal_mesh(mesh);
    const VertexPoints points = get(boost::vertex_point, surface);
    const Approximation::Error_metric metric(surface, points);
    return timed(mesh, [&] {
        Approximation approximation(surface, points, metric);
        approximation.initialize_seeds(CGAL::parameters::seeding_method(Seeding::INCREMENTAL)
                                           .max_number_of_proxies(patch_count));
        approximation.run(20);
        std::vector<int> patch_of_face(mesh.n_faces());
        auto map = surface.add_property_map<CgalMesh::Face_index, std::size_t>("f:patch").first;
        approximation.proxy_map(map);
        for (const auto face : surface.faces()) {
            patch_of_face[face] = static_cast<int>(map[face]);
        }
        return std::pair(patch_of_face, static_cast<int>(approximation.number_of_proxies()));
    });
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: %s MESH:PATCHES[:SUBDIVISIONS] ...\n", argv[0]);
        return 2;
    }
    try {
        std::printf(
            "| mesh | faces | patches | ours s | ours error | CGAL s | CGAL error | "
            "time ratio | error ratio |\n|---|---|---|---|---|---|---|---|---|\n");
        for (int i = 1; i < argc; ++i) {
            const Case job = parse_case(argv[i]);
            fcn::LoadedMesh loaded = fcn::read_mesh(job.path);
            for (int s = 0; s < job.subdivision_count; ++s) loaded.mesh = subdivided(loaded.mesh);
            Outcome ours, cgal;
            if (i % 2 == 1) ours = run_ours(loaded.mesh, job.patch_count);
            cgal = run_cgal(loaded.mesh, job.patch_count);
            if (i % 2 == 0) ours = run_ours(loaded.mesh, job.patch_count);
            std::printf("| %s | %zu | %d/%d | %.3f | %.6g | %.3f | %.6g | %.1f | %.4f |\n",
                        loaded.name.c_str(), loaded.mesh.n_faces(), ours.patch_count,
                        cgal.patch_count, ours.seconds, ours.error, cgal.seconds, cgal.error,
                        cgal.seconds / ours.seconds, ours.error / cgal.error);
            std::fflush(stdout);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
    return 0;
}
