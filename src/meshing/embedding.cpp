// Curves into mesh edges. First every curve is laid out on the untouched mesh: its points become
// vertices, points of edges or points of faces (snapped, so that no sliver arises where a curve
// almost meets an edge), and consecutive ones that share no face are joined over the surface. Only
// then is each face that got points subdivided on its own, by a constrained triangulation. Since
// both faces of an edge see the same points on it, the result is a conforming refinement whatever
// the curves do: cross each other, run along edges, visit a face many times. Inserting the curves
// one by one would have to find its way in a mesh that changes under it.
#include "meshing/embedding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "geometry/errors.h"
#include "meshing/face_subdivision.h"
#include "meshing/surface_path.h"

namespace fcn {
namespace {

using Kind = SimplexPoint::Kind;

constexpr double kMostDetour = 4;  ///< length of a path over the surface to that of its points

struct EdgeStop {
    double t = 0;
    int id = -1;
};

/// The points that curves put on the mesh. Ids below n_vertices are the mesh's own vertices.
class PointSet {
public:
    PointSet(const Mesh& mesh, double snap)
        : mesh_(mesh),
          snap_(snap),
          edge_stops_(mesh.n_edges()),
          face_stops_(mesh.n_faces()),
          is_taken_(mesh.n_vertices(), false) {
        for (const VertexHandle vertex : mesh.vertices()) {
            places_.push_back({Kind::Vertex, vertex.idx(), 0, Vec3::Zero()});
            positions_.push_back(mesh.point(vertex));
        }
    }

    /// A vertex exactly at `position`, which lies at `surface` on the mesh.
    int add_station(const FeatureStation& station) {
        const double tiny = 1e-12 * (1 + station.position.norm());
        SimplexPoint place = snap_to_simplex(mesh_, station.surface, snap_);
        if (place.kind == Kind::Vertex && is_taken_[static_cast<std::size_t>(place.index)]) {
            const auto i = static_cast<std::size_t>(place.index);
            if ((positions_[i] - station.position).norm() <= tiny) return place.index;
            place = snap_to_simplex(mesh_, station.surface, 0);
            if (place.kind == Kind::Vertex) return place.index;
        }
        // As curves' points do, or the curves that end here would all pass through that vertex.
        const int end = near_end(place);
        const bool is_free = end >= 0 && !is_taken_[static_cast<std::size_t>(end)];
        const int id = is_free ? end : find_or_add(place, 0);
        positions_[static_cast<std::size_t>(id)] = station.position;
        if (id < static_cast<int>(is_taken_.size())) is_taken_[static_cast<std::size_t>(id)] = true;
        return id;
    }

    /// The id of a curve's point, merged with points closer than the snapping distance.
    int add(SimplexPoint place) {
        const int end = near_end(place);
        return end >= 0 ? end : find_or_add(place, snap_);
    }

    const SimplexPoint& place(int id) const { return places_[static_cast<std::size_t>(id)]; }
    const std::vector<Vec3>& positions() const { return positions_; }
    const std::vector<EdgeStop>& on_edge(int edge) const {
        return edge_stops_[static_cast<std::size_t>(edge)];
    }
    const std::vector<int>& in_face(int face) const {
        return face_stops_[static_cast<std::size_t>(face)];
    }

    /// A crossing found while subdividing a face.
    int add_crossing(const Vec3& position) {
        positions_.push_back(position);
        places_.emplace_back();
        return static_cast<int>(positions_.size()) - 1;
    }

    void sort_edges() {
        for (auto& stops : edge_stops_)
            std::sort(stops.begin(), stops.end(),
                      [](const EdgeStop& a, const EdgeStop& b) { return a.t < b.t; });
    }

private:
    /// The end of an edge that a point on it is merged with; -1 elsewhere.
    int near_end(const SimplexPoint& place) const {
        if (place.kind != Kind::Edge) return -1;
        const auto halfedge = mesh_.halfedge_handle(EdgeHandle(place.index), 0);
        const double share = std::min(0.05, snap_ / mesh_.calc_edge_length(halfedge));
        if (place.t <= share) return mesh_.from_vertex_handle(halfedge).idx();
        if (place.t >= 1 - share) return mesh_.to_vertex_handle(halfedge).idx();
        return -1;
    }

