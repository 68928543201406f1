// What one would do without adapting the network, to compare with (figures 7, 9 and 10): select
// features by curvature alone; decimate by quadrics (Garland, Heckbert 1997, OpenMesh's decimater);
// filter the surface first. The filter is (M + t K) x = M x0 with M the vertices' areas, K the
// cotangent matrix and t = (length / 2)^2 (Desbrun et al. 1999).
#include "meshing/baselines.h"

#include <Eigen/SparseCholesky>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/errors.h"

namespace fcn {

FeatureCurveNetwork above_curvature(const FeatureCurveNetwork& network, double threshold) {
    FeatureCurveNetwork kept = network;
    kept.segments.clear();
    kept.curves.clear();
    kept.orbits.clear();
    std::erase_if(kept.arcs, [&](const NetworkArc& arc) {
        return arc.pin != Pin::Keep && std::abs(arc.dihedral) < threshold;
    });
    for (NetworkArc& arc : kept.arcs) arc.curve = -1;
    return kept;
}

LoadedMesh decimate_by_quadrics(const LoadedMesh& mesh, std::size_t vertex_count) {
    Mesh work = mesh.mesh;
    work.request_vertex_status();
    work.request_edge_status();
    work.request_halfedge_status();
    work.request_face_status();
    work.request_face_normals();
    work.update_face_normals();
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(work);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadrics;
    decimater.add(quadrics);
    decimater.module(quadrics).unset_max_err();
    // Flat parts cost nothing, so that only this keeps them from folding over.
    OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
    decimater.add(flipping);
    decimater.module(flipping).set_max_normal_deviation(90);
    if (decimater.initialize()) decimater.decimate_to(vertex_count);
    std::vector<Vec3> points(work.n_vertices());
    for (std::size_t v = 0; v < points.size(); ++v)
        points[v] = work.point(VertexHandle(static_cast<int>(v)));
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> labels;
    for (const FaceHandle face : work.faces()) {
        const auto v = face_vertices(work, face);
        triangles.push_back({v[0].idx(), v[1].idx(), v[2].idx()});
        if (!mesh.face_labels.empty())
            labels.push_back(mesh.face_labels[static_cast<std::size_t>(face.idx())]);
    }
    LoadedMesh result = mesh_from_soup(points, triangles, labels);
    result.repairs = {};
    result.name = mesh.name;
    return result;
}

LoadedMesh filter_detail(const LoadedMesh& mesh, double length) {
    using Matrix = Eigen::SparseMatrix<double>;
    const auto n = static_cast<Eigen::Index>(mesh.mesh.n_vertices());
    const double time = length * length / 4;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd area = Eigen::VectorXd::Zero(n);
    for (const FaceHandle face : mesh.mesh.faces()) {
        const auto v = face_vertices(mesh.mesh, face);
        const double share = face_area(mesh.mesh, face) / 3;
        for (std::size_t i = 0; i < 3; ++i) {
            const VertexHandle a = v[i], b = v[(i + 1) % 3], c = v[(i + 2) % 3];
            area[a.idx()] += share;
            const Vec3 x = mesh.mesh.point(b) - mesh.mesh.point(a);
            const Vec3 y = mesh.mesh.point(c) - mesh.mesh.point(a);
            // Bounded below, so that the system stays an M-matrix and needles do no harm.
            const double cotangent =
                std::clamp(x.dot(y) / std::max(x.cross(y).norm(), 1e-300), 0.0, 100.0);
            const double weight = 0.5 * time * cotangent;
            entries.emplace_back(b.idx(), b.idx(), weight);
            entries.emplace_back(c.idx(), c.idx(), weight);
            entries.emplace_back(b.idx(), c.idx(), -weight);
            entries.emplace_back(c.idx(), b.idx(), -weight);
        }
    }
    Eigen::MatrixXd right(n, 3);
    for (const VertexHandle vertex : mesh.mesh.vertices()) {
        const int i = vertex.idx();
        // A boundary vertex is held by a mass that nothing moves.
        const double mass = area[i] + (mesh.mesh.is_boundary(vertex) ? 1e8 * time : 1e-300);
        entries.emplace_back(i, i, mass);
        right.row(i) = mass * mesh.mesh.point(vertex).transpose();
    }
    Matrix system(n, n);
    system.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Matrix> solver(system);
    const Eigen::MatrixXd moved = solver.solve(right);
    if (solver.info() != Eigen::Success || !moved.allFinite())
        throw LogicError("filter: the linear system cannot be solved");
    LoadedMesh result = mesh;
    for (const VertexHandle vertex : mesh.mesh.vertices())
        result.mesh.set_point(vertex, moved.row(vertex.idx()).transpose());
    return result;
}

}  // namespace fcn
