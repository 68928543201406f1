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
constexpr int kSamples = 4;  ///< of a part of a quad, in either direction

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class RowDivision {
public:
    RowDivision(const GridMap& map, const GridVertices& vertices, const std::vector<int>& owners,
                const std::vector<int>& arrivals, const std::vector<std::array<int, 4>>& sides,
                const Mesh& domain, const RowOptions& options)
        : map_(map),
          walk_(map),
          vertices_(vertices),
          owners_(owners),
          arrivals_(arrivals),
          sides_(sides),
          domain_(domain),
          options_(options) {
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
        if (options_.tolerance > 0) follow_surface();
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

    /// The point i / m along the line out of a port and j / n to its left.
    SurfacePoint point_at(int p, int i, int m, int j, int n) const {
        const GridPort& port = vertices_.port(p);
        GridPlace place{port.face, port.image, port.direction};
        const auto go = [&](int part, int count, int turn) {
            if (part == 0) return;
            place.direction = (place.direction + turn) & 3;
            if (const auto there = walk_.go(place, map_.unit() / count * part)) place = *there;
        };
        go(i, m, 0);
        go(j, n, 1);
        SurfacePoint point;
        point.face = place.face;
        point.barycentric = map_.barycentric(place.face, place.image);
        return point;
    }

    void place_vertices() {
        for (int v = 0; v < vertices_.count(); ++v) result_.places.push_back(vertices_.place(v));
        for (const auto& [p, i, m, j, n] : inner_)
            result_.places.push_back(point_at(p, i, m, j, n));
    }

    std::size_t quads_with(int row) const {
        std::size_t count = 0;
        for (const auto& quad : sides_) {
            const int a = row_of_[at(edge(quad[0]))], b = row_of_[at(edge(quad[1]))];
            count += static_cast<std::size_t>((parts_[at(a)] + (a == row)) *
                                              (parts_[at(b)] + (b == row)));
        }
        return count;
    }

    /// Divides rows whose sides or middles are far from the surface, the worst first.
    void follow_surface() {
        for (int round = 0; round < kMostRounds; ++round) {
            const std::vector<double> off = distances_by_row();
            std::vector<int> order;
            for (int row = 0; row < static_cast<int>(off.size()); ++row)
                if (off[at(row)] > options_.tolerance && parts_[at(row)] < kMostParts)
                    order.push_back(row);
            std::stable_sort(order.begin(), order.end(),
                             [&](int a, int b) { return off[at(a)] > off[at(b)]; });
            bool is_changed = false;
            for (const int row : order) {
                if (quads_with(row) > options_.most_quads) continue;
                ++parts_[at(row)];
                is_changed = true;
                break;
            }
            if (!is_changed) break;
        }
        build();
    }

    /// Per row, how far its quads are from the surface: where that can be seen on sides that the
    /// row crosses, there, else inside.
    std::vector<double> distances_by_row() {
        std::vector<double> off(row_of_.size(), 0);
        distances_.resize(sides_.size());
        for (std::size_t q = 0; q < sides_.size(); ++q) {
            const int across = row(sides_[q][0]), along = row(sides_[q][1]);
            QuadDistances& own = distances_[q];
            if (own.across != parts_[at(across)] || own.along != parts_[at(along)])
                own = distances_of(sides_[q]);
            off[at(across)] = std::max(off[at(across)], own.on_across);
            off[at(along)] = std::max(off[at(along)], own.on_along);
            if (std::max(own.on_across, own.on_along) > options_.tolerance) continue;
            const int cheap = lengths_[at(across)] * own.across <= lengths_[at(along)] * own.along
                                  ? across
                                  : along;
            off[at(cheap)] = std::max(off[at(cheap)], own.inside);
        }
        return off;
    }

    struct QuadDistances {
        int across = 0, along = 0;  ///< parts for which they are known
        double on_across = 0, on_along = 0, inside = 0;
    };

    QuadDistances distances_of(const std::array<int, 4>& quad) const {
        QuadDistances result;
        result.across = parts_[at(row(quad[0]))];
        result.along = parts_[at(row(quad[1]))];
        const int m = kSamples * result.across, n = kSamples * result.along;
        std::vector<Vec3> points;
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= m; ++i)
                points.push_back(position(domain_, point_at(quad[0], i, m, j, n)));
        const auto point = [&](int i, int j) { return points[at(j * (m + 1) + i)]; };
        for (int j = 0; j <= n; ++j) {
            for (int i = 0; i <= m; ++i) {
                // In the part's own coordinates.
                const int left = std::min(i / kSamples * kSamples, m - kSamples);
                const int below = std::min(j / kSamples * kSamples, n - kSamples);
                const double u = (i - left) / double(kSamples), v = (j - below) / double(kSamples);
                const Vec3 flat = (1 - u) * (1 - v) * point(left, below) +
                                  u * (1 - v) * point(left + kSamples, below) +
                                  u * v * point(left + kSamples, below + kSamples) +
                                  (1 - u) * v * point(left, below + kSamples);
                const double distance = (point(i, j) - flat).norm();
                double& where = j % kSamples == 0   ? result.on_across
                                : i % kSamples == 0 ? result.on_along
                                                    : result.inside;
                where = std::max(where, distance);
            }
        }
        return result;
    }

    /// A vertex i / m along the line out of a port and j / n to its left.
    struct InnerVertex {
        int port = -1, i = 0, m = 1, j = 0, n = 1;
    };

    const GridMap& map_;
    const GridWalk walk_;
    const GridVertices& vertices_;
    const std::vector<int>&owners_, &arrivals_;
    const std::vector<std::array<int, 4>>& sides_;
    const Mesh& domain_;
    const RowOptions& options_;
    std::vector<int> row_of_;           ///< per port that names an edge; a port that names the row
    std::vector<int> parts_, lengths_;  ///< by row
    std::map<std::array<int, 3>, int> known_;
    std::vector<InnerVertex> inner_;
    int vertex_count_ = 0;
    std::vector<QuadDistances> distances_;
    DividedRows result_;
    std::vector<std::array<Side, 4>> sides_of_;  ///< of the result's faces
};

}  // namespace

DividedRows divide_rows(const GridMap& map, const GridVertices& vertices,
                        const std::vector<int>& owners, const std::vector<int>& arrivals,
                        const std::vector<std::array<int, 4>>& sides, const Mesh& domain,
                        const RowOptions& options) {
    return RowDivision(map, vertices, owners, arrivals, sides, domain, options).run();
}

}  // namespace fcn
