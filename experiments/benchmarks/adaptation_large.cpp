// Everything but the solver on a large mesh: MESH is subdivided until it has FACES faces, then
// detected (sharp edges, or VSA with 500 patches) and adapted at SCALE percent with the greedy
// solver. Prints a line with the seconds of every phase and the peak memory.
// usage: adaptation_large MESH FACES SCALE_PERCENT sharp|vsa

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "adaptation/adaptation.h"
#include "features/features.h"
#include "geometry/mesh_io.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Every face into four at its edge midpoints.
fcn::LoadedMesh subdivide(const fcn::LoadedMesh& input) {
    const fcn::Mesh& mesh = input.mesh;
    std::vector<fcn::Vec3> points;
    for (const auto vertex : mesh.vertices()) points.push_back(mesh.point(vertex));
    const int vertices = static_cast<int>(mesh.n_vertices());
    for (const auto edge : mesh.edges()) {
        const auto halfedge = mesh.halfedge_handle(edge, 0);
        points.push_back((mesh.point(mesh.from_vertex_handle(halfedge)) +
                          mesh.point(mesh.to_vertex_handle(halfedge))) /
                         2);
    }
    std::vector<std::array<int, 3>> triangles;
    for (const auto face : mesh.faces()) {
        std::array<int, 3> corner{}, middle{};
        auto halfedge = mesh.halfedge_handle(face);
        for (int k = 0; k < 3; ++k) {
            corner[k] = mesh.from_vertex_handle(halfedge).idx();
            middle[k] = vertices + mesh.edge_handle(halfedge).idx();
            halfedge = mesh.next_halfedge_handle(halfedge);
        }
        for (int k = 0; k < 3; ++k)
            triangles.push_back({corner[k], middle[k], middle[(k + 2) % 3]});
        triangles.push_back(middle);
    }
    return fcn::mesh_from_soup(points, triangles);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5) {
        std::fprintf(stderr, "usage: %s MESH FACES SCALE_PERCENT sharp|vsa\n", argv[0]);
        return 2;
    }
    try {
        fcn::LoadedMesh mesh = fcn::read_mesh(argv[1]);
        while (mesh.mesh.n_faces() < std::strtoul(argv[2], nullptr, 10)) mesh = subdivide(mesh);
        const auto start = Clock::now();
        fcn::VsaOptions vsa;
        vsa.patch_count = 500;
        vsa.threads = 2;
        const bool is_sharp = std::string(argv[4]) == "sharp";
        fcn::FeatureCurveNetwork network =
            fcn::add_boundaries(is_sharp ? fcn::detect_sharp(mesh) : fcn::detect_vsa(mesh, vsa),
                                mesh, fcn::BoundaryPolicy::Keep);
        const double detecting = seconds_since(start);
        fcn::AdaptationOptions options;
        options.rmin = std::atof(argv[3]) / 100 * fcn::bounding_box(mesh.mesh).diagonal();
        options.solver = labeling::builtin_solvers().find("greedy");
        options.threads = 2;
        const auto result = fcn::adapt_network(mesh, network, options);
        double solving = 0;
        for (const auto& iteration : result.report.iterations) {
            solving += iteration.seconds.at("solve");
        }
        const double total = seconds_since(start);
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        std::printf(
            "%s %s faces %zu arcs %zu segments %zu: detect %.1f s, adapt %.1f s without "
            "solver, solver %.1f s, all but solver %.1f s, peak %.2f GiB\n",
            mesh.name.c_str(), argv[4], mesh.mesh.n_faces(), network.arcs.size(),
            result.network.segments.size(), detecting, total - detecting - solving, solving,
            total - solving, static_cast<double>(usage.ru_maxrss) / (1 << 20));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
}
