// Supporting feature curves (Gehre, Lim, Kobbelt 2016, section 5.3.1, factors L(e) and Loop(e)).
//
// Leaving an arc through one of its ends, the continuation is the arc end at that node with the
// smallest turning angle; the extension goes on while the straightest arc borders the same patch
// as the starting arc. The paper wants each curve to be "a subset of a VSA segment boundary", so
// one patch holds for a whole curve: an arc has two patches, both are tried, and a loop is
// preferred over an open curve, then the longer one. Where several continuations are equally
// straight, one that borders the patch wins, then the lowest index. Arcs without patch ids
// continue while the turning stays below max_turning; arcs with and without patch ids do not
// continue each other (the patch rule cannot hold).
//
// Following arcs one by one is quadratic for long chains. Ends that continue each other mutually
// make chains (per patch), and an extension is a short sequence of chain ranges: whatever enters a
// chain in the middle runs to its end. Chains carry prefix lengths, so the cost of an extension is
// the square of its number of one-sided continuations, which is small, and not its length. What the
// two extensions of an arc reach is united, so the result does not depend on its direction.
//
// The partition into curves takes, again and again, the longest run of a mutual chain whose arcs
// are all still free.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>

#include "network/network.h"

namespace fcn {
namespace {

/// Two continuations are equally straight if their cosines differ by less than this.
constexpr double kStraightnessTie = 1e-9;
constexpr int kNoPatch = -1;

/// A range [first, last] of positions in a chain.
struct ChainRange {
    int chain = -1;
    int first = 0;
    int last = 0;
};

/// End `end` (0 or 1) of arc `arc` is number 2 arc + end; slot k of an arc is its k-th patch, so
/// slot k of arc a is number 2 a + k (slot 0 alone where the arc has no or one patch).
class Continuations {
public:
    Continuations(const FeatureCurveNetwork& network, const CurveOptions& options)
        : network_(network), min_cosine_(std::cos(options.max_turning)) {
        const int arc_count = static_cast<int>(network.arcs.size());
        for (int a = 0; a < arc_count; ++a) {
            lengths_.push_back(network.arcs[a].length());
            std::array<int, 2> p = network.arcs[a].patches;
            if (p[0] < 0) std::swap(p[0], p[1]);
            if (p[0] < 0) p = {kNoPatch, kNoPatch};
            if (p[1] == p[0]) p[1] = kNoPatch;
            patches_.push_back(p);
            for (int e = 0; e < 2; ++e)
                tangents_.push_back(
                    outward_tangent(network.arcs[a], e, lengths_.back(), options.tangent_length));
        }
        link_ends();
        build_chains();
    }

    int slot_count(int arc) const { return patches_[arc][1] == kNoPatch ? 1 : 2; }
    double length(int arc) const { return lengths_[arc]; }

    /// The chain (mutual continuations for one patch) that a slot belongs to.
    struct Chain {
        std::vector<int> arcs;
        std::vector<bool> is_reversed;
        std::vector<double> prefix;        ///< length before arc k; one entry more than arcs
        std::array<int, 2> exits{-1, -1};  ///< one-sided continuation (arc end) before, behind
        bool is_closed = false;
    };
    const std::vector<Chain>& chains() const { return chains_; }

    SupportingCurve extend(int arc, int slot) const;

private:
    static Vec3 outward_tangent(const NetworkArc& arc, int end, double length, double reach);
    void link_ends();
    int straightest(int end, int patch, const std::vector<int>& at_node, int from, int to) const;
    int slot_of(int arc, int patch) const {
        if (patches_[arc][0] == patch) return 0;
        return patch != kNoPatch && patches_[arc][1] == patch ? 1 : -1;
    }
    /// The arc end that continues arc end `end` in slot `slot`; -1 = the extension stops.
    int next(int end, int slot) const { return next_[2 * end + slot]; }
    /// The same if the continuation is mutual.
    int mutual(int end, int slot) const;
    void build_chains();
    void build_chain(int arc, int slot);

    /// What one of the two extensions of a start slot has reached.
    struct Walk {
        int start_chain = -1;
        int start_position = -1;
        bool is_start_forward = true;  ///< the extension leaves along its chain, not against it
        std::vector<ChainRange> visited;
        bool is_loop = false;
    };
    Walk walk(int start_slot, int patch, bool is_forward) const;
    bool run(int chain, int position, bool is_forward, Walk& walk) const;
    double union_length(std::vector<ChainRange> ranges) const;

