// External programs that misbehave, as small Python programs that the test writes: each must end in
// a status and a message, never in a wrong answer, a hang or a process left behind.
#include "labeling_mip/external_solver.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "labeling/errors.h"
#include "labeling/problems.h"
#include "labeling_mip/external_command.h"
#include "labeling_mip/external_process.h"
#include "labeling_mip/mip_solvers.h"

namespace labeling_test {
namespace {

namespace fs = std::filesystem;
using labeling::AnswerFormat;
using labeling::ExternalProgram;
using labeling::SolveOptions;
using labeling::SolveResult;
using labeling::SolveStatus;
using labeling::StopReason;

/// Three labels worth 5, 6, 7; the first two in conflict: the optimum is 13, labels 2 and 3.
LabelingProblem three_labels() {
    labeling::ProblemBuilder builder;
    for (Value w : {5, 6, 7}) builder.add_label(w);
    builder.add_conflict(0, 1);
    return builder.build();
}

class FakePrograms : public testing::Test {
protected:
    void SetUp() override {
        if (labeling::find_program("python3").empty()) GTEST_SKIP() << "python3 is not installed";
    }

    /// A program whose Python text is `body`; argv[1] is the problem, argv[2] the solution file.
    ExternalProgram program(const std::string& body) const {
        const fs::path file = folder_.path() / "fake.py";
        std::ofstream(file) << "import os, signal, sys\n" << body;
        ExternalProgram fake;
        fake.name = "fake";
        fake.advice = "nowhere";
        fake.command = "python3 " + file.string() + " {problem} {solution} [{start}]";
        fake.answer_format = AnswerFormat::Worker;
        return fake;
    }

    SolveResult solve(const std::string& body, SolveOptions options = {}) const {
        return make_external_solver(program(body))->solve(three_labels(), options);
    }

    static std::string answer(const std::string& lines) {
        return "open(sys.argv[2], 'w').write('''" + lines + "end\n''')\n";
    }

    /// A time limit by a clock that runs out as soon as `file` has content, so that the program has
    /// come as far as it should, however slow the machine is.
    static SolveOptions limit_when_written(const fs::path& file) {
        SolveOptions options;
        options.time_limit = std::chrono::duration<double>(1);
        options.clock = [file] {
            std::error_code missing;
            const auto size = fs::file_size(file, missing);
            return !missing && size > 0 ? 1000.0 : 0.0;
        };
        return options;
    }

    static void expect_failure(const SolveResult& result, const std::string& part) {
        EXPECT_EQ(result.stop_reason, StopReason::SolverFailed);
        EXPECT_NE(result.status, SolveStatus::Optimal);
        EXPECT_NE(result.message.find(part), std::string::npos) << result.message;
    }

    static void expect_accused(const SolveResult& result, const std::string& part) {
        expect_failure(result, part);
        EXPECT_GE(result.statistics.at("false_claims"), 1);
        EXPECT_GE(result.bound.value_or(13), 13);
    }

