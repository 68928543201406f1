// Judging a run. A solver claims a status, a value, labels and a bound; what counts is what the
// labels are worth. Renamed problems need no special case for our own program, which answers in the
// original's names; a program of the user's sees the renamed problem only, so it is judged there.
#include "experiment/verdict.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <limits>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/text_file.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;
using labeling::ProgramEnd;
using nlohmann::json;

constexpr std::uintmax_t kLargestAnswer = std::uintmax_t{1} << 28;
constexpr std::size_t kLongestMessage = 300;

/// One printable line; solvers may print anything.
std::string one_line(std::string text) {
    text.resize(std::min(text.size(), kLongestMessage));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

std::string last_line(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    in.seekg(0, std::ios::end);
    const auto size = in.tellg();
    if (size <= 0) return "";
    in.seekg(std::max<std::streamoff>(0, static_cast<std::streamoff>(size) - 2000));
    std::string line, last;
    while (std::getline(in, line)) {
        if (!line.empty()) last = line;
    }
    return one_line(last);
}

/// Nothing for what does not fit, too: it must not come back with another sign.
std::optional<std::int64_t> integer_of(const json& j) {
    if (!j.is_number_integer()) return std::nullopt;
    const bool is_too_large =
        j.is_number_unsigned() &&
        j.get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()};
    if (is_too_large) return std::nullopt;
    return j.get<std::int64_t>();
}

std::optional<std::int64_t> integer_in(const json& j, const char* key) {
    const auto it = j.find(key);
    return it == j.end() ? std::nullopt : integer_of(*it);
}

std::string text_in(const json& j, const char* key) {
    const auto it = j.find(key);
    return it != j.end() && it->is_string() ? one_line(it->get<std::string>()) : std::string();
}

double real_in(const json& j, const char* key) {
    const auto it = j.find(key);
    return it != j.end() && it->is_number() ? it->get<double>() : 0.0;
}

/// What stands in the result file; what is not as it should be is left out.
void take_result(const json& j, Record& record) {
    record.status = text_in(j, "status");
    record.stop_reason = text_in(j, "stop_reason");
    record.message = text_in(j, "message");
    record.bound = integer_in(j, "bound");
    record.work = integer_in(j, "work").value_or(0);
    // Its own clock may say what it likes, but no more than the time it had.
    const auto within = [&](double seconds) {
        return std::clamp(seconds, 0.0, record.measures.wall_seconds);
    };
    record.solver_seconds = within(real_in(j, "seconds"));
    if (const auto it = j.find("statistics"); it != j.end() && it->is_object()) {
        for (const auto& [key, value] : it->items()) {
            if (value.is_number()) record.statistics[one_line(key)] = value.get<double>();
        }
    }
    if (const auto it = j.find("trace"); it != j.end() && it->is_array()) {
        for (const json& p : *it) {
            if (!p.is_array() || p.size() != 4 || !p[0].is_number()) continue;
            const auto work = integer_of(p[1]);
            if (!work) continue;
            record.trace.push_back(
                {within(p[0].get<double>()), *work, integer_of(p[2]), integer_of(p[3])});
        }
    }
}

json read_result(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > kLargestAnswer) {
        return json();
    }
    std::ifstream in(file, std::ios::binary);
    const json j = json::parse(in, nullptr, false);
    return j.is_object() ? j : json();
}

void add_message(Record& record, const std::string& text) {
    if (text.empty()) return;
    record.message = record.message.empty() ? text : one_line(text + "; " + record.message);
}

void accuse(Record& record, const std::string& text) {
    record.outcome = Outcome::Wrong;
    add_message(record, text);
}

/// Reads and checks the labels. True: there are some, and they are feasible.
bool take_labels(const Observed& seen, const labeling::LabelingProblem& problem, Record& record,
                 bool& is_wrong) {
    std::error_code error;
    if (!fs::is_regular_file(seen.solution_file, error)) return false;
    try {
        if (fs::file_size(seen.solution_file) > kLargestAnswer) {
            throw labeling::InputError("the solution file is too large");
        }
        const auto solution = labeling::read_solution(seen.solution_file, problem);
        const auto check = labeling::check_solution(problem, solution);
        if (check.is_feasible) record.value = check.value;
        if (check.is_feasible && check.value_matches) return true;
        is_wrong = true;
        accuse(record, "wrong labels: " + one_line(check.message));
        return check.is_feasible;
    } catch (const labeling::InputError& unreadable) {
        is_wrong = true;
        std::string what = unreadable.what();
        const std::string folder = seen.solution_file.parent_path().string() + "/";
        if (what.starts_with(folder)) what.erase(0, folder.size());
        accuse(record, one_line("unreadable labels: " + what));
        return false;
    }
}

