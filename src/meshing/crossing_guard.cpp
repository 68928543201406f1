// Walls and gaps thinner than an edge's sagitta: a collapse, flip or move there can make the two
// sheets cross, although each of them stays near its own surface. Undoing that later is hard, since
// the sheets have to find back to their sides; so the input being free of crossings, no change that
// makes one is allowed. A change is judged by the triangles it makes against those near them, by
// exact predicates; where triangles cross already (inputs do), there may not be more of them.
#include "meshing/crossing_guard.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meshing/self_intersections.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kFacing = 0.2;  ///< cosine: what faces a vertex that looks the other way

/// Triangles that cover more cells than this are not worth listing everywhere; they are rare.
constexpr int kMostCells = 4096;

}  // namespace

void mark_thin_places(WorkingMesh& mesh, const ReferenceSurface& reference, double reach) {
    for (int v = 0; v < mesh.vertex_end(); ++v)
        if (mesh.is_vertex_alive(v)) mesh.set_thin(v, false);
    for (int f = 0; f < mesh.face_end(); ++f) {
        if (!mesh.is_face_alive(f)) continue;
        const auto [a, b, c] = mesh.corners(f);
        if (mesh.is_thin(a) && mesh.is_thin(b) && mesh.is_thin(c)) continue;
        if (mesh.is_face_resting(f)) continue;
        const Vec3 center = (mesh.point(a) + mesh.point(b) + mesh.point(c)) / 3;
        const double radius = std::sqrt(std::max({(mesh.point(a) - center).squaredNorm(),
                                                  (mesh.point(b) - center).squaredNorm(),
                                                  (mesh.point(c) - center).squaredNorm()}));
        const Vec3 normal = triangle_normal(mesh.point(a), mesh.point(b), mesh.point(c));
        if (!reference.is_any_facing(center, -normal, reach + 0.5 * radius, kFacing)) continue;
        for (const int v : {a, b, c}) mesh.set_thin(v, true);
    }
}

std::size_t CrossingGuard::CellHash::operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const int i : cell) hash = hash * 0x9E3779B97F4A7C15ULL + static_cast<std::uint32_t>(i);
    return static_cast<std::size_t>(hash ^ (hash >> 29));
}

CrossingGuard::CrossingGuard(const WorkingMesh& mesh, double cell) : mesh_(mesh), cell_(cell) {
    for (int f = 0; f < mesh.face_end(); ++f)
        if (mesh.is_face_alive(f)) update_face(f);
}

bool CrossingGuard::is_watched(int f) const {
    const auto [a, b, c] = mesh_.corners(f);
    return mesh_.is_thin(a) || mesh_.is_thin(b) || mesh_.is_thin(c);
}

CrossingGuard::Triangle CrossingGuard::triangle(int f) const {
    const auto [a, b, c] = mesh_.corners(f);
    return {{{a, mesh_.point(a)}, {b, mesh_.point(b)}, {c, mesh_.point(c)}}};
}

std::array<CrossingGuard::Cell, 2> CrossingGuard::cells_of(const Triangle& t) const {
    const Vec3 low = t[0].point.cwiseMin(t[1].point).cwiseMin(t[2].point) / cell_;
    const Vec3 high = t[0].point.cwiseMax(t[1].point).cwiseMax(t[2].point) / cell_;
    std::array<Cell, 2> cells;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto k = static_cast<int>(i);
        cells[0][i] = static_cast<int>(std::clamp(std::floor(low[k]), -1e9, 1e9));
        cells[1][i] = static_cast<int>(std::clamp(std::floor(high[k]), -1e9, 1e9));
    }
    return cells;
}

void CrossingGuard::update_face(int f) {
    if (!is_watched(f)) return;
    const auto [low, high] = cells_of(triangle(f));
    double cells = 1;
    for (std::size_t i = 0; i < 3; ++i) cells *= high[i] - low[i] + 1.0;
    if (cells > kMostCells) return;
    is_empty_ = false;
    for (int x = low[0]; x <= high[0]; ++x)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int z = low[2]; z <= high[2]; ++z) {
                std::vector<int>& faces = grid_[{x, y, z}];
                if (std::find(faces.begin(), faces.end(), f) == faces.end()) faces.push_back(f);
            }
}

