// Elimination in mixed integer linear equations (Bommes, Zimmer, Kobbelt 2009, "Mixed-integer
// quadrangulation", section 4, eliminate constraints one after the other). Theirs picks a pivot of
// smallest coefficient and may lose integrality; here an equation between integers without a
// coefficient 1 is reduced by Euclid's steps, substitutions of determinant 1, so that the free
// integers span all integer solutions.
#include "meshing/integer_elimination.h"

#include <algorithm>
#include <cmath>

namespace fcn {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

IntegerElimination::IntegerElimination(const std::vector<bool>& is_integer)
    : original_count_(is_integer.size()),
      is_integer_(is_integer),
      is_replaced_(is_integer.size(), false),
      replacements_(is_integer.size()),
      sums_(is_integer.size(), 0) {}

const IntegerElimination::Expression& IntegerElimination::expanded(int unknown) {
    Expression& own = replacements_[at(unknown)];
    const bool is_stale = std::any_of(own.begin(), own.end(),
                                      [&](const Term& t) { return is_replaced_[at(t.unknown)]; });
    if (is_stale) {
        Expression terms = own;
        own = expanded(terms);
    }
    return replacements_[at(unknown)];
}

IntegerElimination::Expression IntegerElimination::expanded(const Expression& terms) {
    for (const Term& term : terms)
        if (is_replaced_[at(term.unknown)]) expanded(term.unknown);
    std::vector<int> touched;
    const auto add = [&](int unknown, double coefficient) {
        double& sum = sums_[at(unknown)];
        if (sum == 0) touched.push_back(unknown);
        sum += coefficient;
    };
    for (const Term& term : terms) {
        if (!is_replaced_[at(term.unknown)]) {
            add(term.unknown, term.coefficient);
            continue;
        }
        for (const Term& inner : replacements_[at(term.unknown)])
            add(inner.unknown, term.coefficient * inner.coefficient);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    Expression result;
    for (const int unknown : touched) {
        if (sums_[at(unknown)] != 0) result.push_back({unknown, sums_[at(unknown)]});
        sums_[at(unknown)] = 0;
    }
    return result;
}

void IntegerElimination::replace(int unknown, Expression expression) {
    is_replaced_[at(unknown)] = true;
    replacements_[at(unknown)] = std::move(expression);
}

void IntegerElimination::add(const std::vector<Term>& equation) {
    const Expression terms = expanded(equation);
    int pivot = -1;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        if (is_integer_[at(terms[i].unknown)]) continue;
        if (pivot < 0 || std::abs(terms[i].coefficient) <= std::abs(terms[at(pivot)].coefficient))
            pivot = static_cast<int>(i);
    }
    if (pivot < 0) {
        if (!terms.empty()) eliminate_integers(terms);
        return;
    }
    const Term gone = terms[at(pivot)];
    Expression rest;
    for (const Term& term : terms)
        if (term.unknown != gone.unknown)
            rest.push_back({term.unknown, -term.coefficient / gone.coefficient});
    replace(gone.unknown, std::move(rest));
}

void IntegerElimination::eliminate_integers(Expression equation) {
    for (;;) {
        std::size_t pivot = 0;
        for (std::size_t i = 0; i < equation.size(); ++i)
            if (std::abs(equation[i].coefficient) <= std::abs(equation[pivot].coefficient))
                pivot = i;
        // unknown = new unknown - sum of quotients, until the others' remainders vanish
        const Term gone = equation[pivot];
        Expression quotients, remainders;
        for (const Term& term : equation) {
            if (term.unknown == gone.unknown) continue;
            const double quotient = std::round(term.coefficient / gone.coefficient);
            if (quotient != 0) quotients.push_back({term.unknown, -quotient});
            const double remainder = term.coefficient - quotient * gone.coefficient;
            if (remainder != 0) remainders.push_back({term.unknown, remainder});
        }
        if (remainders.empty()) {
            replace(gone.unknown, std::move(quotients));
            return;
        }
        const int fresh = static_cast<int>(is_integer_.size());
        is_integer_.push_back(true);
        is_replaced_.push_back(false);
        replacements_.emplace_back();
        sums_.push_back(0);
        quotients.push_back({fresh, 1});
        replace(gone.unknown, std::move(quotients));
        remainders.push_back({fresh, gone.coefficient});
        equation = std::move(remainders);
    }
}

EliminatedUnknowns IntegerElimination::finish() {
    EliminatedUnknowns result;
    std::vector<int> column(is_integer_.size(), -1);
    for (std::size_t i = 0; i < is_integer_.size(); ++i) {
        if (is_replaced_[i]) continue;
        column[i] = static_cast<int>(result.is_integer.size());
        result.is_integer.push_back(is_integer_[i]);
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < original_count_; ++i) {
        const int row = static_cast<int>(i);
        if (!is_replaced_[i]) {
            entries.emplace_back(row, column[i], 1.0);
            continue;
        }
        for (const Term& term : expanded(row))
            entries.emplace_back(row, column[at(term.unknown)], term.coefficient);
    }
    result.basis.resize(static_cast<int>(original_count_),
                        static_cast<int>(result.is_integer.size()));
    result.basis.setFromTriplets(entries.begin(), entries.end());
    return result;
}

}  // namespace fcn