    int find_or_add(const SimplexPoint& place, double tolerance) {
        if (place.kind == Kind::Vertex) return place.index;
        const Vec3 here = position(mesh_, place);
        if (place.kind == Kind::Edge) {
            auto& stops = edge_stops_[static_cast<std::size_t>(place.index)];
            const double length = mesh_.calc_edge_length(EdgeHandle(place.index));
            const double share = std::min(0.05, tolerance / length);
            for (const EdgeStop& stop : stops)
                if (std::abs(stop.t - place.t) <= std::max(share, 1e-12)) return stop.id;
            stops.push_back({place.t, append(place, here)});
            return stops.back().id;
        }
        auto& stops = face_stops_[static_cast<std::size_t>(place.index)];
        for (const int id : stops) {
            const Vec3 there = position(mesh_, this->place(id));
            if ((there - here).norm() <= std::max(tolerance * 0.2, 1e-12 * (1 + here.norm())))
                return id;
        }
        stops.push_back(append(place, here));
        return stops.back();
    }

    int append(const SimplexPoint& place, const Vec3& here) {
        places_.push_back(place);
        positions_.push_back(here);
        return static_cast<int>(places_.size()) - 1;
    }

    const Mesh& mesh_;
    double snap_;
    std::vector<SimplexPoint> places_;
    std::vector<Vec3> positions_;
    std::vector<std::vector<EdgeStop>> edge_stops_;
    std::vector<std::vector<int>> face_stops_;
    std::vector<bool> is_taken_;
};

/// The edge whose closure holds both points, -1 if none.
int common_edge(const Mesh& mesh, const SimplexPoint& a, const SimplexPoint& b) {
    const auto is_end = [&](int edge, int vertex) {
        const auto halfedge = mesh.halfedge_handle(EdgeHandle(edge), 0);
        return mesh.from_vertex_handle(halfedge).idx() == vertex ||
               mesh.to_vertex_handle(halfedge).idx() == vertex;
    };
    if (a.kind == Kind::Face || b.kind == Kind::Face) return -1;
    if (a.kind == Kind::Edge && b.kind == Kind::Edge) return a.index == b.index ? a.index : -1;
    if (a.kind == Kind::Edge) return is_end(a.index, b.index) ? a.index : -1;
    if (b.kind == Kind::Edge) return is_end(b.index, a.index) ? b.index : -1;
    const auto halfedge = mesh.find_halfedge(VertexHandle(a.index), VertexHandle(b.index));
    return halfedge.is_valid() ? mesh.edge_handle(halfedge).idx() : -1;
}

int common_face(const Mesh& mesh, const SimplexPoint& a, const SimplexPoint& b) {
    const std::vector<int> faces = incident_faces(mesh, a);
    for (const int face : incident_faces(mesh, b))
        if (std::binary_search(faces.begin(), faces.end(), face)) return face;
    return -1;
}

double distance_to_chord(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 chord = b - a;
    const double square = chord.squaredNorm();
    const double t = square > 0 ? std::clamp((p - a).dot(chord) / square, 0.0, 1.0) : 0;
    return (p - a - t * chord).norm();
}

/// Marks which points of [first, last] a polyline needs to stay within `flatness` (Ramer 1972).
void mark_needed(const std::vector<Vec3>& points, std::size_t first, std::size_t last,
                 double flatness, std::vector<bool>& is_needed) {
    std::vector<std::pair<std::size_t, std::size_t>> stack{{first, last}};
    while (!stack.empty()) {
        const auto [a, b] = stack.back();
        stack.pop_back();
        std::size_t worst = a;
        double deviation = flatness;
        for (std::size_t i = a + 1; i < b; ++i) {
            const double distance = distance_to_chord(points[i], points[a], points[b]);
            if (distance > deviation) {
                deviation = distance;
                worst = i;
            }
        }
        if (worst == a) continue;
        is_needed[worst] = true;
        stack.emplace_back(a, worst);
        stack.emplace_back(worst, b);
    }
}

/// Drops points of a curve that its neighbours imply: along one edge, or straight in one face.
std::vector<SimplexPoint> simplify(const Mesh& mesh, const std::vector<SimplexPoint>& points,
                                   double flatness) {
    std::vector<Vec3> positions;
    for (const SimplexPoint& point : points) positions.push_back(position(mesh, point));
    std::vector<bool> is_needed(points.size(), true);
    for (std::size_t i = 1; i + 1 < points.size();) {
        std::size_t end = i;
        while (end + 1 < points.size() && points[end].kind != Kind::Vertex &&
               points[end].kind == points[i].kind && points[end].index == points[i].index)
            ++end;
        if (end == i) {  // a vertex
            ++i;
            continue;
        }
        // [i, end) lies in one face or edge; its neighbours i - 1 and end bound the run.
        const auto touches = [&](const SimplexPoint& outer) {
            return points[i].kind == Kind::Edge ? common_edge(mesh, outer, points[i]) >= 0
                                                : share_face(mesh, outer, points[i]);
        };
        const std::size_t first = touches(points[i - 1]) ? i - 1 : i;
        const std::size_t last = touches(points[end]) ? end : end - 1;
        for (std::size_t k = first + 1; k < last; ++k) is_needed[k] = false;
        if (points[i].kind == Kind::Face) mark_needed(positions, first, last, flatness, is_needed);
        i = end;
    }
    std::vector<SimplexPoint> kept;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_needed[i]) kept.push_back(points[i]);
    return kept;
}

/// A path without spikes and loops: on a second visit of a vertex what lies between is dropped.
std::vector<int> without_loops(const std::vector<int>& path) {
    std::map<int, std::size_t> seen;
    std::vector<int> simple;
    for (const int id : path) {
        const auto it = seen.find(id);
        if (it == seen.end()) {
            seen[id] = simple.size();
            simple.push_back(id);
            continue;
        }
        for (std::size_t k = it->second + 1; k < simple.size(); ++k) seen.erase(simple[k]);
        simple.resize(it->second + 1);
    }
    return simple;
}

class Embedder {
public:
    Embedder(const Mesh& mesh, const FeaturePieces& pieces, const EmbeddingOptions& options)
        : mesh_(mesh), pieces_(pieces), options_(options), points_(mesh, options.snap) {}

