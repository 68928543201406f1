// The loop over a campaign's runs. Every run is a process of its own, `scalefcn-experiment
// execute`, which leaves a record's file or nothing; what is written there is taken into the
// database at once. So whatever happens to this process, a run is there as a whole or will be made
// again.
#include "experiment/campaign.h"

#include <sched.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>

#include "experiment/database.h"
#include "experiment/estimate.h"
#include "experiment/execute.h"
#include "experiment/folder_lock.h"
#include "experiment/mesh_sources.h"
#include "experiment/problem_sources.h"
#include "experiment/process_tree.h"
#include "experiment/programs.h"
#include "experiment/provenance.h"
#include "experiment/run_command.h"
#include "labeling/errors.h"
#include "labeling/problem.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_process.h"
#include "labeling_mip/mip_solvers.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;
using labeling::InputError;

constexpr int kMostAttempts = 3;
constexpr double kGraceSeconds = 10;  ///< for `execute` to end its solver
constexpr const char* kStartTicks = "10000000";

std::string last_line(const fs::path& file) {
    std::ifstream in(file);
    std::string line, last;
    while (std::getline(in, line)) {
        if (!line.empty()) last = line;
    }
    return last;
}

/// Processors that this process may use.
std::vector<int> allowed_processors() {
    cpu_set_t set;
    std::vector<int> allowed;
    if (::sched_getaffinity(0, sizeof set, &set) != 0) return allowed;
    for (int k = 0; k < CPU_SETSIZE; ++k) {
        if (CPU_ISSET(k, &set)) allowed.push_back(k);
    }
    return allowed;
}

/// Solvers and their options are tried on a problem of two labels, so that no misspelt one is found
/// after a night of runs.
void check_solvers(const CampaignConfig& config) {
    const auto registry = labeling::all_solvers();
    labeling::ProblemBuilder builder;
    builder.add_conflict(builder.add_label(1), builder.add_label(2));
    const labeling::LabelingProblem problem = builder.build();
    for (const SolverConfig& solver : config.solvers) {
        if (solver.solver.empty()) continue;
        try {
            const auto found = registry.find(solver.solver);
            if (solver.options.empty()) continue;
            labeling::SolveOptions options;
            options.time_limit = std::chrono::seconds(10);
            options.extra = solver.options;
            found->solve(problem, options);
        } catch (const InputError& error) {
            throw InputError(config.file.string() + ": solver '" + solver.name +
                             "': " + error.what());
        }
    }
}

/// A start is what a short local search finds, once for each problem and the same everywhere.
void make_starts(const CampaignConfig& config, const std::vector<PlannedProblem>& problems,
                 const fs::path& folder, const std::function<void(const std::string&)>& tell) {
    const bool is_wanted = std::any_of(config.solvers.begin(), config.solvers.end(),
                                       [](const SolverConfig& s) { return !s.start.empty(); });
    if (!is_wanted) return;
    tell("starts for " + std::to_string(problems.size()) + " problems");
    fs::create_directories(folder / "starts");
    for (const PlannedProblem& problem : problems) {
        const fs::path file = start_file(folder, problem);
        if (problem.is_study || fs::exists(file)) continue;
        run_own_program(
            {own_program("labeling-solve").string(), (folder / problem.file).string(), "--solver",
             "local-search", "--work", kStartTicks, "--seed", "1", "-o", file.string()},
            folder / "starts" / "log");
    }
}

void write_solver_versions(const std::vector<SolverConfig>& solvers, const fs::path& folder) {
    std::set<std::string> names;
    for (const SolverConfig& solver : solvers) names.insert(solver.solver);
    labeling::write_text_file(folder / "solver_versions.json",
                              solver_versions(names).dump(1) + "\n");
}

/// The jobs that are left, shared by the threads that make them.
class Runner {
public:
    Runner(const fs::path& folder, const CampaignOptions& options)
        : folder_(folder),
          options_(options),
          plan_(read_plan(folder)),
          database_(folder),
          remaining_(plan_, std::max(1, options.jobs)),
          processors_(allowed_processors()) {}

    CampaignOutcome run() {
        std::error_code ignored;
        kill_processes_of(folder_ / "scratch");  // of an earlier runner that was killed
        fs::remove_all(folder_ / "scratch", ignored);
        fs::create_directories(folder_ / "records");
        database_.store_plan(plan_);
        if (!options_.again.empty()) forget_some();
        find_what_is_left();
        tell("");
        std::vector<std::thread> threads;
        for (int k = 0; k < std::max(1, options_.jobs); ++k) {
            threads.emplace_back([this, k] { work(k); });
        }
        for (std::thread& thread : threads) thread.join();
        if (!fault_.empty()) throw InputError(fault_);
        fs::remove_all(folder_ / "scratch", ignored);
        return {done_, plan_.jobs.size(), options_.stop.stop_requested()};
    }

private:
    /// What could not be made may have become possible. The file goes first: a run of which the
    /// database alone knows is forgotten as a whole the next time.
    void forget_some() {
        for (const Record& record : database_.records()) {
            if (!options_.again.contains(record.outcome)) continue;
            fs::remove(record_file(folder_, record.key));
            database_.erase(record.key);
        }
        write_solver_versions(plan_.solvers, folder_);
    }

