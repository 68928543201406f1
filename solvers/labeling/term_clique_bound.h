#pragma once

#include <cstdint>
#include <vector>

#include "labeling/problem.h"
#include "labeling/propagation.h"
#include "labeling/run_control.h"

namespace labeling {

/// Upper bound from a clique cover of the term conflict graph (a node per label and per bonus).
class TermCliqueBound {
public:
    TermCliqueBound(const LabelingProblem& problem, RunControl& control);

    /// Bound on the value of any completion of the propagated assignment, what is decided included.
    /// Rules count only through what they have decided. Weaker once `control` is over. May stop
    /// early and return any number above `enough` once the bound exceeds it (pass the largest Value
    /// for the full bound).
    Value operator()(const Propagator& propagator, Value enough);

    /// Pair tests so far.
    std::int64_t work() const { return work_; }

private:
    struct TermNode {
        Value value;
        Label first, second;  ///< equal for a label's own term
    };

    bool labels_conflict(Label i, Label j) const;
    bool terms_conflict(const TermNode& a, const TermNode& b);

    const LabelingProblem& problem_;
    RunControl& control_;
    std::vector<std::uint64_t> matrix_;  ///< conflict bits, only for few labels
    std::size_t words_per_row_ = 0;
    std::vector<TermNode> terms_;
    std::vector<std::vector<TermNode>> cliques_;
    std::int64_t work_ = 0;
};

}  // namespace labeling
