// Solvers that misbehave, each as a program of a campaign; what matters is what is recorded, and
// that nothing of them is left.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "campaign_support.h"
#include "experiment/best_solution.h"
#include "experiment/execute.h"
#include "experiment/process_tree.h"
#include "labeling/formats.h"
#include "labeling/generators.h"

namespace experiment::testing {
namespace {

constexpr const char* kProblem =
    "p labeling 3 1 1 0\n"
    "l 1 5\nl 2 4\nl 3 2\n"
    "x 1 2\n"
    "b 1 3 10\n";  // best: labels 1 and 3, 17

constexpr double kShort = 0.5;  // seconds

struct BadSolver {
    const char* name;
    const char* script;  ///< sh; $1 is the problem, $2 the solution, $3 the result
    Outcome outcome;
    const char* part_of_message;
    double seconds = 60;  ///< of time; few for those that never end by themselves
};

class BadDays : public ::testing::TestWithParam<BadSolver> {
protected:
    /// A campaign of one run.
    Record record_of(const std::string& script, double seconds = 60) {
        labeling::write_text_file(folder_.path() / "p.lab", kProblem);
        labeling::write_text_file(folder_.path() / "solver.sh", script);
        labeling::write_text_file(
            folder_.path() / "c.toml",
            "name = \"bad\"\n[limits]\ntime = " + std::to_string(seconds) +
                "\nmargin = 0.2\nmemory = \"200MiB\"\n"
                "disk = \"20MiB\"\n[[problems]]\nfiles = \"p.lab\"\n[[solvers]]\nname = \"bad\"\n"
                "program = \"sh " +
                (folder_.path() / "solver.sh").string() + " {problem} {solution} {result}\"\n");
        const auto result =
            run_experiment(folder_.path(), {"run", "c.toml", "-o", "out", "--no-pin"});
        EXPECT_EQ(result.outcome.exit_code, 0) << result.errors;
        const auto records = Database(folder_.path() / "out").records();
        EXPECT_EQ(records.size(), 1u);
        return records.empty() ? Record() : records[0];
    }
    labeling::ScratchFolder folder_;
};

TEST_P(BadDays, AreRecordedAsWhatTheyAre) {
    const Record record = record_of(GetParam().script, GetParam().seconds);
    EXPECT_EQ(to_string(record.outcome), to_string(GetParam().outcome)) << record.message;
    EXPECT_NE(record.message.find(GetParam().part_of_message), std::string::npos)
        << "message: " << record.message;
    EXPECT_FALSE(fs::exists(folder_.path() / "out" / "scratch"));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadDays,
    ::testing::Values(
        BadSolver{"good", "printf 'v 17\\n1\\n3\\n' > $2", Outcome::Feasible, ""},
        BadSolver{"proves", "printf 'v 17\\n1\\n3\\n' > $2; echo '{\"status\": \"optimal\"}' > $3",
                  Outcome::Optimal, ""},
        BadSolver{"infeasible_optimum",
                  "printf 'v 9\\n1\\n2\\n' > $2; echo '{\"status\": \"optimal\"}' > $3",
                  Outcome::Wrong, "wrong labels"},
        BadSolver{"wrong_value", "printf 'v 99\\n1\\n3\\n' > $2", Outcome::Wrong, "wrong labels"},
        BadSolver{"claims_more",
                  "printf 'v 17\\n1\\n3\\n' > $2; echo '{\"status\": \"feasible\", \"value\": 18}' "
                  "> $3",
                  Outcome::Wrong, "it claims the value 18"},
        BadSolver{"bound_below_value",
                  "printf 'v 17\\n1\\n3\\n' > $2; echo '{\"status\": \"feasible\", \"bound\": 16}' "
                  "> $3",
                  Outcome::Wrong, "bound is below"},
        BadSolver{"claims_without_labels", "echo '{\"status\": \"optimal\", \"value\": 17}' > $3",
                  Outcome::Wrong, "shows none"},
        BadSolver{"rubbish", "head -c 3000 /dev/urandom > $2", Outcome::Wrong, "unreadable"},
        BadSolver{"rubbish_result", "head -c 3000 /dev/urandom > $3; yes | head -n 100000",
                  Outcome::NoSolution, ""},
        BadSolver{"label_out_of_range", "printf 'v 17\\n1\\n4\\n' > $2", Outcome::Wrong,
                  "unreadable"},
        BadSolver{"nothing", "exit 0", Outcome::NoSolution, ""},
        BadSolver{"fails", "echo out of luck >&2; exit 9", Outcome::Crash, "out of luck"},
        BadSolver{"dies", "kill -SEGV $$", Outcome::Crash, "signal 11"},
        BadSolver{"kills_its_keeper", "kill -KILL $PPID; while :; do :; done", Outcome::Crash,
                  "watched over it died of signal 9"},
        BadSolver{"hangs", "while :; do :; done", Outcome::Timeout, "over its time", kShort},
        BadSolver{"ignores_sigterm", "trap '' TERM; while :; do :; done", Outcome::Timeout,
                  "did not end when asked", kShort},
        BadSolver{"answers_when_ended",
                  "trap \"printf 'v 17\\n1\\n3\\n' > $2; exit 0\" TERM; while :; do :; done",
                  Outcome::Timeout, "over its time", kShort},
        BadSolver{"allocates_without_end",
                  "exec python3 -c 'x=[]\nwhile True: x.append(bytearray(b\"1\")*10000000)'",
                  Outcome::OutOfMemory, "over its memory"},
        BadSolver{"children_allocate",
                  "for k in 1 2 3; do python3 -c 'import time\nx=bytearray(b\"1\")*100000000\n"
                  "while True: pass' & done; wait",
                  Outcome::OutOfMemory, "over its memory"},
        BadSolver{"fills_the_disk", "head -c 30000000 /dev/zero > $3.big; exit 0",
                  Outcome::DiskFull, "disk limit"},
        BadSolver{"fills_the_disk_in_pieces",
                  "for k in $(seq 60); do head -c 1000000 /dev/urandom > $3.$k; done",
                  Outcome::DiskFull, "disk limit"}),
    [](const auto& entry) { return std::string(entry.param.name); });

TEST_F(BadDays, NothingOfASolverThatDetachesIsLeft) {
    // The grandchild leaves session and process group, and ignores every signal it can.
    const std::string mark = (folder_.path() / "pid").string();
    const Record record = record_of("setsid sh -c 'trap \"\" TERM HUP INT; echo $$ > " + mark +
                                    "; while :; do :; done' &\nwhile [ ! -s " + mark +
                                    " ]; do :; done\nprintf 'v 17\\n1\\n3\\n' > $2\n");
    EXPECT_EQ(record.outcome, Outcome::Feasible) << record.message;
    const pid_t left = static_cast<pid_t>(std::atol(content(mark).c_str()));
    ASSERT_GT(left, 1);
    EXPECT_NE(::kill(left, 0), 0) << "process " << left << " still runs";
}

TEST_F(BadDays, AnswerOfASolverThatWasEndedIsKept) {
    const Record record = record_of(
        "trap \"printf 'v 17\\n1\\n3\\n' > $2; exit 0\" TERM; while :; do :; done", kShort);
    EXPECT_EQ(record.outcome, Outcome::Timeout);
    EXPECT_EQ(record.value, 17);
}

TEST_F(BadDays, AMissingProgramIsMissing) {
    labeling::write_text_file(folder_.path() / "p.lab", kProblem);
    labeling::write_text_file(
        folder_.path() / "c.toml",
        "name = \"bad\"\n[limits]\ntime = 1\n[[problems]]\nfiles = \"p.lab\"\n"
        "[[solvers]]\nname = \"none\"\nprogram = \"no-such-program-here\"\n");
    run_experiment(folder_.path(), {"run", "c.toml", "-o", "out"});
    const auto records = Database(folder_.path() / "out").records();
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].outcome, Outcome::Missing);
}