    void find_what_is_left() {
        auto finished = database_.finished_keys();
        for (const Job& job : plan_.jobs) {
            if (!finished.contains(job.key)) {
                if (const auto record = read_intact_record(job.key)) {
                    database_.store(*record);
                    finished.insert(job.key);
                }
            }
            if (finished.contains(job.key)) {
                ++done_;
            } else {
                left_.push_back(&job);
                remaining_.is_left(job);
            }
        }
    }

    /// A file that is no record, whatever made it so, is put aside and the run made again.
    std::optional<Record> read_intact_record(const std::string& key) {
        try {
            return read_record(folder_, key);
        } catch (const InputError&) {
            const fs::path file = record_file(folder_, key);
            fs::rename(file, file.string() + ".damaged");
            return std::nullopt;
        }
    }

    void work(int thread) {
        const bool is_pinned = options_.is_pinned && options_.jobs <= processor_count();
        const int processor = is_pinned ? processors_[static_cast<std::size_t>(thread)] : -1;
        while (const Job* job = next_job()) {
            try {
                make(*job, processor);
            } catch (const std::exception& error) {
                const std::lock_guard lock(mutex_);
                if (fault_.empty()) fault_ = error.what();
            }
        }
    }

    int processor_count() const { return static_cast<int>(processors_.size()); }

    const Job* next_job() {
        const std::lock_guard lock(mutex_);
        if (!fault_.empty() || options_.stop.stop_requested() || next_ == left_.size()) {
            return nullptr;
        }
        return left_[next_++];
    }

    void make(const Job& job, int processor) {
        const auto begin = std::chrono::steady_clock::now();
        const fs::path log = folder_ / "scratch" / (job.key + ".log");
        fs::create_directories(log.parent_path());
        std::string reason;
        labeling::ProgramOutcome outcome;
        for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
            labeling::ProgramRun run;
            run.words = {own_program("scalefcn-experiment").string(),
                         "execute",
                         folder_.string(),
                         job.key,
                         "--processor",
                         std::to_string(processor)};
            run.folder = fs::current_path();
            run.output_file = fs::absolute(log).string() + ".output";
            run.error_file = fs::absolute(log);
            run.has_to_end = [this] { return options_.stop.stop_requested(); };
            run.grace_seconds = kGraceSeconds;
            run.signal_when_alone = SIGTERM;  // it has a solver to end
            outcome = labeling::run_program(run);
            if (options_.stop.stop_requested()) return;
            if (const auto record = read_record(folder_, job.key)) return keep(job, *record, begin);
            reason = last_line(log);
            // Bad input and a disk that is full do not get better by trying again.
            if (outcome.end == labeling::ProgramEnd::Exited && outcome.exit_code == 3) break;
        }
        if (outcome.end == labeling::ProgramEnd::Crashed) {
            // The solver's fault, as far as one can know: it would stand in the way for ever.
            const Record record =
                lost_run(plan_, job,
                         "what watched over it died of signal " + std::to_string(outcome.signal) +
                             ", " + std::to_string(kMostAttempts) + " times");
            write_record(record, folder_);
            return keep(job, record, begin);
        }
        throw InputError("no record of " + describe(plan_, job) + " (" + job.key +
                         "): " + (reason.empty() ? "its process ended without a word" : reason));
    }

    /// What remains is estimated by whole runs: reading, checking and recording take their time,
    /// too.
    void keep(const Job& job, const Record& record, std::chrono::steady_clock::time_point begin) {
        const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
        const std::lock_guard lock(mutex_);
        database_.store(record);
        ++done_;
        remaining_.has_ended(job, whole.count());
        char seconds[32];
        std::snprintf(seconds, sizeof seconds, " (%.2f s)", record.measures.wall_seconds);
        tell(describe(plan_, job) + ": " + to_string(record.outcome) + seconds);
    }

    void tell(const std::string& last) {
        if (!options_.on_progress) return;
        const auto [least, most] = remaining_.bounds();
        options_.on_progress({done_, plan_.jobs.size(), last, least, most});
    }

    const fs::path folder_;
    const CampaignOptions& options_;
    const Plan plan_;
    Database database_;
    RemainingTime remaining_;
    const std::vector<int> processors_;
    std::vector<const Job*> left_;
    std::mutex mutex_;  ///< of everything below, and of the database
    std::size_t next_ = 0, done_ = 0;
    std::string fault_;
};

}  // namespace

void prepare_campaign(const fs::path& config_file, const fs::path& folder,
                      const std::function<void(const std::string&)>& tell) {
    const CampaignConfig config = read_config(config_file);
    check_solvers(config);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError(folder.string() + ": " + error.message());
    const FolderLock lock(folder);
    if (fs::exists(folder / "plan.json")) {
        throw InputError(folder.string() +
                         " holds a campaign already: continue it with 'resume', or choose another "
                         "folder");
    }
    auto problems = make_problems(config, folder, tell);
    make_starts(config, problems, folder, tell);
    write_solver_versions(config.solvers, folder);
    write_plan(make_plan(config, std::move(problems)), folder);
}

CampaignOutcome continue_campaign(const fs::path& folder, const CampaignOptions& options) {
    if (!fs::exists(folder / "plan.json")) read_plan(folder);  // says that there is none
    const FolderLock lock(folder);
    return Runner(folder, options).run();
}

std::size_t merge_records(const Plan& plan, const fs::path& folder) {
    const FolderLock lock(folder);
    Database database(folder);
    database.store_plan(plan);
    std::size_t count = 0;
    for (const Job& job : plan.jobs) {
        if (const auto record = read_record(folder, job.key)) count += database.store(*record);
    }
    return count;
}

}  // namespace experiment
