#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"
#include "labeling/rows.h"

namespace labeling {

/// Splits the difference of two labelings into parts that no conflict, bonus or rule joins, so that
/// each part can be taken from either labeling. Costs the adjacency of the labels that differ.
class DifferenceParts {
public:
    DifferenceParts(const LabelingProblem& problem, const RowSystem& rows);

    /// Labels among `candidates` in which a and b differ, grouped; order follows `candidates`.
    /// Labels outside of `candidates` must not differ.
    std::vector<std::vector<Label>> split(std::span<const Label> candidates,
                                          std::span<const std::uint8_t> a,
                                          std::span<const std::uint8_t> b);

private:
    Label find(Label i);
    void join(Label i, Label j);

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    std::vector<Label> parent_, row_mark_;
    std::vector<std::int32_t> part_of_;
    std::vector<std::uint8_t> is_different_;
};

}  // namespace labeling
