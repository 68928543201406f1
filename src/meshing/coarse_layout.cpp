// The layout on which integers are chosen (Coudert-Osmont, Desobry, Heistermann, Bommes, Ray,
// Sokolov 2023, "Quad mesh quantization without a T-mesh"): the mesh decimated to the vertices that
// have to be grid points, in the metric of the seamless map. They collapse edges; here flat
// vertices are taken out of an intrinsic triangulation, which changes no metric. Hard curves divide
// the surface into pieces with boundaries, whose straight sides lose their vertices, too.
#include "meshing/coarse_layout.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "meshing/intrinsic_triangulation.h"

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Rows of the basis as forms.
class Forms {
public:
    Forms(const MapProblem& problem) : problem_(problem) {}

    /// u and v of a corner.
    std::array<std::map<int, double>, 2> of(const IntrinsicTriangulation::Corner& corner) const {
        std::array<std::map<int, double>, 2> result;
        add(result, 2 * corner.copy, turned({1, 0}, corner.from_copy.turns));
        for (const auto& term : corner.from_copy.terms)
            add(result, 2 * (problem_.cut.copy_count + term.chain),
                {static_cast<double>(term.coefficient[0]),
                 static_cast<double>(term.coefficient[1])});
        return result;
    }

private:
    /// Adds factor times the point (unknown, unknown + 1), both complex.
    void add(std::array<std::map<int, double>, 2>& sum, int unknown, const Vec2& factor) const {
        add_row(sum[0], unknown, factor[0]);
        add_row(sum[0], unknown + 1, -factor[1]);
        add_row(sum[1], unknown, factor[1]);
        add_row(sum[1], unknown + 1, factor[0]);
    }
    void add_row(std::map<int, double>& sum, int unknown, double factor) const {
        if (factor == 0) return;
        for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(problem_.unknowns.basis,
                                                                            unknown);
             it; ++it)
            sum[static_cast<int>(it.col())] += factor * it.value();
    }
    const MapProblem& problem_;
};

LinearForm difference(const std::map<int, double>& one, const std::map<int, double>& other) {
    std::map<int, double> sum = one;
    for (const auto& [unknown, coefficient] : other) sum[unknown] -= coefficient;
    LinearForm result;
    for (const auto& [unknown, coefficient] : sum)
        if (coefficient != 0) result.emplace_back(unknown, coefficient);
    return result;
}

/// Sectors that stay: at singular vertices, and where boundaries and hard curves turn or end.
std::vector<bool> grid_points(const Mesh& mesh, const MapProblem& problem, const CornerMap& map,
                              const VertexSectors& sectors) {
    std::vector<double> angle(at(sectors.count()), 0);
    std::vector<bool> is_open(angle.size(), false);
    for (const FaceHandle face : mesh.faces()) {
        const auto& uv = map.uv[at(face.idx())];
        HalfedgeHandle h = mesh.halfedge_handle(face);
        for (std::size_t i = 0; i < 3; ++i, h = mesh.next_halfedge_handle(h)) {
            const auto& names = sectors.of_corner[at(face.idx())];
            const Vec2 a = uv[(i + 1) % 3] - uv[i], b = uv[(i + 2) % 3] - uv[i];
            angle[at(names[i])] += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
            if (problem.is_hard[at(mesh.edge_handle(h).idx())])
                is_open[at(names[i])] = is_open[at(names[(i + 1) % 3])] = true;
        }
    }
    std::vector<bool> result(angle.size(), false);
    for (std::size_t s = 0; s < result.size(); ++s) {
        const long quarters = std::lround(angle[s] / (2 * std::atan(1.0)));
        result[s] =
            problem.cut.is_singular[at(sectors.vertex[s])] != 0 || quarters != (is_open[s] ? 2 : 4);
    }
    return result;
}

}  // namespace

CoarseLayout make_coarse_layout(const Mesh& mesh, const MapProblem& problem,
                                const Eigen::VectorXd& free_values) {
    const Eigen::VectorXd values = problem.unknowns.basis * free_values;
    const VertexSectors sectors = vertex_sectors(mesh, problem.is_hard);
    const std::vector<bool> stays =
        grid_points(mesh, problem, corner_map(problem, values), sectors);
    IntrinsicTriangulation triangulation(mesh, problem, sectors, values);
    // Scattered order, so that no triangle becomes long while others are short.
    std::vector<std::pair<std::uint32_t, int>> order;
    for (std::size_t v = 0; v < stays.size(); ++v)
        if (!stays[v])
            order.emplace_back(static_cast<std::uint32_t>(v) * 2654435769U, static_cast<int>(v));
    std::sort(order.begin(), order.end());
    std::vector<int> left;
    for (const auto& [key, vertex] : order)
        if (!triangulation.remove(vertex)) left.push_back(vertex);
    triangulation.make_delaunay();
    for (int round = 0; round < 3 && !left.empty(); ++round) {
        std::vector<int> still;
        for (const int vertex : left)
            if (!triangulation.remove(vertex)) still.push_back(vertex);
        left = std::move(still);
        triangulation.make_delaunay();
    }

    CoarseLayout layout;
    layout.free_values = free_values;
    const Forms forms(problem);
    for (int slot = 0; slot < triangulation.slot_count(); slot += 3) {
        if (!triangulation.is_alive(slot)) continue;
        const auto a = forms.of(triangulation.corner(slot));
        const auto b = forms.of(triangulation.corner(slot + 1));
        const auto c = forms.of(triangulation.corner(slot + 2));
        int tip = slot;
        double longest = -1;
        for (int k = 0; k < 3; ++k) {
            const Vec2 side = triangulation.corner(slot + (k + 1) % 3).position -
                              triangulation.corner(slot + (k + 2) % 3).position;
            if (side.norm() <= longest) continue;
            longest = side.norm();
            tip = slot + k;
        }
        layout.triangles.push_back({{difference(b[0], a[0]), difference(b[1], a[1]),
                                     difference(c[0], a[0]), difference(c[1], a[1])},
                                    sectors.vertex[at(triangulation.corner(tip).vertex)]});
    }
    layout.vertex_count =
        static_cast<std::size_t>(std::count(stays.begin(), stays.end(), true)) + left.size();
    return layout;
}

}  // namespace fcn
