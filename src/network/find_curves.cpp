// The partition into curves takes, again and again, the longest run of a chain of mutual
// continuations whose arcs are all still free. So every curve is part of the boundary of one patch,
// as supporting curves are (Gehre, Lim, Kobbelt 2016, section 5.3.1), and each arc is in one curve.

#include <algorithm>
#include <queue>

#include "network/continuations.h"
#include "network/network.h"

namespace fcn {
namespace {

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
    const std::vector<ContinuationChain>& chains() const { return continuations_.chains(); }

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
        const ContinuationChain& chain = chains()[range.chain];
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

}  // namespace fcn
