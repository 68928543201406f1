// Maximum-weight matching in general graphs by the primal-dual blossom method (Edmonds 1965,
// "Maximum matching and a polyhedron with 0,1-vertices"; Galil 1986 for the bookkeeping of trees).
//
// Duals: u >= 0 of every vertex, z >= 0 of every blossom (an odd set of vertices), with
// u(a) + u(b) + sum of z over blossoms that hold both >= w(ab). An edge is tight where this is an
// equation. The matching uses tight edges only and fills every blossom with z > 0; when each
// unmatched vertex has u = 0, it is optimal. Departures: one alternating tree is grown at a time,
// from one unmatched vertex with u > 0, and ends as soon as it reaches another unmatched vertex (an
// augmenting path) or a vertex of the tree whose u has come down to 0 (that one becomes unmatched
// instead). In dual graphs of meshes a tree stays small, so that a change of duals may visit the
// whole tree and no priority queues are needed. Weights are doubled: then all duals remain
// integers.
#include "meshing/weighted_matching.h"

#include <algorithm>
#include <limits>

#include "geometry/errors.h"

namespace fcn {
namespace {

enum class Label : std::uint8_t { Free, Outer, Inner };

class Matcher {
public:
    Matcher(int vertex_count, const std::vector<MatchingEdge>& edges);
    std::vector<int> run();

private:
    /// An edge from a vertex in one node to a vertex in another one; -1: none.
    struct Link {
        int from = -1, to = -1;
    };
    /// A vertex (number below n) or a blossom of an odd circle of nodes, children[0] with the base.
    struct Node {
        int parent = -1;
        int base = -1;  ///< the vertex through which the node is matched to the outside
        std::int64_t dual = 0;
        std::vector<int> children;
        std::vector<Link> links;  ///< from children[i] to children[i + 1]
        Label label = Label::Free;
        Link up;  ///< in the tree: from this node to its parent there
    };
    struct Neighbor {
        int vertex;
        std::int64_t weight;
    };

    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    Node& node(int i) { return nodes_[at(i)]; }
    bool is_blossom(int i) const { return i >= n_; }
    int top(int v) const { return top_[at(v)]; }
    /// Of an edge between different top nodes.
    std::int64_t slack(int v, const Neighbor& other) {
        return node(v).dual + node(other.vertex).dual - other.weight;
    }

    void match_greedily();
    void grow_from(int root);
    bool scan(int v);
    void label_outer(int i, Link up);
    void label_inner(int v, int w);
    bool change_duals();
    void shrink(int v, int w);
    void expand_inner(int i);
    void dissolve(int i);
    void rebase(int i, int v);
    void release(int v);
    void finish_tree();
    void set_top(int i, int top);
    void queue_vertices(int i);
    int new_blossom();

