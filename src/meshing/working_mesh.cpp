// A corner table (Rossignac 1999) with the three local changes of incremental remeshing (Hoppe et
// al. 1993: split, collapse, flip). Boundary vertices keep the halfedge that starts their fan, so
// that a star is visited in one turn. The journal holds old values; nothing is stored while no
// recording is under way.
#include "meshing/working_mesh.h"

#include <algorithm>

#include "geometry/errors.h"

namespace fcn {

WorkingMesh::WorkingMesh(std::vector<Vec3> points, const std::vector<std::array<int, 3>>& triangles,
                         std::vector<int> labels)
    : points_(std::move(points)), labels_(std::move(labels)) {
    labels_.resize(triangles.size(), 0);
    out_.assign(points_.size(), -1);
    places_.assign(points_.size(), -1);
    flags_.assign(points_.size(), 0);
    stamps_.assign(points_.size(), 0);
    from_.reserve(3 * triangles.size());
    for (const auto& triangle : triangles)
        for (const int v : triangle) from_.push_back(v);
    twin_.assign(from_.size(), -1);
    roles_.assign(from_.size(), 0);
    link_twins();
    mark_borders();
}

void WorkingMesh::link_twins() {
    std::vector<int> first(points_.size() + 1, 0), order(from_.size());
    for (const int v : from_) ++first[at(v) + 1];
    for (std::size_t v = 0; v < points_.size(); ++v) first[v + 1] += first[v];
    std::vector<int> fill(first.begin(), first.end() - 1);
    for (int h = 0; h < halfedge_end(); ++h) order[at(fill[at(from(h))]++)] = h;
    for (int h = 0; h < halfedge_end(); ++h) {
        const int b = to(h);
        for (int k = first[at(b)]; k < first[at(b) + 1]; ++k)
            if (to(order[at(k)]) == from(h)) {
                if (twin(h) >= 0) throw LogicError("remesh: an edge with more than two faces");
                twin_[at(h)] = order[at(k)];
            }
    }
    for (int h = 0; h < halfedge_end(); ++h)
        if (out_[at(from(h))] < 0 || twin(h) < 0) out_[at(from(h))] = h;
}

void WorkingMesh::mark_borders() {
    for (int h = 0; h < halfedge_end(); ++h) {
        const int other = twin(h);
        if (other < 0)
            for (const int v : {from(h), to(h)}) flags_[at(v)] |= kOnBoundary;
        if (other < 0 || label(face(h)) != label(face(other))) set_role(h, EdgeRole::Border);
    }
}

void WorkingMesh::set_role(int h, EdgeRole role) {
    roles_[at(h)] = static_cast<std::uint8_t>(role);
    if (twin(h) >= 0) roles_[at(twin(h))] = static_cast<std::uint8_t>(role);
    if (role != EdgeRole::Free)
        for (const int v : {from(h), to(h)}) flags_[at(v)] |= kOnCurve;
}

void WorkingMesh::set_point(int v, const Vec3& p) {
    if (is_recording_) moves_.emplace_back(v, points_[at(v)]);
    points_[at(v)] = p;
}

void WorkingMesh::set(Array array, int index, int value) {
    const auto write = [&](auto& values) {
        auto& slot = values[at(index)];
        if (is_recording_) changes_.push_back({array, index, static_cast<int>(slot)});
        slot = static_cast<std::decay_t<decltype(slot)>>(value);
    };
    switch (array) {
        case Array::From:
            return write(from_);
        case Array::Twin:
            return write(twin_);
        case Array::Out:
            return write(out_);
        case Array::Role:
            return write(roles_);
    }
}

WorkingMesh::Checkpoint WorkingMesh::start_recording() {
    is_recording_ = true;
    changes_.clear();
    moves_.clear();
    return {points_.size(), labels_.size()};
}

void WorkingMesh::undo(const Checkpoint& checkpoint) {
    is_recording_ = false;
    for (auto it = changes_.rbegin(); it != changes_.rend(); ++it)
        set(it->array, it->index, it->old);
    for (auto it = moves_.rbegin(); it != moves_.rend(); ++it) points_[at(it->first)] = it->second;
    points_.resize(checkpoint.vertices);
    out_.resize(checkpoint.vertices);
    places_.resize(checkpoint.vertices);
    flags_.resize(checkpoint.vertices);
    stamps_.resize(checkpoint.vertices);
    labels_.resize(checkpoint.faces);
    from_.resize(3 * checkpoint.faces);
    twin_.resize(3 * checkpoint.faces);
    roles_.resize(3 * checkpoint.faces);
}

void WorkingMesh::forget() { is_recording_ = false; }

int WorkingMesh::valence(int v) const {
    int count = 0;
    visit_neighbors(v, [&](int) { return ++count > 0; });
    return count;
}

int WorkingMesh::find_edge(int a, int b) const {
    int found = -1;
    visit_star(a, [&](int h) {
        if (to(h) == b) found = h;
        if (apex(h) == b) found = prev(h);
        return found < 0;
    });
    return found;
}

int WorkingMesh::add_vertex(const Vec3& p, std::uint8_t flags, int place) {
    points_.push_back(p);
    out_.push_back(-1);
    places_.push_back(place);
    flags_.push_back(flags);
    stamps_.push_back(0);
    return vertex_end() - 1;
}

int WorkingMesh::add_face(int a, int b, int c, int label) {
    from_.insert(from_.end(), {a, b, c});
    twin_.insert(twin_.end(), {-1, -1, -1});
    roles_.insert(roles_.end(), {0, 0, 0});
    labels_.push_back(label);
    return halfedge_end() - 3;
}

/// Makes two halfedges of one edge each other's twins; either may be -1. The stronger role stays.
void WorkingMesh::join(int h, int other) {
    const int role = std::max(h < 0 ? 0 : static_cast<int>(roles_[at(h)]),
                              other < 0 ? 0 : static_cast<int>(roles_[at(other)]));
    if (h >= 0) {
        set(Array::Twin, h, other);
        set(Array::Role, h, role);
    }
    if (other >= 0) {
        set(Array::Twin, other, h);
        set(Array::Role, other, role);
    }
}

void WorkingMesh::set_out(int v, int h) {
    if (is_on_boundary(v))
        while (twin(h) >= 0) h = next(twin(h));
    set(Array::Out, v, h);
}

int WorkingMesh::split(int h, const Vec3& p) {
    const int t = twin(h), hn = next(h), b = to(h), c = apex(h);
    const int role = roles_[at(h)];
    const std::uint8_t flags =
        static_cast<std::uint8_t>(kAfloat | (role != 0 ? kOnCurve : 0) | (t < 0 ? kOnBoundary : 0) |
                                  ((flags_[at(from(h))] | flags_[at(b)]) & kThin));
    const int m = add_vertex(p, flags, place(from(h)));
    // Face abc becomes amc; mbc is new.
    const int n = add_face(m, b, c, label(face(h)));
    const int far = twin(hn), far_role = roles_[at(hn)];
    set(Array::From, hn, m);
    roles_[at(n)] = static_cast<std::uint8_t>(role);
    roles_[at(n + 1)] = static_cast<std::uint8_t>(far_role);
    join(n + 1, far);
    set(Array::Role, hn, 0);
    join(n + 2, hn);
    if (t >= 0) {
        // Face bad becomes mad; bmd is new.
        const int tp = prev(t), d = apex(t);
        const int k = add_face(b, m, d, label(face(t)));
        const int outer = twin(tp), outer_role = roles_[at(tp)];
        set(Array::From, t, m);
        roles_[at(k)] = static_cast<std::uint8_t>(role);
        roles_[at(k + 2)] = static_cast<std::uint8_t>(outer_role);
        join(k + 2, outer);
        set(Array::Role, tp, 0);
        join(k + 1, tp);
        join(k, n);
        set_out(d, k + 2);
    }
    set_out(m, n);
    set_out(b, n + 1);
    return m;
}

void WorkingMesh::set_cuts_fixed(bool is_fixed) {
    for (std::uint8_t& flags : flags_)
        if ((flags & kCut) != 0)
            flags = static_cast<std::uint8_t>(is_fixed ? flags | kFixed : flags & ~kFixed);
}

bool WorkingMesh::can_collapse(int h, int vanishing) const {
    const int t = twin(h);
    const int staying = from(h) == vanishing ? to(h) : from(h);
    if (is_fixed(vanishing)) return false;
    if ((is_on_curve(vanishing) || is_on_boundary(vanishing)) && !is_marked(h)) return false;
    if (is_on_boundary(vanishing) && is_on_boundary(staying) && t >= 0) return false;
    // The triangles at the edge vanish and two pairs of sides become one edge each: never a pair
    // without a face, and two curves only where they meet at both ends and one of them was cut.
    for (const int side : {h, t}) {
        if (side < 0) continue;
        const int a = next(side), b = prev(side);
        const bool is_cut_off =
            is_cut(vanishing) && role(a) == EdgeRole::Feature && role(b) == EdgeRole::Feature;
        if (is_marked(a) && is_marked(b) && !is_cut_off) return false;
        if (twin(a) < 0 && twin(b) < 0) return false;
        const int c = apex(side);
        if (valence(c) <= (is_on_boundary(c) ? 2 : 3)) return false;
    }
    // The link condition: no neighbour in common but the corners across the edge.
    const int own = ++stamp_;
    visit_neighbors(staying, [&](int v) {
        stamps_[at(v)] = own;
        return true;
    });
    int common = 0;
    visit_neighbors(vanishing, [&](int v) {
        common += stamps_[at(v)] == own;
        return true;
    });
    return common == (t < 0 ? 1 : 2);
}

/// Joins the two other sides of the face at h, which vanishes.
void WorkingMesh::close_gap(int h) {
    const int a = next(h), b = prev(h), c = apex(h);
    const int x = twin(a), y = twin(b);
    // One of them may be missing at a boundary, and with it what its side of the edge knew.
    const int role = std::max(roles_[at(a)], roles_[at(b)]);
    join(x, y);
    for (const int side : {x, y})
        if (side >= 0) set(Array::Role, side, role);
    for (const int side : {h, a, b}) set(Array::From, side, -1);
    set_out(c, x >= 0 ? x : next(y));
}

void WorkingMesh::collapse(int h, int vanishing) {
    const int staying = from(h) == vanishing ? to(h) : from(h);
    const int t = twin(h);
    const int first = out(vanishing);
    for (int g = first;;) {
        const int following = twin(prev(g));
        set(Array::From, g, staying);
        if (following < 0 || following == first) break;
        g = following;
    }
    set(Array::Out, vanishing, -1);
    // A halfedge out of what stays that is not in the faces that vanish.
    const int y = twin(prev(h)), x = twin(next(h));
    const int out_of_staying = y >= 0 ? y : next(x);
    close_gap(h);
    if (t >= 0) close_gap(t);
    set_out(staying, out_of_staying);
}

bool WorkingMesh::can_flip(int h) const {
    const int t = twin(h);
    if (t < 0 || is_marked(h)) return false;
    const int c = apex(h), d = apex(t);
    return c != d && find_edge(c, d) < 0;
}

void WorkingMesh::flip(int h) {
    const int t = twin(h);
    const int hn = next(h), hp = prev(h), tn = next(t), tp = prev(t);
    const int a = from(h), b = from(t), c = from(hp), d = from(tp);
    const int bc = twin(hn), ca = twin(hp), ad = twin(tn), db = twin(tp);
    const int role_bc = roles_[at(hn)], role_ca = roles_[at(hp)];
    const int role_ad = roles_[at(tn)], role_db = roles_[at(tp)];
    // Faces dca and cdb.
    const std::array<std::array<int, 2>, 6> corners{
        {{h, d}, {hn, c}, {hp, a}, {t, c}, {tn, d}, {tp, b}}};
    for (const auto& [side, v] : corners) set(Array::From, side, v);
    const std::array<std::array<int, 3>, 4> sides{
        {{hn, ca, role_ca}, {hp, ad, role_ad}, {tn, db, role_db}, {tp, bc, role_bc}}};
    for (const auto& [side, other, role] : sides) {
        set(Array::Role, side, role);
        join(side, other);
    }
    set_out(a, hp);
    set_out(b, tp);
    set_out(c, hn);
    set_out(d, tn);
}

void WorkingMesh::compact() {
    std::vector<int> number(points_.size(), -1);
    int vertices = 0;
    for (int v = 0; v < vertex_end(); ++v) {
        if (!is_vertex_alive(v)) continue;
        const int to_slot = number[at(v)] = vertices++;
        points_[at(to_slot)] = points_[at(v)];
        out_[at(to_slot)] = out_[at(v)];
        places_[at(to_slot)] = places_[at(v)];
        flags_[at(to_slot)] = flags_[at(v)];
    }
    std::vector<int> face_number(labels_.size(), -1);
    int faces = 0;
    for (int f = 0; f < face_end(); ++f)
        if (is_face_alive(f)) face_number[at(f)] = faces++;
    const auto moved = [&](int h) { return h < 0 ? -1 : 3 * face_number[at(face(h))] + h % 3; };
    for (int f = 0; f < face_end(); ++f) {
        const int target = face_number[at(f)];
        if (target < 0) continue;
        labels_[at(target)] = labels_[at(f)];
        for (int i = 0; i < 3; ++i) {
            from_[at(3 * target + i)] = number[at(from_[at(3 * f + i)])];
            twin_[at(3 * target + i)] = moved(twin_[at(3 * f + i)]);
            roles_[at(3 * target + i)] = roles_[at(3 * f + i)];
        }
    }
    for (int v = 0; v < vertices; ++v) out_[at(v)] = moved(out_[at(v)]);
    points_.resize(at(vertices));
    out_.resize(at(vertices));
    places_.resize(at(vertices));
    flags_.resize(at(vertices));
    stamps_.assign(at(vertices), 0);
    stamp_ = 0;
    labels_.resize(at(faces));
    from_.resize(at(3 * faces));
    twin_.resize(at(3 * faces));
    roles_.resize(at(3 * faces));
    for (int& v : tracked_)
        if (v >= 0) v = number[at(v)];
}

std::string WorkingMesh::first_fault() const {
    const auto fault = [](const char* what, int which) {
        return std::string(what) + " " + std::to_string(which);
    };
    std::vector<int> faces_at(points_.size(), 0);
    for (int h = 0; h < halfedge_end(); ++h) {
        if (!is_halfedge_alive(h)) continue;
        const int t = twin(h);
        if (!is_face_alive(face(h))) return fault("halfedge of a dead face", h);
        if (!is_vertex_alive(from(h))) return fault("dead vertex of halfedge", h);
        if (from(h) == to(h)) return fault("loop at halfedge", h);
        if (t >= 0 && (twin(t) != h || from(t) != to(h) || to(t) != from(h)))
            return fault("wrong twin of halfedge", h);
        if (t >= 0 && roles_[at(t)] != roles_[at(h)]) return fault("two roles of halfedge", h);
        if (is_marked(h) && !(is_on_curve(from(h)) && is_on_curve(to(h))))
            return fault("no curve at the ends of halfedge", h);
        if (t < 0 && !is_marked(h)) return fault("unmarked border at halfedge", h);
        if (t < 0 && out(from(h)) != h) return fault("not the first of its fan: halfedge", h);
        ++faces_at[at(from(h))];
    }
    for (int v = 0; v < vertex_end(); ++v) {
        if (!is_vertex_alive(v)) continue;
        if (from(out(v)) != v) return fault("wrong halfedge out of vertex", v);
        int visited = 0;
        visit_star(v, [&](int) { return ++visited <= faces_at[at(v)]; });
        if (visited != faces_at[at(v)]) return fault("more than one fan at vertex", v);
    }
    return {};
}

MarkedMesh WorkingMesh::to_marked_mesh() const {
    MarkedMesh marked;
    for (int v = 0; v < vertex_end(); ++v) {
        marked.mesh.add_vertex(point(v));
        marked.is_fixed_vertex.push_back(is_fixed(v) && !is_cut(v));
    }
    for (int f = 0; f < face_end(); ++f) {
        const auto [a, b, c] = corners(f);
        marked.mesh.add_face(VertexHandle(a), VertexHandle(b), VertexHandle(c));
        marked.face_label.push_back(label(f));
    }
    marked.station_vertex = tracked_;
    marked.edge_role.assign(marked.mesh.n_edges(), EdgeRole::Free);
    for (int h = 0; h < halfedge_end(); ++h) {
        if (!is_first(h) || !is_marked(h)) continue;
        const HalfedgeHandle there =
            marked.mesh.find_halfedge(VertexHandle(from(h)), VertexHandle(to(h)));
        marked.edge_role[at(marked.mesh.edge_handle(there).idx())] = role(h);
    }
    return marked;
}

}  // namespace fcn