/// How it ended, when it did not end well; true then.
bool judge_end(const Observed& seen, Record& record) {
    const auto set = [&](Outcome outcome, const std::string& text) {
        record.outcome = outcome;
        add_message(record, text);
        return true;
    };
    switch (seen.forced) {
        case ForcedEnd::Memory:
            return set(Outcome::OutOfMemory, "ended: over its memory limit");
        case ForcedEnd::Disk:
            return set(Outcome::DiskFull, "ended: over its disk limit");
        case ForcedEnd::Time:
            return set(Outcome::Timeout, seen.outcome.end == ProgramEnd::Killed
                                             ? "killed: over its time, and did not end when asked"
                                             : "ended: over its time");
        case ForcedEnd::None:
            break;
    }
    const std::string said = last_line(seen.error_file);
    const std::string quote = said.empty() ? "" : ": " + said;
    switch (seen.outcome.end) {
        case ProgramEnd::NotFound:
            return set(Outcome::Missing, "no such program");
        case ProgramEnd::NotStarted:
            return set(Outcome::Crash, "does not start: " + seen.outcome.message);
        case ProgramEnd::Crashed:
            if (seen.outcome.signal == SIGXFSZ) {
                return set(Outcome::DiskFull, "a file over its disk limit");
            }
            return set(Outcome::Crash,
                       "died of signal " + std::to_string(seen.outcome.signal) + quote);
        default:
            break;
    }
    if (said.find("bad_alloc") != std::string::npos) return set(Outcome::OutOfMemory, said);
    // 4 is our own programs' way to say that there is no solution.
    const int code = seen.outcome.exit_code;
    if (code == 127) return set(Outcome::Missing, said);  // a shell's way to say: no such program
    if (code != 0 && code != 4) {
        return set(Outcome::Crash, "exit code " + std::to_string(code) + quote);
    }
    return false;
}

bool has_statistic(const Record& record, const char* key) {
    const auto it = record.statistics.find(key);
    return it != record.statistics.end() && it->second > 0;
}

void judge_claims(Record& record, bool has_labels, const SolverConfig& solver) {
    if (has_statistic(record, "false_claims")) return accuse(record, "a false claim");
    if (has_labels && record.bound && *record.bound < *record.value) {
        return accuse(record, "its bound is below its value");
    }
    if (record.status == "infeasible") {
        if (has_labels) return accuse(record, "it says infeasible and has a solution");
        record.outcome = Outcome::Infeasible;
        return;
    }
    if (!has_labels) {
        if (record.status == "optimal" || record.status == "feasible") {
            return accuse(record, "it claims a solution and shows none");
        }
        record.outcome = has_statistic(record, "missing")          ? Outcome::Missing
                         : has_statistic(record, "not_applicable") ? Outcome::NotApplicable
                         : record.stop_reason == "solver-failed"   ? Outcome::Crash
                                                                   : Outcome::NoSolution;
        return;
    }
    record.outcome = record.status == "optimal" ? Outcome::Optimal : Outcome::Feasible;
    if (record.outcome != Outcome::Optimal) return;
    if (solver.limits.gap > 0) return;  // optimal within the gap: the value is no bound
    if (!record.bound) record.bound = record.value;
    if (*record.bound > *record.value) {
        accuse(record, "it says optimal under a bound that is higher");
    }
}

}  // namespace

void judge(const Observed& seen, const labeling::LabelingProblem& problem,
           const SolverConfig& solver, Record& record) {
    const json result = read_result(seen.result_file);
    if (!result.is_null()) take_result(result, record);
    bool is_wrong = false;
    const bool has_labels = take_labels(seen, problem, record, is_wrong);
    if (is_wrong) return;
    if (judge_end(seen, record)) return;
    const auto claimed = result.is_null() ? std::nullopt : integer_in(result, "value");
    if (has_labels && claimed && *claimed != *record.value) {
        return accuse(record, "it claims the value " + std::to_string(*claimed) +
                                  ", its labels are worth " + std::to_string(*record.value));
    }
    judge_claims(record, has_labels, solver);
}

void judge_study(const Observed& seen, Record& record, const fs::path& home) {
    const json result = read_result(seen.result_file);
    if (!result.is_null()) take_result(result, record);
    if (judge_end(seen, record)) return;
    if (result.is_null()) {
        record.outcome = Outcome::Crash;
        add_message(record, "no result");
        return;
    }
    record.value = integer_in(result, "value");
    record.outcome = record.status == "optimal" ? Outcome::Optimal : Outcome::Feasible;
    std::error_code error;
    fs::create_directories(home / "segments", error);
    fs::copy_file(seen.solution_file, home / "segments" / (record.key + ".txt"),
                  fs::copy_options::overwrite_existing, error);
}

}  // namespace experiment
