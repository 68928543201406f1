// Whole campaigns: killed at random moments, on a full disk, by two runners, with bad input.
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <set>

#include "campaign_support.h"
#include "experiment/folder_lock.h"

namespace experiment::testing {
namespace {

constexpr const char* kCampaign =
    "name = \"killed\"\n"
    "seeds = [1, 2]\n"
    "[limits]\n"
    "work = 200000\n"
    "[[problems]]\n"
    "family = \"chain\"\n"
    "labels = [30, 60]\n"
    "seed = [1, 2]\n"
    "[[problems]]\n"
    "family = \"planted\"\n"
    "cliques = 20\n"
    "[[solvers]]\n"
    "solver = \"greedy\"\n"
    "[[solvers]]\n"
    "solver = \"local-search\"\n"
    "[[solvers]]\n"
    "solver = \"auto\"\n"
    "renamings = [0, 1]\n";
constexpr std::size_t kRuns = 5 * 2 * 4;

class Campaign : public ::testing::Test {
protected:
    void SetUp() override { labeling::write_text_file(folder_.path() / "c.toml", kCampaign); }
    ProgramResult run(std::vector<std::string> words,
                      const std::function<void(labeling::ProgramRun&)>& change = {}) {
        return run_experiment(folder_.path(), std::move(words), change);
    }
    fs::path out(const char* name) const { return folder_.path() / name; }
    std::map<std::string, std::string> undisturbed() {
        const auto result = run({"run", "c.toml", "-o", "whole", "-j", "2", "-q"});
        EXPECT_EQ(result.outcome.exit_code, 0) << result.errors;
        return answers(out("whole"));
    }
    labeling::ScratchFolder folder_;
};

/// Kills the program with SIGKILL once `milliseconds` are over.
std::function<void(labeling::ProgramRun&)> killed_after(int milliseconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    return [end](labeling::ProgramRun& run) {
        run.grace_seconds = 0;
        run.has_to_end = [end] { return std::chrono::steady_clock::now() >= end; };
    };
}

TEST_F(Campaign, KilledAgainAndAgainItEndsAsIfUndisturbed) {
    const auto whole = undisturbed();
    ASSERT_EQ(whole.size(), kRuns);
    const unsigned seed = std::random_device()();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 engine(seed);
    run({"plan", "c.toml", "-o", "killed", "-q"});
    int kills = 0;
    for (int k = 0; k < 25; ++k) {
        const int milliseconds = static_cast<int>(20 + engine() % 300);
        const auto result = run({"resume", "killed", "-q", "-j", std::to_string(1 + k % 2)},
                                killed_after(milliseconds));
        if (result.outcome.end == labeling::ProgramEnd::Exited) break;  // it had finished
        ++kills;
        // What is there is whole: the database opens, and each run is the undisturbed one's.
        for (const auto& [key, answer] : answers(out("killed"))) EXPECT_EQ(answer, whole.at(key));
    }
    EXPECT_GT(kills, 0);
    const auto last = run({"resume", "killed", "-q"});
    EXPECT_EQ(last.outcome.exit_code, 0) << last.errors;
    EXPECT_EQ(answers(out("killed")), whole);
}

TEST_F(Campaign, KilledWhileItIsPreparedItCanBeStartedAgain) {
    const auto whole = undisturbed();
    for (int milliseconds : {5, 30, 60}) {
        run({"run", "c.toml", "-o", "again", "-q"}, killed_after(milliseconds));
        if (fs::exists(out("again") / "plan.json")) break;
    }
    const bool is_planned = fs::exists(out("again") / "plan.json");
    const auto result =
        is_planned ? run({"resume", "again", "-q"}) : run({"run", "c.toml", "-o", "again", "-q"});
    EXPECT_EQ(result.outcome.exit_code, 0) << result.errors;
    EXPECT_EQ(answers(out("again")), whole);
}

TEST_F(Campaign, OnAFullDiskItSaysSoAndGoesOnLater) {
    const auto whole = undisturbed();
    ASSERT_EQ(run({"plan", "c.toml", "-o", "full", "-q"}).outcome.exit_code, 0);
    const auto full = run({"resume", "full", "-q"},
                          [](labeling::ProgramRun& program) { program.file_bytes = 60000; });
    EXPECT_EQ(full.outcome.exit_code, 3) << full.errors;
    EXPECT_NE(full.errors.find("campaign.sqlite"), std::string::npos) << full.errors;
    const auto later = run({"resume", "full", "-q"});
    EXPECT_EQ(later.outcome.exit_code, 0) << later.errors;
    EXPECT_EQ(answers(out("full")), whole);
}

TEST_F(Campaign, OneRunnerAtATime) {
    ASSERT_EQ(run({"plan", "c.toml", "-o", "locked", "-q"}).outcome.exit_code, 0);
    {
        const FolderLock lock(out("locked"));
        const auto second = run({"resume", "locked"});
        EXPECT_EQ(second.outcome.exit_code, 3);
        EXPECT_NE(second.errors.find("another runner is at work"), std::string::npos)
            << second.errors;
    }
    EXPECT_EQ(run({"resume", "locked", "-q"}).outcome.exit_code, 0);
}

TEST_F(Campaign, ADamagedRecordIsMadeAgain) {
    ASSERT_EQ(run({"plan", "c.toml", "-o", "damaged", "-q"}).outcome.exit_code, 0);
    const Plan plan = read_plan(out("damaged"));
    fs::create_directories(out("damaged") / "records");
    std::ofstream(out("damaged") / "records" / (plan.jobs[0].key + ".json")) << "{\"key\": 1";
    EXPECT_EQ(run({"resume", "damaged", "-q"}).outcome.exit_code, 0);
    EXPECT_EQ(answers(out("damaged")).size(), kRuns);
}

TEST_F(Campaign, WhatWasMissingIsMadeOnceItIsThere) {
    labeling::write_text_file(out("p.lab"), "p labeling 1 0 0 0\nl 1 5\n");
    labeling::write_text_file(out("m.toml"),
                              "name = \"m\"\n[limits]\ntime = 60\n[[problems]]\nfiles = "
                              "\"p.lab\"\n[[solvers]]\nsolver = \"greedy\"\n[[solvers]]\nname = "
                              "\"later\"\nprogram = \"./later.sh {solution}\"\n");
    const auto outcomes = [&] {
        std::multiset<std::string> names;
        for (const Record& r : Database(out("m")).records()) names.insert(to_string(r.outcome));
        return names;
    };
    EXPECT_EQ(run({"run", "m.toml", "-o", "m", "-q"}).outcome.exit_code, 0);
    EXPECT_EQ(outcomes(), (std::multiset<std::string>{"feasible", "missing"}));
    labeling::write_text_file(out("later.sh"), "#!/bin/sh\nprintf 'v 5\\n1\\n' > $1\n");
    fs::permissions(out("later.sh"), fs::perms::owner_all);
    const auto greedy = answers(out("m"));
    run({"resume", "m", "-q"});
    EXPECT_EQ(answers(out("m")), greedy);
    run({"resume", "m", "-q", "--again", "not-applicable"});
    EXPECT_EQ(answers(out("m")), greedy);
    EXPECT_EQ(run({"resume", "m", "-q", "--again", "missing"}).outcome.exit_code, 0);
    EXPECT_EQ(outcomes(), (std::multiset<std::string>{"feasible", "feasible"}));
    // What was made is no more made again than hidden.
    EXPECT_EQ(run({"resume", "m", "-q", "--again", "crash"}).outcome.exit_code, 2);
}

TEST_F(Campaign, RecordsMadeElsewhereAreMerged) {
    const auto whole = undisturbed();
    ASSERT_EQ(run({"plan", "c.toml", "-o", "apart", "-q"}).outcome.exit_code, 0);
    for (const Job& job : read_plan(out("apart")).jobs) {
        ASSERT_EQ(run({"execute", "apart", job.key}).outcome.exit_code, 0);
    }
    EXPECT_NE(run({"merge", "apart"}).output.find("40 new records"), std::string::npos);
    EXPECT_NE(run({"merge", "apart"}).output.find("0 new records"), std::string::npos);
    EXPECT_EQ(answers(out("apart")), whole);
}

TEST_F(Campaign, AProblemThatWasChangedIsNotRun) {
    ASSERT_EQ(run({"plan", "c.toml", "-o", "changed", "-q"}).outcome.exit_code, 0);
    const Plan plan = read_plan(out("changed"));
    fs::copy_file(out("changed") / plan.problems[1].file, out("changed") / plan.problems[0].file,
                  fs::copy_options::overwrite_existing);
    const auto result = run({"resume", "changed", "-q"});
    EXPECT_EQ(result.outcome.exit_code, 3);
    EXPECT_NE(result.errors.find("not the problem that was planned"), std::string::npos)
        << result.errors;
}

/// A triangle, so high.
std::string triangle(const char* height) {
    return std::string("OFF\n3 1 0\n0 0 0\n1 0 0\n0 ") + height + " 0\n3 0 1 2\n";
}

TEST_F(Campaign, MeshesOfOneNameAreNotTakenForEachOther) {
    for (const char* part : {"a", "b"}) {
        fs::create_directories(out(part));
        labeling::write_text_file(out(part) / "m.off", triangle(part[0] == 'a' ? "1" : "2"));
    }
    const std::string tail = "scales = \"50%\"\nstudy = true\n[[solvers]]\nsolver = \"greedy\"\n";
    labeling::write_text_file(
        out("two.toml"),
        "name = \"two\"\n[[problems]]\nmeshes = [\"a/m.off\", \"b/m.off\"]\n" + tail);
    const auto two = run({"plan", "two.toml", "-o", "two"});
    EXPECT_EQ(two.outcome.exit_code, 3);
    EXPECT_NE(two.errors.find("b/m.off: another mesh is"), std::string::npos) << two.errors;
    // And one that was changed after it was planned is not studied.
    labeling::write_text_file(out("one.toml"),
                              "name = \"one\"\n[[problems]]\nmeshes = \"a/m.off\"\n" + tail);
    ASSERT_EQ(run({"plan", "one.toml", "-o", "one", "-q"}).outcome.exit_code, 0);
    labeling::write_text_file(out("one") / "meshes" / "m.off", triangle("3"));
    const auto one = run({"resume", "one", "-q"});
    EXPECT_EQ(one.outcome.exit_code, 3);
    EXPECT_NE(one.errors.find("m.off: not the mesh that was planned"), std::string::npos)
        << one.errors;
}

TEST_F(Campaign, BadInputIsRefusedBeforeAnythingRuns) {
    const auto refused = [&](const std::string& text, const std::string& part) {
        labeling::write_text_file(out("bad.toml"), text);
        const auto result = run({"run", "bad.toml", "-o", "bad"});
        EXPECT_EQ(result.outcome.exit_code, 3) << result.errors;
        EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
        EXPECT_FALSE(fs::exists(out("bad") / "plan.json"));
    };
    const std::string head = "name = \"bad\"\n";
    const std::string greedy = "[[solvers]]\nsolver = \"greedy\"\n";
    refused(head + "[[problems]]\nfiles = \"*.nothing\"\n" + greedy, "nothing matches *.nothing");
    refused(head + "[[problems]]\nfiles = \"missing.lab\"\n" + greedy, "missing.lab");
    refused(head + "[[problems]]\nfamily = \"chain\"\n[[solvers]]\nsolver = \"magic\"\n", "magic");
    refused(head + "[[problems]]\nfamily = \"chain\"\n" + greedy + "options = { rulez = 1 }\n",
            "solver 'greedy': solver greedy has no option 'rulez'");
    refused(head + "[[problems]]\nfamily = \"chain\"\n[[solvers]]\nsolver = \"cbc\"\n" +
                "options = { rows = \"all\" }\n",
            "'all' is not paper or strengthened");
    refused(head + "[[problems]]\nfamily = \"chain\"\nlabels = -4\n" + greedy, "bad.toml:2");
    refused(head + "[[problems]]\nmeshes = \"cgal:none-of-that-name\"\nscales = \"2%\"\n" + greedy,
            "fetch_meshes.sh none-of-that-name");
    EXPECT_EQ(run({"resume", "nowhere"}).outcome.exit_code, 3);
    EXPECT_EQ(run({"run"}).outcome.exit_code, 2);
    run({"run", "c.toml", "-o", "twice", "-q"});
    const auto twice = run({"run", "c.toml", "-o", "twice", "-q"});
    EXPECT_EQ(twice.outcome.exit_code, 3);
    EXPECT_NE(twice.errors.find("resume"), std::string::npos) << twice.errors;
}

}  // namespace
}  // namespace experiment::testing
