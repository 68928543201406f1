// Painted values come from programs that weld, reorder or round vertices, so where a file has
// positions they decide, within a hundred-thousandth of the diagonal.

#include "app/importance_file.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <map>

#include "app/inputs.h"
#include "geometry/errors.h"
#include "geometry/text_cursor.h"
#include "geometry/vertex_values.h"

namespace fcn::app {
namespace {

constexpr double kSamePlace = 1e-5;  ///< in diagonals

using Cell = std::array<long long, 3>;

Cell cell_of(const Vec3& point, double size) {
    return {std::llround(point[0] / size), std::llround(point[1] / size),
            std::llround(point[2] / size)};
}

/// The value painted at each vertex's position.
std::vector<double> looked_up(const VertexValues& painted, const std::string& path,
                              const LoadedMesh& mesh) {
    const double size = kSamePlace * bounding_box(mesh.mesh).diagonal();
    std::map<Cell, std::vector<std::size_t>> cells;
    for (std::size_t k = 0; k < painted.points.size(); ++k)
        cells[cell_of(painted.points[k], size)].push_back(k);
    std::vector<double> values;
    for (const VertexHandle v : mesh.mesh.vertices()) {
        const Vec3& point = mesh.mesh.point(v);
        const Cell center = cell_of(point, size);
        double best = size;
        std::size_t found = painted.points.size();
        for (int k = 0; k < 27; ++k) {
            const auto at = cells.find(
                {center[0] + k % 3 - 1, center[1] + k / 3 % 3 - 1, center[2] + k / 9 - 1});
            if (at == cells.end()) continue;
            for (const std::size_t candidate : at->second) {
                const double distance = (painted.points[candidate] - point).norm();
                if (distance > best || (distance == best && candidate > found)) continue;
                best = distance;
                found = candidate;
            }
        }
        if (found == painted.points.size())
            throw InputError(fmt::format("{}: no value at vertex {} ({}, {}, {}) of the mesh", path,
                                         v.idx(), point[0], point[1], point[2]));
        values.push_back(painted.values[found]);
    }
    return values;
}

std::vector<double> read_column(const std::string& text, const std::string& path,
                                const LoadedMesh& mesh) {
    TextCursor in(text, path, '#');
    VertexValues painted;
    int columns = 0;
    while (!in.peek().empty()) {
        std::vector<double> row{in.number("a value")};
        while (row.size() < 5) {
            const std::string_view token = in.token_on_line();
            if (token.empty()) break;
            row.push_back(in.parse_number(token, "a value"));
        }
        const int count = static_cast<int>(row.size());
        if ((count != 1 && count != 4) || (columns > 0 && count != columns))
            in.fail("expected one number a line, or four (x y z value)");
        columns = count;
        if (count == 4) painted.points.emplace_back(row[0], row[1], row[2]);
        painted.values.push_back(row.back());
        in.skip_line();
    }
    if (columns == 4) return looked_up(painted, path, mesh);
    if (painted.values.size() != mesh.mesh.n_vertices())
        throw InputError(fmt::format("{}: {} values, the mesh has {} vertices (after repair)", path,
                                     painted.values.size(), mesh.mesh.n_vertices()));
    return painted.values;
}

}  // namespace

std::vector<double> read_importance(const std::string& path, const std::string& property,
                                    const LoadedMesh& mesh) {
    const std::string text = read_text(path);
    if (text.starts_with("ply"))
        return looked_up(read_ply_values(text, path, property), path, mesh);
    return read_column(text, path, mesh);
}

}  // namespace fcn::app
