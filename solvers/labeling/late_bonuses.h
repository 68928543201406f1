#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"
#include "labeling/relaxation.h"
#include "labeling/run_control.h"
#include "labeling/term_graph.h"

namespace labeling {

/// Small bonuses stay out of a relaxation until their absence raises its bound.
class LateBonuses {
public:
    /// Leaves the smallest bonuses out where there are `many` per label or more. Before any row.
    void leave_out(const LabelingProblem& problem, Relaxation& relaxation, std::int64_t many);

    /// Brings in those whose absence matters most at the present solution, with their links, until
    /// the others raise the bound by a small part of `gap` only; returns how many.
    std::size_t bring_in(const LabelingProblem& problem, const TermGraph& graph, double gap,
                         Relaxation& relaxation, RunControl& control);

    std::size_t size() const { return left_out_.size(); }

private:
    std::vector<std::int32_t> left_out_;  ///< by falling value
};

}  // namespace labeling