TEST_F(BadDays, ARenamedProblemIsAnsweredInItsOwnNames) {
    labeling::write_text_file(folder_.path() / "p.lab", kProblem);
    // Copies the weights' order: takes the label of weight 5 and its bonus partner, whatever they
    // are called now.
    labeling::write_text_file(
        folder_.path() / "solver.sh",
        "a=$(awk '$1==\"l\" && $3==5 {print $2}' $1); b=$(awk '$1==\"l\" && $3==2 {print $2}' $1)\n"
        "printf 'v 17\\n%s\\n%s\\n' $a $b > $2\n");
    labeling::write_text_file(
        folder_.path() / "c.toml",
        "name = \"renamed\"\nrenamings = [0, 1, 2, 3]\n[limits]\ntime = 5\n[[problems]]\n"
        "files = \"p.lab\"\n[[solvers]]\nname = \"x\"\nprogram = \"sh " +
            (folder_.path() / "solver.sh").string() + " {problem} {solution}\"\n");
    run_experiment(folder_.path(), {"run", "c.toml", "-o", "out"});
    const auto records = Database(folder_.path() / "out").records();
    ASSERT_EQ(records.size(), 4u);
    for (const Record& r : records) EXPECT_EQ(r.value, 17) << r.message;
}

TEST_F(BadDays, BestLabelsOfARenamedProblemAreKeptInTheOriginalsNames) {
    labeling::write_text_file(folder_.path() / "p.lab", kProblem);
    // Answers with the start that it was given.
    labeling::write_text_file(folder_.path() / "solver.sh", "cp $1 $2\n");
    labeling::write_text_file(folder_.path() / "c.toml",
                              "name = \"renamed\"\n[limits]\ntime = 60\n[[problems]]\n"
                              "files = \"p.lab\"\n[[solvers]]\nname = \"x\"\nrenamings = [3]\n"
                              "start = \"local-search\"\nprogram = \"sh " +
                                  (folder_.path() / "solver.sh").string() +
                                  " {start} {solution}\"\n");
    run_experiment(folder_.path(), {"run", "c.toml", "-o", "out"});
    const auto campaign = load_campaign(folder_.path() / "out");
    ASSERT_TRUE(campaign.records.at(0));
    EXPECT_EQ(campaign.records[0]->value, 17) << campaign.records[0]->message;
    const auto problem = labeling::read_problem(folder_.path() / "p.lab");
    const auto kept = labeling::read_solution(
        best_solution_file(folder_.path() / "out", campaign.plan.problems[0].hash), problem);
    EXPECT_EQ(labeling::check_solution(problem, kept).value, 17);
    EXPECT_TRUE(labeling::check_solution(problem, kept).is_feasible);
}

