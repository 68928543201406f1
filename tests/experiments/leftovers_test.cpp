// What is left of a run whose runner was killed or told to stop: nothing, also where the solver is
// a script and its work is done by a process below it.
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "campaign_support.h"
#include "experiment/process_tree.h"

namespace experiment::testing {
namespace {

/// Watches a process that may end at any time, and is not a child.
class Watched {
public:
    explicit Watched(pid_t process)
        : file_(static_cast<int>(::syscall(SYS_pidfd_open, process, 0))) {}
    ~Watched() {
        if (file_ >= 0) ::close(file_);
    }
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;

    bool ends_within(int milliseconds) const {
        if (file_ < 0) return true;  // it had ended before
        pollfd event{file_, POLLIN, 0};
        return ::poll(&event, 1, milliseconds) == 1;
    }

private:
    int file_;
};

constexpr int kPatience = 20000;  // milliseconds, of a machine that is busy

class Leftovers : public ::testing::Test {
protected:
    /// A campaign of one run: a script whose child does the work and ignores what it is told.
    void plan() {
        labeling::write_text_file(folder_.path() / "p.lab", "p labeling 1 0 0 0\nl 1 5\n");
        labeling::write_text_file(folder_.path() / "solver.sh",
                                  "sh -c 'trap \"\" TERM HUP INT; echo $$ > " + mark().string() +
                                      "; while :; do :; done'\n");
        labeling::write_text_file(folder_.path() / "c.toml",
                                  "name = \"left\"\n[limits]\ntime = 60\n[[problems]]\n"
                                  "files = \"p.lab\"\n[[solvers]]\nname = \"script\"\n"
                                  "program = \"sh " +
                                      (folder_.path() / "solver.sh").string() + " {problem}\"\n");
        ASSERT_EQ(
            run_experiment(folder_.path(), {"plan", "c.toml", "-o", "out", "-q"}).outcome.exit_code,
            0);
    }
    fs::path mark() const { return folder_.path() / "pid"; }

    /// Makes the run until its work has begun, then ends the runner; SIGKILL without a grace.
    ProgramResult ended_at_work(double grace_seconds) {
        return run_experiment(folder_.path(), {"resume", "out"}, [&](labeling::ProgramRun& run) {
            run.grace_seconds = grace_seconds;
            run.has_to_end = [&] { return content(mark()).ends_with("\n"); };
        });
    }
    pid_t worker() const { return static_cast<pid_t>(std::atol(content(mark()).c_str())); }

    labeling::ScratchFolder folder_;
};

TEST_F(Leftovers, NothingWhenTheRunnerIsKilled) {
    plan();
    EXPECT_EQ(ended_at_work(0).outcome.end, labeling::ProgramEnd::Killed);
    ASSERT_GT(worker(), 1);
    EXPECT_TRUE(Watched(worker()).ends_within(kPatience)) << worker();
    EXPECT_TRUE(Database(folder_.path() / "out").records().empty());
}

TEST_F(Leftovers, NothingWhenTheRunnerIsToldToStop) {
    plan();
    const auto result = ended_at_work(kPatience / 1000.0);
    EXPECT_EQ(result.outcome.exit_code, 4) << result.errors;
    ASSERT_GT(worker(), 1);
    EXPECT_TRUE(Watched(worker()).ends_within(0)) << worker();
    EXPECT_TRUE(Database(folder_.path() / "out").records().empty());
}

/// A process that does nothing but ignore SIGTERM, with this TMPDIR.
pid_t idle_process(const fs::path& temporary) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    ::setenv("TMPDIR", temporary.c_str(), 1);
    ::signal(SIGTERM, SIG_IGN);
    ::execlp("tail", "tail", "-f", "/dev/null", nullptr);
    ::_exit(127);
}

TEST_F(Leftovers, AreKnownByTheirEnvironmentAndEndedBeforeTheNextRun) {
    const fs::path scratch = folder_.path() / "scratch";
    const pid_t inside = idle_process(scratch / "0123.host.1");
    const pid_t beside = idle_process(folder_.path() / "scratch2" / "0123.host.1");
    const Watched of_inside(inside), of_beside(beside);
    // Before it starts the other program a child has this process's environment.
    const fs::path same = folder_.path() / "." / "scratch2" / ".." / "scratch";
    while (!of_inside.ends_within(1)) kill_processes_of(same);
    EXPECT_FALSE(of_beside.ends_within(0));
    int status = 0;
    ASSERT_EQ(::waitpid(inside, &status, 0), inside);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
    ::kill(beside, SIGKILL);
    ::waitpid(beside, &status, 0);
}

}  // namespace
}  // namespace experiment::testing
