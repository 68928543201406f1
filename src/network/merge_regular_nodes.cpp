// Joins arcs through nodes of exactly two arc ends. The joinable pairs of arc ends form chains and
// cycles of arcs; each is traced from its arc of lowest index, in that arc's direction, and becomes
// one arc. A cycle keeps the lowest arc's first node. Left as they are: chains whose joined
// polyline would be closed with fewer than the three distinct samples of a closed arc, and a node
// where a second long segment would come into one arc. Curves are carried as
// links between consecutive arc ends: links inside a joined arc vanish, the others move to its
// ends, and joined arcs tie their curves together.

#include <algorithm>

#include "network/drop_unused_nodes.h"
#include "network/network.h"

namespace fcn {
namespace {

/// End `end` (0 or 1) of arc `arc` is number 2 arc + end.
struct Piece {
    int arc = -1;
    bool is_reversed = false;
};

class Merger {
public:
    explicit Merger(const FeatureCurveNetwork& network) : in_(network) {}

    FeatureCurveNetwork run() {
        find_joins();
        trace_chains();
        join_arcs();
        carry_segments();
        carry_curves();
        drop_unused_nodes(out_);
        return std::move(out_);
    }

private:
    std::array<int, 2> patches_along(int arc, bool is_reversed) const {
        std::array<int, 2> patches = in_.arcs[arc].patches;
        if (is_reversed) std::swap(patches[0], patches[1]);
        return patches;
    }

    bool is_joinable(int end, int other, const std::vector<bool>& is_in_orbit) const {
        const int a = end / 2, b = other / 2;
        if (a == b || is_in_orbit[a] || is_in_orbit[b]) return false;
        const NetworkArc &first = in_.arcs[a], &second = in_.arcs[b];
        // Walk in through `end` and out through `other`: both arcs see the same side as left.
        return first.kind == second.kind && first.pin == second.pin &&
               first.source == second.source &&
               patches_along(a, end % 2 == 0) == patches_along(b, other % 2 == 1);
    }

    void find_joins() {
        const int end_count = 2 * static_cast<int>(in_.arcs.size());
        std::vector<bool> is_in_orbit(in_.arcs.size(), false);
        for (const SymmetryOrbit& orbit : in_.orbits)
            for (const OrbitMember& member : orbit.members) is_in_orbit[member.arc] = true;
        has_long_segment_.assign(in_.arcs.size(), false);
        for (const NetworkSegment& segment : in_.segments)
            if (segment.is_long) has_long_segment_[segment.arc] = true;
        std::vector<std::array<int, 2>> ends(in_.nodes.size(), {-1, -1});
        const std::vector<int> valence = in_.valences();
        for (int end = 0; end < end_count; ++end) {
            std::array<int, 2>& pair = ends[in_.arcs[end / 2].nodes[end % 2]];
            (pair[0] < 0 ? pair[0] : pair[1]) = end;
        }
        join_.assign(end_count, -1);
        for (std::size_t n = 0; n < ends.size(); ++n) {
            if (valence[n] != 2 || !is_joinable(ends[n][0], ends[n][1], is_in_orbit)) continue;
            join_[ends[n][0]] = ends[n][1];
            join_[ends[n][1]] = ends[n][0];
        }
    }

    std::size_t sample_count(const std::vector<Piece>& chain) const {
        std::size_t count = 1;
        for (const Piece& piece : chain) count += in_.arcs[piece.arc].samples.size() - 1;
        return count;
    }

    void trace_chains() {
        std::vector<bool> is_done(in_.arcs.size(), false);
        for (int a = 0; a < static_cast<int>(in_.arcs.size()); ++a) {
            if (is_done[a]) continue;
            std::vector<Piece> back;  // from a's start outwards
            bool is_cycle = false;
            for (int end = join_[2 * a]; end >= 0; end = join_[end ^ 1]) {
                if (end / 2 == a) {
                    is_cycle = true;
                    break;
                }
                back.push_back({end / 2, end % 2 == 0});
            }
            std::vector<Piece> chain;
            if (!is_cycle) chain.assign(back.rbegin(), back.rend());
            chain.push_back({a, false});
            for (int end = join_[2 * a + 1]; end >= 0 && end / 2 != a; end = join_[end ^ 1])
                chain.push_back({end / 2, end % 2 == 1});
            for (const Piece& piece : chain) is_done[piece.arc] = true;
            add_chain(chain);
        }
    }

