// One run, seen from outside. The solver is a process of its own (`labeling-solve`, or a program of
// the user's), which is pinned, measured by the kernel, and ended when it exceeds its time, its
// memory or its disk. Whatever it says is a claim: its labels are read from a file and checked here
// with check_solution, which shares no code with any solver.
//
// Limits. Time is told to the solver, which should keep it; it is ended a tenth and a margin later,
// since reading the problem counts too. Memory is the resident memory of all its processes
// together, looked at every 20 ms. Disk is what it writes into its scratch folder, which is also
// its TMPDIR.
#include "experiment/execute.h"

#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>

#include "experiment/best_solution.h"
#include "experiment/hash.h"
#include "experiment/instructions.h"
#include "experiment/process_tree.h"
#include "experiment/programs.h"
#include "experiment/provenance.h"
#include "experiment/run_command.h"
#include "experiment/verdict.h"
#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/renaming.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_process.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kGraceSeconds = 2;  ///< between SIGTERM and SIGKILL
constexpr double kWatchSeconds = 0.02;
constexpr double kDiskWatchSeconds = 0.2;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::string calendar_now() {
    const std::time_t time = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&time, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

void pin(int processor) {
    if (processor < 0) return;
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(processor, &set);
    ::sched_setaffinity(0, sizeof set, &set);
}

/// The processor this process is held to, or -1.
int pinned_processor() {
    cpu_set_t set;
    if (::sched_getaffinity(0, sizeof set, &set) != 0 || CPU_COUNT(&set) != 1) return -1;
    for (int k = 0; k < CPU_SETSIZE; ++k) {
        if (CPU_ISSET(k, &set)) return k;
    }
    return -1;
}

double folder_mib(const fs::path& folder) {
    double bytes = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error)) {
        struct stat status {};  // what it occupies: a file with holes may look large
        if (::lstat(it->path().c_str(), &status) == 0) {
            bytes += 512.0 * static_cast<double>(status.st_blocks);
        }
    }
    return bytes / (1024 * 1024);
}

/// What nothing else calls its own: a process that was given up, on a machine that nobody reaches,
/// may still be at the same run.
std::string own_mark() {
    char host[256] = "";
    ::gethostname(host, sizeof host - 1);
    return std::string(".") + host + "." + std::to_string(::getpid());
}

std::string without(std::string text, const std::string& part) {
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at)) {
        text.erase(at, part.size());
    }
    return text;
}