    int n_;
    std::vector<Node> nodes_;
    std::vector<std::vector<Neighbor>> neighbors_;
    std::vector<int> partner_, top_;
    std::vector<int> tree_;   ///< top nodes that were labelled; some may be gone by now
    std::vector<int> queue_;  ///< outer vertices to be scanned
    std::vector<int> unused_;
};

Matcher::Matcher(int vertex_count, const std::vector<MatchingEdge>& edges)
    : n_(vertex_count),
      nodes_(at(vertex_count)),
      neighbors_(at(vertex_count)),
      partner_(at(vertex_count), -1),
      top_(at(vertex_count)) {
    for (int v = 0; v < n_; ++v) {
        node(v).base = v;
        top_[at(v)] = v;
    }
    for (const MatchingEdge& edge : edges) {
        if (std::min(edge.a, edge.b) < 0 || std::max(edge.a, edge.b) >= n_ || edge.a == edge.b)
            throw LogicError("matching: an edge has bad ends");
        if (edge.weight <= 0) continue;
        neighbors_[at(edge.a)].push_back({edge.b, 2 * edge.weight});
        neighbors_[at(edge.b)].push_back({edge.a, 2 * edge.weight});
        node(edge.a).dual = std::max(node(edge.a).dual, edge.weight);
        node(edge.b).dual = std::max(node(edge.b).dual, edge.weight);
    }
}

std::vector<int> Matcher::run() {
    match_greedily();
    for (int v = 0; v < n_; ++v)
        if (partner_[at(v)] < 0 && node(v).dual > 0) grow_from(v);
    return partner_;
}

/// Edges that are the heaviest at both of their ends are tight.
void Matcher::match_greedily() {
    for (int v = 0; v < n_; ++v) {
        if (partner_[at(v)] >= 0) continue;
        for (const Neighbor& other : neighbors_[at(v)]) {
            if (partner_[at(other.vertex)] >= 0 || slack(v, other) != 0) continue;
            partner_[at(v)] = other.vertex;
            partner_[at(other.vertex)] = v;
            break;
        }
    }
}

void Matcher::grow_from(int root) {
    label_outer(top(root), {});
    for (bool is_done = false; !is_done;) {
        while (!queue_.empty() && !is_done) {
            const int v = queue_.back();
            queue_.pop_back();
            is_done = scan(v);
        }
        if (!is_done) is_done = change_duals();
    }
    finish_tree();
}

/// Follows tight edges out of an outer vertex; whether that ended the tree.
bool Matcher::scan(int v) {
    for (const Neighbor& other : neighbors_[at(v)]) {
        const int w = other.vertex;
        if (top(w) == top(v) || slack(v, other) != 0) continue;
        const Node& there = node(top(w));
        if (there.label == Label::Outer) {
            shrink(v, w);
        } else if (there.label == Label::Free) {
            if (partner_[at(there.base)] < 0) {
                rebase(top(w), w);
                release(v);
                partner_[at(v)] = w;
                partner_[at(w)] = v;
                return true;
            }
            label_inner(w, v);
        }
    }
    return false;
}

void Matcher::label_outer(int i, Link up) {
    node(i).label = Label::Outer;
    node(i).up = up;
    tree_.push_back(i);
    queue_vertices(i);
}

/// The node of w hangs under v, and the node it is matched to under it.
void Matcher::label_inner(int w, int v) {
    const int i = top(w);
    node(i).label = Label::Inner;
    node(i).up = {w, v};
    tree_.push_back(i);
    const int base = node(i).base;
    label_outer(top(partner_[at(base)]), {partner_[at(base)], base});
}

void Matcher::queue_vertices(int i) {
    if (!is_blossom(i)) {
        queue_.push_back(i);
        return;
    }
    for (const int child : node(i).children) queue_vertices(child);
}

void Matcher::set_top(int i, int top) {
    if (!is_blossom(i)) {
        top_[at(i)] = top;
        return;
    }
    for (const int child : node(i).children) set_top(child, top);
}

int Matcher::new_blossom() {
    if (unused_.empty()) {
        nodes_.emplace_back();
        return static_cast<int>(nodes_.size()) - 1;
    }
    const int i = unused_.back();
    unused_.pop_back();
    node(i) = {};
    return i;
}

/// The circle that a tight edge between two outer vertices closes becomes an outer blossom.
void Matcher::shrink(int v, int w) {
    std::vector<int> from_v{top(v)}, from_w{top(w)};
    const auto parent = [&](int i) { return node(i).up.to < 0 ? -1 : top(node(i).up.to); };
    while (parent(from_v.back()) >= 0) from_v.push_back(parent(from_v.back()));
    while (parent(from_w.back()) >= 0) from_w.push_back(parent(from_w.back()));
    // Both end at the root; what they share but for the last common node goes.
    while (from_v.size() > 1 && from_w.size() > 1 &&
           from_v[from_v.size() - 2] == from_w[from_w.size() - 2]) {
        from_v.pop_back();
        from_w.pop_back();
    }
    const int i = new_blossom();
    Node& blossom = node(i);
    const int apex = from_v.back();
    blossom.base = node(apex).base;
    blossom.up = node(apex).up;
    blossom.label = Label::Outer;
    for (std::size_t k = from_v.size(); k-- > 0;) {
        blossom.children.push_back(from_v[k]);
        const Link up = k > 0 ? node(from_v[k - 1]).up : Link{w, v};
        blossom.links.push_back({up.to, up.from});
    }
    for (std::size_t k = 0; k + 1 < from_w.size(); ++k) {
        blossom.children.push_back(from_w[k]);
        blossom.links.push_back(node(from_w[k]).up);
    }
    for (const int child : blossom.children) {
        node(child).parent = i;
        if (node(child).label == Label::Inner) queue_vertices(child);
        node(child).label = Label::Free;
    }
    set_top(i, i);
    tree_.push_back(i);
}

/// One step of the duals; whether it ended the tree.
bool Matcher::change_duals() {
    std::int64_t step = std::numeric_limits<std::int64_t>::max();
    int ending = -1;     // a vertex whose dual comes to 0
    int expanding = -1;  // an inner blossom whose dual comes to 0
    std::vector<int> outer, inner;
    const auto collect = [&](const auto& self, int i, std::vector<int>& into) -> void {
        if (!is_blossom(i)) return into.push_back(i);
        for (const int child : node(i).children) self(self, child, into);
    };
    std::vector<int> nodes;  // of the tree, as it is now
    for (const int i : tree_)
        if (node(i).parent < 0 && node(i).label != Label::Free) nodes.push_back(i);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const int i : nodes) {
        const bool is_outer = node(i).label == Label::Outer;
        collect(collect, i, is_outer ? outer : inner);
        if (!is_outer && is_blossom(i) && node(i).dual / 2 < step) {
            step = node(i).dual / 2;
            expanding = i;
        }
    }
    for (const int v : outer) {
        for (const Neighbor& other : neighbors_[at(v)]) {
            const Label there = node(top(other.vertex)).label;
            if (top(other.vertex) == top(v) || there == Label::Inner) continue;
            const std::int64_t room = there == Label::Outer ? slack(v, other) / 2 : slack(v, other);
            if (room >= step) continue;
            step = room;
            expanding = -1;
        }
    }
    for (const int v : outer) {
        if (node(v).dual > step || (node(v).dual == step && ending >= 0)) continue;
        step = node(v).dual;
        ending = v;
        expanding = -1;
    }
    for (const int v : outer) node(v).dual -= step;
    for (const int v : inner) node(v).dual += step;
    for (const int i : nodes)
        if (is_blossom(i)) node(i).dual += node(i).label == Label::Outer ? 2 * step : -2 * step;
    tree_ = std::move(nodes);
    if (ending >= 0) {
        release(ending);
        partner_[at(ending)] = -1;
        return true;
    }
    if (expanding >= 0) expand_inner(expanding);
    queue_.insert(queue_.end(), outer.begin(), outer.end());
    return false;
}

/// Its children become top nodes.
void Matcher::dissolve(int i) {
    for (const int child : node(i).children) {
        node(child).parent = -1;
        set_top(child, child);
    }
    node(i).label = Label::Free;
    node(i).children.clear();
    unused_.push_back(i);
}

/// An inner blossom without dual: the children on the even way from where the tree comes in to the
/// base take its place.
void Matcher::expand_inner(int i) {
    const std::vector<int> children = node(i).children;
    const std::vector<Link> links = node(i).links;
    const Link up = node(i).up;
    dissolve(i);
    std::erase(tree_, i);
    const std::size_t count = children.size();
    std::size_t k = 0;
    while (children[k] != top(up.from)) ++k;
    const bool is_forward = k % 2 == 1;  // children 2 j - 1 and 2 j are matched
    Link entry = up;
    while (true) {
        const int child = children[k];
        node(child).label = Label::Inner;
        node(child).up = entry;
        tree_.push_back(child);
        if (k == 0) break;
        const std::size_t mate = is_forward ? k + 1 : k - 1;
        const int base = node(child).base;
        label_outer(children[mate], {partner_[at(base)], base});
        const std::size_t after = is_forward ? (mate + 1) % count : mate - 1;
        const Link link = links[is_forward ? mate : after];
        entry = is_forward ? Link{link.to, link.from} : link;
        k = after;
    }
}

/// Changes the matching inside a node so that its base is v.
void Matcher::rebase(int i, int v) {
    if (!is_blossom(i)) return;
    int child = v;
    while (node(child).parent != i) child = node(child).parent;
    rebase(child, v);
    const std::size_t count = node(i).children.size();
    std::size_t k = 0;
    while (node(i).children[k] != child) ++k;
    const auto match = [&](std::size_t j) {
        const Link link = node(i).links[j];
        rebase(node(i).children[j], link.from);
        rebase(node(i).children[(j + 1) % count], link.to);
        partner_[at(link.from)] = link.to;
        partner_[at(link.to)] = link.from;
    };
    if (k % 2 == 0) {
        for (std::size_t j = 0; j < k; j += 2) match(j);
    } else {
        for (std::size_t j = k + 1; j < count; j += 2) match(j);
    }
    auto& children = node(i).children;
    auto& links = node(i).links;
    std::rotate(children.begin(), children.begin() + static_cast<std::ptrdiff_t>(k),
                children.end());
    std::rotate(links.begin(), links.begin() + static_cast<std::ptrdiff_t>(k), links.end());
    node(i).base = v;
}

/// Changes the matching along the tree so that outer vertex v is the one without a partner, and
/// the root is matched.
void Matcher::release(int v) {
    while (true) {
        const int outer = top(v);
        rebase(outer, v);
        if (node(outer).up.to < 0) return;
        const int inner = top(node(outer).up.to);
        const Link up = node(inner).up;
        rebase(inner, up.from);
        partner_[at(up.from)] = up.to;
        partner_[at(up.to)] = up.from;
        v = up.to;
    }
}

/// Labels go; blossoms without dual do, too, since they only lengthen what follows.
void Matcher::finish_tree() {
    queue_.clear();
    for (const int i : tree_) node(i).label = Label::Free;
    for (std::size_t k = 0; k < tree_.size(); ++k) {
        const int i = tree_[k];
        if (!is_blossom(i) || node(i).parent >= 0 || node(i).dual != 0 || node(i).children.empty())
            continue;
        const std::vector<int> children = node(i).children;
        dissolve(i);
        tree_.insert(tree_.end(), children.begin(), children.end());
    }
    tree_.clear();
}

}  // namespace

std::vector<int> heaviest_matching(int vertex_count, const std::vector<MatchingEdge>& edges) {
    return Matcher(vertex_count, edges).run();
}

}  // namespace fcn