    EmbeddedMesh run() {
        for (const FeatureStation& station : pieces_.stations)
            result_.station_vertex.push_back(station.is_used ? points_.add_station(station) : -1);
        for (const FeaturePiece& piece : pieces_.pieces) paths_.push_back(lay_out(piece));
        points_.sort_edges();
        collect_lines();
        build_faces();
        result_.points = points_.positions();
        for (std::size_t i = 0; i < paths_.size(); ++i) result_.chains.push_back(chain_of(i));
        return std::move(result_);
    }

private:
    /// Point ids along a piece, consecutive ones sharing a face; empty if there is no way, or only
    /// one around half the part: a point that lies on the wrong sheet of a thin wall.
    std::vector<int> lay_out(const FeaturePiece& piece) {
        const int from = result_.station_vertex[static_cast<std::size_t>(piece.from)];
        const int to = result_.station_vertex[static_cast<std::size_t>(piece.to)];
        std::vector<SimplexPoint> places{points_.place(from)};
        for (const SurfacePoint& point : piece.points)
            places.push_back(snap_to_simplex(mesh_, point, options_.snap));
        places.push_back(points_.place(to));
        places = simplify(mesh_, places, options_.flatness);

        double wanted = options_.detour;
        for (std::size_t i = 1; i < places.size(); ++i)
            wanted +=
                kMostDetour * (position(mesh_, places[i]) - position(mesh_, places[i - 1])).norm();
        std::vector<int> path{from};
        const auto go_to = [&](int id) {
            if (id == path.back()) return;
            const Vec3& here = points_.positions()[static_cast<std::size_t>(path.back())];
            wanted -= (points_.positions()[static_cast<std::size_t>(id)] - here).norm();
            path.push_back(id);
        };
        for (std::size_t i = 1; i < places.size(); ++i) {
            const bool is_last = i + 1 == places.size();
            const int next = is_last ? to : points_.add(places[i]);
            const auto between = trace_path(mesh_, points_.place(path.back()), points_.place(next));
            if (!between) {
                ++result_.lost_pieces;
                return {};
            }
            for (const SimplexPoint& place : *between) go_to(points_.add(place));
            go_to(next);
            if (wanted < 0) {
                ++result_.lost_pieces;
                return {};
            }
        }
        return path;
    }

    void collect_lines() {
        for (const auto& path : paths_) {
            for (std::size_t i = 1; i < path.size(); ++i) {
                const auto key = std::minmax({path[i - 1], path[i]});
                const SimplexPoint& a = points_.place(path[i - 1]);
                const SimplexPoint& b = points_.place(path[i]);
                if (common_edge(mesh_, a, b) >= 0) continue;
                const int face = common_face(mesh_, a, b);
                if (face < 0) throw LogicError("embedding: consecutive points share no face");
                face_lines_[face].insert({key.first, key.second});
            }
        }
    }

