#include "experiment/config.h"

#include <algorithm>
#include <set>

#include "experiment/config_table.h"
#include "experiment/run_command.h"
#include "labeling/errors.h"
#include "labeling/generators.h"
#include "labeling/text_file.h"

namespace experiment {
namespace {

constexpr double kMostSeconds = 1e7;
constexpr std::int64_t kMostTicks = std::int64_t{1} << 52;

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

/// Names become file names and table cells.
void require_name(const ConfigTable& table, const toml::node* where, const std::string& name) {
    const bool is_plain = std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '-' || c == '_' || c == '.' || c == '+' || c == ' ' || c == '(' || c == ')';
    });
    if (!is_plain || name.size() > 60) {
        table.fail(where, "name '" + name + "': letters, digits and -_.+() only, at most 60");
    }
}

Limits limits_from(ConfigTable& table, Limits limits) {
    if (table.has("time")) limits.seconds = table.real("time", 1, 1e-3, kMostSeconds);
    if (table.has("work")) limits.ticks = table.integer("work", 1, 1, kMostTicks);
    limits.gap = table.real("gap", limits.gap, 0, 1);
    limits.memory_mib = table.mebibytes("memory", limits.memory_mib);
    limits.disk_mib = table.mebibytes("disk", limits.disk_mib);
    limits.margin_seconds = table.real("margin", limits.margin_seconds, 0, kMostSeconds);
    return limits;
}

/// What solvers inherit unless they say otherwise.
struct Defaults {
    Limits limits;
    std::vector<std::uint64_t> seeds{1}, renamings{0};
    int threads = 1;
};

/// A program with a relative path is seen from the configuration's folder, like other files; one
/// without a slash is looked up in PATH.
std::string with_own_folder(const std::string& command, const std::filesystem::path& config) {
    const bool is_quoted = command.starts_with('"') || command.starts_with('\'');
    const std::size_t begin = is_quoted ? 1 : 0;
    const std::size_t end =
        std::min(is_quoted ? command.find(command[0], begin) : command.find_first_of(" \t[{"),
                 command.size());
    const std::string program = command.substr(begin, end - begin);
    if (program.starts_with('/') || program.find('/') == std::string::npos) return command;
    const auto whole = (std::filesystem::absolute(config).parent_path() / program);
    const std::string rest = command.substr(std::min(command.size(), end + begin));
    return '"' + whole.lexically_normal().string() + '"' + rest;
}

SolverConfig solver_from(ConfigTable table, const Defaults& defaults, const std::string& file) {
    SolverConfig solver;
    solver.solver = table.text("solver", "");
    solver.program = table.text("program", "");
    if (solver.solver.empty() == solver.program.empty()) {
        table.fail(nullptr, "a solver needs either 'solver' or 'program'");
    }
    solver.program = with_own_folder(solver.program, file);
    solver.name = table.text("name", solver.solver);
    if (solver.name.empty()) table.fail(nullptr, "a program needs a name");
    require_name(table, table.node("name"), solver.name);
    if (const toml::table* options = table.table("options")) {
        ConfigTable reader(*options, file, "options");
        for (const std::string& key : reader.keys()) {
            const auto values = reader.plain_values(key.c_str());
            if (values.size() != 1) reader.fail(options, "option " + key + ": one value");
            solver.options[key] = values[0];
        }
        if (!solver.program.empty()) reader.fail(options, "a program has no options: its command");
    }
    solver.start = table.text("start", "");
    if (!is_one_of(solver.start, {"", "local-search"})) {
        table.fail(table.node("start"), "start: only \"local-search\" is known");
    }
    solver.threads = static_cast<int>(table.integer("threads", defaults.threads, 1, 1024));
    solver.limits = limits_from(table, defaults.limits);
    if (!solver.limits.seconds && !solver.program.empty()) {
        table.fail(nullptr, "a program needs a time limit: it counts no ticks");
    }
    if (!solver.program.empty()) {
        try {
            check_command(solver);
        } catch (const labeling::InputError& error) {
            table.fail(table.node("program"), error.what());
        }
    }
    solver.seeds = table.seeds("seeds", defaults.seeds);
    solver.renamings = table.seeds("renamings", defaults.renamings);
    solver.problems = table.texts("problems", {});
    table.finish();
    return solver;
}

void read_family(ConfigTable& table, ProblemConfig& problems) {
    problems.family = table.required_text("family");
    const auto families = labeling::problem_families();
    if (std::find(families.begin(), families.end(), problems.family) == families.end()) {
        std::string names;
        for (const std::string& name : families) names += (names.empty() ? "" : ", ") + name;
        table.fail(table.node("family"),
                   "unknown family '" + problems.family + "'; known: " + names);
    }
    for (const std::string& key : table.keys()) {
        if (key == "family" || key == "group" || key == "drop-rules") continue;
        problems.family_options[key] = table.plain_values(key.c_str());
    }
}

