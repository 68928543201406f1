// The smoke campaign as anyone would run it, and what is made of it: list, show, report, export.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "campaign_support.h"
#include "labeling/formats.h"
#include "labeling/proof_checker.h"

namespace experiment::testing {
namespace {

const std::string kSources = SCALEFCN_SOURCE_DIR;

bool has_scalefcn() { return fs::exists(SCALEFCN_BINARY_DIR "/bin/scalefcn"); }

class Smoke : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        if (!has_scalefcn()) return;
        folder_ = new labeling::ScratchFolder;
        made_ = run_experiment(
            folder_->path(),
            {"run", kSources + "/experiments/corpora/smoke.toml", "-o", "smoke", "-q", "-j", "2"});
    }
    static void TearDownTestSuite() {
        delete folder_;
        folder_ = nullptr;
    }
    void SetUp() override {
        if (folder_ == nullptr) GTEST_SKIP() << "scalefcn was not built: no meshes to adapt";
        ASSERT_EQ(made_.outcome.exit_code, 0) << made_.errors;
    }
    static labeling::ScratchFolder* folder_;
    static ProgramResult made_;
};

labeling::ScratchFolder* Smoke::folder_ = nullptr;
ProgramResult Smoke::made_;

TEST_F(Smoke, EveryRunIsSolvedAndExactSolversAgree) {
    const CampaignRuns campaign = load_campaign(folder_->path() / "smoke");
    std::map<std::size_t, std::int64_t> optimum;
    for (std::size_t k = 0; k < campaign.plan.jobs.size(); ++k) {
        const Job& job = campaign.plan.jobs[k];
        ASSERT_TRUE(campaign.records[k]) << describe(campaign.plan, job);
        const Record& record = *campaign.records[k];
        EXPECT_TRUE(is_solved(record.outcome)) << describe(campaign.plan, job) << record.message;
        if (record.outcome != Outcome::Optimal) continue;
        const auto [it, is_new] = optimum.emplace(job.problem, *record.value);
        EXPECT_EQ(it->second, *record.value) << describe(campaign.plan, job);
    }
    EXPECT_EQ(optimum.size(), campaign.plan.problems.size());
    for (const auto& [problem, value] : optimum) {
        const auto known = campaign.plan.problems[problem].optimum;
        EXPECT_EQ(value, known.value_or(value)) << campaign.plan.problems[problem].name;
    }
}

TEST_F(Smoke, RecordsSayWhereTheyComeFrom) {
    for (const Record& r : Database(folder_->path() / "smoke").records()) {
        for (const char* key : {"commit", "changed_sources", "compiler", "flags", "processor",
                                "solve_program_hash", "instance", "seed", "sqlite"}) {
            EXPECT_FALSE(r.provenance.value(key, std::string()).empty()) << key;
        }
        EXPECT_FALSE(r.command.empty());
        EXPECT_GT(r.measures.wall_seconds, 0);
        EXPECT_GT(r.measures.peak_mib, 0);
    }
}

TEST_F(Smoke, ListShowsEveryRunAndShowOne) {
    const auto list = run_experiment(folder_->path(), {"list", "smoke"});
    const Plan plan = read_plan(folder_->path() / "smoke");
    EXPECT_EQ(static_cast<std::size_t>(std::count(list.output.begin(), list.output.end(), '\n')),
              plan.jobs.size());
    const auto show = run_experiment(folder_->path(), {"show", "smoke", plan.jobs[0].key});
    EXPECT_NE(show.output.find(describe(plan, plan.jobs[0])), std::string::npos);
    EXPECT_EQ(run_experiment(folder_->path(), {"show", "smoke", "nothing"}).outcome.exit_code, 3);
}

TEST_F(Smoke, ReportIsWritten) {
    const auto result = run_experiment(folder_->path(), {"report", "smoke", "-o", "report"});
    EXPECT_EQ(result.outcome.exit_code, 0) << result.errors;
    for (const char* file : {"report.md", "report.html", "runs.csv"}) {
        EXPECT_GT(content(folder_->path() / "report" / file).size(), 500u) << file;
    }
}

TEST_F(Smoke, TheLibraryHoldsWhatItSays) {
    const auto result = run_experiment(
        folder_->path(), {"export", "smoke", "-o", "library", "--proof-nodes", "2000"});
    ASSERT_EQ(result.outcome.exit_code, 0) << result.errors;
    const fs::path library = folder_->path() / "library";
    const auto manifest = nlohmann::json::parse(content(library / "manifest.json"));
    ASSERT_EQ(manifest.size(), read_plan(folder_->path() / "smoke").problems.size());
    int certificates = 0;
    for (const auto& entry : manifest) {
        const std::string name = entry.at("name");
        const auto problem = labeling::read_problem(library / (name + ".lab.gz"));
        const auto solution = labeling::read_solution(library / (name + ".sol.gz"), problem);
        const auto check = labeling::check_solution(problem, solution);
        EXPECT_TRUE(check.is_feasible) << name;
        EXPECT_EQ(check.value, entry.at("best_value").get<std::int64_t>()) << name;
        EXPECT_EQ(labeling::read_problem(library / (name + ".mps.gz")).label_count(),
                  problem.label_count());
        if (!entry.at("has_certificate").get<bool>()) continue;
        ++certificates;
        const auto proof =
            labeling::check_proof(labeling::format_problem(problem, labeling::ProblemFormat::Opb),
                                  labeling::read_text_file(library / (name + ".pbp.gz")));
        EXPECT_TRUE(proof.is_valid) << name << ": " << proof.message;
    }
    EXPECT_GT(certificates, 0);
    EXPECT_NE(content(library / "scoreboard.md").find("| auto |"), std::string::npos);
}

