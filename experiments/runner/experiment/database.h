#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "experiment/campaign_runs.h"
#include "experiment/plan.h"
#include "experiment/record.h"

struct sqlite3;

namespace experiment {

/// FOLDER/campaign.sqlite (write-ahead log): tables campaign, problems, solvers, jobs, runs, trace,
/// provenance; docs/experiments.md describes them. Every function throws InputError that names the
/// file and SQLite's reason when something cannot be read or written, a full disk among them; what
/// was complete before stays.
class Database {
public:
    enum class Access {
        Write,  ///< it is made where it is not there
        Read    ///< it may lie where nobody can write; with no file, there are no records
    };
    explicit Database(const std::filesystem::path& folder, Access access = Access::Write);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    /// Problems, solvers and jobs; in one transaction, again at will.
    void store_plan(const Plan& plan);
    /// A run with its trace, in one transaction. A run that is there already is left as it is;
    /// false then.
    bool store(const Record& record);
    /// Forgets a run, in one transaction.
    void erase(const std::string& key);
    std::set<std::string> finished_keys() const;
    std::vector<Record> records() const;

private:
    void open_to_write();
    void open_to_read();

    sqlite3* handle_ = nullptr;  ///< none: nothing to read
    std::string name_;
};

/// Plan and records of a campaign's folder.
CampaignRuns load_campaign(const std::filesystem::path& folder);

}  // namespace experiment
