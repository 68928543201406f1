#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>

namespace experiment {

/// Counts the instructions that a process, and what it starts, executes in user mode, by the
/// kernel's performance counters. Counts are far more repeatable than times. Where the kernel does
/// not allow it (containers, virtual machines, perf_event_paranoid above 2) there is no count.
class InstructionCounter {
public:
    InstructionCounter() = default;
    ~InstructionCounter();
    InstructionCounter(const InstructionCounter&) = delete;
    InstructionCounter& operator=(const InstructionCounter&) = delete;

    /// Before the process executes its program.
    void watch(pid_t process);
    /// After it has ended.
    std::optional<std::int64_t> count() const;

private:
    int file_ = -1;
};

}  // namespace experiment