    const FeatureCurveNetwork& network_;
    double min_cosine_;
    std::vector<double> lengths_;
    std::vector<std::array<int, 2>> patches_;
    std::vector<Vec3> tangents_;  ///< per arc end, unit, out of the node
    std::vector<int> next_;       ///< per arc end and slot
    std::vector<Chain> chains_;
    std::vector<int> chain_of_;     ///< per slot
    std::vector<int> position_of_;  ///< per slot
};

Vec3 Continuations::outward_tangent(const NetworkArc& arc, int end, double length, double reach) {
    // Beyond the middle of a closed arc the direction would turn back to the node.
    if (arc.is_closed()) reach = std::min(reach, length / 2);
    const int count = static_cast<int>(arc.samples.size());
    const auto sample = [&](int k) -> const Vec3& {
        return arc.samples[end == 0 ? k : count - 1 - k].position;
    };
    double walked = 0;
    Vec3 direction = Vec3::Zero();
    for (int k = 1; k < count; ++k) {
        const double step = (sample(k) - sample(k - 1)).norm();
        if (walked + step >= reach && step > 0) {
            const double share = reach > 0 ? (reach - walked) / step : 1.0;
            const Vec3 point = sample(k - 1) + share * (sample(k) - sample(k - 1));
            direction = point - sample(0);
            if (direction.norm() > 0) break;
        }
        walked += step;
        if (sample(k) != sample(0)) direction = sample(k) - sample(0);
    }
    const double norm = direction.norm();
    return norm > 0 ? Vec3(direction / norm) : Vec3::Zero();
}

void Continuations::link_ends() {
    const int end_count = static_cast<int>(tangents_.size());
    std::vector<int> first(network_.nodes.size() + 1, 0);
    const auto node = [&](int end) { return network_.arcs[end / 2].nodes[end % 2]; };
    for (int end = 0; end < end_count; ++end) ++first[node(end) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<int> at_node(end_count), fill(first.begin(), first.end() - 1);
    for (int end = 0; end < end_count; ++end) at_node[fill[node(end)]++] = end;
    next_.assign(2 * end_count, -1);
    for (int end = 0; end < end_count; ++end)
        for (int slot = 0; slot < slot_count(end / 2); ++slot)
            next_[2 * end + slot] = straightest(end, patches_[end / 2][slot], at_node,
                                                first[node(end)], first[node(end) + 1]);
}

int Continuations::straightest(int end, int patch, const std::vector<int>& at_node, int from,
                               int to) const {
    double best = -2;
    for (int k = from; k < to; ++k)
        if (at_node[k] != end) best = std::max(best, -tangents_[end].dot(tangents_[at_node[k]]));
    if (best < -1.5) return -1;
    if (patch == kNoPatch && best <= min_cosine_) return -1;
    for (int k = from; k < to; ++k) {
        const int candidate = at_node[k];
        if (candidate == end || slot_of(candidate / 2, patch) < 0) continue;
        if (-tangents_[end].dot(tangents_[candidate]) >= best - kStraightnessTie) return candidate;
    }
    return -1;
}

int Continuations::mutual(int end, int slot) const {
    const int other = next(end, slot);
    if (other < 0) return -1;
    const int patch = patches_[end / 2][slot];
    return next(other, slot_of(other / 2, patch)) == end ? other : -1;
}

void Continuations::build_chains() {
    chain_of_.assign(2 * lengths_.size(), -1);
    position_of_.assign(2 * lengths_.size(), -1);
    for (int a = 0; a < static_cast<int>(lengths_.size()); ++a)
        for (int slot = 0; slot < slot_count(a); ++slot)
            if (chain_of_[2 * a + slot] < 0) build_chain(a, slot);
}

void Continuations::build_chain(int arc, int slot) {
    const int patch = patches_[arc][slot];
    Chain chain;
    std::vector<int> back;  // ends through which the walk backwards enters
    for (int out = 2 * arc;;) {
        const int in = mutual(out, slot_of(out / 2, patch));
        if (in < 0) break;
        if (in / 2 == arc) {
            chain.is_closed = true;
            break;
        }
        back.push_back(in);
        out = in ^ 1;
    }
    const auto add = [&](int a, bool is_reversed) {
        chain.arcs.push_back(a);
        chain.is_reversed.push_back(is_reversed);
    };
    if (!chain.is_closed)
        for (auto in = back.rbegin(); in != back.rend(); ++in) add(*in / 2, *in % 2 == 0);
    add(arc, false);
    for (int out = 2 * arc + 1;;) {
        const int in = mutual(out, slot_of(out / 2, patch));
        if (in < 0 || in / 2 == arc) break;
        add(in / 2, in % 2 == 1);
        out = in ^ 1;
    }
    chain.prefix.push_back(0);
    for (std::size_t k = 0; k < chain.arcs.size(); ++k) {
        const int a = chain.arcs[k];
        const int s = 2 * a + slot_of(a, patch);
        chain_of_[s] = static_cast<int>(chains_.size());
        position_of_[s] = static_cast<int>(k);
        chain.prefix.push_back(chain.prefix.back() + lengths_[a]);
    }
    const auto exit = [&](std::size_t k, bool is_start) {
        const int a = chain.arcs[k];
        return next(2 * a + (is_start == chain.is_reversed[k] ? 1 : 0), slot_of(a, patch));
    };
    if (!chain.is_closed) chain.exits = {exit(0, true), exit(chain.arcs.size() - 1, false)};
    chains_.push_back(std::move(chain));
}

/// Runs through `chain` from `position` to its end in one direction, as far as nothing was visited
/// before. Returns false when the extension stops inside.
bool Continuations::run(int chain, int position, bool is_forward, Walk& walk) const {
    const int count = static_cast<int>(chains_[chain].arcs.size());
    int stop = is_forward ? count : -1;  // first position not taken
    for (const ChainRange& r : walk.visited) {
        if (r.chain != chain) continue;
        if (r.first <= position && position <= r.last) stop = position;
        if (is_forward && r.first > position) stop = std::min(stop, r.first);
        if (!is_forward && r.last < position) stop = std::max(stop, r.last);
    }
    if (is_forward && stop > position) walk.visited.push_back({chain, position, stop - 1});
    if (!is_forward && stop < position) walk.visited.push_back({chain, stop + 1, position});
    if (stop < 0 || stop >= count) return true;
    walk.is_loop = chain == walk.start_chain && stop == walk.start_position &&
                   is_forward == walk.is_start_forward;
    return false;
}

/// One extension: to the end of the start's chain, then along one-sided continuations.
Continuations::Walk Continuations::walk(int start_slot, int patch, bool is_forward) const {
    Walk walk;
    walk.start_chain = chain_of_[start_slot];
    walk.start_position = position_of_[start_slot];
    walk.is_start_forward = is_forward;
    if (!run(walk.start_chain, walk.start_position, is_forward, walk)) return walk;
    int in = chains_[walk.start_chain].exits[is_forward ? 1 : 0];
    while (in >= 0) {
        const int slot = 2 * (in / 2) + slot_of(in / 2, patch);
        const int chain = chain_of_[slot];
        const Chain& links = chains_[chain];
        const int position = position_of_[slot];
        const bool is_along = (in % 2 == 1) == links.is_reversed[position];
        if (!run(chain, position, is_along, walk)) return walk;
        if (links.is_closed) {
            // Entered from outside: the rest of the cycle, up to where it was entered.
            run(chain, is_along ? 0 : static_cast<int>(links.arcs.size()) - 1, is_along, walk);
            return walk;
        }
        in = links.exits[is_along ? 1 : 0];
    }
    return walk;
}

double Continuations::union_length(std::vector<ChainRange> ranges) const {
    std::sort(ranges.begin(), ranges.end(), [](const ChainRange& a, const ChainRange& b) {
        return std::tie(a.chain, a.first, a.last) < std::tie(b.chain, b.first, b.last);
    });
    double length = 0;
    int chain = -1, end = 0;  // positions below `end` of `chain` are counted
    for (const ChainRange& r : ranges) {
        if (r.chain != chain) end = 0;
        chain = r.chain;
        const int begin = std::max(r.first, end);
        if (begin > r.last) continue;
        length += chains_[chain].prefix[r.last + 1] - chains_[chain].prefix[begin];
        end = r.last + 1;
    }
    return length;
}

SupportingCurve Continuations::extend(int arc, int slot) const {
    const int start_slot = 2 * arc + slot;
    const Chain& chain = chains_[chain_of_[start_slot]];
    if (chain.is_closed) return {chain.prefix.back(), true};
    const Walk forward = walk(start_slot, patches_[arc][slot], true);
    const Walk backward = walk(start_slot, patches_[arc][slot], false);
    if (forward.is_loop || backward.is_loop)
        return {std::max(forward.is_loop ? union_length(forward.visited) : 0,
                         backward.is_loop ? union_length(backward.visited) : 0),
                true};
    std::vector<ChainRange> both = forward.visited;
    both.insert(both.end(), backward.visited.begin(), backward.visited.end());
    return {union_length(std::move(both)), network_.arcs[arc].is_closed()};
}

/// A run of free arcs of a chain, by length.
struct Run {
    double length = 0;
    ChainRange range;
    bool operator<(const Run& other) const {
        if (length != other.length) return length < other.length;
        if (range.chain != other.range.chain) return range.chain > other.range.chain;
        return range.first > other.range.first;
    }
};

class Partition {
public:
    Partition(FeatureCurveNetwork& network, const CurveOptions& options)
        : network_(network), continuations_(network, options) {
        for (NetworkArc& arc : network_.arcs) arc.curve = -1;
    }

    void run() {
        for (std::size_t c = 0; c < chains().size(); ++c)
            push({static_cast<int>(c), 0, static_cast<int>(chains()[c].arcs.size()) - 1});
        while (!queue_.empty()) {
            const ChainRange range = queue_.top().range;
            queue_.pop();
            if (is_free(range))
                take(range);
            else
                push_free_parts(range);
        }
        sort_curves();
    }

private:
    const std::vector<Continuations::Chain>& chains() const { return continuations_.chains(); }

    void push(const ChainRange& range) {
        const auto& prefix = chains()[range.chain].prefix;
        queue_.push({prefix[range.last + 1] - prefix[range.first], range});
    }

    bool is_taken(int chain, int position) const {
        return network_.arcs[chains()[chain].arcs[position]].curve >= 0;
    }

    bool is_free(const ChainRange& range) const {
        for (int k = range.first; k <= range.last; ++k)
            if (is_taken(range.chain, k)) return false;
        return true;
    }

    void push_free_parts(const ChainRange& range) {
        int k = range.first;
        while (k <= range.last) {
            const int begin = k;
            while (k <= range.last && !is_taken(range.chain, k)) ++k;
            if (k > begin) push({range.chain, begin, k - 1});
            ++k;
        }
    }

    void take(const ChainRange& range) {
        const Continuations::Chain& chain = chains()[range.chain];
        NetworkCurve curve;
        for (int k = range.first; k <= range.last; ++k) {
            curve.arcs.push_back(chain.arcs[k]);
            curve.is_reversed.push_back(chain.is_reversed[k]);
            curve.length += continuations_.length(chain.arcs[k]);
            network_.arcs[chain.arcs[k]].curve = 0;
        }
        const bool is_whole = curve.arcs.size() == chain.arcs.size();
        const bool is_closed_arc =
            curve.arcs.size() == 1 && network_.arcs[curve.arcs[0]].is_closed();
        curve.is_closed = (chain.is_closed && is_whole) || is_closed_arc;
        normalise(curve);
        curves_.push_back(std::move(curve));
    }

    /// The arc of lowest index runs forward, and a closed curve starts with it.
    static void normalise(NetworkCurve& curve) {
        const auto lowest = [&] {
            return std::min_element(curve.arcs.begin(), curve.arcs.end()) - curve.arcs.begin();
        };
        if (curve.is_reversed[lowest()]) {
            std::reverse(curve.arcs.begin(), curve.arcs.end());
            std::reverse(curve.is_reversed.begin(), curve.is_reversed.end());
            curve.is_reversed.flip();
        }
        if (!curve.is_closed) return;
        const auto start = lowest();
        std::rotate(curve.arcs.begin(), curve.arcs.begin() + start, curve.arcs.end());
        std::rotate(curve.is_reversed.begin(), curve.is_reversed.begin() + start,
                    curve.is_reversed.end());
    }

    void sort_curves() {
        const auto lowest = [](const NetworkCurve& curve) {
            return *std::min_element(curve.arcs.begin(), curve.arcs.end());
        };
        std::vector<std::pair<int, std::size_t>> order;
        for (std::size_t c = 0; c < curves_.size(); ++c) order.push_back({lowest(curves_[c]), c});
        std::sort(order.begin(), order.end());
        network_.curves.clear();
        for (const auto& [arc, c] : order) {
            for (int member : curves_[c].arcs)
                network_.arcs[member].curve = static_cast<int>(network_.curves.size());
            network_.curves.push_back(std::move(curves_[c]));
        }
    }

    FeatureCurveNetwork& network_;
    Continuations continuations_;
    std::priority_queue<Run> queue_;
    std::vector<NetworkCurve> curves_;
};

}  // namespace

void find_curves(FeatureCurveNetwork& network, const CurveOptions& options) {
    Partition(network, options).run();
}

std::vector<SupportingCurve> supporting_curves(const FeatureCurveNetwork& network,
                                               const CurveOptions& options) {
    const Continuations continuations(network, options);
    std::vector<SupportingCurve> result;
    result.reserve(network.arcs.size());
    for (int a = 0; a < static_cast<int>(network.arcs.size()); ++a) {
        SupportingCurve best = continuations.extend(a, 0);
        for (int slot = 1; slot < continuations.slot_count(a); ++slot) {
            const SupportingCurve other = continuations.extend(a, slot);
            if (other.is_loop != best.is_loop ? other.is_loop : other.length > best.length)
                best = other;
        }
        result.push_back(best);
    }
    return result;
}

}  // namespace fcn
