#pragma once

#include <array>
#include <vector>

#include "network/network.h"

namespace fcn {

inline constexpr int kNoPatch = -1;

/// Mutual continuations for one patch, as far as they go.
struct ContinuationChain {
    std::vector<int> arcs;
    std::vector<bool> is_reversed;
    std::vector<double> prefix;        ///< length before arc k; one entry more than arcs
    std::array<int, 2> exits{-1, -1};  ///< one-sided continuation (arc end) before, behind
    bool is_closed = false;
};

/// A range [first, last] of positions in a chain.
struct ChainRange {
    int chain = -1;
    int first = 0;
    int last = 0;
};

/// How arcs continue each other through nodes. End `end` (0 or 1) of arc `arc` is number
/// 2 arc + end; slot k of an arc is its k-th patch, number 2 arc + k (slot 0 alone where the arc
/// has no or one patch). O(sum of squared valences). Keeps a reference to the network.
class Continuations {
public:
    Continuations(const FeatureCurveNetwork& network, const CurveOptions& options);

    const FeatureCurveNetwork& network() const { return network_; }
    int slot_count(int arc) const { return patches_[arc][1] == kNoPatch ? 1 : 2; }
    /// The slot in which `arc` borders `patch` (kNoPatch: has no patches); -1 if it does not.
    int slot_of(int arc, int patch) const {
        if (patches_[arc][0] == patch) return 0;
        return patch != kNoPatch && patches_[arc][1] == patch ? 1 : -1;
    }
    int patch(int arc, int slot) const { return patches_[arc][slot]; }
    double length(int arc) const { return lengths_[arc]; }

    const std::vector<ContinuationChain>& chains() const { return chains_; }
    int chain_of(int arc, int slot) const { return chain_of_[2 * arc + slot]; }
    int position_of(int arc, int slot) const { return position_of_[2 * arc + slot]; }

private:
    void link_ends();
    int straightest(int end, int patch, const std::vector<int>& at_node, int from, int to) const;
    /// The arc end that continues arc end `end` in slot `slot`; -1 = the extension stops.
    int next(int end, int slot) const { return next_[2 * end + slot]; }
    /// The same if the continuation is mutual.
    int mutual(int end, int slot) const;
    void build_chain(int arc, int slot);

    const FeatureCurveNetwork& network_;
    double min_cosine_;
    std::vector<double> lengths_;
    std::vector<std::array<int, 2>> patches_;
    std::vector<Vec3> tangents_;  ///< per arc end, unit, out of the node
    std::vector<int> next_;       ///< per arc end and slot
    std::vector<ContinuationChain> chains_;
    std::vector<int> chain_of_;     ///< per slot
    std::vector<int> position_of_;  ///< per slot
};

}  // namespace fcn
