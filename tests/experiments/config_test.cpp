#include "experiment/config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "experiment/pattern.h"
#include "experiment/plan.h"
#include "labeling/errors.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_process.h"

namespace experiment {
namespace {

const std::string kSmall =
    "name = \"small\"\n"
    "[limits]\n"
    "time = 2\n"
    "[[problems]]\n"
    "family = \"chain\"\n"
    "labels = [20, 40]\n"
    "seed = [1, 2, 3]\n"
    "[[solvers]]\n"
    "solver = \"greedy\"\n";

std::string error_of(const std::string& text) {
    try {
        parse_config(text, "some.toml");
    } catch (const labeling::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Config, ReadsWhatIsThereAndFillsInTheRest) {
    const CampaignConfig config = parse_config(kSmall, "some.toml");
    ASSERT_EQ(config.solvers.size(), 1u);
    EXPECT_EQ(config.solvers[0].name, "greedy");
    EXPECT_EQ(config.solvers[0].limits.seconds, 2.0);
    EXPECT_EQ(config.solvers[0].seeds, std::vector<std::uint64_t>{1});
    EXPECT_EQ(config.solvers[0].renamings, std::vector<std::uint64_t>{0});
    EXPECT_EQ(config.report.baseline, "greedy");
    EXPECT_EQ(config.problems[0].family_options.at("labels").size(), 2u);
}

TEST(Config, SolversOverrideLimits) {
    const CampaignConfig config =
        parse_config(kSmall + "time = 7.5\nmemory = \"2GiB\"\n", "some.toml");
    EXPECT_EQ(config.solvers[0].limits.seconds, 7.5);
    EXPECT_EQ(config.solvers[0].limits.memory_mib, 2048);
}

struct BadConfig {
    const char* what;
    std::string text;
    const char* part_of_error;
};

class BadConfigs : public ::testing::TestWithParam<BadConfig> {};

TEST_P(BadConfigs, AreRefusedWithLineAndReason) {
    const std::string error = error_of(GetParam().text);
    EXPECT_NE(error.find(GetParam().part_of_error), std::string::npos) << "error: " << error;
    EXPECT_EQ(error.find("some.toml:"), 0u) << "error: " << error;
}

INSTANTIATE_TEST_SUITE_P(
    All, BadConfigs,
    ::testing::Values(
        BadConfig{"unknown key of a solver", kSmall + "thread = 2\n", ":10: unknown key 'thread'"},
        BadConfig{"unknown key at the top", "colour = 1\n" + kSmall, ":1: unknown key 'colour'"},
        BadConfig{"negative limit", kSmall + "time = -1\n", ":10: time: -1 is not between"},
        BadConfig{"limit that is no number", kSmall + "time = \"long\"\n", "time is not a number"},
        BadConfig{"limit that is nan", kSmall + "time = nan\n", "time: nan is not between"},
        BadConfig{"memory without unit", kSmall + "memory = \"4\"\n", "not a size"},
        BadConfig{"seed twice", kSmall + "seeds = [3, 3]\n", "3 stands there twice"},
        BadConfig{"negative seed", kSmall + "seeds = [-3]\n", "not an integer of at least 0"},
        BadConfig{"no seeds", kSmall + "seeds = []\n", "seeds is empty"},
        BadConfig{"two solvers of one name", kSmall + "[[solvers]]\nsolver = \"greedy\"\n",
                  "two solvers are named 'greedy'"},
        BadConfig{"neither solver nor program", kSmall + "[[solvers]]\nname = \"x\"\n",
                  "either 'solver' or 'program'"},
        BadConfig{"both", kSmall + "program = \"p\"\n", "either 'solver' or 'program'"},
        BadConfig{"limits are listed", kSmall + "[limits.sub]\n", "time, work"},
        BadConfig{"program with a misspelt placeholder",
                  kSmall + "[[solvers]]\nname = \"x\"\nprogram = \"p {problm}\"\n",
                  ":12: command 'p {problm}': unknown placeholder {problm}"},
        BadConfig{"program with an open quote",
                  kSmall + "[[solvers]]\nname = \"x\"\nprogram = \"'p {problem}\"\n",
                  ":12: command ''p {problem}': an open quote"},
        BadConfig{"program of blanks", kSmall + "[[solvers]]\nname = \"x\"\nprogram = \"  \"\n",
                  ":12: no program"},
        BadConfig{"unknown family", kSmall + "[[problems]]\nfamily = \"circles\"\n",
                  "unknown family 'circles'"},
        BadConfig{"two sources", kSmall + "[[problems]]\nfamily = \"chain\"\nfiles = \"a\"\n",
                  "one of files, family and meshes"},
        BadConfig{"no scales", kSmall + "[[problems]]\nmeshes = \"a.off\"\n", "need scales"},
        BadConfig{"unknown baseline", kSmall + "[report]\nbaseline = \"scip\"\n",
                  "no solver 'scip'"},
        BadConfig{"name of a file elsewhere", kSmall + "name = \"../x\"\n", "letters, digits"},
        BadConfig{"no TOML", "name = \n", ":1: "},
        BadConfig{"no name", "[[solvers]]\nsolver = \"greedy\"\n", "needs name"},
        BadConfig{"empty", "", "needs name"}),
    [](const auto& entry) {
        std::string name = entry.param.what;
        for (char& c : name) c = c == ' ' ? '_' : c;
        return name;
    });

TEST(Corpora, AllOfThemCanBeRead) {
    int count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(SCALEFCN_SOURCE_DIR "/experiments/corpora")) {
        SCOPED_TRACE(entry.path().string());
        const CampaignConfig config = read_config(entry.path());
        EXPECT_EQ(config.name, entry.path().stem().string());
        EXPECT_FALSE(config.description.empty());
        ++count;
    }
    EXPECT_GE(count, 7);
}

std::set<std::string> meshes_of(const std::string& corpus) {
    std::set<std::string> meshes;
    const std::string file = SCALEFCN_SOURCE_DIR "/experiments/corpora/" + corpus + ".toml";
    for (const ProblemConfig& problems : read_config(file).problems) {
        meshes.insert(problems.meshes.begin(), problems.meshes.end());
    }
    return meshes;
}

TEST(Corpora, NothingIsJudgedByAMeshThatWasTunedOn) {
    auto tuned = meshes_of("tuning");
    // Of the development problems.
    for (const char* mesh : {"cgal:fandisk", "cgal:ChineseDragon-10kv", "cgal:mech-holes-shark"}) {
        tuned.insert(mesh);
    }
    const auto judged = meshes_of("judging");
    EXPECT_GE(judged.size(), 8u);
    for (const std::string& mesh : judged) EXPECT_FALSE(tuned.contains(mesh)) << mesh;
    // The lists are of these meshes, each hash once in both.
    std::set<std::string> hashes;
    for (const char* corpus : {"tuning", "judging"}) {
        const auto meshes = meshes_of(corpus);
        std::ifstream list(std::string(SCALEFCN_SOURCE_DIR "/experiments/problems/") + corpus +
                           ".txt");
        std::string name, hash;
        int count = 0;
        while (list >> name >> hash) {
            ++count;
            EXPECT_TRUE(hashes.insert(hash).second) << name;
            EXPECT_TRUE(std::any_of(meshes.begin(), meshes.end(), [&](const std::string& mesh) {
                return name.starts_with(mesh.substr(5) + "_");
            })) << name;
        }
        EXPECT_GE(count, 48) << corpus;
    }
}

std::vector<PlannedProblem> two_problems() {
    std::vector<PlannedProblem> problems(2);
    problems[0].name = "a";
    problems[0].hash = "1";
    problems[1].name = "b";
    problems[1].hash = "2";
    return problems;
}

TEST(Plan, HoldsEveryCombinationOnceInBlocksOfOneProblem) {
    const CampaignConfig config = parse_config(
        "name = \"x\"\nseeds = [1, 2, 3]\n[[problems]]\nfamily = \"chain\"\n"
        "[[solvers]]\nsolver = \"greedy\"\n[[solvers]]\nsolver = \"auto\"\nrenamings = [0, 1]\n"
        "[[solvers]]\nsolver = \"lns\"\nproblems = [\"b*\"]\n",
        "some.toml");
    const Plan plan = make_plan(config, two_problems());
    ASSERT_EQ(plan.jobs.size(), 3u + 6u + 3u + 6u + 3u);
    std::map<std::string, int> keys;
    for (std::size_t k = 0; k < plan.jobs.size(); ++k) {
        ++keys[plan.jobs[k].key];
        EXPECT_EQ(plan.jobs[k].problem, k < 9 ? 0u : 1u);
    }
    EXPECT_EQ(keys.size(), plan.jobs.size());
    // Solvers take turns: some run of another solver stands between those of each.
    int changes = 0;
    for (std::size_t k = 1; k < plan.jobs.size(); ++k) {
        changes += plan.jobs[k].solver != plan.jobs[k - 1].solver;
    }
    EXPECT_GT(changes, 5);
}

TEST(Plan, KeysDependOnWhatMattersAndOnNothingElse) {
    const auto plan_of = [](const std::string& more) {
        return make_plan(parse_config(kSmall + more, "some.toml"), two_problems());
    };
    const Plan plan = plan_of("");
    EXPECT_EQ(plan.jobs[0].key, plan_of("[report]\nfloor = 0.1\n").jobs[0].key);
    EXPECT_NE(plan.jobs[0].key, plan_of("time = 3\n").jobs[0].key);
    EXPECT_NE(plan.jobs[0].key, plan_of("options = { rule = \"gain\" }\n").jobs[0].key);
    EXPECT_NE(plan.jobs[0].key, plan_of("seeds = [2]\n").jobs[0].key);
}

TEST(Config, RelativeProgramsAreSeenFromItsFolder) {
    const auto program = [](const std::string& command) {
        return parse_config(kSmall + "[[solvers]]\nname = \"x\"\nprogram = '''" + command + "'''\n",
                            "/some where/some.toml")
            .solvers[1]
            .program;
    };
    EXPECT_EQ(program("./p {problem}"), "\"/some where/p\" {problem}");
    EXPECT_EQ(program("\"../my p\" {problem}"), "\"/my p\" {problem}");
    EXPECT_EQ(program("'my p/q'"), "\"/some where/my p/q\"");
    EXPECT_EQ(program("p ./x {problem}"), "p ./x {problem}");
    EXPECT_EQ(program("/p/q {problem}"), "/p/q {problem}");
    EXPECT_EQ(program("{programs}/scalefcn {problem}"), "{programs}/scalefcn {problem}");
}

TEST(Config, PatternsDoNotMeanTheFolder) {
    const labeling::ScratchFolder folder;
    const auto home = folder.path() / "[a] *";
    std::filesystem::create_directories(home);
    labeling::write_text_file(home / "p 1.lab", "");
    EXPECT_EQ(matching_files("p*.lab", home).size(), 1u);
    EXPECT_EQ(matching_files((folder.path() / "*" / "p*").string(), home).size(), 1u);
}

TEST(Plan, WhatAStudyWouldDropIsRefused) {
    auto problems = two_problems();
    problems[1].is_study = true;
    const auto plan_of = [&](const std::string& solver) {
        return make_plan(parse_config("name = \"x\"\n[limits]\ntime = 5\n[[problems]]\nfamily = "
                                      "\"chain\"\n[[solvers]]\n" +
                                          solver,
                                      "some.toml"),
                         problems);
    };
    EXPECT_EQ(plan_of("solver = \"auto\"\ngap = 0.1\nseeds = [1, 2]\n").jobs.size(), 4u);
    for (const char* solver :
         {"solver = \"greedy\"\noptions = { rule = \"weight\" }\n",
          "solver = \"cbc\"\nstart = \"local-search\"\n", "solver = \"auto\"\nthreads = 2\n",
          "solver = \"auto\"\nrenamings = [0, 1]\n", "name = \"p\"\nprogram = \"p\"\n"}) {
        EXPECT_THROW(plan_of(solver), labeling::InputError) << solver;
        EXPECT_EQ(plan_of(std::string(solver) + "problems = [\"a\"]\n").jobs[0].problem, 0u);
    }
}

TEST(Plan, IsReadBackAsItWasWritten) {
    const Plan plan = make_plan(
        parse_config(kSmall + "options = { rule = \"gain\" }\nwork = 1000\n", "some.toml"),
        two_problems());
    EXPECT_EQ(to_json(plan_from(to_json(plan), "plan")).dump(), to_json(plan).dump());
}

}  // namespace
}  // namespace experiment
