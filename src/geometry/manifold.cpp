// Triangle soup to oriented 2-manifold connectivity.
//
// Halfedges are grouped by their end points. Two at an edge are partners. More than two: partners
// are picked greedily, first those whose given orientations agree, then the straightest
// continuation, then the convex pair (two solids that touch along an edge come apart, a fin comes
// off the wall it stands on); who stays alone gets a boundary. Orientation then spreads
// breadth-first over partners, and where it cannot agree (a Moebius band) the edge is cut; a
// component keeps the orientation of its majority. The fans of corners that partners connect make
// the vertices: every fan but the first of a vertex gets a copy of it. What can be left are two
// edges with the same end points; one of them is split in the middle, since a mesh where two
// vertices do not determine their edge breaks most algorithms on it.

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/errors.h"
#include "geometry/polygon_soup.h"

namespace fcn {

namespace {

int next_in_face(int halfedge) { return halfedge % 3 == 2 ? halfedge - 2 : halfedge + 1; }
int previous_in_face(int halfedge) { return halfedge % 3 == 0 ? halfedge + 2 : halfedge - 1; }

class ManifoldMaker {
public:
    ManifoldMaker(TriangleSoup soup, RepairReport& report)
        : soup_(std::move(soup)), report_(report) {}

    ManifoldSoup run() {
        constexpr int kMostRounds = 16;
        for (int round = 0; round < kMostRounds; ++round) {
            pair_halfedges();
            orient();
            separate_fans();
            if (!split_repeated_edges()) {
                return {std::move(soup_), std::move(partner_)};
            }
        }
        throw LogicError("edges with equal end points remain after repair");
    }

private:
    int from(int halfedge) const { return soup_.triangles[halfedge / 3][halfedge % 3]; }
    int to(int halfedge) const { return from(next_in_face(halfedge)); }
    int apex(int halfedge) const { return from(previous_in_face(halfedge)); }
    int halfedge_count() const { return static_cast<int>(3 * soup_.triangles.size()); }

    /// Calls visit(begin, end) with the halfedges of each edge in ascending order.
    template <typename Visit>
    void for_each_edge(Visit visit) const {
        std::vector<int> begin(soup_.points.size() + 1, 0);
        for (int h = 0; h < halfedge_count(); ++h) ++begin[std::min(from(h), to(h)) + 1];
        for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
        std::vector<int> order(static_cast<std::size_t>(halfedge_count()));
        std::vector<int> cursor(begin.begin(), begin.end() - 1);
        for (int h = 0; h < halfedge_count(); ++h) order[cursor[std::min(from(h), to(h))]++] = h;
        const auto larger = [&](int h) { return std::max(from(h), to(h)); };
        for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
            const auto first = order.begin() + begin[v];
            const auto last = order.begin() + begin[v + 1];
            std::sort(first, last, [&](int g, int h) {
                return larger(g) != larger(h) ? larger(g) < larger(h) : g < h;
            });
            for (auto group = first; group != last;) {
                auto end = group;
                while (end != last && larger(*end) == larger(*group)) ++end;
                visit(group, end);
                group = end;
            }
        }
    }

    void pair_halfedges() {
        partner_.assign(static_cast<std::size_t>(halfedge_count()), -1);
        for_each_edge([&](auto begin, auto end) {
            if (end - begin == 2) {
                link(begin[0], begin[1]);
            } else if (end - begin > 2) {
                ++report_.split_edge_count;
                pair_at_crowded_edge(std::vector<int>(begin, end));
            }
        });
    }

    void link(int g, int h) {
        partner_[g] = h;
        partner_[h] = g;
    }

    struct Candidate {
        bool is_disagreeing;
        double bend;
        bool is_concave;
        int g, h;
    };

    /// Angle between the two faces at an edge as if `other` were oriented to agree with `one`.
    Candidate candidate(int one, int other) const {
        const Vec3& a = soup_.points[from(one)];
        const Vec3 axis = (soup_.points[to(one)] - a).normalized();
        const auto outward = [&](int h) {
            const Vec3 arm = soup_.points[apex(h)] - a;
            return Vec3((arm - axis * axis.dot(arm)).normalized());
        };
        const Vec3 left = outward(one);
        const Vec3 right = outward(other);
        Candidate result{from(one) == from(other), 0.0, false, one, other};
        // Straight is when the arms are opposite; round so that ties are ties.
        result.bend = std::round((1.0 + left.dot(right)) * 1e6);
        const Vec3 normal = axis.cross(left);
        result.is_concave = right.dot(normal) > 0;
        return result;
    }

