#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string_view>

#include "labeling/solver.h"

namespace labeling {

/// Limits, clock, stop token and trace of one solve() call, shared by all parts of a solver.
/// Work is counted in ticks of about 100 ns and is the only thing that decides when no time limit
/// is set, so runs repeat exactly. The clock is read once per kTicksPerClockRead ticks.
class RunControl {
public:
    static constexpr std::int64_t kTicksPerClockRead = 20000;

    /// `default_work_limit` applies where the options give none.
    explicit RunControl(const SolveOptions& options,
                        std::optional<std::int64_t> default_work_limit = std::nullopt);
    /// For one of several lanes of a run: counts its own work, up to `ticks`, and asks `is_stopped`
    /// instead of clock and stop token.
    RunControl(std::int64_t ticks, std::function<bool()> is_stopped);

    /// Adds work; true when the caller has to stop (a part's cap or the end of the whole run).
    bool spend(std::int64_t ticks) {
        work_ += ticks;
        if (work_ >= next_check_) check();
        return is_over_ || work_ >= cap_;
    }
    /// True when the whole run has to end, not just a part of it.
    bool is_over() const { return is_over_; }
    /// True when the whole run or the current part has to end.
    bool should_stop() const { return is_over_ || work_ >= cap_; }
    /// Reads clock and stop token now.
    void check();
    /// Ends the run for the given reason unless it is over already.
    void end(StopReason reason);
    StopReason reason() const { return reason_; }

    std::int64_t work() const { return work_; }
    double seconds() const;
    /// Seconds left until the time limit; infinity without one.
    double seconds_left() const;
    /// Ticks left for the caller.
    std::int64_t work_left() const { return std::max<std::int64_t>(0, cap_ - work_); }
    /// The same, or less where the clock leaves less, at ten million ticks a second.
    std::int64_t ticks_left() const;

    /// Records an improvement of value or bound; ends the run when the gap is reached.
    void report(std::optional<Value> value, std::optional<Value> bound);
    std::optional<Value> best_value() const { return best_value_; }
    std::optional<Value> best_bound() const { return best_bound_; }
    /// Work, seconds, trace and stop reason into the result.
    void fill(SolveResult& result) const;

    /// While it lives, the parts it covers see at most `ticks` more work.
    class Cap {
    public:
        Cap(RunControl& control, std::int64_t ticks) : control_(control), previous_(control.cap_) {
            const std::int64_t room = std::numeric_limits<std::int64_t>::max() - control.work_;
            control.cap_ = std::min(control.cap_, control.work_ + std::min(ticks, room));
        }
        ~Cap() { control_.cap_ = previous_; }
        Cap(const Cap&) = delete;
        Cap& operator=(const Cap&) = delete;

    private:
        RunControl& control_;
        std::int64_t previous_;
    };

private:
    double now() const;

    const SolveOptions& options_;
    std::function<bool()> is_stopped_;
    double start_ = 0;
    std::int64_t work_ = 0;
    std::int64_t limit_;
    std::int64_t cap_;
    std::int64_t next_check_ = 0;
    bool is_over_ = false;
    StopReason reason_ = StopReason::Finished;
    std::optional<Value> best_value_, best_bound_;
    std::vector<TracePoint> trace_;
};

/// Throws InputError naming the first of options.extra that is not among `known`.
void require_known_extras(const SolveOptions& options, std::string_view solver,
                          std::initializer_list<std::string_view> known);

/// Integer value of an extra option, or `fallback`; throws InputError when it is not a number in
/// [low, high].
std::int64_t extra_integer(const SolveOptions& options, std::string_view key, std::int64_t fallback,
                           std::int64_t low, std::int64_t high);

/// Value of an extra option that is on or off, or `fallback`; throws InputError on another value.
bool extra_switch(const SolveOptions& options, std::string_view key, bool fallback);

/// Throws InputError when the warm start has the wrong length or an entry other than -1, 0, 1, or
/// a limit is negative or not a number.
void require_valid_options(const LabelingProblem& problem, const SolveOptions& options);

/// The only way out of a solver: checks the solution (if any) exactly, throws LogicError when it is
/// wrong or the bound lies below its value, and sets status, solver name, trace and limits.
/// `is_infeasible` says that the solver proved that no solution exists.
SolveResult finish(const LabelingProblem& problem, std::string_view solver,
                   const RunControl& control, std::optional<Solution> solution,
                   std::optional<Value> bound, bool is_infeasible = false);

}  // namespace labeling
