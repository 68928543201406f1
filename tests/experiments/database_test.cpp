#include "experiment/database.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "experiment/estimate.h"
#include "experiment/folder_lock.h"
#include "labeling/errors.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_process.h"

namespace experiment {
namespace {

Record some_record(const std::string& key) {
    Record r;
    r.key = key;
    r.outcome = Outcome::Optimal;
    r.status = "optimal";
    r.stop_reason = "finished";
    r.message = "with 'quotes' and \"more\"";
    r.value = 1234567890123;
    r.bound = 1234567890124;
    r.work = 77;
    r.solver_seconds = 0.125;
    r.statistics = {{"nodes", 3}, {"gap", 0.5}};
    r.trace = {{0.5, 10, 5, std::nullopt}, {0.75, 20, std::nullopt, 9}};
    r.measures.wall_seconds = 1.5;
    r.measures.instructions = 42;
    r.measures.started_at = "2020-01-01T00:00:00Z";
    r.command = "labeling-solve x";
    r.provenance = {{"commit", "abc"}, {"instance", "f00"}, {"seed", "1"}};
    return r;
}

TEST(Database, GivesBackWhatItWasGiven) {
    const labeling::ScratchFolder folder;
    Database(folder.path()).store(some_record("a"));
    const auto records = Database(folder.path()).records();
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(to_json(records[0]).dump(), to_json(some_record("a")).dump());
}

TEST(Database, KeepsTheFirstRecordOfARun) {
    const labeling::ScratchFolder folder;
    Database database(folder.path());
    EXPECT_TRUE(database.store(some_record("a")));
    Record other = some_record("a");
    other.value = 1;
    other.trace.clear();
    EXPECT_FALSE(database.store(other));
    ASSERT_EQ(database.records().size(), 1u);
    EXPECT_EQ(database.records()[0].value, some_record("a").value);
    EXPECT_EQ(database.records()[0].trace.size(), 2u);
}

TEST(Database, SaysWhatIsWrongWithAFileThatIsNone) {
    const labeling::ScratchFolder folder;
    labeling::write_text_file(folder.path() / "campaign.sqlite", std::string(5000, 'x'));
    try {
        Database database(folder.path());
        FAIL() << "accepted";
    } catch (const labeling::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("campaign.sqlite: file is not a database"),
                  std::string::npos)
            << error.what();
    }
}

/// How many records somebody reads who may write nothing there; -1: an error.
int records_for_a_stranger(const std::filesystem::path& folder) {
    ::chmod(folder.c_str(), 0555);
    const pid_t child = ::fork();
    if (child == 0) {
        constexpr uid_t kNobody = 65534;
        if (::geteuid() == 0 && ::setresuid(kNobody, kNobody, kNobody) != 0) ::_exit(100);
        try {
            ::_exit(static_cast<int>(Database(folder, Database::Access::Read).records().size()));
        } catch (const labeling::InputError&) {
            ::_exit(101);
        }
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ::chmod(folder.c_str(), 0755);
    return WIFEXITED(status) && WEXITSTATUS(status) < 100 ? WEXITSTATUS(status) : -1;
}

TEST(Database, IsReadWhereNobodyCanWrite) {
    const labeling::ScratchFolder folder;
    EXPECT_EQ(records_for_a_stranger(folder.path()), 0);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "campaign.sqlite"));
    // A name that an address would not hold as it is.
    const auto home = folder.path() / "50% of it?";
    std::filesystem::create_directories(home);
    ::chmod(folder.path().c_str(), 0755);
    Database(home).store(some_record("a"));
    EXPECT_EQ(records_for_a_stranger(home), 1);
    // While somebody else writes.
    Database writer(home);
    writer.store(some_record("b"));
    EXPECT_EQ(Database(home, Database::Access::Read).records().size(), 2u);
}