    void build_faces() {
        for (const FaceHandle face : mesh_.faces()) {
            FaceSubdivisionInput input;
            std::vector<int> ids = boundary_ids(face, input);
            input.boundary_count = static_cast<int>(ids.size());
            for (const int id : points_.in_face(face.idx())) {
                const Vec3& weight = points_.place(id).barycentric;
                input.points.push_back(weight[0] * corner_[0] + weight[1] * corner_[1] +
                                       weight[2] * corner_[2]);
                ids.push_back(id);
            }
            const auto lines = face_lines_.find(face.idx());
            if (ids.size() == 3) {
                add_triangle(face, {ids[0], ids[1], ids[2]});
                continue;
            }
            if (lines != face_lines_.end()) add_lines(lines->second, ids, input);
            FaceSubdivision subdivision = subdivide_face(input);
            if (!subdivision.is_valid)
                throw LogicError("embedding: face " + std::to_string(face.idx()) +
                                 " cannot be subdivided");
            take(face, subdivision, ids, lines);
        }
    }

    /// Corners and edge points counter-clockwise; sets the face's own plane and their places in it.
    std::vector<int> boundary_ids(FaceHandle face, FaceSubdivisionInput& input) {
        const auto vertices = face_vertices(mesh_, face);
        set_plane(vertices);
        std::vector<int> ids;
        for (std::size_t i = 0; i < 3; ++i) {
            const Eigen::Vector2d& a = corner_[i];
            const Eigen::Vector2d& b = corner_[(i + 1) % 3];
            ids.push_back(vertices[i].idx());
            input.points.push_back(a);
            const auto halfedge = mesh_.find_halfedge(vertices[i], vertices[(i + 1) % 3]);
            const EdgeHandle edge = mesh_.edge_handle(halfedge);
            const bool is_first = mesh_.halfedge_handle(edge, 0) == halfedge;
            std::vector<EdgeStop> stops = points_.on_edge(edge.idx());
            if (!is_first) std::reverse(stops.begin(), stops.end());
            for (const EdgeStop& stop : stops) {
                const double t = is_first ? stop.t : 1 - stop.t;
                input.points.push_back((1 - t) * a + t * b);
                ids.push_back(stop.id);
            }
        }
        return ids;
    }

    /// The face laid flat; needles, whose true shape has no room for rounding, get a regular one.
    void set_plane(const std::array<VertexHandle, 3>& vertices) {
        const Vec3 u = mesh_.point(vertices[1]) - mesh_.point(vertices[0]);
        const Vec3 v = mesh_.point(vertices[2]) - mesh_.point(vertices[0]);
        const double base = u.norm(), height = base > 0 ? u.cross(v).norm() / base : 0;
        corner_[0] = Eigen::Vector2d::Zero();
        corner_[1] = {base, 0};
        corner_[2] = {base > 0 ? u.dot(v) / base : 0, height};
        if (height > 1e-6 * std::max(base, v.norm())) return;
        corner_[1] = {1, 0};
        corner_[2] = {0.5, 1};
    }

    static void add_lines(const std::set<std::pair<int, int>>& lines, const std::vector<int>& ids,
                          FaceSubdivisionInput& input) {
        const auto local = [&](int id) {
            return static_cast<int>(std::find(ids.begin(), ids.end(), id) - ids.begin());
        };
        for (const auto& [a, b] : lines) input.lines.push_back({local(a), local(b)});
    }

