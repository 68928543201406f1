#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace experiment {

/// How a run ended, in the runner's judgement.
enum class Outcome {
    Optimal,        ///< labels checked; the solver says that nothing is better
    Feasible,       ///< labels checked
    Infeasible,     ///< the solver says that there is no solution
    NoSolution,     ///< it ended in time, without labels
    NotApplicable,  ///< it cannot take this problem
    Missing,        ///< it is not installed
    Timeout,        ///< ended from outside, over its time
    OutOfMemory,    ///< ended from outside or by its own failed allocation
    DiskFull,       ///< wrote more than it may
    Crash,          ///< died of a signal or an unexpected exit code
    Wrong,          ///< infeasible labels, a wrong value, or a claim that is refuted
};

std::string to_string(Outcome outcome);
/// Throws InputError on an unknown word.
Outcome outcome_from(const std::string& text);
/// Has labels that passed the check.
bool is_solved(Outcome outcome);

/// Best value and bound at a time, by the solver's own clock.
struct TracePoint {
    double seconds = 0;
    std::int64_t work = 0;
    std::optional<std::int64_t> value, bound;
};

/// What the operating system says of the run's processes.
struct Measures {
    double wall_seconds = 0;                   ///< by a clock that does not jump
    double user_seconds = 0;                   ///< of the process and all that it waited for
    double system_seconds = 0;                 ///< the same
    double peak_mib = 0;                       ///< resident memory, of the largest process
    std::optional<std::int64_t> instructions;  ///< in user mode, where the kernel lets us count
    double load = 0;                           ///< of the machine over the last minute, at start
    int processor = -1;                        ///< the one it was pinned to; -1: none
    int exit_code = 0;
    int signal = 0;
    std::string started_at;  ///< UTC, for people; nothing is computed from it
};

/// One run: what was asked, what came of it, and where. Times are seconds, values and bounds the
/// problem's integer units.
struct Record {
    std::string key;  ///< of the job
    Outcome outcome = Outcome::Crash;
    std::string status, stop_reason;    ///< as the solver says
    std::string message;                ///< one line, may be empty
    std::optional<std::int64_t> value;  ///< recomputed by the runner
    std::optional<std::int64_t> bound;  ///< as claimed
    std::int64_t work = 0;
    double solver_seconds = 0;  ///< the solver's own clock
    std::map<std::string, double> statistics;
    std::vector<TracePoint> trace;
    Measures measures;
    std::string command;
    nlohmann::json provenance;
};

nlohmann::json to_json(const Record& record);
/// Throws InputError that names what is missing or of the wrong kind.
Record record_from(const nlohmann::json& json, const std::string& source);

}  // namespace experiment
