// The layout on which integers are chosen (Coudert-Osmont, Desobry, Heistermann, Bommes, Ray,
// Sokolov 2023, "Quad mesh quantization without a T-mesh"): the mesh decimated to the vertices that
// have to be grid points, in the metric of the seamless map. They collapse edges; here flat
// vertices are taken out of an intrinsic triangulation, which changes no metric.
#include "meshing/coarse_layout.h"

#include <algorithm>
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

/// Vertices that stay: singular ones, corners of the boundary, ends and joints of hard curves.
std::vector<bool> grid_points(const Mesh& mesh, const MapProblem& problem, const CornerMap& map) {
    std::vector<bool> result(mesh.n_vertices(), false);
    for (const VertexHandle vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex)) continue;
        int hard = 0;
        for (const EdgeHandle edge : mesh.ve_range(vertex))
            hard += problem.is_hard[at(edge.idx())] && !mesh.is_boundary(edge);
        const int regular = mesh.is_boundary(vertex) ? 2 : 4;
        result[at(vertex.idx())] = hard > 0 || problem.cut.is_singular[at(vertex.idx())] != 0 ||
                                   quarters_around(mesh, map, vertex) != regular;
    }
    return result;
}

}  // namespace

CoarseLayout make_coarse_layout(const Mesh& mesh, const MapProblem& problem,
                                const Eigen::VectorXd& free_values) {
    const Eigen::VectorXd values = problem.unknowns.basis * free_values;
    const std::vector<bool> stays = grid_points(mesh, problem, corner_map(problem, values));
    IntrinsicTriangulation triangulation(mesh, problem, values, problem.is_hard);
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
        layout.triangles.push_back({{difference(b[0], a[0]), difference(b[1], a[1]),
                                     difference(c[0], a[0]), difference(c[1], a[1])}});
    }
    layout.vertex_count =
        static_cast<std::size_t>(std::count(stays.begin(), stays.end(), true)) + left.size();
    return layout;
}

}  // namespace fcn
