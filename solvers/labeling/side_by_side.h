#pragma once

#include <cstddef>
#include <functional>

#include "labeling/run_control.h"

namespace labeling {

/// Says whether the run has to end; may be called from the thread of its task.
using StopQuestion = std::function<bool()>;

/// Runs task(k, is_stopped) for k = 0 .. count - 1: one after the other, or on up to `threads`
/// threads while the calling one watches clock and stop token. A task may touch nothing that
/// another one changes, and not `control`. Rethrows what a task throws.
void run_side_by_side(std::size_t count, int threads, RunControl& control,
                      const std::function<void(std::size_t, const StopQuestion&)>& task);

}  // namespace labeling
