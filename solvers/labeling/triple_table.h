#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"
#include "labeling/rows.h"

namespace labeling {

/// Rules "at most two of three labels", looked up by two of their labels.
class TripleTable {
public:
    struct Triple {
        Label labels[3];
    };

    explicit TripleTable(const RowSystem& rows);

    const std::vector<Triple>& triples() const { return triples_; }
    /// Labels that such a rule switches off once a and b are on, ascending.
    std::span<const Label> thirds(Label a, Label b) const;

private:
    std::size_t slot(std::uint64_t key) const;

    struct Pair {
        std::uint64_t key;
        std::uint32_t begin, end;  ///< in thirds_
    };
    std::vector<Triple> triples_;
    std::vector<Pair> pairs_;
    std::vector<Label> thirds_;
    std::vector<std::uint32_t> slots_;  ///< hash table: index in pairs_ plus 1, 0 where empty
};

}  // namespace labeling
