// Connectivity of quad meshes: halfedges are paired by sorting their end points, so that what is
// checked rests on the faces alone; the fans around vertices are walked over these pairs.
#include "meshing/quad_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/polygon_soup.h"

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Faces of any fixed number of corners.
template <std::size_t N>
class Connectivity {
public:
    Connectivity(std::size_t point_count, const std::vector<std::array<int, N>>& faces)
        : points_(static_cast<int>(point_count)), faces_(faces) {}

    QuadTopology check() {
        if (is_faulty_index() || is_faulty_edge()) return result_;
        count();
        return result_;
    }
    /// After a check without a fault.
    std::vector<int> take_opposites() { return std::move(opposite_); }

private:
    static constexpr int kCorners = static_cast<int>(N);
    int halfedge_count() const { return kCorners * static_cast<int>(faces_.size()); }
    int from(int h) const { return faces_[at(h / kCorners)][at(h % kCorners)]; }
    int to(int h) const { return from(next(h)); }
    std::pair<int, int> ends(int h) const {
        return {std::min(from(h), to(h)), std::max(from(h), to(h))};
    }
    static int next(int h) { return h % kCorners == kCorners - 1 ? h - kCorners + 1 : h + 1; }
    static int previous(int h) { return h % kCorners == 0 ? h + kCorners - 1 : h - 1; }

    bool fail(std::string what) {
        result_.fault = std::move(what);
        return true;
    }

    bool is_faulty_index() {
        if (faces_.empty()) return fail("there are no faces");
        std::vector<bool> is_used(at(points_), false);
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            std::array<int, N> corners = faces_[f];
            std::sort(corners.begin(), corners.end());
            if (corners.front() < 0 || corners.back() >= points_)
                return fail("face " + std::to_string(f) + " has a corner that is no vertex");
            if (std::adjacent_find(corners.begin(), corners.end()) != corners.end())
                return fail("face " + std::to_string(f) + " has a corner twice");
            for (const int v : corners) is_used[at(v)] = true;
        }
        const auto unused = std::find(is_used.begin(), is_used.end(), false);
        if (unused == is_used.end()) return false;
        return fail("vertex " + std::to_string(unused - is_used.begin()) + " has no face");
    }

    /// Pairs the halfedges on the way.
    bool is_faulty_edge() {
        std::vector<int> order(at(halfedge_count()));
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(),
                  [&](int a, int b) { return std::pair(ends(a), a) < std::pair(ends(b), b); });
        opposite_.assign(order.size(), -1);
        const auto is_same_edge = [&](int a, int b) { return ends(a) == ends(b); };
        edges_ = 0;
        for (std::size_t i = 0; i < order.size(); ++edges_) {
            std::size_t end = i + 1;
            while (end < order.size() && is_same_edge(order[i], order[end])) ++end;
            const int h = order[i];
            const auto [low, high] = ends(h);
            const std::string name = "edge " + std::to_string(low) + " " + std::to_string(high);
            if (end - i > 2) return fail(name + " has more than two faces");
            if (end - i == 2) {
                if (from(h) == from(order[i + 1])) return fail(name + " has faces that disagree");
                opposite_[at(h)] = order[i + 1];
                opposite_[at(order[i + 1])] = h;
            }
            i = end;
        }
        return is_faulty_fan();
    }

    /// Halfedges out of a vertex that can be reached from one of them.
    int fan_size(int start) const {
        int size = 0, h = start;
        do {  // counter-clockwise until a boundary
            ++size;
            h = opposite_[at(previous(h))];
        } while (h >= 0 && h != start);
        if (h == start) return size;
        for (h = opposite_[at(start)]; h >= 0; h = opposite_[at(h)]) {
            h = next(h);
            ++size;
        }
        return size;
    }

    bool is_faulty_fan() {
        std::vector<int> valence(at(points_), 0), some(at(points_), -1);
        for (int h = 0; h < halfedge_count(); ++h) {
            ++valence[at(from(h))];
            some[at(from(h))] = h;
        }
        for (int v = 0; v < points_; ++v)
            if (fan_size(some[at(v)]) != valence[at(v)])
                return fail("vertex " + std::to_string(v) + " has more than one fan of faces");
        return false;
    }

    void count() {
        result_.euler_characteristic = points_ - edges_ + static_cast<int>(faces_.size());
        std::vector<bool> is_seen(at(halfedge_count()), false);
        for (int h = 0; h < halfedge_count(); ++h) {
            if (opposite_[at(h)] >= 0 || is_seen[at(h)]) continue;
            ++result_.boundary_loops;
            int on = h;
            do {
                is_seen[at(on)] = true;
                on = next(on);
                while (opposite_[at(on)] >= 0) on = next(opposite_[at(on)]);
            } while (on != h);
        }
        std::vector<bool> is_reached(faces_.size(), false);
        std::vector<int> stack;
        for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
            if (is_reached[at(f)]) continue;
            ++result_.components;
            stack.assign(1, f);
            is_reached[at(f)] = true;
            while (!stack.empty()) {
                const int face = stack.back();
                stack.pop_back();
                for (int h = kCorners * face; h < kCorners * (face + 1); ++h) {
                    if (opposite_[at(h)] < 0) continue;
                    const int other = opposite_[at(h)] / kCorners;
                    if (is_reached[at(other)]) continue;
                    is_reached[at(other)] = true;
                    stack.push_back(other);
                }
            }
        }
    }

    int points_;
    const std::vector<std::array<int, N>>& faces_;
    std::vector<int> opposite_;
    int edges_ = 0;
    QuadTopology result_;
};

