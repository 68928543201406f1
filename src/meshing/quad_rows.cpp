// Rows of quads divided where a surface is too thin for the grid. Around a tube of one or two quads
// edges have the same ends, which is no mesh. Dividing all quads of a row that runs along the tube
// puts more of them around it and keeps everything else. A row goes from quad to quad through
// opposite sides, so its division is a number that opposite sides share; a quad becomes a small
// grid of as many parts as its two rows have. Rows grow until nothing is wrong.
#include "meshing/quad_rows.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "meshing/grid_walk.h"

namespace fcn {
namespace {

constexpr int kMostParts = 4;
constexpr int kMostRounds = 200;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class RowDivision {
public:
    RowDivision(const GridMap& map, const GridVertices& vertices, const std::vector<int>& owners,
                const std::vector<int>& arrivals, const std::vector<std::array<int, 4>>& sides)
        : map_(map), vertices_(vertices), owners_(owners), arrivals_(arrivals), sides_(sides) {
        find_rows();
    }

    DividedRows run() {
        build();
        for (int round = 0; round < kMostRounds; ++round) {
            const std::vector<int> rows = rows_to_divide();
            if (rows.empty()) break;
            for (const int row : rows) ++parts_[at(row)];
            build();
        }
        for (std::size_t row = 0; row < parts_.size(); ++row)
            result_.divided += parts_[row] > 1 && row_of_[row] == static_cast<int>(row);
        place_vertices();
        return std::move(result_);
    }

private:
    /// A side of a part of a quad, and the row that crosses it.
    struct Side {
        int row = -1;
        std::array<int, 3> name{};  ///< the same for both quads at it
    };

    /// The port by which both sides of an edge know it.
    int edge(int port) const { return std::min(port, arrivals_[at(port)]); }
    int row(int port) const { return row_of_[at(edge(port))]; }

    void find_rows() {
        row_of_.resize(arrivals_.size());
        std::iota(row_of_.begin(), row_of_.end(), 0);
        const auto root = [&](int p) {
            while (row_of_[at(p)] != p) p = row_of_[at(p)] = row_of_[at(row_of_[at(p)])];
            return p;
        };
        for (const auto& quad : sides_)
            for (const std::size_t i : {0u, 1u}) {
                const int a = root(edge(quad[i])), b = root(edge(quad[i + 2]));
                row_of_[at(std::max(a, b))] = std::min(a, b);
            }
        for (std::size_t p = 0; p < row_of_.size(); ++p) row_of_[p] = root(static_cast<int>(p));
        parts_.assign(row_of_.size(), 1);
        lengths_.assign(row_of_.size(), 0);
        for (const auto& quad : sides_)
            for (const std::size_t i : {0u, 1u}) ++lengths_[at(row(quad[i]))];
    }

    /// The vertex a share of k / n along the side that begins at a port.
    int vertex_on_side(int port, int k, int n) {
        if (k == 0) return owners_[at(port)];
        if (k == n) return owners_[at(arrivals_[at(port)])];
        const bool is_first = edge(port) == port;
        const std::array<int, 3> name{edge(port), is_first ? k : n - k, -1};
        const auto [it, is_new] = known_.try_emplace(name, vertex_count_);
        if (is_new) {
            ++vertex_count_;
            inner_.push_back({edge(port), name[1], n, 0, 1});
        }
        return it->second;
    }

    void build() {
        known_.clear();
        inner_.clear();
        vertex_count_ = vertices_.count();
        result_.faces.clear();
        sides_of_.clear();
        for (int q = 0; q < static_cast<int>(sides_.size()); ++q) divide(q);
    }

    void divide(int q) {
        const auto& quad = sides_[at(q)];
        const int m = parts_[at(row(quad[0]))], n = parts_[at(row(quad[1]))];
        std::vector<int> grid(at((m + 1) * (n + 1)));
        const auto vertex = [&](int i, int j) -> int& { return grid[at(j * (m + 1) + i)]; };
        for (int j = 0; j <= n; ++j) {
            for (int i = 0; i <= m; ++i) {
                if (j == 0)
                    vertex(i, j) = vertex_on_side(quad[0], i, m);
                else if (i == m)
                    vertex(i, j) = vertex_on_side(quad[1], j, n);
                else if (j == n)
                    vertex(i, j) = vertex_on_side(quad[2], m - i, m);
                else if (i == 0)
                    vertex(i, j) = vertex_on_side(quad[3], n - j, n);
                else {
                    vertex(i, j) = vertex_count_++;
                    inner_.push_back({quad[0], i, m, j, n});
                }
            }
        }
        // Names of the sides of parts: on edges by the edge, inside by the quad.
        const auto along = [&](int i, int j, bool is_up) {
            const int own = is_up ? quad[1] : quad[0];
            Side side{row(own), {-1 - q, 2 * (j * (m + 1) + i) + is_up, 0}};
            const auto on_edge = [&](int port, int k, int count) {
                side.name = {edge(port), edge(port) == port ? k : count - 1 - k, 1};
            };
            if (!is_up && j == 0) on_edge(quad[0], i, m);
            if (!is_up && j == n) on_edge(quad[2], m - 1 - i, m);
            if (is_up && i == m) on_edge(quad[1], j, n);
            if (is_up && i == 0) on_edge(quad[3], n - 1 - j, n);
            return side;
        };
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < m; ++i) {
                result_.faces.push_back(
                    {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
                sides_of_.push_back({along(i, j, false), along(i + 1, j, true),
                                     along(i, j + 1, false), along(i, j, true)});
            }
        }
    }

    /// One row for each place where something is wrong.
    std::vector<int> rows_to_divide() const {
        std::map<std::array<int, 2>, std::vector<Side>> edges;
        std::vector<int> rows;
        const auto add_shortest = [&](const std::vector<int>& candidates) {
            int best = -1;
            for (const int r : candidates)
                if (std::find(rows.begin(), rows.end(), r) != rows.end()) return;
            for (const int r : candidates)
                if (parts_[at(r)] < kMostParts &&
                    (best < 0 ||
                     lengths_[at(r)] * parts_[at(r)] < lengths_[at(best)] * parts_[at(best)]))
                    best = r;
            if (best >= 0) rows.push_back(best);
        };
        for (std::size_t f = 0; f < result_.faces.size(); ++f) {
            const auto& face = result_.faces[f];
            const auto& sides = sides_of_[f];
            if (face[0] == face[2] || face[1] == face[3])
                add_shortest({sides[0].row, sides[1].row});
            for (std::size_t i = 0; i < 4; ++i) {
                const int a = face[i], b = face[(i + 1) % 4];
                auto& there = edges[{std::min(a, b), std::max(a, b)}];
                if (std::none_of(there.begin(), there.end(),
                                 [&](const Side& side) { return side.name == sides[i].name; }))
                    there.push_back(sides[i]);
            }
        }
        for (const auto& [ends, there] : edges) {
            if (there.size() < 2 && ends[0] != ends[1]) continue;
            std::vector<int> candidates;
            for (const Side& side : there) candidates.push_back(side.row);
            add_shortest(candidates);
        }
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        return rows;
    }

    void place_vertices() {
        for (int v = 0; v < vertices_.count(); ++v) result_.places.push_back(vertices_.place(v));
        const GridWalk walk(map_);
        for (const auto& [p, i, m, j, n] : inner_) {
            const GridPort& port = vertices_.port(p);
            GridPlace place{port.face, port.image, port.direction};
            const auto go = [&](int part, int count, int turn) {
                if (part == 0) return;
                place.direction = (place.direction + turn) & 3;
                if (const auto there = walk.go(place, map_.unit() / count * part)) place = *there;
            };
            go(i, m, 0);
            go(j, n, 1);
            SurfacePoint point;
            point.face = place.face;
            point.barycentric = map_.barycentric(place.face, place.image);
            result_.places.push_back(point);
        }
    }

    /// A vertex i / m along the line out of a port and j / n to its left.
    struct InnerVertex {
        int port = -1, i = 0, m = 1, j = 0, n = 1;
    };

    const GridMap& map_;
    const GridVertices& vertices_;
    const std::vector<int>&owners_, &arrivals_;
    const std::vector<std::array<int, 4>>& sides_;
    std::vector<int> row_of_;           ///< per port that names an edge; a port that names the row
    std::vector<int> parts_, lengths_;  ///< by row
    std::map<std::array<int, 3>, int> known_;
    std::vector<InnerVertex> inner_;
    int vertex_count_ = 0;
    DividedRows result_;
    std::vector<std::array<Side, 4>> sides_of_;  ///< of the result's faces
};

}  // namespace

DividedRows divide_rows(const GridMap& map, const GridVertices& vertices,
                        const std::vector<int>& owners, const std::vector<int>& arrivals,
                        const std::vector<std::array<int, 4>>& sides) {
    return RowDivision(map, vertices, owners, arrivals, sides).run();
}

}  // namespace fcn