TEST_F(BadDays, NumbersThatDoNotFitAreNone) {
    const Record record = record_of(
        "printf 'v 17\n1\n3\n' > $2\n"
        "echo '{\"status\": \"feasible\", \"bound\": 10000000000000000000, \"seconds\": -3,"
        "\"trace\": [[1e300, 5, 10000000000000000000, 18], [-1, 6, 17, null]]}' > $3\n");
    EXPECT_EQ(record.outcome, Outcome::Feasible) << record.message;
    EXPECT_FALSE(record.bound);
    EXPECT_EQ(record.solver_seconds, 0);
    ASSERT_EQ(record.trace.size(), 2u);
    EXPECT_FALSE(record.trace[0].value);
    EXPECT_EQ(record.trace[0].bound, 18);
    EXPECT_EQ(record.trace[0].seconds, record.measures.wall_seconds);
    EXPECT_EQ(record.trace[1].seconds, 0);
}

/// execute() wants a process of its own.
TEST(Clock, AJumpingCalendarChangesNoDuration) {
    const labeling::ScratchFolder folder;
    labeling::write_text_file(folder.path() / "p.lab", kProblem);
    labeling::write_text_file(
        folder.path() / "c.toml",
        "name = \"clock\"\n[limits]\ntime = 5\n[[problems]]\nfiles = \"p.lab\"\n"
        "[[solvers]]\nsolver = \"greedy\"\nseeds = [1, 2, 3]\n");
    ASSERT_EQ(run_experiment(folder.path(), {"plan", "c.toml", "-o", "out"}).outcome.exit_code, 0);
    const Plan plan = read_plan(folder.path() / "out");
    ::setenv("PATH", (std::string(SCALEFCN_BINARY_DIR "/bin:") + std::getenv("PATH")).c_str(), 1);
    const char* calendar[] = {"2031-01-01T00:00:00Z", "1999-01-01T00:00:00Z",
                              "2031-01-01T00:00:00Z"};
    for (std::size_t k = 0; k < plan.jobs.size(); ++k) {
        const pid_t child = ::fork();
        if (child == 0) {
            ExecuteOptions options;
            options.calendar = [&] { return std::string(calendar[k]); };
            write_record(*execute(plan, plan.jobs[k], folder.path() / "out", options),
                         folder.path() / "out");
            ::_exit(0);
        }
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        const auto record = read_record(folder.path() / "out", plan.jobs[k].key);
        ASSERT_TRUE(record);
        EXPECT_EQ(record->measures.started_at, calendar[k]);
        EXPECT_EQ(record->outcome, Outcome::Feasible) << record->message;
        EXPECT_GE(record->measures.wall_seconds, 0);
        EXPECT_LT(record->measures.wall_seconds, 1000);
    }
    // The runner takes them as they are: nothing left to do, nothing lost.
    const auto result = run_experiment(folder.path(), {"resume", "out"});
    EXPECT_NE(result.output.find("3 of 3 runs done"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace experiment::testing