void CrossingGuard::update_star(int v) {
    if (is_empty_) return;
    mesh_.visit_star(v, [&](int h) {
        update_face(WorkingMesh::face(h));
        return true;
    });
}

std::size_t CrossingGuard::count(const Triangle& t, const std::vector<int>& left_out) const {
    const auto [low, high] = cells_of(t);
    candidates_.clear();
    stamps_.resize(static_cast<std::size_t>(mesh_.face_end()), 0);
    ++stamp_;
    for (const int f : left_out) stamps_[static_cast<std::size_t>(f)] = stamp_;
    for (int x = low[0]; x <= high[0]; ++x)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int z = low[2]; z <= high[2]; ++z) {
                const auto cell = grid_.find({x, y, z});
                if (cell == grid_.end()) continue;
                for (const int f : cell->second) {
                    if (f >= mesh_.face_end() || !mesh_.is_face_alive(f)) continue;
                    unsigned& stamp = stamps_[static_cast<std::size_t>(f)];
                    if (stamp == stamp_) continue;
                    stamp = stamp_;
                    candidates_.push_back(f);
                }
            }
    std::size_t crossings = 0;
    for (const int f : candidates_) {
        const Triangle other = triangle(f);
        crossings += do_triangles_cross({t[0].vertex, t[1].vertex, t[2].vertex},
                                        {t[0].point, t[1].point, t[2].point},
                                        {other[0].vertex, other[1].vertex, other[2].vertex},
                                        {other[0].point, other[1].point, other[2].point});
    }
    return crossings;
}

bool CrossingGuard::allows(const std::vector<Triangle>& after,
                           const std::vector<int>& replaced) const {
    std::size_t now = 0;
    for (const Triangle& t : after) now += count(t, replaced);
    if (now == 0) return true;
    std::size_t before = 0;
    for (const int f : replaced) before += count(triangle(f), replaced);
    return now <= before;
}

bool CrossingGuard::allows_move(int v, const Vec3& to) const {
    if (is_empty_ || !mesh_.is_thin(v)) return true;
    std::vector<Triangle> after;
    std::vector<int> replaced;
    mesh_.visit_star(v, [&](int h) {
        replaced.push_back(WorkingMesh::face(h));
        after.push_back({{{v, to},
                          {mesh_.to(h), mesh_.point(mesh_.to(h))},
                          {mesh_.apex(h), mesh_.point(mesh_.apex(h))}}});
        return true;
    });
    return allows(after, replaced);
}

bool CrossingGuard::allows_collapse(int h, int vanishing) const {
    const int staying = mesh_.from(h) == vanishing ? mesh_.to(h) : mesh_.from(h);
    if (is_empty_ || !(mesh_.is_thin(vanishing) || mesh_.is_thin(staying))) return true;
    std::vector<Triangle> after;
    std::vector<int> replaced;
    mesh_.visit_star(vanishing, [&](int out) {
        replaced.push_back(WorkingMesh::face(out));
        const int b = mesh_.to(out), c = mesh_.apex(out);
        if (b != staying && c != staying)
            after.push_back(
                {{{staying, mesh_.point(staying)}, {b, mesh_.point(b)}, {c, mesh_.point(c)}}});
        return true;
    });
    return allows(after, replaced);
}

bool CrossingGuard::allows_flip(int h) const {
    const int t = mesh_.twin(h);
    const int f = WorkingMesh::face(h), g = WorkingMesh::face(t);
    if (is_empty_ || !(is_watched(f) || is_watched(g))) return true;
    const auto corner = [&](int v) { return Corner{v, mesh_.point(v)}; };
    const Corner a = corner(mesh_.from(h)), b = corner(mesh_.to(h)), c = corner(mesh_.apex(h)),
                 d = corner(mesh_.apex(t));
    return allows({{{d, c, a}}, {{c, d, b}}}, {f, g});
}

std::size_t CrossingGuard::crossings(const std::vector<int>& faces) const {
    if (is_empty_) return 0;
    std::size_t sum = 0;
    const std::vector<int> none;
    std::vector<int> self(1);
    for (const int f : faces) {
        if (!is_watched(f)) continue;
        self[0] = f;
        sum += count(triangle(f), self);
    }
    return sum;
}

}  // namespace fcn
