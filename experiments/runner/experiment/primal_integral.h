#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "experiment/record.h"

namespace experiment {

/// Of a value to the best one: (best - value) / max(1, |best|), at least 0 and at most 1; 1 without
/// a value.
double primal_gap(std::optional<std::int64_t> value, std::int64_t best);

/// Gap at each time of a run: 1 from 0 on, then down with each better value.
struct GapStep {
    double seconds = 0;
    double gap = 1;
};

/// Of a trace, times cut off at `limit_seconds`; what comes later is not there. `end_value`, the
/// checked value at the end, is reached at `end_seconds` if the trace never reaches it, and values
/// of the trace beyond it are not believed.
std::vector<GapStep> gap_steps(const std::vector<TracePoint>& trace,
                               std::optional<std::int64_t> end_value, double end_seconds,
                               std::int64_t best, double limit_seconds);

/// Area under the gap from 0 to `limit_seconds`, in seconds: gap 1 until the first solution.
double primal_integral(const std::vector<GapStep>& steps, double limit_seconds);

/// First time at which the gap is at most `target`; nothing when never.
std::optional<double> time_to_gap(const std::vector<GapStep>& steps, double target);

}  // namespace experiment