    /// Cuts a chain where a second long segment would enter it, and leaves one alone that would
    /// become a closed arc of too few samples.
    void add_chain(const std::vector<Piece>& chain) {
        std::vector<std::vector<Piece>> parts(1);
        bool has_long = false;
        for (const Piece& piece : chain) {
            if (has_long && has_long_segment_[piece.arc]) {
                parts.emplace_back();
                has_long = false;
            }
            has_long = has_long || has_long_segment_[piece.arc];
            parts.back().push_back(piece);
        }
        for (std::vector<Piece>& part : parts) {
            if (part.size() > 1 && start_node(part.front()) == end_node(part.back()) &&
                sample_count(part) < 4) {
                for (const Piece& piece : part) chains_.push_back({{piece.arc, false}});
            } else {
                chains_.push_back(std::move(part));
            }
        }
    }

    int start_node(const Piece& p) const { return in_.arcs[p.arc].nodes[p.is_reversed ? 1 : 0]; }
    int end_node(const Piece& p) const { return in_.arcs[p.arc].nodes[p.is_reversed ? 0 : 1]; }

    void append(NetworkArc& arc, const Piece& piece, bool has_origins) const {
        const NetworkArc& part = in_.arcs[piece.arc];
        std::vector<ArcSample> samples = part.samples;
        std::vector<int> origins = part.origins;
        if (has_origins && origins.empty()) origins.assign(samples.size() - 1, piece.arc);
        if (piece.is_reversed) {
            std::reverse(samples.begin(), samples.end());
            std::reverse(origins.begin(), origins.end());
        }
        const std::ptrdiff_t shared = arc.samples.empty() ? 0 : 1;
        arc.samples.insert(arc.samples.end(), samples.begin() + shared, samples.end());
        arc.origins.insert(arc.origins.end(), origins.begin(), origins.end());
    }

    void join_arcs() {
        out_ = in_;
        out_.arcs.clear();
        out_.segments.clear();
        out_.curves.clear();
        place_.resize(in_.arcs.size());
        for (const std::vector<Piece>& chain : chains_) {
            const Piece &first = chain.front(), &last = chain.back();
            NetworkArc arc = in_.arcs[first.arc];
            arc.patches = patches_along(first.arc, first.is_reversed);
            arc.nodes = {start_node(first), end_node(last)};
            arc.samples.clear();
            arc.origins.clear();
            const bool has_origins = std::any_of(chain.begin(), chain.end(), [&](const Piece& p) {
                return !in_.arcs[p.arc].origins.empty();
            });
            double length = 0, turning = 0;
            for (const Piece& piece : chain) {
                place_[piece.arc] = {static_cast<int>(out_.arcs.size()),
                                     std::max(0, static_cast<int>(arc.samples.size()) - 1),
                                     piece.is_reversed};
                append(arc, piece, has_origins);
                const double part = in_.arcs[piece.arc].length();
                length += part;
                turning += part * in_.arcs[piece.arc].dihedral;
            }
            if (chain.size() > 1 && length > 0) arc.dihedral = turning / length;
            out_.arcs.push_back(std::move(arc));
        }
        for (SymmetryOrbit& orbit : out_.orbits)
            for (OrbitMember& member : orbit.members) member.arc = place_[member.arc].arc;
    }

    void carry_segments() {
        std::vector<std::vector<int>> of_arc(in_.arcs.size());
        for (std::size_t s = 0; s < in_.segments.size(); ++s)
            of_arc[in_.segments[s].arc].push_back(static_cast<int>(s));
        for (const std::vector<Piece>& chain : chains_)
            for (const Piece& piece : chain) {
                std::vector<int>& part = of_arc[piece.arc];
                if (piece.is_reversed) std::reverse(part.begin(), part.end());
                for (int s : part) out_.segments.push_back(moved_segment(in_.segments[s]));
            }
    }

