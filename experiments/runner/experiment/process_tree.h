#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace experiment {

/// From now on, processes below this one that lose their parent become its children, also those
/// that moved to a session of their own. Linux.
void adopt_orphans();

/// All processes below `root`, by /proc; `root` itself is not among them.
std::vector<pid_t> descendants(pid_t root);

/// Resident memory of these processes together, in MiB; pages they share count once for each.
double resident_mib(const std::vector<pid_t>& processes);

/// Kills everything below this process and reaps it. Gives up after a second, since a process that
/// waits in the kernel cannot be killed; returns how many are left.
int kill_descendants();

/// Ends every process that was started with a TMPDIR below `folder`, which is how a run's processes
/// are known when what watched over them is gone. Those of other users stay.
void kill_processes_of(const std::filesystem::path& folder);

}  // namespace experiment
