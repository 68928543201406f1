// A map to the plane in whole numbers. Ebke, Bommes, Campen, Kobbelt 2013 (section 3) truncate
// coordinates so that transitions between charts lose no bits, then decide orientation exactly.
// Coordinates that are truncated like that are multiples of one power of two, so here they become
// integers once, and all that follows is integer arithmetic: 62 bits a coordinate, 128 a product.
// Transitions are not trusted but found from the coordinates on both sides of an edge.
#include "meshing/grid_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fcn {
namespace {

__extension__ using Wide = __int128;

constexpr int kCoordinateBits = 60;  ///< differences take one more, cross products fit 128

Wide cross(const GridPoint& a, const GridPoint& b) { return Wide{a.u} * b.v - Wide{a.v} * b.u; }

/// For a direction, whose coordinates are -1, 0, 1.
int dot_sign(const GridPoint& direction, const GridPoint& p) {
    const std::int64_t dot = direction.u * p.u + direction.v * p.v;
    return dot > 0 ? 1 : dot < 0 ? -1 : 0;
}

Wide floor_ratio(Wide a, Wide b) {
    const Wide ratio = a / b;
    return ratio - (a % b != 0 && (a < 0) != (b < 0));
}

}  // namespace

GridPoint turned(const GridPoint& p, int quarters) {
    switch (quarters & 3) {
        case 1:
            return {-p.v, p.u};
        case 2:
            return {-p.u, -p.v};
        case 3:
            return {p.v, -p.u};
        default:
            return p;
    }
}

GridPoint direction_vector(int direction) { return turned(GridPoint{1, 0}, direction); }

