#include "labeling/run_control.h"

#include <charconv>
#include <chrono>
#include <cmath>

#include "labeling/errors.h"

namespace labeling {
namespace {

const SolveOptions& no_options() {
    static const SolveOptions options;
    return options;
}

}  // namespace

RunControl::RunControl(const SolveOptions& options, std::optional<std::int64_t> default_work_limit)
    : options_(options) {
    const auto limit = options.work_limit ? options.work_limit : default_work_limit;
    limit_ = limit.value_or(std::numeric_limits<std::int64_t>::max());
    cap_ = limit_;
    start_ = now();
    check();
}

RunControl::RunControl(std::int64_t ticks, std::function<bool()> is_stopped)
    : options_(no_options()), is_stopped_(std::move(is_stopped)), limit_(ticks), cap_(ticks) {
    start_ = now();
    check();
}

double RunControl::now() const {
    if (options_.clock) return options_.clock();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double RunControl::seconds() const { return now() - start_; }

double RunControl::seconds_left() const {
    if (!options_.time_limit) return std::numeric_limits<double>::infinity();
    return std::max(0.0, options_.time_limit->count() - seconds());
}

void RunControl::check() {
    next_check_ = std::min(limit_, work_ + kTicksPerClockRead);
    if (next_check_ <= work_) next_check_ = std::numeric_limits<std::int64_t>::max();
    if (is_stopped_ ? is_stopped_() : options_.stop.stop_requested()) {
        end(StopReason::Interrupted);
    } else if (options_.time_limit && seconds() >= options_.time_limit->count()) {
        end(StopReason::TimeLimit);
    } else if (work_ >= limit_) {
        end(StopReason::WorkLimit);
    }
}

std::int64_t RunControl::ticks_left() const {
    constexpr double kTicksPerSecond = 1e7;
    const double by_clock = kTicksPerSecond * seconds_left();
    const std::int64_t by_work = work_left();
    return by_clock < static_cast<double>(by_work) ? static_cast<std::int64_t>(by_clock) : by_work;
}

void RunControl::end(StopReason reason) {
    if (is_over_) return;
    is_over_ = true;
    reason_ = reason;
}

void RunControl::report(std::optional<Value> value, std::optional<Value> bound) {
    bool is_news = false;
    if (value && (!best_value_ || *value > *best_value_)) {
        best_value_ = value;
        is_news = true;
    }
    if (bound && (!best_bound_ || *bound < *best_bound_)) {
        best_bound_ = bound;
        is_news = true;
    }
    if (!is_news) return;
    trace_.push_back({seconds(), work_, best_value_, best_bound_});
    if (options_.on_improvement) options_.on_improvement(trace_.back());
    if (options_.relative_gap > 0 && best_value_ && best_bound_ && *best_bound_ > *best_value_) {
        const double gap = static_cast<double>(*best_bound_ - *best_value_);
        const double scale = std::max(1.0, std::abs(static_cast<double>(*best_value_)));
        if (gap <= options_.relative_gap * scale) end(StopReason::GapReached);
    }
}

void RunControl::fill(SolveResult& result) const {
    result.work = work_;
    result.seconds = seconds();
    result.trace = trace_;
    result.stop_reason = reason_;
}

void require_known_extras(const SolveOptions& options, std::string_view solver,
                          std::initializer_list<std::string_view> known) {
    for (const auto& [key, value] : options.extra) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        std::string names;
        for (std::string_view k : known) names += (names.empty() ? "" : ", ") + std::string(k);
        throw InputError("solver " + std::string(solver) + " has no option '" + key +
                         "'; known: " + (names.empty() ? "none" : names));
    }
}

std::int64_t extra_integer(const SolveOptions& options, std::string_view key, std::int64_t fallback,
                           std::int64_t low, std::int64_t high) {
    const auto it = options.extra.find(std::string(key));
    if (it == options.extra.end()) return fallback;
    std::int64_t number = 0;
    const std::string& text = it->second;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < low || number > high) {
        throw InputError("option " + std::string(key) + ": '" + text +
                         "' is not an integer between " + std::to_string(low) + " and " +
                         std::to_string(high));
    }
    return number;
}

bool extra_switch(const SolveOptions& options, std::string_view key, bool fallback) {
    const auto it = options.extra.find(std::string(key));
    if (it == options.extra.end()) return fallback;
    if (it->second != "on" && it->second != "off") {
        throw InputError("option " + it->first + ": '" + it->second + "' is not on or off");
    }
    return it->second == "on";
}

void require_valid_options(const LabelingProblem& problem, const SolveOptions& options) {
    const auto& start = options.warm_start;
    if (!start.empty() && start.size() != static_cast<std::size_t>(problem.label_count())) {
        throw InputError("the warm start has " + std::to_string(start.size()) +
                         " labels, the problem " + std::to_string(problem.label_count()));
    }
    for (std::size_t i = 0; i < start.size(); ++i) {
        if (start[i] < -1 || start[i] > 1) {
            throw InputError("warm start: label " + std::to_string(i + 1) + " has the value " +
                             std::to_string(start[i]) + ", expected -1, 0 or 1");
        }
    }
    if (options.time_limit && !(options.time_limit->count() >= 0)) {
        throw InputError("the time limit must not be negative");
    }
    if (options.work_limit && *options.work_limit < 0) {
        throw InputError("the work limit must not be negative");
    }
    if (!(options.relative_gap >= 0)) throw InputError("the relative gap must not be negative");
    if (options.threads < 1) throw InputError("the number of threads must be at least 1");
}

SolveResult finish(const LabelingProblem& problem, std::string_view solver,
                   const RunControl& control, std::optional<Solution> solution,
                   std::optional<Value> bound, bool is_infeasible) {
    SolveResult result;
    result.solver = solver;
    control.fill(result);
    if (solution) {
        const SolutionCheck check = check_solution(problem, *solution);
        if (!check.message.empty()) {
            throw LogicError(std::string(solver) + " gave a wrong answer: " + check.message);
        }
        if (is_infeasible || (bound && *bound < check.value)) {
            throw LogicError(std::string(solver) + ": the bound contradicts the solution");
        }
        const bool is_optimal = bound && *bound == check.value;
        result.status = is_optimal ? SolveStatus::Optimal : SolveStatus::Feasible;
        if (is_optimal) result.stop_reason = StopReason::Finished;
        result.solution = std::move(solution);
        result.bound = bound;
    } else if (is_infeasible) {
        result.status = SolveStatus::Infeasible;
        result.stop_reason = StopReason::Finished;
    } else {
        result.status = SolveStatus::NoSolution;
        result.bound = bound;
    }
    return result;
}

}  // namespace labeling
