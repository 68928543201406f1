// The commands that show what a campaign holds.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "commands.h"
#include "experiment/compare.h"
#include "experiment/database.h"
#include "experiment/library.h"
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

int report(const fs::path& folder, const fs::path& output) {
    const fs::path to = output.empty() ? folder / "report" : output;
    const ReportResult result = write_report(load_campaign(folder), to);
    if (!result.note.empty()) std::fprintf(stderr, "%s\n", result.note.c_str());
    for (const fs::path& file : result.files) std::printf("%s\n", file.c_str());
    for (const std::string& line : result.contradictions) {
        std::fprintf(stderr, "contradiction: %s\n", line.c_str());
    }
    return result.contradictions.empty() ? kDone : kViolation;
}

Command add_report(CLI::App& program) {
    struct Arguments {
        fs::path folder, output;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* parser = program.add_subcommand(
        "report",
        "Tables and plots of a campaign, finished or not; exit code 5 if runs contradict "
        "each other");
    parser->add_option("DIR", arguments->folder, "Folder of the campaign")->required();
    parser->add_option("-o,--output", arguments->output, "Folder for the report (DIR/report)");
    parser->footer("Example:\n  scalefcn-experiment report out/smoke");
    return {parser, [arguments] { return report(arguments->folder, arguments->output); }};
}

Command add_compare(CLI::App& program) {
    struct Arguments {
        fs::path before, after;
        bool is_json = false;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* parser = program.add_subcommand(
        "compare", "What changed from one campaign to another; exit code 5 on a regression");
    parser->add_option("A", arguments->before, "Folder of the earlier campaign")->required();
    parser->add_option("B", arguments->after, "Folder of the later campaign")->required();
    parser->add_flag("--json", arguments->is_json, "One JSON object instead of text");
    parser->footer("Example:\n  scalefcn-experiment compare out/before out/after");
    return {parser, [arguments] {
                const CampaignChange result = compare_campaigns(load_campaign(arguments->before),
                                                                load_campaign(arguments->after));
                const std::string text =
                    arguments->is_json ? to_json(result).dump(2) + "\n" : to_text(result);
                std::fputs(text.c_str(), stdout);
                return int{result.has_regression ? kViolation : kDone};
            }};
}

Command add_export(CLI::App& program) {
    struct Arguments {
        std::vector<fs::path> folders;
        fs::path output;
        LibraryOptions options;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* parser = program.add_subcommand(
        "export", "The problems of campaigns as a library, with what is known of them");
    parser->add_option("DIR", arguments->folders, "Folders of campaigns")->required();
    parser->add_option("-o,--output", arguments->output, "Folder of the library")->required();
    parser
        ->add_option("--proof-nodes", arguments->options.proof_nodes,
                     "Most nodes of the proof of each solved problem; 0: no proofs")
        ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 40))
        ->capture_default_str();
    parser->footer("Example:\n  scalefcn-experiment export out/core -o out/library");
    return {parser, [arguments] {
                std::vector<LibrarySource> sources;
                for (const fs::path& folder : arguments->folders) {
                    sources.push_back({load_campaign(folder), folder});
                }
                const LibraryResult result =
                    export_library(sources, arguments->output, arguments->options);
                std::printf("%zu problems, %zu proven, %zu with a certificate in %s\n",
                            result.problems, result.proven, result.certificates,
                            arguments->output.c_str());
                return int{kDone};
            }};
}

}  // namespace

std::vector<Command> add_view_commands(CLI::App& program) {
    return {add_list(program), add_show(program), add_report(program), add_compare(program),
            add_export(program)};
}

}  // namespace experiment