    NetworkSegment moved_segment(NetworkSegment segment) const {
        const Place& place = place_[segment.arc];
        const int last = static_cast<int>(in_.arcs[segment.arc].samples.size()) - 1;
        if (place.is_reversed) {
            std::swap(segment.nodes[0], segment.nodes[1]);
            const int first = last - segment.last_sample;
            segment.last_sample = last - segment.first_sample;
            segment.first_sample = first;
        }
        segment.first_sample += place.first_sample;
        segment.last_sample += place.first_sample;
        segment.arc = place.arc;
        return segment;
    }

    /// The end of the joined arc that an end of an old arc became; -1 when it is inside.
    int moved_end(int end) const {
        const Place& place = place_[end / 2];
        const std::vector<Piece>& chain = chains_[place.arc];
        if (end == 2 * chain.front().arc + (chain.front().is_reversed ? 1 : 0))
            return 2 * place.arc;
        if (end == 2 * chain.back().arc + (chain.back().is_reversed ? 0 : 1))
            return 2 * place.arc + 1;
        return -1;
    }

    void carry_curves() {
        std::vector<int> link(2 * out_.arcs.size(), -1);
        std::vector<bool> has_curve(out_.arcs.size(), false);
        for (const NetworkCurve& curve : in_.curves) {
            const std::size_t count = curve.arcs.size();
            for (std::size_t k = 0; k < count; ++k) {
                has_curve[place_[curve.arcs[k]].arc] = true;
                if (k + 1 == count && !curve.is_closed) continue;
                const std::size_t next = (k + 1) % count;
                const int from = moved_end(2 * curve.arcs[k] + (curve.is_reversed[k] ? 0 : 1));
                const int to = moved_end(2 * curve.arcs[next] + (curve.is_reversed[next] ? 1 : 0));
                if (from < 0 || to < 0) continue;
                link[from] = to;
                link[to] = from;
            }
        }
        for (std::size_t a = 0; a < out_.arcs.size(); ++a) out_.arcs[a].curve = -1;
        for (int a = 0; a < static_cast<int>(out_.arcs.size()); ++a)
            if (has_curve[a] && out_.arcs[a].curve < 0) trace_curve(a, link);
    }

    void trace_curve(int start, const std::vector<int>& link) {
        NetworkCurve curve;
        std::vector<Piece> back;
        for (int end = link[2 * start]; end >= 0; end = link[end ^ 1]) {
            if (end / 2 == start) {
                curve.is_closed = true;
                break;
            }
            back.push_back({end / 2, end % 2 == 0});
        }
        std::vector<Piece> pieces;
        if (!curve.is_closed) pieces.assign(back.rbegin(), back.rend());
        pieces.push_back({start, false});
        for (int end = link[2 * start + 1]; end >= 0 && end / 2 != start; end = link[end ^ 1])
            pieces.push_back({end / 2, end % 2 == 1});
        // A closed arc is a closed curve whether or not its own ends are linked.
        if (pieces.size() == 1 && out_.arcs[start].is_closed()) curve.is_closed = true;
        for (const Piece& piece : pieces) {
            curve.arcs.push_back(piece.arc);
            curve.is_reversed.push_back(piece.is_reversed);
            curve.length += out_.arcs[piece.arc].length();
            out_.arcs[piece.arc].curve = static_cast<int>(out_.curves.size());
        }
        out_.curves.push_back(std::move(curve));
    }

    /// Where an old arc went.
    struct Place {
        int arc = -1;
        int first_sample = 0;
        bool is_reversed = false;
    };

    const FeatureCurveNetwork& in_;
    FeatureCurveNetwork out_;
    std::vector<bool> has_long_segment_;
    std::vector<int> join_;  ///< per arc end the end it is joined to, -1 none
    std::vector<std::vector<Piece>> chains_;
    std::vector<Place> place_;
};

}  // namespace

FeatureCurveNetwork merge_regular_nodes(const FeatureCurveNetwork& network) {
    return Merger(network).run();
}

}  // namespace fcn
