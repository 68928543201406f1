#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace labeling {

/// A program to run, its limits, and where its output goes.
struct ProgramRun {
    std::vector<std::string> words;     ///< program (looked up in PATH) and its arguments
    std::filesystem::path folder;       ///< working folder
    std::filesystem::path output_file;  ///< standard output
    std::filesystem::path error_file;   ///< standard error
    std::int64_t memory_bytes = 0;      ///< address space of each process; 0 = no limit
    std::int64_t file_bytes = 0;        ///< largest file it may write; 0 = no limit
    double grace_seconds = 0.3;         ///< between SIGTERM and SIGKILL
    int signal_when_alone = 9;          ///< that it gets when its parent dies
    std::function<bool()> has_to_end;   ///< asked every 10 ms; true: stop the program
    /// Called with the process's number once it exists and before the program starts in it.
    std::function<void(int)> before_start;
};

enum class ProgramEnd {
    Exited,      ///< on its own; see exit_code
    Crashed,     ///< by a signal that was not ours; see signal
    Stopped,     ///< by us, it obeyed SIGTERM
    Killed,      ///< by us, with SIGKILL
    NotFound,    ///< no such program
    NotStarted,  ///< the system refused; see message
};

struct ProgramOutcome {
    ProgramEnd end = ProgramEnd::NotStarted;
    int exit_code = 0;
    int signal = 0;
    std::string message;           ///< why it did not start
    double seconds = 0;            ///< wall time
    double processor_seconds = 0;  ///< user and system, of the program and what it waited for
    double system_seconds = 0;     ///< the part of it spent in the kernel
    double memory_mib = 0;         ///< peak resident memory of the largest process
};

/// Runs a program in a process group of its own and waits for it. Whatever the program left running
/// in its group is killed before this returns; the program dies with its parent. Safe with threads.
/// It cannot reach processes that moved to another session.
ProgramOutcome run_program(const ProgramRun& run);

/// Full path of a program: as it is when it holds a slash, else by PATH; empty when there is none
/// that may be executed.
std::filesystem::path find_program(const std::string& name);

/// A new folder under the temporary folder, removed with all its content at the end.
class ScratchFolder {
public:
    /// Throws InputError when it cannot be made.
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace labeling
