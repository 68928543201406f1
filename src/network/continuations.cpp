// How arcs continue each other (Gehre, Lim, Kobbelt 2016, section 5.3.1). Leaving an arc through
// one of its ends, the continuation is the arc end at that node with the smallest turning angle, if
// it borders the patch that is followed. Where several are equally straight, one that borders the
// patch wins, then the lowest index. Arcs without patch ids continue while the turning stays below
// max_turning; arcs with and without patch ids do not continue each other (the patch rule cannot
// hold). Ends that continue each other mutually make chains, one set of chains per patch.

#include "network/continuations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fcn {
namespace {

/// Two continuations are equally straight if their cosines differ by less than this.
constexpr double kStraightnessTie = 1e-9;

/// Unit direction from the node into the arc, taken over the length `reach`.
Vec3 outward_tangent(const NetworkArc& arc, int end, double length, double reach) {
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

}  // namespace

Continuations::Continuations(const FeatureCurveNetwork& network, const CurveOptions& options)
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
    chain_of_.assign(2 * arc_count, -1);
    position_of_.assign(2 * arc_count, -1);
    for (int a = 0; a < arc_count; ++a)
        for (int slot = 0; slot < slot_count(a); ++slot)
            if (chain_of_[2 * a + slot] < 0) build_chain(a, slot);
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

void Continuations::build_chain(int arc, int slot) {
    const int patch = patches_[arc][slot];
    ContinuationChain chain;
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

}  // namespace fcn
