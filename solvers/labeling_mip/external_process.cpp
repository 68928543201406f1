// A program in a child process that can be ended whatever it does. It leads a process group of its
// own, so that one signal reaches it and everything it started; it gets SIGTERM, a grace, then
// SIGKILL; and when its leader has ended, what is left of the group is killed too. Between fork and
// exec only calls are made that are safe while other threads hold locks: all words and paths are
// laid out before. Why exec failed comes back through a pipe that a successful exec closes.
//
// The leader is not reaped before its group has been killed: until then its number, and so the
// group's, cannot be given to another process.
#include "labeling_mip/external_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>

#include "labeling/errors.h"

namespace labeling {
namespace {

constexpr int kPatienceMilliseconds = 10;
constexpr int kMostWaitsForGroup = 300;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

bool is_executable(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

void limit(decltype(RLIMIT_AS) what, std::int64_t bytes) {
    if (bytes <= 0) return;
    const rlimit bound{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
    ::setrlimit(what, &bound);
}

/// What the child needs, laid out before the fork.
struct Launch {
    std::string program, folder, output, error;
    std::vector<char*> words;
    std::int64_t memory_bytes = 0, file_bytes = 0;
    pid_t parent = 0;
    int signal_when_alone = SIGKILL;
    int gate = -1;  ///< end of a pipe; the child waits until it closes
};

[[noreturn]] void fail(int pipe) {
    const int reason = errno;
    [[maybe_unused]] const ssize_t written = ::write(pipe, &reason, sizeof reason);
    ::_exit(127);
}

/// In the child: never returns.
[[noreturn]] void launch(const Launch& l, int pipe) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, l.signal_when_alone);
    if (::getppid() != l.parent) ::_exit(127);
    char nothing = 0;
    while (l.gate >= 0 && ::read(l.gate, &nothing, 1) < 0 && errno == EINTR) {
    }
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    for (int s : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD, SIGXFSZ}) ::signal(s, SIG_DFL);
    const int in = ::open("/dev/null", O_RDONLY);
    const int out = ::open(l.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err = ::open(l.error.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (in < 0 || out < 0 || err < 0 || ::chdir(l.folder.c_str()) != 0) fail(pipe);
    ::dup2(in, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    limit(RLIMIT_AS, l.memory_bytes);
    limit(RLIMIT_FSIZE, l.file_bytes);
    limit(RLIMIT_CORE, 0);
    ::execv(l.program.c_str(), l.words.data());
    fail(pipe);
}

/// True when the leader has ended; it stays to be reaped.
bool has_ended(pid_t child) {
    siginfo_t info{};
    while (::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0) {
        if (errno != EINTR) return true;
    }
    return info.si_pid == child;
}

/// Waits for the leader; ends it when told to. True: we ended it; `is_killed`: by SIGKILL.
bool wait_for(pid_t child, const ProgramRun& run, bool& is_killed) {
    double deadline = 0;
    bool is_ended_by_us = false;
    while (!has_ended(child)) {
        if (!is_ended_by_us && run.has_to_end && run.has_to_end()) {
            is_ended_by_us = true;
            deadline = now() + run.grace_seconds;
            ::kill(-child, SIGTERM);
        }
        if (is_ended_by_us && !is_killed && now() >= deadline) {
            is_killed = true;
            ::kill(-child, SIGKILL);
        }
        ::poll(nullptr, 0, kPatienceMilliseconds);
    }
    return is_ended_by_us;
}

void reap(pid_t child, ProgramOutcome& outcome) {
    int status = 0;
    rusage usage{};
    while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status)) {
        outcome.signal = WTERMSIG(status);
    } else if (WIFEXITED(status)) {
        outcome.exit_code = WEXITSTATUS(status);
    }
    outcome.processor_seconds =
        static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
        1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    outcome.system_seconds = static_cast<double>(usage.ru_stime.tv_sec) +
                             1e-6 * static_cast<double>(usage.ru_stime.tv_usec);
    outcome.memory_mib = static_cast<double>(usage.ru_maxrss) / 1024;
}

/// SIGKILL is not immediate, and those who lost their parent are reaped by someone else: waits
/// until the group is empty, but not for ever.
void await_group(pid_t group) {
    for (int k = 0; k < kMostWaitsForGroup && ::kill(-group, 0) == 0; ++k) ::poll(nullptr, 0, 1);
}

ProgramOutcome refused(ProgramEnd end, std::string message) {
    ProgramOutcome outcome;
    outcome.end = end;
    outcome.message = std::move(message);
    return outcome;
}

}  // namespace

std::filesystem::path find_program(const std::string& name) {
    if (name.empty()) return {};
    if (name.find('/') != std::string::npos) {
        return is_executable(name) ? std::filesystem::absolute(name) : std::filesystem::path();
    }
    const char* path = std::getenv("PATH");
    const std::string folders = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
    for (std::size_t from = 0; from <= folders.size();) {
        const std::size_t to = std::min(folders.find(':', from), folders.size());
        const auto file = std::filesystem::path(folders.substr(from, to - from)) / name;
        if (to > from && is_executable(file)) return std::filesystem::absolute(file);
        from = to + 1;
    }
    return {};
}

ProgramOutcome run_program(const ProgramRun& run) {
    const auto program = run.words.empty() ? std::filesystem::path() : find_program(run.words[0]);
    if (program.empty()) return refused(ProgramEnd::NotFound, "no such program");
    std::vector<std::string> words = run.words;
    Launch start{program.string(),
                 run.folder.string(),
                 run.output_file.string(),
                 run.error_file.string(),
                 {},
                 run.memory_bytes,
                 run.file_bytes,
                 ::getpid(),
                 run.signal_when_alone,
                 -1};
    for (std::string& word : words) start.words.push_back(word.data());
    start.words.push_back(nullptr);

    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) {
        return refused(ProgramEnd::NotStarted, std::strerror(errno));
    }
    int gate[2] = {-1, -1};
    if (run.before_start && ::pipe2(gate, O_CLOEXEC) != 0) {
        const int reason = errno;
        for (int end : ends) ::close(end);
        return refused(ProgramEnd::NotStarted, std::strerror(reason));
    }
    start.gate = gate[0];
    double begin = now();
    const pid_t child = ::fork();
    if (child == 0) {
        if (gate[1] >= 0) ::close(gate[1]);
        launch(start, ends[1]);
    }
    const int fork_error = errno;
    if (run.before_start) {
        if (child > 0) run.before_start(child);
        for (int end : gate) ::close(end);
        begin = now();
    }
    ::close(ends[1]);
    if (child < 0) {
        ::close(ends[0]);
        return refused(ProgramEnd::NotStarted, std::strerror(fork_error));
    }
    ::setpgid(child, child);  // whoever comes first: the group exists before it is signalled
    int reason = 0;
    ssize_t size = 0;
    while ((size = ::read(ends[0], &reason, sizeof reason)) < 0 && errno == EINTR) {
    }
    ::close(ends[0]);

    ProgramOutcome outcome;
    bool is_killed = false;
    const bool is_ended_by_us = wait_for(child, run, is_killed);
    ::kill(-child, SIGKILL);
    reap(child, outcome);
    await_group(child);
    outcome.seconds = now() - begin;
    if (size == sizeof reason) {
        return refused(ProgramEnd::NotStarted, std::strerror(reason));
    }
    outcome.end = is_killed             ? ProgramEnd::Killed
                  : is_ended_by_us      ? ProgramEnd::Stopped
                  : outcome.signal != 0 ? ProgramEnd::Crashed
                                        : ProgramEnd::Exited;
    return outcome;
}

ScratchFolder::ScratchFolder() {
    std::error_code error;
    auto parent = std::filesystem::temp_directory_path(error);
    if (error) parent = "/tmp";
    std::string name = (parent / "labeling-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        throw InputError(name + ": cannot make a folder: " + std::strerror(errno));
    }
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace labeling