void require_words(ConfigTable& table, const char* key, const std::vector<std::string>& words,
                   std::initializer_list<const char*> known) {
    for (const std::string& word : words) {
        if (!is_one_of(word, known)) {
            table.fail(table.node(key), std::string(key) + ": unknown '" + word + "'");
        }
    }
}

void read_meshes(ConfigTable& table, ProblemConfig& problems) {
    problems.meshes = table.texts("meshes", {});
    problems.scales = table.texts("scales", {});
    if (problems.scales.empty()) table.fail(nullptr, "problems from meshes need scales");
    problems.detectors = table.texts("detectors", {"auto"});
    problems.modes = table.texts("modes", {"best"});
    require_words(table, "modes", problems.modes, {"best", "paper"});
    problems.targets = table.texts("targets", {"tri"});
    require_words(table, "targets", problems.targets, {"tri", "quad"});
    problems.adapt_options = table.texts("adapt-options", {});
    problems.iterations = table.text("iterations", "all");
    require_words(table, "iterations", {problems.iterations}, {"all", "first"});
    problems.is_study = table.flag("study", false);
}

ProblemConfig problems_from(ConfigTable table) {
    ProblemConfig problems;
    problems.line = table.line();
    const int kinds = table.has("files") + table.has("family") + table.has("meshes");
    if (kinds != 1) table.fail(nullptr, "problems need one of files, family and meshes");
    if (table.has("files")) problems.files = table.texts("files", {});
    if (table.has("family")) read_family(table, problems);
    if (table.has("meshes")) read_meshes(table, problems);
    problems.group = table.text("group", "");
    problems.drops_rules = table.flag("drop-rules", false);
    table.finish();
    return problems;
}

ReportConfig report_from(ConfigTable table, const std::vector<SolverConfig>& solvers) {
    ReportConfig report;
    report.baseline = table.text("baseline", "");
    const bool is_known = std::any_of(solvers.begin(), solvers.end(), [&](const SolverConfig& s) {
        return s.name == report.baseline;
    });
    if (!report.baseline.empty() && !is_known) {
        table.fail(table.node("baseline"), "baseline: no solver '" + report.baseline + "'");
    }
    report.floor_seconds = table.real("floor", report.floor_seconds, 1e-6, 1e6);
    report.shift_seconds = table.real("shift", report.shift_seconds, 1e-6, 1e6);
    report.resamplings = static_cast<int>(table.integer("resamplings", 1000, 100, 1000000));
    report.clock = table.text("clock", report.clock);
    if (!is_one_of(report.clock, {"cpu", "wall"})) {
        table.fail(table.node("clock"), "clock: cpu or wall");
    }
    table.finish();
    return report;
}

CampaignConfig config_from(const toml::table& root, const std::filesystem::path& file) {
    const std::string source = file.string();
    CampaignConfig config;
    ConfigTable table(root, source, "the campaign");
    config.name = table.required_text("name");
    require_name(table, table.node("name"), config.name);
    config.description = table.text("description", "");
    config.shuffle = static_cast<std::uint64_t>(table.integer("shuffle", 1, 0, kMostTicks));
    Defaults defaults;
    if (const toml::table* limits = table.table("limits")) {
        ConfigTable reader(*limits, source, "limits");
        defaults.limits = limits_from(reader, defaults.limits);
        reader.finish();
    }
    defaults.seeds = table.seeds("seeds", defaults.seeds);
    defaults.renamings = table.seeds("renamings", defaults.renamings);
    defaults.threads = static_cast<int>(table.integer("threads", 1, 1, 1024));
    for (const toml::table* problems : table.tables("problems")) {
        config.problems.push_back(problems_from(ConfigTable(*problems, source, "problems")));
    }
    std::set<std::string> names;
    for (const toml::table* entry : table.tables("solvers")) {
        ConfigTable reader(*entry, source, "solvers");
        config.solvers.push_back(solver_from(reader, defaults, source));
        if (!names.insert(config.solvers.back().name).second) {
            reader.fail(entry, "two solvers are named '" + config.solvers.back().name + "'");
        }
    }
    if (config.problems.empty()) table.fail(nullptr, "no [[problems]]");
    if (config.solvers.empty()) table.fail(nullptr, "no [[solvers]]");
    if (const toml::table* report = table.table("report")) {
        config.report = report_from(ConfigTable(*report, source, "report"), config.solvers);
    }
    if (config.report.baseline.empty()) config.report.baseline = config.solvers.front().name;
    table.finish();
    return config;
}

}  // namespace

CampaignConfig parse_config(const std::string& text, const std::filesystem::path& file) {
    try {
        const toml::table root = toml::parse(text, file.string());
        CampaignConfig config = config_from(root, file);
        config.file = file;
        config.text = text;
        return config;
    } catch (const toml::parse_error& error) {
        throw labeling::InputError(file.string() + ":" + std::to_string(error.source().begin.line) +
                                   ": " + std::string(error.description()));
    }
}

CampaignConfig read_config(const std::filesystem::path& file) {
    return parse_config(labeling::read_text_file(file), file);
}

}  // namespace experiment
