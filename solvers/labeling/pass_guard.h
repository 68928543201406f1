#pragma once

#include <cstdint>

#include "labeling/run_control.h"

namespace labeling {

/// Thrown out of a pass; never leaves a solver.
struct StoppedInPass {};

/// For passes over a whole problem, which cannot return half of what they make: looks at clock and
/// stop token once in a while and throws StoppedInPass when the run is over. Counts no work.
class PassGuard {
public:
    /// Never throws.
    PassGuard() = default;
    explicit PassGuard(RunControl& control) : control_(&control) {}

    /// After so many adjacency entries.
    void step(std::int64_t entries) {
        left_ -= entries;
        if (left_ > 0) return;
        left_ = kEntriesPerLook;
        if (control_ == nullptr) return;
        control_->check();
        if (control_->is_over()) throw StoppedInPass();
    }
    /// At once.
    void look() { step(left_); }

private:
    static constexpr std::int64_t kEntriesPerLook = 300'000;
    RunControl* control_ = nullptr;
    std::int64_t left_ = kEntriesPerLook;
};

}  // namespace labeling