TEST(Library, TwoContentsOfOneNameAreTwoProblems) {
    const labeling::ScratchFolder folder;
    for (const char* version : {"1", "2"}) {
        labeling::write_text_file(folder.path() / "p.lab",
                                  std::string("p labeling 1 0 0 0\nl 1 ") + version + "\n");
        labeling::write_text_file(
            folder.path() / "c.toml",
            "name = \"c\"\n[[problems]]\nfiles = \"p.lab\"\n[[solvers]]\nsolver = \"auto\"\n");
        run_experiment(folder.path(), {"run", "c.toml", "-o", version, "-q"});
    }
    const auto result = run_experiment(folder.path(), {"export", "1", "2", "1", "-o", "library"});
    ASSERT_EQ(result.outcome.exit_code, 0) << result.errors;
    const fs::path library = folder.path() / "library";
    const auto manifest = nlohmann::json::parse(content(library / "manifest.json"));
    ASSERT_EQ(manifest.size(), 2u);
    std::set<std::int64_t> values;
    for (const auto& entry : manifest) {
        const std::string name = entry.at("name");
        const auto problem = labeling::read_problem(library / (name + ".lab.gz"));
        const auto solution = labeling::read_solution(library / (name + ".sol.gz"), problem);
        EXPECT_TRUE(labeling::check_solution(problem, solution).value_matches) << name;
        EXPECT_EQ(entry.at("best_value"), entry.at("labels_value")) << name;
        EXPECT_EQ(entry.at("best_value").get<std::int64_t>(), solution.value) << name;
        values.insert(solution.value);
    }
    EXPECT_EQ(values, (std::set<std::int64_t>{1, 2}));
    // Two campaigns of one problem: no second group, so nothing can be told.
    const auto compared = run_experiment(folder.path(), {"compare", "1", "1"});
    EXPECT_EQ(compared.outcome.exit_code, 0);
    EXPECT_NE(compared.output.find("cannot tell"), std::string::npos) << compared.output;
}

TEST(Report, AFalseClaimOfOptimalityStopsItInRed) {
    const labeling::ScratchFolder folder;
    labeling::write_text_file(folder.path() / "liar.sh",
                              "printf 'v 0\\n' > $1; echo '{\"status\": \"optimal\"}' > $2\n");
    labeling::write_text_file(
        folder.path() / "c.toml",
        "name = \"lies\"\n[limits]\ntime = 5\n[[problems]]\nfamily = \"unit-disks\"\n"
        "labels = 30\n[[solvers]]\nsolver = \"auto\"\n[[solvers]]\nname = \"liar\"\n"
        "program = \"sh " +
            (folder.path() / "liar.sh").string() + " {solution} {result}\"\n");
    ASSERT_EQ(run_experiment(folder.path(), {"run", "c.toml", "-o", "c"}).outcome.exit_code, 0);
    const auto report = run_experiment(folder.path(), {"report", "c"});
    EXPECT_EQ(report.outcome.exit_code, 5);
    EXPECT_NE(report.errors.find("liar"), std::string::npos) << report.errors;
    EXPECT_EQ(run_experiment(folder.path(), {"export", "c", "-o", "l"}).outcome.exit_code, 3);
}

TEST(Wrappers, AnIndependentSetBecomesALabeling) {
    if (!has_scalefcn()) GTEST_SKIP() << "scalefcn was not built: nothing converts to a graph";
    const labeling::ScratchFolder folder;
    // Labels 1, 2 in conflict, a bonus on 1 and 3: vertex 4 is the bonus.
    labeling::write_text_file(folder.path() / "p.lab",
                              "p labeling 3 1 1 0\nl 1 5\nl 2 4\nl 3 2\nx 1 2\nb 1 3 10\n");
    labeling::write_text_file(
        folder.path() / "c.toml",
        "name = \"sets\"\n[limits]\ntime = 20\n[[problems]]\nfiles = \"p.lab\"\n[[solvers]]\n"
        "name = \"numbers\"\nprogram = 'python3 {sources}/experiments/wrappers/independent_set.py "
        "{problem} {solution} --convert {programs}/scalefcn -- sh -c \"echo 4 > $0\" %set'\n"
        "[[solvers]]\nname = \"flags\"\nprogram = 'python3 "
        "{sources}/experiments/wrappers/independent_set.py {problem} {solution} --convert "
        "{programs}/scalefcn --flags -- sh -c \"printf 0\\\\n1\\\\n1\\\\n0\\\\n > $0\" %set'\n"
        "[[solvers]]\nname = \"absent\"\nprogram = 'python3 "
        "{sources}/experiments/wrappers/independent_set.py {problem} {solution} --convert "
        "{programs}/scalefcn -- no-such-solver %graph'\n");
    const auto result = run_experiment(folder.path(), {"run", "c.toml", "-o", "c"});
    ASSERT_EQ(result.outcome.exit_code, 0) << result.errors;
    const CampaignRuns campaign = load_campaign(folder.path() / "c");
    for (std::size_t k = 0; k < campaign.records.size(); ++k) {
        const std::string& name = campaign.plan.solvers[campaign.plan.jobs[k].solver].name;
        const Record& record = *campaign.records[k];
        if (name == "absent") {
            EXPECT_EQ(record.outcome, Outcome::Missing) << record.message;
        } else {
            EXPECT_EQ(record.value, name == "numbers" ? 17 : 6) << name << ": " << record.message;
        }
    }
}

}  // namespace
}  // namespace experiment::testing