    void pair_at_crowded_edge(const std::vector<int>& halfedges) {
        // Beyond this many faces at one edge nothing sensible can be joined.
        constexpr std::size_t kMostFaces = 64;
        if (halfedges.size() > kMostFaces) return;
        std::vector<Candidate> candidates;
        for (std::size_t i = 0; i < halfedges.size(); ++i) {
            for (std::size_t j = i + 1; j < halfedges.size(); ++j) {
                candidates.push_back(candidate(halfedges[i], halfedges[j]));
            }
        }
        const auto key = [](const Candidate& c) {
            return std::tuple(c.is_disagreeing, c.bend, c.is_concave, c.g, c.h);
        };
        std::sort(candidates.begin(), candidates.end(),
                  [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
        for (const Candidate& c : candidates) {
            if (partner_[c.g] < 0 && partner_[c.h] < 0) link(c.g, c.h);
        }
    }

    void orient() {
        const std::size_t face_count = soup_.triangles.size();
        std::vector<signed char> flip(face_count, -1);
        std::vector<int> queue;
        for (std::size_t seed = 0; seed < face_count; ++seed) {
            if (flip[seed] >= 0) continue;
            queue.assign(1, static_cast<int>(seed));
            flip[seed] = 0;
            std::size_t flipped_count = 0;
            for (std::size_t head = 0; head < queue.size(); ++head) {
                flipped_count += flip[queue[head]];
                visit_neighbours(queue[head], flip, queue);
            }
            if (2 * flipped_count > queue.size()) {
                for (int face : queue) flip[face] ^= 1;
                flipped_count = queue.size() - flipped_count;
            }
            report_.reoriented_face_count += flipped_count;
        }
        for (std::size_t face = 0; face < face_count; ++face) {
            if (flip[face] == 1) turn_over(static_cast<int>(face));
        }
    }

    void visit_neighbours(int face, std::vector<signed char>& flip, std::vector<int>& queue) {
        for (int h = 3 * face; h < 3 * face + 3; ++h) {
            const int g = partner_[h];
            if (g < 0) continue;
            const signed char wanted = flip[face] ^ (from(g) == from(h) ? 1 : 0);
            if (flip[g / 3] < 0) {
                flip[g / 3] = wanted;
                queue.push_back(g / 3);
            } else if (flip[g / 3] != wanted) {
                partner_[g] = partner_[h] = -1;
                ++report_.split_edge_count;
            }
        }
    }

    /// Swaps corners 1 and 2; edges 0 and 2 change places.
    void turn_over(int face) {
        auto& corners = soup_.triangles[face];
        std::swap(corners[1], corners[2]);
        const int first = partner_[3 * face];
        const int last = partner_[3 * face + 2];
        partner_[3 * face] = last;
        partner_[3 * face + 2] = first;
        if (last >= 0) partner_[last] = 3 * face;
        if (first >= 0) partner_[first] = 3 * face + 2;
    }

    /// Walks the fan of corners around each vertex; a halfedge stands for the corner it starts at.
    void separate_fans() {
        std::vector<bool> is_visited(static_cast<std::size_t>(halfedge_count()), false);
        std::vector<bool> is_taken(soup_.points.size(), false);
        for (int start = 0; start < halfedge_count(); ++start) {
            if (is_visited[start]) continue;
            int vertex = from(start);
            const bool is_copy = is_taken[vertex];
            if (is_copy) {
                ++report_.split_vertex_count;
                soup_.points.push_back(Vec3(soup_.points[vertex]));
                is_taken.push_back(true);
                vertex = static_cast<int>(soup_.points.size()) - 1;
            } else {
                is_taken[vertex] = true;
            }
            const auto claim = [&](int corner) {
                is_visited[corner] = true;
                soup_.triangles[corner / 3][corner % 3] = vertex;
            };
            claim(start);
            int corner = start;
            while ((corner = partner_[previous_in_face(corner)]) >= 0 && corner != start) {
                claim(corner);
            }
            if (corner == start) continue;
            corner = start;
            while (partner_[corner] >= 0) {
                corner = next_in_face(partner_[corner]);
                claim(corner);
            }
        }
    }

    /// Splits all but one of the edges that share both end points; true if there were any.
    bool split_repeated_edges() {
        std::vector<int> middle;  // per halfedge, filled only if needed
        for_each_edge([&](auto begin, auto end) {
            if (end - begin < 2 || (end - begin == 2 && partner_[begin[0]] == begin[1])) return;
            if (middle.empty()) middle.assign(static_cast<std::size_t>(halfedge_count()), -1);
            for (auto h = begin; h != end; ++h) {
                const bool is_first = h == begin || partner_[*h] == *begin;
                if (is_first || middle[*h] >= 0) continue;
                ++report_.split_edge_count;
                middle[*h] = static_cast<int>(soup_.points.size());
                if (partner_[*h] >= 0) middle[partner_[*h]] = middle[*h];
                soup_.points.push_back(Vec3(0.5 * (soup_.points[from(*h)] + soup_.points[to(*h)])));
            }
        });
        if (middle.empty()) return false;
        for (int face = 0, count = halfedge_count() / 3; face < count; ++face) {
            subdivide(face, {middle[3 * face], middle[3 * face + 1], middle[3 * face + 2]});
        }
        return true;
    }

    /// Replaces a face by triangles that use the given middle points of its edges (-1: none).
    void subdivide(int face, const std::array<int, 3>& middle) {
        std::vector<int> outline;
        int anchor = -1;
        for (int c = 0; c < 3; ++c) {
            outline.push_back(soup_.triangles[face][c]);
            if (middle[c] < 0) continue;
            anchor = static_cast<int>(outline.size());
            outline.push_back(middle[c]);
        }
        if (anchor < 0) return;
        // A fan from a middle point never makes a triangle without area.
        const std::size_t count = outline.size();
        for (std::size_t i = 1; i + 1 < count; ++i) {
            const std::array<int, 3> corners{outline[anchor], outline[(anchor + i) % count],
                                             outline[(anchor + i + 1) % count]};
            if (i == 1) {
                soup_.triangles[face] = corners;
            } else {
                soup_.triangles.push_back(corners);
                if (!soup_.labels.empty()) soup_.labels.push_back(soup_.labels[face]);
            }
        }
    }

    TriangleSoup soup_;
    RepairReport& report_;
    std::vector<int> partner_;
};

}  // namespace

ManifoldSoup make_manifold(TriangleSoup soup, RepairReport& report) {
    return ManifoldMaker(std::move(soup), report).run();
}

Mesh build_mesh(const ManifoldSoup& manifold) {
    const auto& triangles = manifold.soup.triangles;
    const auto& partner = manifold.partner;
    const int halfedge_count = static_cast<int>(3 * triangles.size());
    Mesh mesh;
    mesh.reserve(manifold.soup.points.size(), static_cast<std::size_t>(halfedge_count) / 2 + 1,
                 triangles.size());
    for (const Vec3& point : manifold.soup.points) mesh.add_vertex(point);

    std::vector<HalfedgeHandle> handle(static_cast<std::size_t>(halfedge_count));
    const auto vertex = [&](int h) { return VertexHandle(triangles[h / 3][h % 3]); };
    for (int h = 0; h < halfedge_count; ++h) {
        if (partner[h] >= 0 && partner[h] < h) {
            handle[h] = mesh.opposite_halfedge_handle(handle[partner[h]]);
        } else {
            handle[h] = mesh.new_edge(vertex(h), vertex(next_in_face(h)));
        }
    }
    for (int h = 0; h < halfedge_count; h += 3) {
        const FaceHandle face = mesh.new_face();
        mesh.set_halfedge_handle(face, handle[h]);
        for (int corner = h; corner < h + 3; ++corner) {
            mesh.set_face_handle(handle[corner], face);
            mesh.set_next_halfedge_handle(handle[corner], handle[next_in_face(corner)]);
            if (!mesh.halfedge_handle(vertex(corner)).is_valid()) {
                mesh.set_halfedge_handle(vertex(corner), handle[corner]);
            }
        }
    }
    for (int h = 0; h < halfedge_count; ++h) {
        if (partner[h] >= 0) continue;
        // The boundary halfedge opposite to h ends where h starts; the next one around the hole is
        // found by turning about that vertex.
        int turning = h;
        while (partner[previous_in_face(turning)] >= 0) {
            turning = partner[previous_in_face(turning)];
        }
        const HalfedgeHandle following =
            mesh.opposite_halfedge_handle(handle[previous_in_face(turning)]);
        mesh.set_next_halfedge_handle(mesh.opposite_halfedge_handle(handle[h]), following);
        // OpenMesh finds boundary vertices by their first outgoing halfedge.
        mesh.set_halfedge_handle(vertex(h), following);
    }
    return mesh;
}

}  // namespace fcn
