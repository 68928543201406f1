// The commands that make runs.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "experiment/campaign.h"
#include "experiment/execute.h"
#include "experiment/study.h"
#include "labeling/errors.h"
#include "tools/stop_at_signals.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;

std::string duration(double seconds) {
    char text[40];
    if (seconds < 100) {
        std::snprintf(text, sizeof text, "%.0f s", seconds);
    } else if (seconds < 6000) {
        std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
    } else {
        std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
    }
    return text;
}

/// A line that is redrawn on a terminal; elsewhere a line now and then, so that a log stays short.
class ProgressLine {
public:
    explicit ProgressLine(bool is_quiet) : is_quiet_(is_quiet), is_terminal_(::isatty(2) != 0) {}
    ~ProgressLine() {
        if (has_drawn_) std::fprintf(stderr, "\n");
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const CampaignProgress& p) {
        if (is_quiet_) return;
        const auto now = std::chrono::steady_clock::now();
        constexpr std::chrono::seconds kBetween(10);
        const bool is_end = p.done == p.total;
        if (!is_terminal_ && !is_end && has_told_ && now - last_ < kBetween) return;
        last_ = now;
        has_told_ = true;
        const std::string left =
            is_end ? "done"
                   : "left: " + duration(p.least_seconds) + " to " + duration(p.most_seconds);
        const std::string last = p.last.empty() ? "" : "; " + p.last;
        std::fprintf(stderr, is_terminal_ ? "\r\033[K[%zu/%zu] %s%s" : "[%zu/%zu] %s%s\n", p.done,
                     p.total, left.c_str(), last.c_str());
        has_drawn_ = is_terminal_;
    }

private:
    const bool is_quiet_, is_terminal_;
    bool has_drawn_ = false, has_told_ = false;
    std::chrono::steady_clock::time_point last_;
};

struct RunArguments {
    fs::path config, folder;
    int jobs = 1;
    bool is_unpinned = false, is_quiet = false;
    std::vector<std::string> again;
};

void tell_line(bool is_quiet, const std::string& text) {
    if (!is_quiet) std::fprintf(stderr, "%s\n", text.c_str());
}

void prepare(const RunArguments& arguments) {
    prepare_campaign(arguments.config, arguments.folder,
                     [&](const std::string& text) { tell_line(arguments.is_quiet, text); });
}

int go_on(const RunArguments& arguments) {
    CampaignOptions options;
    options.jobs = arguments.jobs;
    options.is_pinned = !arguments.is_unpinned;
    for (const std::string& name : arguments.again) options.again.insert(outcome_from(name));
    options.stop = labeling::stop_at_signals();
    CampaignOutcome outcome;
    {
        ProgressLine line(arguments.is_quiet);
        options.on_progress = [&](const CampaignProgress& p) { line.show(p); };
        outcome = continue_campaign(arguments.folder, options);
    }
    std::printf("%zu of %zu runs done in %s\n", outcome.done, outcome.total,
                arguments.folder.c_str());
    if (outcome.done == outcome.total) return kDone;
    tell_line(arguments.is_quiet,
              "interrupted; go on with: scalefcn-experiment resume " + arguments.folder.string());
    return kNotFinished;
}

void add_run_options(CLI::App& parser, RunArguments& arguments) {
    parser
        .add_option("-j,--jobs", arguments.jobs,
                    "Runs at the same time; more than one disturb each other's times")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    parser.add_flag("--no-pin", arguments.is_unpinned, "Do not pin runs to processors");
    parser.add_flag("-q,--quiet", arguments.is_quiet, "No progress");
}

Command add_run(CLI::App& program) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* parser = program.add_subcommand("run", "Prepare a campaign and make all its runs");
    parser->add_option("CONFIG", arguments->config, "TOML file")->required();
    parser->add_option("-o,--output", arguments->folder, "New folder for the campaign")->required();
    add_run_options(*parser, *arguments);
    parser->footer("Example:\n  scalefcn-experiment run smoke.toml -o out/smoke");
    return {parser, [arguments] {
                prepare(*arguments);
                return go_on(*arguments);
            }};
}

Command add_resume(CLI::App& program) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* parser =
        program.add_subcommand("resume", "Make the runs that a campaign does not hold yet");
    parser->add_option("DIR", arguments->folder, "Folder of the campaign")->required();
    parser
        ->add_option("--again", arguments->again,
                     "Also make again what ended so: missing, once it is installed; "
                     "not-applicable, with a larger licence")
        ->check(CLI::IsMember({"missing", "not-applicable"}))
        ->delimiter(',');
    add_run_options(*parser, *arguments);
    parser->footer("Example:\n  scalefcn-experiment resume out/smoke");
    return {parser, [arguments] { return go_on(*arguments); }};
}

