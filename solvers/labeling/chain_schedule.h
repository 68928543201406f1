#pragma once

#include <cstdint>
#include <vector>

#include "labeling/random.h"

namespace labeling {

/// Kinds of annealing, of which the search learns which pays at the moment.
struct ChainKind {
    bool is_window = false;
    std::int64_t ticks = 25;  ///< per label of the problem or window
    double gain = 0, cost = 0;
    int used = 0;
};

/// Chooses the kind of the next round: mostly the one with the largest gain per tick of late,
/// otherwise any, short ones more often.
class ChainSchedule {
public:
    ChainSchedule(bool has_windows, bool is_adaptive);
    std::size_t choose(Random& random);
    const ChainKind& kind(std::size_t k) const { return kinds_[k]; }
    void credit(std::size_t k, double gain, double cost);

private:
    std::vector<ChainKind> kinds_;
    bool is_adaptive_;
};

}  // namespace labeling
