#include "experiment/provenance.h"

#include <sqlite3.h>
#include <sys/utsname.h>
#include <unistd.h>
#include <zlib.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "experiment/built_from.h"
#include "experiment/hash.h"
#include "experiment/programs.h"
#include "labeling_mip/external_process.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string first_line(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
        if (!line.empty()) return line.substr(0, 200);
    }
    return "";
}

/// What a program prints, or nothing when it is not there or fails.
std::string output_of(std::vector<std::string> words) {
    const labeling::ScratchFolder scratch;
    labeling::ProgramRun run;
    run.words = std::move(words);
    run.folder = scratch.path();
    run.output_file = scratch.path() / "output";
    run.error_file = scratch.path() / "errors";
    const auto outcome = labeling::run_program(run);
    if (outcome.end != labeling::ProgramEnd::Exited || outcome.exit_code != 0) return "";
    return text_of(run.output_file);
}

std::string or_unknown(const std::string& text) { return text.empty() ? "unknown" : text; }

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    std::string line;
    while (std::getline(file, line)) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return "";
}

}  // namespace

json provenance(const fs::path& solve_program) {
    json result;
    result["commit"] = kBuiltFromCommit;
    result["changed_sources"] = kBuiltFromChangedSources;
    result["version"] = EXPERIMENT_VERSION;
    result["compiler"] = EXPERIMENT_COMPILER;
    result["flags"] = EXPERIMENT_FLAGS;
    result["solve_program_hash"] = content_hash(text_of(solve_program));
    result["sqlite"] = sqlite3_libversion();
    result["zlib"] = zlibVersion();
    result["cbc"] = EXPERIMENT_CBC_VERSION;
    result["processor"] = or_unknown(processor_name());
    result["processors"] = std::to_string(::sysconf(_SC_NPROCESSORS_ONLN));
    utsname system{};
    if (::uname(&system) == 0) {
        result["system"] = std::string(system.sysname) + " " + system.release;
        result["host"] = system.nodename;
    }
    return result;
}

json solver_versions(const std::set<std::string>& names) {
    const std::string python = python_for_solvers();
    const auto package = [&](const char* distribution) {
        return std::vector<std::string>{python, "-c",
                                        std::string("import importlib.metadata as m; print('") +
                                            distribution + "', m.version('" + distribution + "'))"};
    };
    const std::map<std::string, std::vector<std::string>> questions{
        {"glpk", {"glpsol", "--version"}},       {"clasp", {"clasp", "--version"}},
        {"toulbar2", {"toulbar2", "--version"}}, {"highs", package("highspy")},
        {"scip", package("pyscipopt")},          {"cp-sat", package("ortools")},
        {"gurobi", package("gurobipy")}};
    json result = json::object();
    for (const auto& [name, words] : questions) {
        if (!names.contains(name)) continue;
        const std::string line = first_line(output_of(words));
        result[name] = line.empty() ? "missing" : line;
    }
    return result;
}

}  // namespace experiment