Command add_plan(CLI::App& program) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* parser = program.add_subcommand(
        "plan", "Prepare a campaign without a run, and print the keys of its runs");
    parser->add_option("CONFIG", arguments->config, "TOML file")->required();
    parser->add_option("-o,--output", arguments->folder, "New folder for the campaign")->required();
    parser->add_flag("-q,--quiet", arguments->is_quiet, "No progress, no keys");
    parser->footer("Example:\n  scalefcn-experiment plan core.toml -o out/core");
    return {parser, [arguments] {
                prepare(*arguments);
                if (arguments->is_quiet) return int{kDone};
                for (const Job& job : read_plan(arguments->folder).jobs) {
                    std::printf("%s\n", job.key.c_str());
                }
                return int{kDone};
            }};
}

struct ExecuteArguments {
    fs::path folder;
    std::string key;
    ExecuteOptions options;
};

bool has_record(const fs::path& folder, const std::string& key) {
    try {
        return read_record(folder, key).has_value();
    } catch (const labeling::InputError&) {
        return false;  // a damaged one
    }
}

int execute_one(const ExecuteArguments& arguments) {
    const Plan plan = read_plan(arguments.folder);
    const auto job = std::find_if(plan.jobs.begin(), plan.jobs.end(),
                                  [&](const Job& j) { return j.key == arguments.key; });
    if (job == plan.jobs.end()) {
        throw labeling::InputError(arguments.folder.string() + ": no run " + arguments.key);
    }
    ExecuteOptions options = arguments.options;
    options.stop = labeling::stop_at_signals(true);
    const auto record = execute(plan, *job, arguments.folder, options);
    if (!record) return kNotFinished;
    // The first one counts. A second one comes from a process that was given up and made again.
    if (!has_record(arguments.folder, job->key)) write_record(*record, arguments.folder);
    return kDone;
}

Command add_execute(CLI::App& program) {
    auto arguments = std::make_shared<ExecuteArguments>();
    CLI::App* parser = program.add_subcommand(
        "execute", "Make one run of a prepared campaign; its record goes to DIR/records/KEY.json");
    parser->add_option("DIR", arguments->folder, "Folder of the campaign")->required();
    parser->add_option("KEY", arguments->key, "As 'list' shows it")->required();
    parser->add_option("--processor", arguments->options.processor, "Pin to this one; -1: do not")
        ->check(CLI::Range(-1, 1 << 16))
        ->capture_default_str();
    parser->footer("Example:\n  scalefcn-experiment execute out/smoke 0123456789abcdef");
    return {parser, [arguments] { return execute_one(*arguments); }};
}

Command add_merge(CLI::App& program) {
    auto folder = std::make_shared<fs::path>();
    CLI::App* parser =
        program.add_subcommand("merge", "Take records that were made elsewhere into the database");
    parser->add_option("DIR", *folder, "Folder of the campaign")->required();
    parser->footer("Example:\n  scalefcn-experiment merge out/core");
    return {parser, [folder] {
                const Plan plan = read_plan(*folder);
                const std::size_t count = merge_records(plan, *folder);
                std::printf("%zu new records\n", count);
                return int{kDone};
            }};
}

struct StudyArguments {
    StudyRequest request;
    fs::path segments, result;
};

Command add_study(CLI::App& program) {
    auto a = std::make_shared<StudyArguments>();
    CLI::App* parser = program.add_subcommand(
        "study-run", "Adapt, remesh and measure one mesh with one solver; what a study runs");
    parser->add_option("MESH", a->request.mesh, "Triangle mesh")->required();
    parser->add_option("--scale", a->request.scale, "As for scalefcn")->required();
    parser->add_option("--detector", a->request.detector, "Method, or vsa and patches")->required();
    parser->add_option("--mode", a->request.mode, "best, paper")->required();
    parser->add_option("--target", a->request.target, "tri, quad")->required();
    parser->add_option("--options", a->request.options, "More options of scalefcn run");
    parser->add_option("--solver", a->request.solver, "Solver of the adaptation")->required();
    parser->add_option("--seed", a->request.seed, "Seed")->required();
    parser->add_option("--work", a->request.work, "Ticks");
    parser->add_option("--gap", a->request.gap, "Relative gap");
    parser->add_option("-o,--output", a->segments, "File of the kept segments")->required();
    parser->add_option("--result", a->result, "File of the measures")->required();
    parser->footer(
        "Example:\n  scalefcn-experiment study-run fandisk.off --scale 2% --detector 'vsa 150' "
        "--mode best --target tri --solver greedy --seed 1 -o segments.txt --result result.json");
    return {parser, [a] {
                run_study(a->request, a->segments, a->result);
                return int{kDone};
            }};
}

}  // namespace

std::vector<Command> add_run_commands(CLI::App& program) {
    return {add_run(program),     add_resume(program), add_plan(program),
            add_execute(program), add_merge(program),  add_study(program)};
}

std::vector<Command> add_commands(CLI::App& program) {
    auto commands = add_run_commands(program);
    for (const Command& command : add_view_commands(program)) commands.push_back(command);
    return commands;
}

}  // namespace experiment
