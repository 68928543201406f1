// Rules of three labels, by pairs of them: a sorted list of third labels per pair, found through a
// hash table with open addressing, because the lookups are most of what separating takes.
#include "labeling/triple_table.h"

#include <algorithm>

namespace labeling {
namespace {

std::uint64_t key_of(Label a, Label b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) |
           static_cast<std::uint32_t>(std::max(a, b));
}

}  // namespace

TripleTable::TripleTable(const RowSystem& rows) {
    std::vector<std::pair<std::uint64_t, Label>> all;
    for (std::int32_t row = 0; row < rows.row_count(); ++row) {
        const auto terms = rows.terms(row);
        if (rows.right_hand_side(row) != 2 || terms.size() != 3) continue;
        const bool is_plain = std::all_of(terms.begin(), terms.end(),
                                          [](const Term& t) { return t.coefficient == 1; });
        if (!is_plain) continue;
        triples_.push_back({{terms[0].label, terms[1].label, terms[2].label}});
        for (std::size_t k = 0; k < 3; ++k) {
            all.emplace_back(key_of(terms[(k + 1) % 3].label, terms[(k + 2) % 3].label),
                             terms[k].label);
        }
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const auto& [key, third] : all) {
        const auto at = static_cast<std::uint32_t>(thirds_.size());
        if (pairs_.empty() || pairs_.back().key != key) pairs_.push_back({key, at, at});
        ++pairs_.back().end;
        thirds_.push_back(third);
    }
    std::size_t size = 16;
    while (size < 3 * pairs_.size()) size *= 2;
    slots_.assign(size, 0);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
        slots_[slot(pairs_[k].key)] = static_cast<std::uint32_t>(k) + 1;
    }
}

std::size_t TripleTable::slot(std::uint64_t key) const {
    std::size_t at = ((key * 0x9e3779b97f4a7c15ULL) >> 20) & (slots_.size() - 1);
    while (slots_[at] != 0 && pairs_[slots_[at] - 1].key != key)
        at = (at + 1) & (slots_.size() - 1);
    return at;
}

std::span<const Label> TripleTable::thirds(Label a, Label b) const {
    const std::uint32_t found = slots_[slot(key_of(a, b))];
    if (found == 0) return {};
    const Pair& pair = pairs_[found - 1];
    return {thirds_.data() + pair.begin, pair.end - pair.begin};
}

}  // namespace labeling