    void take(FaceHandle face, const FaceSubdivision& subdivision, std::vector<int> ids,
              std::map<int, std::set<std::pair<int, int>>>::const_iterator lines) {
        const auto vertices = face_vertices(mesh_, face);
        for (const Eigen::Vector2d& added : subdivision.added) {
            // Barycentric coordinates in the laid-out face carry the crossing back into space.
            const Eigen::Vector2d u = corner_[1] - corner_[0], v = corner_[2] - corner_[0];
            const Eigen::Vector2d p = added - corner_[0];
            const double area = u[0] * v[1] - u[1] * v[0];
            const double b = (p[0] * v[1] - p[1] * v[0]) / area;
            const double c = (u[0] * p[1] - u[1] * p[0]) / area;
            ids.push_back(points_.add_crossing((1 - b - c) * mesh_.point(vertices[0]) +
                                               b * mesh_.point(vertices[1]) +
                                               c * mesh_.point(vertices[2])));
        }
        const auto id = [&](int local) { return ids[static_cast<std::size_t>(local)]; };
        for (const auto& t : subdivision.triangles)
            add_triangle(face, {id(t[0]), id(t[1]), id(t[2])});
        if (lines == face_lines_.end()) return;
        std::size_t index = 0;
        for (const auto& line : lines->second) {
            std::vector<int> path;
            for (const int local : subdivision.paths[index]) path.push_back(id(local));
            if (path.front() != line.first) std::reverse(path.begin(), path.end());
            line_paths_[line] = std::move(path);
            ++index;
        }
    }

    void add_triangle(FaceHandle source, const std::array<int, 3>& ids) {
        result_.triangles.push_back(ids);
        result_.source_face.push_back(source.idx());
    }

    /// The mesh edges of one straight step of a path, `a` first.
    std::vector<int> step(int a, int b) const {
        const int edge = common_edge(mesh_, points_.place(a), points_.place(b));
        if (edge < 0) {
            std::vector<int> path = line_paths_.at(std::minmax({a, b}));
            if (path.front() != a) std::reverse(path.begin(), path.end());
            return path;
        }
        const double from = parameter(edge, a), to = parameter(edge, b);
        std::vector<int> path{a};
        for (const EdgeStop& stop : points_.on_edge(edge))
            if (stop.t > std::min(from, to) && stop.t < std::max(from, to)) path.push_back(stop.id);
        if (from > to) std::reverse(path.begin() + 1, path.end());
        path.push_back(b);
        return path;
    }

    double parameter(int edge, int id) const {
        const SimplexPoint& place = points_.place(id);
        if (place.kind == Kind::Edge) return place.t;
        const auto halfedge = mesh_.halfedge_handle(EdgeHandle(edge), 0);
        return mesh_.from_vertex_handle(halfedge).idx() == place.index ? 0 : 1;
    }

    std::vector<int> chain_of(std::size_t piece) const {
        const std::vector<int>& path = paths_[piece];
        if (path.empty()) return {};
        std::vector<int> chain{path.front()};
        for (std::size_t i = 1; i < path.size(); ++i) {
            const std::vector<int> part = step(path[i - 1], path[i]);
            chain.insert(chain.end(), part.begin() + 1, part.end());
        }
        return without_loops(chain);
    }

    const Mesh& mesh_;
    const FeaturePieces& pieces_;
    EmbeddingOptions options_;
    PointSet points_;
    std::vector<std::vector<int>> paths_;
    std::map<int, std::set<std::pair<int, int>>> face_lines_;
    std::map<std::pair<int, int>, std::vector<int>> line_paths_;
    std::array<Eigen::Vector2d, 3> corner_;
    EmbeddedMesh result_;
};

}  // namespace

std::vector<int> entangled_pieces(const EmbeddedMesh& embedded, const FeaturePieces& pieces) {
    // Who passes through each vertex; stations belong to all pieces that end there.
    std::vector<std::vector<int>> visitors(embedded.points.size());
    const auto at = [&](int vertex) -> std::vector<int>& {
        return visitors[static_cast<std::size_t>(vertex)];
    };
    for (std::size_t piece = 0; piece < embedded.chains.size(); ++piece)
        for (const int vertex : embedded.chains[piece])
            at(vertex).push_back(static_cast<int>(piece));
    std::set<int> entangled;
    for (std::size_t piece = 0; piece < embedded.chains.size(); ++piece) {
        const std::vector<int>& chain = embedded.chains[piece];
        for (std::size_t i = 1; i + 1 < chain.size(); ++i)
            if (at(chain[i]).size() > 1) entangled.insert(at(chain[i]).begin(), at(chain[i]).end());
    }
    std::erase_if(entangled, [&](int piece) {
        return pieces.pieces[static_cast<std::size_t>(piece)].is_rigid;
    });
    return {entangled.begin(), entangled.end()};
}

EmbeddedMesh embed_pieces(const Mesh& mesh, const FeaturePieces& pieces,
                          const EmbeddingOptions& options) {
    return Embedder(mesh, pieces, options).run();
}

}  // namespace fcn
