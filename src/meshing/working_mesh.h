#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meshing/marked_mesh.h"

namespace fcn {

/// The mesh that remeshing changes: flat arrays, about 60 bytes a face. Halfedge 3 f + i of face f
/// runs from its corner i to corner i + 1; there are no halfedges outside the boundary (twin -1).
/// Roles belong to edges, labels to faces. A vertex that is on a boundary or on a curve stays so,
/// and none that is not comes to be: that is what the rules for changes amount to. Deleted items
/// keep their numbers until compact(). Changes can be undone back to a checkpoint.
class WorkingMesh {
public:
    /// Oriented 2-manifold triangles over all points; every boundary edge becomes a border, and so
    /// do edges between faces of different labels. `labels` may be empty.
    WorkingMesh(std::vector<Vec3> points, const std::vector<std::array<int, 3>>& triangles,
                std::vector<int> labels);

    static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int prev(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
    static int face(int h) { return h / 3; }

    // Numbers run below these; is_alive tells which exist.
    int vertex_end() const { return static_cast<int>(points_.size()); }
    int face_end() const { return static_cast<int>(labels_.size()); }
    int halfedge_end() const { return static_cast<int>(from_.size()); }
    bool is_vertex_alive(int v) const { return out_[at(v)] >= 0; }
    bool is_face_alive(int f) const { return from_[at(3 * f)] >= 0; }
    bool is_halfedge_alive(int h) const { return from_[at(h)] >= 0; }
    /// Each edge has one halfedge for which this holds.
    bool is_first(int h) const { return from_[at(h)] >= 0 && twin_[at(h)] < h; }

    int from(int h) const { return from_[at(h)]; }
    int to(int h) const { return from_[at(next(h))]; }
    int apex(int h) const { return from_[at(prev(h))]; }
    int twin(int h) const { return twin_[at(h)]; }
    /// Some halfedge out of v; at a boundary the first one counter-clockwise.
    int out(int v) const { return out_[at(v)]; }
    std::array<int, 3> corners(int f) const {
        return {from_[at(3 * f)], from_[at(3 * f + 1)], from_[at(3 * f + 2)]};
    }

    const Vec3& point(int v) const { return points_[at(v)]; }
    EdgeRole role(int h) const { return static_cast<EdgeRole>(roles_[at(h)]); }
    bool is_marked(int h) const { return roles_[at(h)] != 0; }
    int label(int f) const { return labels_[at(f)]; }
    bool is_fixed(int v) const { return (flags_[at(v)] & (kFixed | kResting)) != 0; }
    /// Fixed for the time being.
    bool is_resting(int v) const { return (flags_[at(v)] & kResting) != 0; }
    bool is_on_curve(int v) const { return (flags_[at(v)] & kOnCurve) != 0; }
    bool is_on_boundary(int v) const { return (flags_[at(v)] & kOnBoundary) != 0; }
    bool is_free(int v) const {
        return (flags_[at(v)] & (kFixed | kResting | kOnCurve | kOnBoundary)) == 0;
    }
    /// A face of the reference surface near the vertex; -1: unknown.
    int place(int v) const { return places_[at(v)]; }
    /// False from a split until the vertex is placed.
    bool is_placed(int v) const { return (flags_[at(v)] & kAfloat) == 0; }

    void set_point(int v, const Vec3& p);
    void set_place(int v, int place) {
        places_[at(v)] = place;
        flags_[at(v)] &= static_cast<std::uint8_t>(~kAfloat);
    }
    void set_role(int h, EdgeRole role);
    void fix(int v) { flags_[at(v)] |= kFixed; }
    void release(int v) { flags_[at(v)] &= static_cast<std::uint8_t>(~kFixed); }
    /// Whether the vertex is fixed for no reason of its own: it came of a cut through a feature
    /// edge, or curves run together there that end in a node nearby.
    bool is_cut(int v) const { return (flags_[at(v)] & kCut) != 0; }
    void fix_cut(int v) { flags_[at(v)] |= kFixed | kCut; }
    /// Fixes all cuts, or releases them.
    void set_cuts_fixed(bool is_fixed);
    void set_resting(int v, bool is_resting) {
        flags_[at(v)] = static_cast<std::uint8_t>(is_resting ? flags_[at(v)] | kResting
                                                             : flags_[at(v)] & ~kResting);
    }
    /// Whether another sheet is near (crossing_guard.h says when).
    bool is_thin(int v) const { return (flags_[at(v)] & kThin) != 0; }
    void set_thin(int v, bool is_thin) {
        flags_[at(v)] =
            static_cast<std::uint8_t>(is_thin ? flags_[at(v)] | kThin : flags_[at(v)] & ~kThin);
    }
    /// Whether all ends of an edge, or corners of a face, rest.
    bool is_edge_resting(int h) const { return is_resting(from(h)) && is_resting(to(h)); }
    bool is_face_resting(int f) const { return is_edge_resting(3 * f) && is_resting(apex(3 * f)); }

    /// Calls visit(h) for the halfedges out of v, counter-clockwise, one a face, until it returns
    /// false; returns whether it never did.
    template <class Visit>
    bool visit_star(int v, Visit&& visit) const {
        const int start = out(v);
        int h = start;
        do {
            if (!visit(h)) return false;
            h = twin(prev(h));
        } while (h >= 0 && h != start);
        return true;
    }
    /// The same for the neighbours of v, visit(u).
    template <class Visit>
    bool visit_neighbors(int v, Visit&& visit) const {
        int last = -1;
        const auto both = [&](int h) {
            last = h;
            return visit(to(h));
        };
        if (!visit_star(v, both)) return false;
        return !is_on_boundary(v) || visit(apex(last));
    }
    int valence(int v) const;
    /// The halfedge from a to b or from b to a, -1: not an edge.
    int find_edge(int a, int b) const;

    /// Halves edge h at p; returns the new vertex. h keeps its origin and ends there.
    int split(int h, const Vec3& p);
    /// Whether `vanishing`, an end of edge h, may go into the other one: topology and curves.
    bool can_collapse(int h, int vanishing) const;
    void collapse(int h, int vanishing);
    /// Whether h is a free inner edge whose flip makes no edge twice.
    bool can_flip(int h) const;
    void flip(int h);

    struct Checkpoint {
        std::size_t vertices, faces;
    };
    /// Changes from here on can be undone, until forget().
    Checkpoint start_recording();
    void undo(const Checkpoint& checkpoint);
    void forget();

    /// Vertices by number that others refer to; -1: none.
    void track(std::vector<int> vertices) { tracked_ = std::move(vertices); }
    const std::vector<int>& tracked() const { return tracked_; }

    /// Renumbers what is alive in its order, tracked vertices with it.
    void compact();
    /// The first broken invariant, for tests; empty: none. Linear time.
    std::string first_fault() const;
    /// For compacted meshes.
    MarkedMesh to_marked_mesh() const;

private:
    enum Flag : std::uint8_t {
        kFixed = 1,
        kOnCurve = 2,
        kOnBoundary = 4,
        kAfloat = 8,
        kResting = 16,
        kThin = 32,
        kCut = 64
    };
    enum class Array : std::uint8_t { From, Twin, Out, Role };
    struct Change {
        Array array;
        int index, old;
    };
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    void link_twins();
    void mark_borders();
    int add_vertex(const Vec3& p, std::uint8_t flags, int place);
    int add_face(int a, int b, int c, int label);
    void set(Array array, int index, int value);
    void join(int h, int other);
    void set_out(int v, int h);
    void close_gap(int h);

    std::vector<Vec3> points_;
    std::vector<int> out_, places_, tracked_;
    std::vector<std::uint8_t> flags_;
    std::vector<int> from_, twin_;
    std::vector<std::uint8_t> roles_;
    std::vector<int> labels_;
    mutable std::vector<int> stamps_;
    mutable int stamp_ = 0;
    bool is_recording_ = false;
    std::vector<Change> changes_;
    std::vector<std::pair<int, Vec3>> moves_;
};

}  // namespace fcn
