// The commands that show what a campaign holds.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "commands.h"
#include "experiment/database.h"
#include "experiment/report.h"
#include "labeling/errors.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;

void list_run(const Plan& plan, const Job& job, const std::optional<Record>& record) {
    std::printf("%s  %-20s %-40s seed %llu renaming %llu  ", job.key.c_str(),
                plan.solvers[job.solver].name.c_str(), plan.problems[job.problem].name.c_str(),
                static_cast<unsigned long long>(job.seed),
                static_cast<unsigned long long>(job.renaming));
    if (!record) {
        std::printf("not run yet\n");
        return;
    }
    std::printf("%-14s", to_string(record->outcome).c_str());
    if (record->value) std::printf(" value %lld", static_cast<long long>(*record->value));
    if (record->bound) std::printf(" bound %lld", static_cast<long long>(*record->bound));
    std::printf(" cpu %.2f s\n", record->measures.user_seconds + record->measures.system_seconds);
}

Command add_list(CLI::App& program) {
    auto folder = std::make_shared<fs::path>();
    CLI::App* parser = program.add_subcommand("list", "All runs of a campaign, a line each");
    parser->add_option("DIR", *folder, "Folder of the campaign")->required();
    parser->footer("Example:\n  scalefcn-experiment list out/smoke");
    return {parser, [folder] {
                const CampaignRuns campaign = load_campaign(*folder);
                for (std::size_t k = 0; k < campaign.plan.jobs.size(); ++k) {
                    list_run(campaign.plan, campaign.plan.jobs[k], campaign.records[k]);
                }
                return int{kDone};
            }};
}

int show(const fs::path& folder, const std::string& key) {
    const CampaignRuns campaign = load_campaign(folder);
    const Plan& plan = campaign.plan;
    int found = 0;
    for (std::size_t k = 0; k < plan.jobs.size(); ++k) {
        if (!plan.jobs[k].key.starts_with(key)) continue;
        ++found;
        std::printf("%s\n", describe(plan, plan.jobs[k]).c_str());
        if (campaign.records[k]) {
            std::printf("%s\n", to_json(*campaign.records[k]).dump(2).c_str());
        } else {
            std::printf("not run yet\n");
        }
    }
    if (found == 0) throw labeling::InputError(folder.string() + ": no run " + key);
    return kDone;
}

Command add_show(CLI::App& program) {
    struct Arguments {
        fs::path folder;
        std::string key;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* parser = program.add_subcommand("show", "Everything that is known of a run");
    parser->add_option("DIR", arguments->folder, "Folder of the campaign")->required();
    parser->add_option("RUN", arguments->key, "Key of the run, or how it begins")->required();
    parser->footer("Example:\n  scalefcn-experiment show out/smoke 0123");
    return {parser, [arguments] { return show(arguments->folder, arguments->key); }};
}

}  // namespace

std::vector<Command> add_view_commands(CLI::App& program) {
    return {add_list(program), add_show(program)};
}

}  // namespace experiment
