#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "labeling/problem.h"
#include "labeling/solution.h"

namespace labeling {

enum class SolveStatus { Optimal, Feasible, Infeasible, NoSolution };
enum class StopReason { Finished, TimeLimit, WorkLimit, GapReached, Interrupted, SolverFailed };

std::string_view to_string(SolveStatus status);
std::string_view to_string(StopReason reason);

/// A point of the anytime curve: best value and best bound so far.
struct TracePoint {
    double seconds = 0;
    std::int64_t work = 0;
    std::optional<Value> value;
    std::optional<Value> bound;
};

struct SolveOptions {
    /// Wall time; nullopt = none. Kept within 5% + 0.1 s.
    std::optional<std::chrono::duration<double>> time_limit;
    /// Deterministic work in solver ticks (about 10^7 a second); nullopt = the solver's default
    /// (exact solvers: none).
    std::optional<std::int64_t> work_limit;
    /// Stop when (bound - value) <= relative_gap * max(1, |value|).
    double relative_gap = 0;
    std::uint64_t seed = 1;
    int threads = 1;
    /// Full or partial start: one entry per label, 0, 1 or -1 (unknown); empty = none.
    std::vector<std::int8_t> warm_start;
    std::function<void(const TracePoint&)> on_improvement;
    std::stop_token stop;
    /// Seconds since an arbitrary origin; tests inject their own. Empty = steady clock.
    std::function<double()> clock;
    /// Solver-specific options by name; unknown ones throw InputError.
    std::map<std::string, std::string> extra;
};

struct SolveResult {
    SolveStatus status = SolveStatus::NoSolution;
    StopReason stop_reason = StopReason::Finished;
    std::optional<Solution> solution;
    /// Proven upper bound; nullopt when the solver proved none (heuristics never claim one).
    std::optional<Value> bound;
    std::string solver;   ///< name of the solver that produced it
    std::string message;  ///< one line of explanation, may be empty
    std::int64_t work = 0;
    double seconds = 0;
    std::map<std::string, double> statistics;
    std::vector<TracePoint> trace;

    /// (bound - value) / max(1, |value|); nullopt without both.
    std::optional<double> relative_gap() const;
};

/// A solver holds no state between calls; solve() may run on several threads at once.
class Solver {
public:
    virtual ~Solver() = default;
    virtual std::string name() const = 0;
    virtual std::string description() const = 0;
    virtual bool is_exact() const = 0;
    /// Every answer has passed check_solution before it is returned.
    virtual SolveResult solve(const LabelingProblem& problem,
                              const SolveOptions& options = {}) const = 0;
};

/// Solvers by name. The registry of this library holds greedy, local-search, lns, branch-and-bound
/// and auto; labeling_mip adds cbc.
class SolverRegistry {
public:
    void add(std::shared_ptr<const Solver> solver);
    /// Throws InputError that lists the known names.
    std::shared_ptr<const Solver> find(std::string_view name) const;
    std::vector<std::string> names() const;

private:
    std::map<std::string, std::shared_ptr<const Solver>, std::less<>> solvers_;
};

/// greedy, local-search, lns, branch-and-bound, auto.
SolverRegistry builtin_solvers();

}  // namespace labeling