int orientation(const GridPoint& a, const GridPoint& b) {
    const Wide area = cross(a, b);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

GridMap::GridMap(const Mesh& mesh, const CornerMap& map) {
    if (map.uv.size() != mesh.n_faces()) {
        fault_ = "a map of " + std::to_string(map.uv.size()) + " faces for a mesh of " +
                 std::to_string(mesh.n_faces());
        return;
    }
    copy_connectivity(mesh);
    scale(map) && check_faces() && find_transitions() && check_boundary() && check_vertices();
}

void GridMap::copy_connectivity(const Mesh& mesh) {
    from_.resize(3 * mesh.n_faces());
    twin_.assign(from_.size(), -1);
    out_.assign(mesh.n_vertices(), -1);
    std::vector<int> number(mesh.n_halfedges(), -1);
    for (const FaceHandle face : mesh.faces()) {
        HalfedgeHandle h = mesh.halfedge_handle(face);
        for (int i = 0; i < 3; ++i, h = mesh.next_halfedge_handle(h)) {
            number[at(h.idx())] = 3 * face.idx() + i;
            from_[at(3 * face.idx() + i)] = mesh.from_vertex_handle(h).idx();
        }
    }
    for (const HalfedgeHandle h : mesh.halfedges())
        if (number[at(h.idx())] >= 0)
            twin_[at(number[at(h.idx())])] = number[at(mesh.opposite_halfedge_handle(h).idx())];
    for (int h = static_cast<int>(from_.size()) - 1; h >= 0; --h)
        if (out_[at(from(h))] < 0 || twin(h) < 0) out_[at(from(h))] = h;
}

bool GridMap::scale(const CornerMap& map) {
    double largest = 1, area = 0;
    for (std::size_t f = 0; f < map.uv.size(); ++f) {
        const auto& [a, b, c] = map.uv[f];
        for (const Vec2& p : map.uv[f]) largest = std::max(largest, p.cwiseAbs().maxCoeff());
        const Vec2 ab = b - a, ac = c - a;
        area += std::abs(ab[0] * ac[1] - ab[1] * ac[0]) / 2;
        if (!a.allFinite() || !b.allFinite() || !c.allFinite()) {
            fault_ = "face " + std::to_string(f) + ": coordinates that are not finite";
            return false;
        }
    }
    const int whole_bits = std::ilogb(largest) + 1;
    if (whole_bits > 30 || !(area < kMostQuads)) {
        fault_ = "more than " + std::to_string(static_cast<long>(kMostQuads)) + " quads";
        return false;
    }
    bits_ = kCoordinateBits - whole_bits;
    images_.resize(from_.size());
    for (std::size_t h = 0; h < images_.size(); ++h) {
        const Vec2& p = map.uv[h / 3][h % 3];
        const double u = std::ldexp(p[0], bits_), v = std::ldexp(p[1], bits_);
        images_[h] = {static_cast<std::int64_t>(u), static_cast<std::int64_t>(v)};
        if (static_cast<double>(images_[h].u) == u && static_cast<double>(images_[h].v) == v)
            continue;
        fault_ = "face " + std::to_string(h / 3) + ": coordinates that are not truncated";
        return false;
    }
    return true;
}

bool GridMap::check_faces() {
    for (int h = 0; h < static_cast<int>(from_.size()); h += 3) {
        const int sign = side(h, image(prev(h)));
        if (sign > 0) continue;
        fault_ =
            "face " + std::to_string(face(h)) + (sign < 0 ? ": turned over" : ": without area");
        return false;
    }
    return true;
}

bool GridMap::find_transitions() {
    across_.resize(from_.size());
    for (int h = 0; h < static_cast<int>(from_.size()); ++h) {
        const int other = twin(h);
        if (other < 0) continue;
        const GridPoint there = image(other) - image(next(other));
        int quarters = 0;
        while (quarters < 4 && turned(vector(h), quarters) != there) ++quarters;
        const GridPoint shift = image(next(other)) - turned(image(h), quarters);
        if (quarters < 4 && is_whole(shift)) {
            across_[at(h)] = {quarters, shift};
            continue;
        }
        fault_ = "edge between faces " + std::to_string(face(h)) + " and " +
                 std::to_string(face(other)) +
                 (quarters == 4 ? ": not a quarter turn" : ": shift is not whole");
        return false;
    }
    return true;
}

bool GridMap::check_vertices() {
    for (int v = 0; v < vertex_count(); ++v) {
        if (out(v) < 0 || is_whole(image(out(v)))) continue;
        const int count = direction_count(v);
        if (count == (is_boundary(v) ? 3 : 4)) continue;
        fault_ = "vertex " + std::to_string(v) + ": valence " + std::to_string(count) +
                 ", not on the grid";
        return false;
    }
    return true;
}

bool GridMap::check_boundary() {
    const std::int64_t mask = unit() - 1;
    for (int h = 0; h < static_cast<int>(from_.size()); ++h) {
        if (twin(h) >= 0) continue;
        const GridPoint p = image(h), d = vector(h);
        if ((d.u == 0 && (p.u & mask) == 0) || (d.v == 0 && (p.v & mask) == 0)) continue;
        fault_ = "face " + std::to_string(face(h)) + ": boundary edge off the lines of the grid";
        return false;
    }
    return true;
}

std::vector<GridPoint> GridMap::whole_points(int f) const {
    std::vector<GridPoint> points;
    const GridPoint corners[] = {image(3 * f), image(3 * f + 1), image(3 * f + 2)};
    const auto [low, high] = std::minmax({corners[0].v, corners[1].v, corners[2].v});
    const std::int64_t step = unit();
    const auto round_up = [&](Wide x) { return -floor_ratio(-x, step) * step; };
    for (Wide row = round_up(low); row <= high; row += step) {
        Wide left = std::min({corners[0].u, corners[1].u, corners[2].u});
        Wide right = std::max({corners[0].u, corners[1].u, corners[2].u});
        // Left of the edge from a by d: d.v (u - a.u) <= d.u (v - a.v).
        for (int h = 3 * f; h < 3 * f + 3; ++h) {
            const GridPoint a = image(h), d = vector(h);
            const Wide reach = d.u * (row - a.v);
            if (d.v > 0) right = std::min(right, a.u + floor_ratio(reach, d.v));
            if (d.v < 0) left = std::max(left, a.u - floor_ratio(reach, -d.v));
        }
        for (Wide u = round_up(left); u <= right; u += step)
            points.push_back({static_cast<std::int64_t>(u), static_cast<std::int64_t>(row)});
    }
    return points;
}

Vec3 GridMap::barycentric(int f, const GridPoint& p) const {
    Vec3 weights;
    for (int i = 0; i < 3; ++i) {
        const int h = 3 * f + i;
        weights[(i + 2) % 3] = std::max(0.0, static_cast<double>(cross(vector(h), p - image(h))));
    }
    return weights / weights.sum();
}

bool GridMap::is_in_corner(int h, int d) const {
    const GridPoint direction = direction_vector(d);
    const GridPoint end = image(prev(h)) - image(h);
    return orientation(vector(h), direction) >= 0 && orientation(direction, end) > 0;
}

bool GridMap::is_on_corner_end(int h, int d) const {
    const GridPoint direction = direction_vector(d);
    const GridPoint end = image(prev(h)) - image(h);
    return orientation(direction, end) == 0 && dot_sign(direction, end) > 0;
}

bool GridMap::is_in_half_plane(int h, int d) const {
    const GridPoint direction = direction_vector(d), along = vector(h);
    const int sign = orientation(along, direction);
    return sign > 0 || (sign == 0 && dot_sign(direction, along) > 0);
}

int GridMap::direction_count(int v) const {
    int count = 0, h = out(v), last = h;
    if (h < 0) return 0;
    do {
        for (int d = 0; d < 4; ++d) count += is_in_corner(h, d);
        last = h;
        h = twin(prev(h));
    } while (h >= 0 && h != out(v));
    if (h >= 0) return count;
    for (int d = 0; d < 4; ++d) count += is_on_corner_end(last, d);
    return count;
}

}  // namespace fcn
