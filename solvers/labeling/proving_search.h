#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

#include "labeling/linear_model.h"
#include "labeling/lp_engine.h"
#include "labeling/solution.h"

namespace labeling {

struct ProofOptions {
    std::optional<std::int64_t> node_limit;
    std::size_t most_bytes = std::size_t{1} << 30;  ///< of the proof; more is given up
    std::stop_token stop;
};

struct ProofResult {
    /// VeriPB proof against format_problem(problem, Opb); empty when a limit or a stop ended it.
    std::string proof;
    std::optional<Solution> solution;  ///< optimal; nullopt: the problem is proven infeasible
    std::int64_t nodes = 0;
    bool is_complete = false;
};

/// Proves `known` optimal, or finds and proves better; without it, finds an optimum or proves that
/// there is no solution. The proof is checked by nobody here: see check_proof, or VeriPB.
ProofResult prove_optimality(const LabelingProblem& problem, const std::optional<Solution>& known,
                             const LpFactory& lp, const ProofOptions& options = {});

}  // namespace labeling