    labeling::ScratchFolder folder_;
};

TEST_F(FakePrograms, AnHonestOneIsBelieved) {
    const SolveResult result =
        solve(answer("status optimal\nvalue 13\nbound 13\nseconds 0.25\nlabel 2\nlabel 3\n"));
    EXPECT_EQ(result.status, SolveStatus::Optimal);
    EXPECT_EQ(result.stop_reason, StopReason::Finished);
    ASSERT_TRUE(result.solution);
    EXPECT_EQ(result.solution->value, 13);
    EXPECT_EQ(result.statistics.at("solver_seconds"), 0.25);
    EXPECT_GT(result.statistics.at("process_seconds"), 0);
    EXPECT_GT(result.statistics.at("memory_mib"), 0);
    EXPECT_EQ(result.statistics.count("false_claims"), 0u);
}

TEST_F(FakePrograms, AMissingOneIsNamedWithTheWayToGetIt) {
    ExternalProgram missing = program("");
    missing.command = "no-such-program-anywhere {problem}";
    const SolveResult result = make_external_solver(missing)->solve(three_labels());
    expect_failure(result, "'no-such-program-anywhere' is not installed: nowhere");
    EXPECT_FALSE(result.solution);
    EXPECT_FALSE(result.bound);
}

TEST_F(FakePrograms, OneThatIsNoProgramSaysWhy) {
    const fs::path file = folder_.path() / "no-program";
    std::ofstream(file) << "\x01\x02";
    fs::permissions(file, fs::perms::owner_all);
    ExternalProgram broken = program("");
    broken.command = file.string();
    expect_failure(make_external_solver(broken)->solve(three_labels()), "does not start");
}

TEST_F(FakePrograms, ACrashIsNamed) {
    expect_failure(solve("os.kill(os.getpid(), signal.SIGSEGV)\n"), "signal 11");
    expect_failure(solve("sys.exit('out of luck')\n"), "out of luck");
    // What it wrote before it died counts as a solution, not as a proof.
    const SolveResult late =
        solve(answer("status optimal\nbound 13\nvalue 13\nlabel 2\nlabel 3\n") +
              "os.kill(os.getpid(), signal.SIGABRT)\n");
    expect_failure(late, "signal 6");
    ASSERT_TRUE(late.solution);
    EXPECT_EQ(late.solution->value, 13);
    EXPECT_FALSE(late.bound);
}

TEST_F(FakePrograms, LiesAreRefused) {
    expect_accused(solve(answer("status optimal\nvalue 18\nlabel 1\nlabel 2\nlabel 3\n")),
                   "infeasible");
    expect_accused(solve(answer("status optimal\nvalue 14\nlabel 2\nlabel 3\n")),
                   "claims the value 14");
    expect_accused(solve(answer("status optimal\nvalue 12\nlabel 2\nlabel 3\n")),
                   "claims the value 12");
    expect_accused(solve(answer("status optimal\nvalue 13\nlabel 2\nlabel 3\nbound 9\n")),
                   "bound 9");
    expect_accused(solve(answer("status feasible\nvalue 13\nbound 5\nlabel 2\nlabel 3\n")),
                   "bound 5");
    expect_accused(solve(answer("status optimal\nvalue 12\nbound 40\nlabel 1\nlabel 3\n")),
                   "under the bound 40");
    expect_accused(solve(answer("status optimal\n")), "shows none");
}

TEST_F(FakePrograms, LabelsThatAreNotQuiteIntegersProveNothing) {
    labeling::ProblemBuilder builder;
    for (const labeling::Value weight : {5'000'000, 7'000'000}) builder.add_label(weight);
    builder.add_conflict(0, 1);
    const LabelingProblem problem = builder.build();
    const auto solve_large = [&](const std::string& lines) {
        return make_external_solver(program(answer(lines)))->solve(problem);
    };
    // A ten-millionth of the label that is out, beside all of the one that is in, is worth half a
    // unit: such a sum rounds to one more than the labels are worth.
    const SolveResult rounded =
        solve_large("status optimal\nvalue 7000001\nbound 7000001\nlabel 2\n");
    EXPECT_EQ(rounded.statistics.count("false_claims"), 0u);
    EXPECT_EQ(rounded.status, SolveStatus::Feasible);
    ASSERT_TRUE(rounded.solution);
    EXPECT_EQ(rounded.solution->value, 7'000'000);
    EXPECT_GE(rounded.bound.value_or(7'000'001), 7'000'001);
    const SolveResult lie = solve_large("status optimal\nvalue 7000100\nlabel 2\n");
    expect_failure(lie, "claims the value 7000100");
}

TEST_F(FakePrograms, LiesAgainstWhatIsKnownAreRefused) {
    SolveOptions options;
    options.warm_start = {0, 1, 1};
    const SolveResult none = solve(answer("status infeasible\n"), options);
    expect_accused(none, "no solution");
    const SolveResult worse =
        solve(answer("status optimal\nvalue 12\nbound 12\nlabel 1\nlabel 3\n"), options);
    expect_accused(worse, "12");
    for (const SolveResult* result : {&none, &worse}) {
        ASSERT_TRUE(result->solution);
        EXPECT_EQ(result->solution->value, 13);
    }
}

TEST_F(FakePrograms, RubbishIsRefused) {
    const char* texts[] = {"",
                           "hello\n",
                           "status optimal\n",
                           "status splendid\nend\n",
                           "status optimal\nvalue nan\nend\n",
                           "status optimal\nvalue 1e999\nend\n",
                           "status optimal\nvalue 13\nlabel 4\nend\n",
                           "status optimal\nvalue 13\nlabel 0\nend\n",
                           "status optimal\nlabel 2\nend\n",
                           "\\x00\\xff\\x80\n"};
    for (const char* text : texts) {
        const SolveResult result =
            solve(std::string("open(sys.argv[2], 'w').write('''") + text + "''')\n");
        expect_failure(result, "no answer");
        EXPECT_FALSE(result.solution) << text;
        EXPECT_FALSE(result.bound) << text;
    }
}

TEST_F(FakePrograms, EveryReaderRefusesRandomText) {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        std::mt19937_64 engine(seed);
        const char* words[] = {"s",  "mip", "o",    "1",     "x1",     "-x2", "v", "j", "OPTIMUM",
                               "\n", "e",   "o",    "FOUND", "b2",     "0.5", "c", "3", "Optimum:",
                               "\n", "+",   "1e99", "-7",    "status", "\n",  "2", "0", "Dual"};
        std::string text;
        for (std::int64_t k = pick(engine, 0, 30); k > 0; --k) {
            text += words[pick(engine, 0, std::ssize(words) - 1)];
            text += ' ';
        }
        for (AnswerFormat format :
             {AnswerFormat::Worker, AnswerFormat::Glpk, AnswerFormat::PseudoBoolean,
              AnswerFormat::Toulbar2, AnswerFormat::Columns}) {
            try {
                const auto read = labeling::read_answer(format, text, text, 3);
                ASSERT_TRUE(read.labels.empty() || read.labels.size() == 3) << seed;
                for (auto label : read.labels) ASSERT_LE(label, 1) << seed;
            } catch (const labeling::InputError&) {
                continue;  // a refusal is an answer; anything else ends the test
            }
        }
    }
}

/// True when no process of that number is left. The program wrote its own and its child's numbers.
bool is_gone(const fs::path& file) {
    std::ifstream in(file);
    int process = 0, count = 0;
    while (in >> process) {
        ++count;
        if (::kill(process, 0) == 0) {
            // A zombie that nobody has reaped yet counts as ended.
            std::ifstream state("/proc/" + std::to_string(process) + "/stat");
            std::string number, name, letter;
            state >> number >> name >> letter;
            if (state && letter != "Z" && letter != "X") return false;
        }
    }
    return count > 0;
}

TEST_F(FakePrograms, OneThatHangsIsStopped) {
    const fs::path numbers = folder_.path() / "numbers";
    const std::string note = "open('" + numbers.string() + "', 'a').write(f'{os.getpid()}\\n')\n";
    const SolveResult obedient =
        solve(note + "while True: signal.pause()\n", limit_when_written(numbers));
    EXPECT_EQ(obedient.stop_reason, StopReason::TimeLimit);
    EXPECT_EQ(obedient.status, SolveStatus::NoSolution);
    EXPECT_TRUE(is_gone(numbers));
    fs::remove(numbers);
    const SolveResult deaf = solve(
        "signal.signal(signal.SIGTERM, signal.SIG_IGN)\n" + note + "while True: signal.pause()\n",
        limit_when_written(numbers));
    EXPECT_EQ(deaf.stop_reason, StopReason::TimeLimit);
    EXPECT_TRUE(is_gone(numbers));
}

TEST_F(FakePrograms, WhatItStartedIsEndedWithIt) {
    const fs::path numbers = folder_.path() / "numbers";
    const std::string fork =
        "signal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
        "read, write = os.pipe()\n"
        "if os.fork() == 0:\n"
        "    open('" +
        numbers.string() +
        "', 'a').write(f'{os.getpid()}\\n')\n"
        "    os.write(write, b'x')\n"
        "    while True: signal.pause()\n"
        "os.read(read, 1)\n";
    // The program itself ends well; its child would live for ever.
    const SolveResult result = solve(fork + answer("status optimal\nvalue 13\nlabel 2\nlabel 3\n"));
    EXPECT_EQ(result.status, SolveStatus::Optimal);
    EXPECT_TRUE(is_gone(numbers));
    fs::remove(numbers);
    const SolveResult stopped =
        solve(fork + "while True: signal.pause()\n", limit_when_written(numbers));
    EXPECT_EQ(stopped.stop_reason, StopReason::TimeLimit);
    EXPECT_TRUE(is_gone(numbers));
}

TEST_F(FakePrograms, AnAnswerBeforeTheLimitSurvivesTheHang) {
    const fs::path sign = folder_.path() / "sign";
    const SolveResult result =
        solve(answer("status feasible\nvalue 12\nbound 20\nlabel 1\nlabel 3\n") + "open('" +
                  sign.string() + "', 'w').write('x')\nwhile True: signal.pause()\n",
              limit_when_written(sign));
    EXPECT_EQ(result.stop_reason, StopReason::TimeLimit);
    ASSERT_TRUE(result.solution && result.bound);
    EXPECT_EQ(result.solution->value, 12);
    EXPECT_GE(*result.bound, 20);
}

TEST_F(FakePrograms, AStopRequestEndsIt) {
    std::stop_source source;
    source.request_stop();
    SolveOptions options;
    options.stop = source.get_token();
    EXPECT_EQ(solve("while True: signal.pause()\n", options).stop_reason, StopReason::Interrupted);
}

TEST_F(FakePrograms, TheMemoryLimitHolds) {
    SolveOptions options;
    options.extra["memory"] = "256";
    expect_failure(
        solve("x = bytearray(1 << 30)\n" + answer("status optimal\nvalue 13\nlabel 2\nlabel 3\n"),
              options),
        "MemoryError");
}

TEST_F(FakePrograms, GetTheStartAndTheirFolderIsRemoved) {
    const fs::path copy = folder_.path() / "copy";
    SolveOptions options;
    options.warm_start = {0, 1, 1};
    const std::string body = "open('" + copy.string() +
                             "', 'w').write(os.getcwd() + '\\n' + open(sys.argv[3]).read())\n" +
                             answer("status unknown\n");
    const SolveResult result = solve(body, options);
    ASSERT_TRUE(result.solution);
    EXPECT_EQ(result.solution->value, 13);
    std::ifstream in(copy);
    std::string scratch, line, start;
    std::getline(in, scratch);
    while (std::getline(in, line)) start += line + ";";
    EXPECT_EQ(start, "b1 0;b2 1;b3 1;");
    EXPECT_FALSE(scratch.empty());
    EXPECT_FALSE(fs::exists(scratch));
}

TEST(Answers, AreReadAsTheProgramsWriteThem) {
    using Claim = labeling::ExternalAnswer::Claim;
    const auto glpk = labeling::read_answer(
        AnswerFormat::Glpk, "c Problem:\ns mip 4 3 f 12\ni 1 1\nj 1 1\nj 2 0\nj 3 1\ne o f\n",
        "+    12: mip =     not found yet <=              +inf        (1; 0)\n"
        "+    40: >>>>>   1.200000000e+01 <=   1.450000000e+01  20.8% (4; 0)\n"
        "Time used:   0.3 secs\n",
        3);
    EXPECT_EQ(glpk.claim, Claim::Feasible);
    EXPECT_EQ(glpk.labels, (std::vector<std::uint8_t>{1, 0, 1}));
    EXPECT_EQ(glpk.value, 12);
    EXPECT_EQ(glpk.bound, 14.5);
    EXPECT_EQ(glpk.seconds, 0.3);
    const auto clasp = labeling::read_answer(
        AnswerFormat::PseudoBoolean, "",
        "c clasp version 3.3.5\no -5\no -13\nv -x1 x2 x3\nv x4\ns SATISFIABLE\n"
        "c Time           : 2.004s (Solving: 2.00s)\n",
        3);
    EXPECT_EQ(clasp.claim, Claim::Feasible);
    EXPECT_EQ(clasp.labels, (std::vector<std::uint8_t>{0, 1, 1}));
    EXPECT_EQ(clasp.value, 13);
    EXPECT_EQ(clasp.seconds, 2.004);
    const auto toulbar2 = labeling::read_answer(
        AnswerFormat::Toulbar2, "0 1 1\n",
        "c /usr/bin/toulbar2  version : 1.1.1\nNew solution: -12 (0 backtracks, 3 nodes, depth 2)\n"
        "Optimality gap: [-15, -12] 25.000 % (4 backtracks, 9 nodes)\n"
        "New solution: -13 (5 backtracks, 11 nodes, depth 2)\n"
        "Time limit expired... Aborting...\n",
        3);
    EXPECT_EQ(toulbar2.claim, Claim::Feasible);
    EXPECT_EQ(toulbar2.value, 13);
    EXPECT_EQ(toulbar2.bound, 15);

    const auto closed = labeling::read_answer(
        AnswerFormat::Toulbar2, "1 0 1\n",
        "Optimality gap: [-15, -12] 25.000 % (4 backtracks, 9 nodes)\n"
        "Optimum: -13 in 7 backtracks and 15 nodes ( 0 removals by DEE) and 0.5 seconds.\n",
        3);
    EXPECT_EQ(closed.claim, Claim::Optimal);
    EXPECT_EQ(closed.value, 13);
    EXPECT_FALSE(closed.bound.has_value());
    const auto proven = labeling::read_answer(
        AnswerFormat::Toulbar2, "0 1 1\n",
        "Optimum: -13 in 5 backtracks and 11 nodes ( 0 removals by DEE) and 0.250 seconds.\n", 3);
    EXPECT_EQ(proven.claim, Claim::Optimal);
    EXPECT_EQ(proven.seconds, 0.25);
    EXPECT_EQ(proven.nodes, 11);
}

TEST(CommandTemplates, ArePlacedWordByWord) {
    const std::map<std::string, std::string> values{
        {"problem", "/a b/p.mps"}, {"time", ""}, {"seed", "7"}};
    using Words = std::vector<std::string>;
    EXPECT_EQ(labeling::command_words("run {problem} -s={seed}", values),
              (Words{"run", "/a b/p.mps", "-s=7"}));
    EXPECT_EQ(labeling::command_words("run [-t {time} -x] [-s {seed}] \"a  b\" \"\"", values),
              (Words{"run", "-s", "7", "a  b", ""}));
    EXPECT_EQ(labeling::command_words("'a \"b' c\"'d {seed}'\"", values),
              (Words{"a \"b", "c'd 7'"}));
    for (const char* wrong : {"{time}", "{nothing}", "\"a", "'a\"", "[a", "a]", "{seed", "[[a]]"}) {
        EXPECT_THROW(labeling::command_words(wrong, values), labeling::InputError) << wrong;
    }
}

TEST_F(FakePrograms, AnyProgramCanBeNamedInTheOptions) {
    const auto solver = labeling::all_solvers().find("external");
    EXPECT_THROW(solver->solve(three_labels()), labeling::InputError);
    SolveOptions options;
    options.extra["command"] = program(
                                   "open(sys.argv[2], 'w').write('# value\\n 1 b2 1\\nb3 "
                                   "0.9999999 (obj:7)\\n')\n")
                                   .command;
    options.extra["format"] = "lp";
    options.extra["answer"] = "columns";
    const SolveResult result = solver->solve(three_labels(), options);
    ASSERT_TRUE(result.solution);
    EXPECT_EQ(result.solution->value, 13);
    EXPECT_FALSE(result.bound);
    options.extra["answer"] = "telepathy";
    EXPECT_THROW(solver->solve(three_labels(), options), labeling::InputError);
}

}  // namespace
}  // namespace labeling_test
