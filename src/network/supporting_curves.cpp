// Supporting feature curves (Gehre, Lim, Kobbelt 2016, section 5.3.1, factors L(e) and Loop(e)):
// each arc is extended at both ends while the straightest continuation borders the same patch as
// the starting arc. The paper wants each curve to be "a subset of a VSA segment boundary", so one
// patch holds for a whole curve: an arc has two patches, both are tried, and a loop is preferred
// over an open curve, then the longer one.
//
// Following arcs one by one is quadratic for long chains. An extension is a short sequence of
// ranges of the chains of mutual continuations: whatever enters a chain in the middle runs to its
// end. Chains carry prefix lengths, so the cost of an extension is the square of its number of
// one-sided continuations, which is small, and not its length. What the two extensions of an arc
// reach is united, so the result does not depend on its direction.

#include <algorithm>
#include <tuple>

#include "network/continuations.h"
#include "network/network.h"

namespace fcn {
namespace {

/// What one of the two extensions of an arc has reached.
struct Walk {
    int start_chain = -1;
    int start_position = -1;
    bool is_start_forward = true;  ///< the extension leaves along its chain, not against it
    std::vector<ChainRange> visited;
    bool is_loop = false;
};

class Extension {
public:
    Extension(const FeatureCurveNetwork& network, const CurveOptions& options)
        : links_(network, options) {}

    const Continuations& links() const { return links_; }
    /// The extended curve of an arc along the patch of one of its slots.
    SupportingCurve extend(int arc, int slot) const;

private:
    Walk walk(int arc, int slot, bool is_forward) const;
    bool run(int chain, int position, bool is_forward, Walk& walk) const;
    double union_length(std::vector<ChainRange> ranges) const;

    Continuations links_;
};

/// Runs through `chain` from `position` to its end in one direction, as far as nothing was visited
/// before. Returns false when the extension stops inside.
bool Extension::run(int chain, int position, bool is_forward, Walk& walk) const {
    const int count = static_cast<int>(links_.chains()[chain].arcs.size());
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
Walk Extension::walk(int arc, int slot, bool is_forward) const {
    Walk walk;
    const int patch = links_.patch(arc, slot);
    walk.start_chain = links_.chain_of(arc, slot);
    walk.start_position = links_.position_of(arc, slot);
    walk.is_start_forward = is_forward;
    if (!run(walk.start_chain, walk.start_position, is_forward, walk)) return walk;
    int in = links_.chains()[walk.start_chain].exits[is_forward ? 1 : 0];
    while (in >= 0) {
        const int entered_slot = links_.slot_of(in / 2, patch);
        const int number = links_.chain_of(in / 2, entered_slot);
        const ContinuationChain& chain = links_.chains()[number];
        const int position = links_.position_of(in / 2, entered_slot);
        const bool is_along = (in % 2 == 1) == chain.is_reversed[position];
        if (!run(number, position, is_along, walk)) return walk;
        if (chain.is_closed) {
            // Entered from outside: the rest of the cycle, up to where it was entered.
            run(number, is_along ? 0 : static_cast<int>(chain.arcs.size()) - 1, is_along, walk);
            return walk;
        }
        in = chain.exits[is_along ? 1 : 0];
    }
    return walk;
}

double Extension::union_length(std::vector<ChainRange> ranges) const {
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
        length += links_.chains()[chain].prefix[r.last + 1] - links_.chains()[chain].prefix[begin];
        end = r.last + 1;
    }
    return length;
}

SupportingCurve Extension::extend(int arc, int slot) const {
    const ContinuationChain& chain = links_.chains()[links_.chain_of(arc, slot)];
    if (chain.is_closed) return {chain.prefix.back(), true};
    const Walk forward = walk(arc, slot, true);
    const Walk backward = walk(arc, slot, false);
    if (forward.is_loop || backward.is_loop)
        return {std::max(forward.is_loop ? union_length(forward.visited) : 0,
                         backward.is_loop ? union_length(backward.visited) : 0),
                true};
    std::vector<ChainRange> both = forward.visited;
    both.insert(both.end(), backward.visited.begin(), backward.visited.end());
    return {union_length(std::move(both)), links_.network().arcs[arc].is_closed()};
}

}  // namespace

std::vector<SupportingCurve> supporting_curves(const FeatureCurveNetwork& network,
                                               const CurveOptions& options) {
    const Extension extension(network, options);
    std::vector<SupportingCurve> result;
    result.reserve(network.arcs.size());
    for (int a = 0; a < static_cast<int>(network.arcs.size()); ++a) {
        SupportingCurve best = extension.extend(a, 0);
        for (int slot = 1; slot < extension.links().slot_count(a); ++slot) {
            const SupportingCurve other = extension.extend(a, slot);
            if (other.is_loop != best.is_loop ? other.is_loop : other.length > best.length)
                best = other;
        }
        result.push_back(best);
    }
    return result;
}

}  // namespace fcn
