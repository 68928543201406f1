// Changes of frame by quarter turns and translations that have names, not values: a translation's
// coefficient is a Gaussian integer, for turning is multiplication by i.
#include "meshing/symbolic_transition.h"

namespace fcn {
namespace {

std::array<int, 2> turned_coefficient(const std::array<int, 2>& c, int turns) {
    switch (turns & 3) {
        case 0:
            return c;
        case 1:
            return {-c[1], c[0]};
        case 2:
            return {-c[0], -c[1]};
        default:
            return {c[1], -c[0]};
    }
}

}  // namespace

Vec2 SymbolicTransition::apply(const Vec2& point, const std::vector<Vec2>& translations) const {
    Vec2 result = turned(point, turns);
    for (const Term& term : terms) {
        const Vec2& t = translations[static_cast<std::size_t>(term.chain)];
        result += term.coefficient[0] * t + term.coefficient[1] * turned(t, 1);
    }
    return result;
}

SymbolicTransition composed(const SymbolicTransition& outer, const SymbolicTransition& inner) {
    SymbolicTransition result;
    result.turns = (outer.turns + inner.turns) & 3;
    std::size_t i = 0, j = 0;
    while (i < outer.terms.size() || j < inner.terms.size()) {
        SymbolicTransition::Term term;
        const bool takes_outer =
            i < outer.terms.size() &&
            (j == inner.terms.size() || outer.terms[i].chain <= inner.terms[j].chain);
        const bool takes_inner =
            j < inner.terms.size() &&
            (i == outer.terms.size() || inner.terms[j].chain <= outer.terms[i].chain);
        if (takes_outer) term = outer.terms[i++];
        if (takes_inner) {
            const auto c = turned_coefficient(inner.terms[j].coefficient, outer.turns);
            term.chain = inner.terms[j++].chain;
            term.coefficient[0] += c[0];
            term.coefficient[1] += c[1];
        }
        if (term.coefficient[0] != 0 || term.coefficient[1] != 0) result.terms.push_back(term);
    }
    return result;
}

SymbolicTransition inverse(const SymbolicTransition& transition) {
    SymbolicTransition result;
    result.turns = (4 - transition.turns) & 3;
    for (const auto& term : transition.terms) {
        const auto c = turned_coefficient(term.coefficient, result.turns);
        result.terms.push_back({term.chain, {-c[0], -c[1]}});
    }
    return result;
}

}  // namespace fcn
