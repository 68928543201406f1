#include "experiment/instructions.h"

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace experiment {

InstructionCounter::~InstructionCounter() {
    if (file_ >= 0) ::close(file_);
}

void InstructionCounter::watch(pid_t process) {
    perf_event_attr what{};
    what.type = PERF_TYPE_HARDWARE;
    what.size = sizeof what;
    what.config = PERF_COUNT_HW_INSTRUCTIONS;
    what.disabled = 1;
    what.enable_on_exec = 1;
    what.inherit = 1;
    what.exclude_kernel = 1;
    what.exclude_hv = 1;
    what.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    file_ = static_cast<int>(::syscall(SYS_perf_event_open, &what, process, -1, -1, 0));
}

std::optional<std::int64_t> InstructionCounter::count() const {
    struct {
        std::uint64_t value, enabled, running;
    } answer{};
    if (file_ < 0 || ::read(file_, &answer, sizeof answer) != sizeof answer) return std::nullopt;
    // A counter that was shared with others counted only part of the time: no exact number.
    if (answer.running == 0 || answer.running < answer.enabled) return std::nullopt;
    return static_cast<std::int64_t>(answer.value);
}

}  // namespace experiment