TEST(Database, WithoutTablesHasNoRecords) {
    const labeling::ScratchFolder folder;
    labeling::write_text_file(folder.path() / "campaign.sqlite", "");
    EXPECT_TRUE(Database(folder.path(), Database::Access::Read).records().empty());
    labeling::write_text_file(folder.path() / "campaign.sqlite", std::string(5000, 'x'));
    EXPECT_THROW(Database(folder.path(), Database::Access::Read), labeling::InputError);
}

TEST(Record, IsReadBackFromJson) {
    const Record r = some_record("a");
    EXPECT_EQ(to_json(record_from(to_json(r), "file")).dump(), to_json(r).dump());
    auto broken = to_json(r);
    broken.erase("measures");
    EXPECT_THROW(record_from(broken, "file"), labeling::InputError);
    broken = to_json(r);
    broken["outcome"] = "splendid";
    EXPECT_THROW(record_from(broken, "file"), labeling::InputError);
}

TEST(FolderLock, IsHeldByOne) {
    const labeling::ScratchFolder folder;
    {
        const FolderLock lock(folder.path());
        EXPECT_THROW(FolderLock second(folder.path()), labeling::InputError);
    }
    EXPECT_NO_THROW(FolderLock third(folder.path()));
}

TEST(RemainingTime, CountsLimitsFirstAndMeansLater) {
    Plan plan;
    plan.solvers.resize(1);
    plan.solvers[0].limits.seconds = 10;
    plan.solvers[0].limits.margin_seconds = 1;
    RemainingTime remaining(plan, 2);
    std::vector<Job> jobs;
    for (std::size_t problem = 0; problem < 6; ++problem) jobs.push_back({"k", problem, 0, 1, 0});
    for (const Job& job : jobs) remaining.is_left(job);
    EXPECT_EQ(remaining.bounds().first, 0);
    EXPECT_NEAR(remaining.bounds().second, 6 * 12.1 / 2, 1e-9);
    remaining.has_ended(jobs[0], 3);
    remaining.has_ended(jobs[1], 3);
    // Two equal times: four runs of three seconds, two at a time.
    EXPECT_NEAR(remaining.bounds().first, 6, 1e-9);
    EXPECT_NEAR(remaining.bounds().second, 6, 1e-9);
    // Times that differ say little about a single run that is left, and never more than the limit.
    remaining.has_ended(jobs[2], 9);
    remaining.has_ended(jobs[3], 1);
    remaining.has_ended(jobs[4], 2);
    EXPECT_EQ(remaining.bounds().first, 0);
    EXPECT_GT(remaining.bounds().second, (3 + 3 + 9 + 1 + 2) / 5.0);
    EXPECT_LE(remaining.bounds().second, 12.1 / 2);
    remaining.has_ended(jobs[5], 2);
    EXPECT_EQ(remaining.bounds(), (std::pair<double, double>{0, 0}));
}

TEST(RemainingTime, KnowsHowHardAProblemWasForTheSolver) {
    Plan plan;
    plan.solvers.resize(2);
    for (auto& solver : plan.solvers) solver.limits.seconds = 100;
    RemainingTime remaining(plan, 1);
    const Job hard{"a", 0, 0, 1, 0}, easy{"b", 1, 0, 1, 0}, other{"c", 0, 1, 1, 0};
    for (int k = 0; k < 5; ++k) remaining.is_left(hard);
    for (int k = 0; k < 9; ++k) remaining.is_left(easy);
    for (int k = 0; k < 9; ++k) remaining.has_ended(easy, 1);
    remaining.has_ended(hard, 80);
    // Four runs like the one of 80 seconds, though nine of ten took one second.
    EXPECT_LE(remaining.bounds().first, 4 * 80);
    EXPECT_GT(remaining.bounds().first, 4 * 40);
    EXPECT_GE(remaining.bounds().second, 4 * 80);
    EXPECT_LE(remaining.bounds().second, 4 * 110.2);
    const double before = remaining.bounds().first;
    remaining.is_left(other);  // another solver's times say nothing
    EXPECT_EQ(remaining.bounds().first, before);
    EXPECT_GT(remaining.bounds().second, 4 * 80 + 100);
}

}  // namespace
}  // namespace experiment
