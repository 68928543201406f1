#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "experiment/plan.h"
#include "experiment/record.h"

namespace experiment {

struct ExecuteOptions {
    int processor = -1;  ///< pin to this one; -1: leave it to the system
    /// UTC for `started_at`; tests inject their own. Durations never come from it.
    std::function<std::string()> calendar;
    std::stop_token stop;  ///< ends the run, of which nothing is kept then
};

/// Makes one run of a campaign: starts the solver in a process of its own, holds it to its limits
/// from outside, checks its labels exactly, and judges. Must be called in a process of its own, as
/// `scalefcn-experiment execute` is: it sets environment, processor and process table of the whole
/// process, and ends everything below it. Nothing when it was told to stop. Throws InputError when
/// the campaign's files are damaged.
std::optional<Record> execute(const Plan& plan, const Job& job, const std::filesystem::path& folder,
                              const ExecuteOptions& options = {});

/// The record of a run that ends every process that makes it: a crash.
Record lost_run(const Plan& plan, const Job& job, const std::string& message);

/// FOLDER/records/KEY.json.
std::filesystem::path record_file(const std::filesystem::path& folder, const std::string& key);
/// Atomically. Throws InputError when it cannot be written.
void write_record(const Record& record, const std::filesystem::path& folder);
/// Nothing when there is none. Throws InputError on a damaged one.
std::optional<Record> read_record(const std::filesystem::path& folder, const std::string& key);

}  // namespace experiment