/// Features are edges, each once.
std::string feature_fault(const QuadMesh& mesh) {
    std::vector<std::array<int, 2>> edges;
    for (const auto& face : mesh.faces)
        for (std::size_t i = 0; i < 4; ++i) {
            const auto [low, high] = std::minmax(face[i], face[(i + 1) % 4]);
            edges.push_back({low, high});
        }
    std::sort(edges.begin(), edges.end());
    std::vector<std::array<int, 2>> features;
    for (const QuadFeatureEdge& feature : mesh.feature_edges) {
        const auto [low, high] = std::minmax(feature.from, feature.to);
        features.push_back({low, high});
    }
    std::sort(features.begin(), features.end());
    const auto name = [](const std::array<int, 2>& edge) {
        return "feature " + std::to_string(edge[0]) + " " + std::to_string(edge[1]);
    };
    const auto twice = std::adjacent_find(features.begin(), features.end());
    if (twice != features.end()) return name(*twice) + " is there twice";
    for (const auto& feature : features)
        if (!std::binary_search(edges.begin(), edges.end(), feature))
            return name(feature) + " is no edge";
    return {};
}

double least_sine(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double area = (b - a).cross(c - a).norm();
    const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
    const double product = ab * bc * ca;
    return product > 0 ? area * std::min({ab, bc, ca}) / product : 0;
}

}  // namespace

QuadTopology check_topology(const QuadMesh& mesh) {
    QuadTopology result = Connectivity<4>(mesh.points.size(), mesh.faces).check();
    if (result.fault.empty()) result.fault = feature_fault(mesh);
    if (result.fault.empty() && !mesh.face_labels.empty() &&
        mesh.face_labels.size() != mesh.faces.size())
        result.fault = "there are not as many labels as faces";
    for (std::size_t v = 0; result.fault.empty() && v < mesh.points.size(); ++v)
        if (!mesh.points[v].allFinite())
            result.fault = "vertex " + std::to_string(v) + " is not finite";
    return result;
}

QuadTopology topology_of(const Mesh& mesh) {
    std::vector<std::array<int, 3>> faces;
    for (const FaceHandle face : mesh.faces()) {
        const auto v = face_vertices(mesh, face);
        faces.push_back({v[0].idx(), v[1].idx(), v[2].idx()});
    }
    return Connectivity<3>(mesh.n_vertices(), faces).check();
}

std::vector<int> opposite_halfedges(const QuadMesh& mesh) {
    Connectivity<4> connectivity(mesh.points.size(), mesh.faces);
    connectivity.check();
    return connectivity.take_opposites();
}

std::vector<std::array<int, 3>> cut_into_triangles(const QuadMesh& mesh) {
    std::vector<std::array<int, 3>> triangles;
    triangles.reserve(2 * mesh.faces.size());
    for (const auto& [a, b, c, d] : mesh.faces) {
        const auto sine = [&](int i, int j, int k) {
            return least_sine(mesh.points[at(i)], mesh.points[at(j)], mesh.points[at(k)]);
        };
        if (std::min(sine(a, b, c), sine(a, c, d)) >= std::min(sine(b, c, d), sine(b, d, a))) {
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        } else {
            triangles.push_back({b, c, d});
            triangles.push_back({b, d, a});
        }
    }
    return triangles;
}

Mesh triangle_mesh(const QuadMesh& mesh) {
    RepairReport unused;
    return build_mesh(make_manifold({mesh.points, cut_into_triangles(mesh), {}}, unused));
}

}  // namespace fcn
