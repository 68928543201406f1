#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace labeling {

struct ProofCheck {
    bool is_valid = false;
    std::string message;  ///< "line 12: ..." of what is wrong; empty when valid
    /// Of the minimised OPB objective. Both empty in a valid proof: there is no solution.
    std::optional<std::int64_t> lower, upper;
};

/// Checks a proof in VeriPB's format 2.0 against the OPB text it is about. Knows the steps `f`,
/// `soli` (all variables given), `pol` with + * d s and literals, `rup`, `del id`, `output NONE`,
/// `conclusion BOUNDS` (INF INF: infeasible); rejects all others. Shares no code with any search,
/// nor with the readers of labeling problems. Arithmetic is exact: numbers beyond 2^100 are
/// refused. Never throws on bad text.
ProofCheck check_proof(std::string_view opb, std::string_view proof);

}  // namespace labeling