/// A folder that is empty at the start and gone at the end.
class RunFolder {
public:
    explicit RunFolder(fs::path path) : path_(std::move(path)) {
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    ~RunFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    RunFolder(const RunFolder&) = delete;
    RunFolder& operator=(const RunFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// Holds a run to its limits.
class Watch {
public:
    Watch(const Limits& limits, const fs::path& folder) : limits_(limits), folder_(folder) {}

    bool has_to_end() {
        const double time = now();
        if (begin_ == 0) begin_ = time;
        if (limits_.seconds && time - begin_ > 1.1 * *limits_.seconds + limits_.margin_seconds) {
            return end(ForcedEnd::Time);
        }
        if (time >= next_memory_) {
            next_memory_ = time + kWatchSeconds;
            const double used = resident_mib(descendants(::getpid()));
            peak_ = std::max(peak_, used);
            if (used > static_cast<double>(limits_.memory_mib)) return end(ForcedEnd::Memory);
        }
        if (time >= next_disk_) {
            next_disk_ = time + kDiskWatchSeconds;
            if (folder_mib(folder_) > static_cast<double>(limits_.disk_mib)) {
                return end(ForcedEnd::Disk);
            }
        }
        return reason_ != ForcedEnd::None;
    }
    ForcedEnd reason() const { return reason_; }
    double peak_mib() const { return peak_; }

private:
    bool end(ForcedEnd reason) {
        if (reason_ == ForcedEnd::None) reason_ = reason;
        return true;
    }
    const Limits& limits_;
    const fs::path& folder_;
    double begin_ = 0, next_memory_ = 0, next_disk_ = 0, peak_ = 0;
    ForcedEnd reason_ = ForcedEnd::None;
};

labeling::ProgramOutcome run_watched(const RunCommand& command, const Limits& limits,
                                     const fs::path& scratch, const std::stop_token& stop,
                                     Observed& seen, Measures& measures) {
    Watch watch(limits, scratch);
    InstructionCounter counter;
    labeling::ProgramRun run;
    run.words = command.words;
    run.folder = scratch;
    run.output_file = scratch / "output.txt";
    run.error_file = scratch / "errors.txt";
    run.file_bytes = limits.disk_mib << 20;
    run.grace_seconds = kGraceSeconds;
    run.has_to_end = [&] { return stop.stop_requested() || watch.has_to_end(); };
    run.before_start = [&](int process) { counter.watch(process); };
    const labeling::ProgramOutcome outcome = labeling::run_program(run);
    seen.orphans_left = kill_descendants();
    seen.forced = watch.reason();
    if (folder_mib(scratch) > static_cast<double>(limits.disk_mib)) seen.forced = ForcedEnd::Disk;
    measures.wall_seconds = outcome.seconds;
    measures.user_seconds = outcome.processor_seconds - outcome.system_seconds;
    measures.system_seconds = outcome.system_seconds;
    measures.peak_mib = std::max(outcome.memory_mib, watch.peak_mib());
    measures.instructions = counter.count();
    measures.exit_code = outcome.exit_code;
    measures.signal = outcome.signal;
    return outcome;
}

[[noreturn]] void fail_as_changed(const fs::path& file, const char* what) {
    throw labeling::InputError(file.string() + ": not the " + what +
                               " that was planned (its hash differs)");
}

void require_planned_mesh(const fs::path& file, const std::string& hash) {
    std::ifstream in(file, std::ios::binary);
    const std::string content(std::istreambuf_iterator<char>(in), {});
    if (content_hash(content) != hash) fail_as_changed(file, "mesh");
}

void add_provenance(const PlannedProblem& problem, const Job& job, Record& record) {
    record.provenance = provenance(own_program("labeling-solve"));
    record.provenance["instance"] = problem.hash;
    record.provenance["seed"] = std::to_string(job.seed);
    if (problem.is_study) record.provenance["study_program_hash"] = program_hash("scalefcn");
}

}  // namespace

std::optional<Record> execute(const Plan& plan, const Job& job, const fs::path& folder,
                              const ExecuteOptions& options) {
    const PlannedProblem& planned = plan.problems.at(job.problem);
    const SolverConfig& solver = plan.solvers.at(job.solver);
    adopt_orphans();
    if (solver.threads == 1) pin(options.processor);

    Record record;
    record.key = job.key;
    record.measures.started_at = options.calendar ? options.calendar() : calendar_now();
    record.measures.processor = pinned_processor();
    double load[1] = {0};
    if (::getloadavg(load, 1) == 1) record.measures.load = load[0];

    const fs::path home = fs::canonical(folder);  // one name, by which what is left is known
    if (planned.is_study) require_planned_mesh(home / planned.file, planned.hash);
    const RunFolder scratch(home / "scratch" / (job.key + own_mark()));
    ::setenv("TMPDIR", scratch.path().c_str(), 1);
    const RunCommand command = run_command(plan, job, home, scratch.path());
    record.command = without(command.text, own_mark());
    Observed seen;
    seen.outcome =
        run_watched(command, solver.limits, scratch.path(), options.stop, seen, record.measures);
    if (options.stop.stop_requested()) return std::nullopt;
    seen.result_file = command.result_file;
    seen.solution_file = command.solution_file;
    seen.error_file = scratch.path() / "errors.txt";
    if (planned.is_study) {
        judge_study(seen, record, home);
    } else {
        const auto problem = labeling::read_problem(home / planned.file);
        if (hexadecimal(problem.hash()) != planned.hash) {
            fail_as_changed(home / planned.file, "problem");
        }
        // A program of the user's saw the renamed problem and answers in its names.
        const bool is_renamed = !solver.program.empty() && job.renaming != 0;
        const auto asked = labeling::rename_labels(problem, is_renamed ? job.renaming : 0);
        judge(seen, asked.problem, solver, record);
        if (record.value && record.outcome != Outcome::Wrong) {
            fs::path labels = seen.solution_file;
            if (is_renamed) {
                const auto solution = labeling::read_solution(labels, asked.problem);
                labels = scratch.path() / "original.sol";
                labeling::write_solution(labeling::original_solution(asked, solution), labels);
            }
            keep_if_best(home, planned.hash, labels, *record.value);
        }
    }
    add_provenance(planned, job, record);
    return record;
}

Record lost_run(const Plan& plan, const Job& job, const std::string& message) {
    Record record;
    record.key = job.key;
    record.outcome = Outcome::Crash;
    record.message = message;
    record.measures.started_at = calendar_now();
    add_provenance(plan.problems.at(job.problem), job, record);
    return record;
}

fs::path record_file(const fs::path& folder, const std::string& key) {
    return folder / "records" / (key + ".json");
}

void write_record(const Record& record, const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder / "records", error);
    labeling::write_text_file(record_file(folder, record.key), to_json(record).dump() + "\n");
}

std::optional<Record> read_record(const fs::path& folder, const std::string& key) {
    const fs::path file = record_file(folder, key);
    if (!fs::exists(file)) return std::nullopt;
    const json j = json::parse(labeling::read_text_file(file), nullptr, false);
    if (j.is_discarded()) throw labeling::InputError(file.string() + ": not JSON");
    Record record = record_from(j, file.string());
    if (record.key != key) {
        throw labeling::InputError(file.string() + ": the record of another run, " + record.key);
    }
    return record;
}

}  // namespace experiment
