#pragma once

#include <array>
#include <vector>

#include "meshing/corner_map.h"

namespace fcn {

/// x -> turned(x, turns) + sum of translations, each turned and weighted: a translation t of chain
/// c with coefficient (a, b) adds a t + b turned(t, 1). Changes of frame of a seamless map whatever
/// its translations are.
struct SymbolicTransition {
    struct Term {
        int chain = 0;
        std::array<int, 2> coefficient{};
    };
    int turns = 0;
    std::vector<Term> terms;  ///< by chain, no zeros

    Vec2 apply(const Vec2& point, const std::vector<Vec2>& translations) const;
};

/// First `inner`, then `outer`.
SymbolicTransition composed(const SymbolicTransition& outer, const SymbolicTransition& inner);
SymbolicTransition inverse(const SymbolicTransition& transition);

}  // namespace fcn
