// One solve with a program that we did not write: write the problem, run the program where it can
// be ended, read its answer, and believe of it only what can be checked.
//
// What can be checked exactly: that the labels satisfy every conflict and rule, and what they are
// worth. What cannot: that nothing better exists. A claim of optimality or a bound is refused when
// it contradicts something known (a start that is better, the program's own labels, its own value);
// else it is taken as the program's word, weakened by what its arithmetic may have lost: a program
// that computes in doubles is believed to half a unit only while all positive terms sum to at most
// 2^40 units, as for the linked CBC.
//
// Cold unless asked: without a warm start in the options the program gets none, so that what is
// measured is its own. With one, ours is completed greedily, passed on where the program takes
// starts, and kept as the answer's floor.
#include "labeling_mip/external_solver.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "labeling/errors.h"
#include "labeling/greedy.h"
#include "labeling/run_control.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_command.h"
#include "labeling_mip/external_process.h"
#include "labeling_mip/external_worker.h"

namespace labeling {
namespace {

using Claim = ExternalAnswer::Claim;

constexpr double kTicksPerSecond = 1e7;
constexpr std::int64_t kLargestFile = std::int64_t{1} << 32;
constexpr std::uintmax_t kLargestAnswer = std::uintmax_t{1} << 28;
constexpr Value kExactTotal = Value{1} << 40;

/// Programs count no ticks: a work limit is the time that so many ticks take.
SolveOptions with_work_as_time(SolveOptions options) {
    if (options.work_limit) {
        const std::chrono::duration<double> time(static_cast<double>(*options.work_limit) /
                                                 kTicksPerSecond);
        options.time_limit = options.time_limit ? std::min(*options.time_limit, time) : time;
        options.work_limit.reset();
    }
    return options;
}

RowStyle row_style(const SolveOptions& options) {
    const auto it = options.extra.find("rows");
    if (it == options.extra.end() || it->second == "strengthened") return RowStyle::Strengthened;
    if (it->second == "paper") return RowStyle::Paper;
    throw InputError("option rows: '" + it->second + "' is not paper or strengthened");
}

std::string extension(ProblemFormat format) {
    switch (format) {
        case ProblemFormat::Lab:
            return "lab";
        case ProblemFormat::Mps:
            return "mps";
        case ProblemFormat::Lp:
            return "lp";
        case ProblemFormat::Opb:
            return "opb";
        case ProblemFormat::Cfn:
            return "cfn";
        case ProblemFormat::Metis:
            return "graph";
    }
    throw LogicError("unknown problem format");
}

/// Text of a file the program may have written; empty when there is none or it is too long.
std::string text_of(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return {};
    const auto size = std::filesystem::file_size(file, error);
    if (error || size > kLargestAnswer) return {};
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The last line of a text that is not blank, printable and short.
std::string last_line(const std::string& text) {
    LineReader reader(text, "");
    std::string line;
    while (reader.next()) {
        if (!reader.words().empty()) line = std::string(reader.rest(0));
    }
    line.resize(std::min<std::size_t>(line.size(), 200));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return line;
}

class ExternalRun {
public:
    ExternalRun(const ExternalProgram& program, const LabelingProblem& problem,
                const SolveOptions& options)
        : program_(program),
          problem_(problem),
          options_(with_work_as_time(options)),
          memory_(extra_integer(options, "memory", 0, 1, std::int64_t{1} << 30)),
          rows_(row_style(options)),
          control_(options_) {
        for (Value w : problem.weights()) {
            total_ += std::max(Value{0}, w);
            largest_ = std::max(largest_, std::abs(w));
        }
        for (const Bonus& b : problem.bonuses()) {
            total_ += b.value;
            largest_ = std::max(largest_, b.value);
        }
    }

    SolveResult run() {
        if (problem_.label_count() == 0) {
            Solution empty;
            if (!check_solution(problem_, empty).is_feasible) return result(true);
            best_ = empty;
            bound_ = 0;
            return result();
        }
        take_start();
        if (control_.is_over()) return result();
        if (program_.largest_coefficient > 0 && largest_ > program_.largest_coefficient) {
            statistics_["not_applicable"] = 1;
            fail("not tried: a coefficient of the objective, " + std::to_string(largest_) +
                 ", exceeds what " + program_.name + " reads");
            return result();
        }
        const ScratchFolder folder;
        std::string text;
        try {
            text = format_problem(problem_, program_.problem_format, rows_);
        } catch (const InputError& error) {
            statistics_["not_applicable"] = 1;
            fail(std::string("not tried: ") + error.what());
            return result();
        }
        const ProgramOutcome outcome = start_program(folder.path(), text);
        judge(outcome, folder.path());
        return result(is_infeasible_ && !best_);
    }

private:
    void take_start() {
        if (options_.warm_start.empty()) return;
        const RowSystem rows(problem_);
        GreedyOptions greedy;
        greedy.start = options_.warm_start;
        best_ = greedy_labeling(problem_, rows, control_, greedy).solution;
        if (best_) control_.report(best_->value, std::nullopt);
    }

    /// One line per column; numbers alone where the program wants them.
    std::string start_text() const {
        const auto model = linear_model(problem_, rows_);
        std::string text;
        for (std::int32_t c = 0; c < model.column_count(); ++c) {
            const bool is_label = c < model.label_count;
            if (!is_label && program_.problem_format == ProblemFormat::Cfn) break;
            bool is_on = is_label && best_->labels[c] != 0;
            if (!is_label) {
                const Bonus& b = model.bonuses[c - model.label_count];
                is_on = best_->labels[b.first] != 0 && best_->labels[b.second] != 0;
            }
            if (program_.problem_format == ProblemFormat::Opb) {
                text += "x" + std::to_string(c + 1) + " ";
            } else if (program_.problem_format != ProblemFormat::Cfn) {
                text += model.column_name(c) + " ";
            }
            text += is_on ? "1\n" : "0\n";
        }
        return text;
    }

    std::map<std::string, std::string> placeholders(const std::filesystem::path& folder) const {
        std::map<std::string, std::string> values{
            {"problem", (folder / ("problem." + extension(program_.problem_format))).string()},
            {"solution", (folder / "solution.sol").string()},
            {"worker", (folder / "worker.py").string()},
            {"python", worker_python(options_)},
            {"start", best_ ? (folder / "start.sol").string() : ""},
            {"time", ""},
            {"seconds", ""},
            {"gap", options_.relative_gap > 0 ? std::to_string(options_.relative_gap) : ""},
            {"threads", std::to_string(options_.threads)},
            {"seed", std::to_string(options_.seed % 1000000)}};
        if (options_.time_limit && !options_.clock) {
            const double time = std::max(0.05, 0.97 * control_.seconds_left() - 0.15);
            values["time"] = std::to_string(time);
            values["seconds"] =
                std::to_string(static_cast<std::int64_t>(std::clamp(time, 1.0, 1e9)));
        }
        return values;
    }

    ProgramOutcome start_program(const std::filesystem::path& folder, const std::string& text) {
        // Writing what the program needs counts as its time, as it would for anyone who calls it.
        ProgramRun run;
        auto values = placeholders(folder);
        write_text_file(values["problem"], text);
        if (best_) write_text_file(values["start"], start_text());
        if (program_.command.find("{worker}") != std::string::npos) {
            write_text_file(values["worker"], worker_text());
        }
        values = placeholders(folder);  // again: writing has taken some of the time
        run.words = command_words(program_.command, values);
        program_name_ = run.words.empty() ? "" : run.words[0];
        run.folder = folder;
        run.output_file = folder / "output.txt";
        run.error_file = folder / "errors.txt";
        run.memory_bytes = memory_ << 20;
        run.file_bytes = kLargestFile;
        const double limit = options_.time_limit ? options_.time_limit->count() : 10;
        run.grace_seconds = std::clamp(0.02 * limit, 0.02, 1.0);
        run.has_to_end = [this] {
            control_.check();
            return control_.is_over();
        };
        return run_program(run);
    }

    void judge(const ProgramOutcome& outcome, const std::filesystem::path& folder) {
        switch (outcome.end) {
            case ProgramEnd::NotFound:
                statistics_["missing"] = 1;
                return fail("'" + program_name_ + "' is not installed: " + program_.advice);
            case ProgramEnd::NotStarted:
                return fail("'" + program_name_ + "' does not start: " + outcome.message);
            default:
                break;
        }
        statistics_["process_seconds"] = outcome.seconds;
        statistics_["process_cpu"] = outcome.processor_seconds;
        statistics_["memory_mib"] = outcome.memory_mib;
        const bool is_stopped = control_.is_over();
        ExternalAnswer answer;
        std::string unreadable;
        try {
            answer = read_answer(program_.answer_format, text_of(folder / "solution.sol"),
                                 text_of(folder / "output.txt"), problem_.label_count());
        } catch (const InputError& error) {
            unreadable = error.what();
        }
        if (answer.seconds) statistics_["solver_seconds"] = *answer.seconds;
        if (answer.nodes) statistics_["nodes"] = *answer.nodes;
        if (outcome.end == ProgramEnd::Crashed) {
            fail("the program died of signal " + std::to_string(outcome.signal));
            answer.claim = std::min(answer.claim, Claim::Feasible);  // labels can be checked,
            answer.bound.reset();                                    // nothing else
        } else if (answer.claim == Claim::Failed) {
            // The worker's words for a package that is not there and for a licence too small.
            if (answer.message.starts_with("not installed")) statistics_["missing"] = 1;
            if (answer.message.find("size-limited") != std::string::npos) {
                statistics_["not_applicable"] = 1;
            }
            return fail(answer.message.empty() ? "the program gave up" : answer.message);
        } else if (!unreadable.empty() && !is_stopped) {
            const std::string said = last_line(text_of(folder / "errors.txt"));
            return fail("no answer (exit code " + std::to_string(outcome.exit_code) +
                        "): " + unreadable + (said.empty() ? "" : "; it said: " + said));
        }
        believe(answer);
    }

    void believe(const ExternalAnswer& answer) {
        std::optional<Value> found;
        bool is_honest = true;
        if (!answer.labels.empty()) {
            Solution solution{answer.labels, 0};
            const SolutionCheck check = check_solution(problem_, solution);
            if (check.is_feasible) {
                found = solution.value = check.value;
                if (!best_ || check.value > best_->value) best_ = std::move(solution);
                control_.report(best_->value, std::nullopt);
            } else {
                is_honest = false;
                accuse("its labels are infeasible: " + check.message);
            }
        }
        const bool is_off =
            found && answer.value && !is_fitting(answer, static_cast<double>(*found));
        const bool is_fractional =
            is_off && is_within_integrality(*answer.value - static_cast<double>(*found));
        if (is_off && !is_fractional) {
            is_honest = false;
            accuse("it claims the value " + plain(*answer.value) + ", its labels are worth " +
                   std::to_string(*found));
        }
        if (answer.claim == Claim::Infeasible) {
            if (best_) {
                accuse("it claims that there is no solution, but one is known");
            } else {
                is_infeasible_ = true;
            }
            return;
        }
        if (is_honest && answer.bound) take_bound(*answer.bound);
        if (answer.claim == Claim::Optimal) {
            if (!found && is_honest) {
                accuse("it claims an optimum and shows none");
            } else if (is_fractional) {
                take_bound(std::max(*answer.value, static_cast<double>(*found)));
                message_ = "optimal with labels that are not quite integers";
            } else if (is_honest && !is_accused()) {
                take_optimum(*found, answer);
            }
        } else {
            stop_short();
        }
        if (!answer.message.empty() && message_.empty()) message_ = answer.message;
    }

    /// An unfinished program may have bonus columns left at 0 that its labels earn, so its value
    /// may be below the labels' worth; above it never, and an optimum is exact.
    bool is_fitting(const ExternalAnswer& answer, double worth) const {
        const double error = slack(worth) + 0.5;
        if (*answer.value > worth + error) return false;
        return answer.claim != Claim::Optimal || options_.relative_gap > 0 ||
               *answer.value >= worth - error;
    }

    /// MIP solvers take numbers near enough to 0 and 1 for labels, and count them as they are:
    /// their value may be that much off, and then proves nothing, but it is no lie.
    bool is_within_integrality(double difference) const {
        constexpr double kIntegrality = 1e-6;
        return !program_.is_exact &&
               std::abs(difference) <= kIntegrality * static_cast<double>(total_);
    }

    void take_bound(double bound) {
        const double raised =
            program_.is_exact ? std::floor(bound + 0.5) : std::ceil(bound + slack(bound) + 1);
        if (!(std::abs(raised) < 9e15)) return;
        const Value integer = static_cast<Value>(raised);
        if (best_ && integer < best_->value) {
            accuse("it claims the bound " + plain(bound) + ", below the known value " +
                   std::to_string(best_->value));
            return;
        }
        bound_ = std::min(bound_.value_or(integer), integer);
        control_.report(std::nullopt, bound_);
    }

    void take_optimum(Value found, const ExternalAnswer& answer) {
        if (best_->value > found) {
            accuse("it claims the optimum " + std::to_string(found) + ", but " +
                   std::to_string(best_->value) + " is known");
            return;
        }
        if (options_.relative_gap > 0) return control_.end(StopReason::GapReached);
        if (answer.bound &&
            *answer.bound > static_cast<double>(found) + slack(static_cast<double>(found)) + 1) {
            accuse("it claims the optimum " + std::to_string(found) + " under the bound " +
                   plain(*answer.bound));
            return;
        }
        const double loss =
            program_.relative_tolerance * (1 + std::abs(static_cast<double>(found)));
        const bool is_proof = program_.is_exact || (total_ <= kExactTotal && loss < 1);
        if (is_proof) {
            bound_ = found;
            control_.report(std::nullopt, bound_);
        } else {
            take_bound(static_cast<double>(found));
            if (message_.empty()) message_ = "optimal within the program's tolerances";
        }
    }

    /// Neither optimal nor infeasible: why did it end?
    void stop_short() {
        if (control_.is_over()) return;
        if (options_.time_limit) return control_.end(StopReason::TimeLimit);
        if (!is_accused()) fail("the program ended without a result");
    }

    double slack(double value) const {
        if (program_.is_exact) return 0;
        return std::ldexp(static_cast<double>(total_), -40) +
               program_.relative_tolerance * (1 + std::abs(value));
    }

    static std::string plain(double number) {
        char text[40];
        std::snprintf(text, sizeof text, "%.10g", number);
        return text;
    }

    void fail(const std::string& message) {
        control_.end(StopReason::SolverFailed);
        if (message_.empty()) message_ = message;
    }
    void accuse(const std::string& message) {
        statistics_["false_claims"] += 1;
        fail(message);
    }
    bool is_accused() const { return statistics_.contains("false_claims"); }

    SolveResult result(bool is_infeasible = false) {
        SolveResult r =
            finish(problem_, program_.name, control_, std::move(best_), bound_, is_infeasible);
        r.message = message_;
        for (const auto& [key, value] : statistics_) r.statistics[key] = value;
        return r;
    }

    const ExternalProgram& program_;
    const LabelingProblem& problem_;
    const SolveOptions options_;
    const std::int64_t memory_;  ///< MiB, 0 = no limit
    const RowStyle rows_;
    RunControl control_;
    Value total_ = 0, largest_ = 0;
    std::optional<Solution> best_;
    std::optional<Value> bound_;
    bool is_infeasible_ = false;
    std::string program_name_, message_;
    std::map<std::string, double> statistics_;
};

class ExternalSolver final : public Solver {
public:
    explicit ExternalSolver(ExternalProgram program) : program_(std::move(program)) {}
    std::string name() const override { return program_.name; }
    std::string description() const override { return program_.description; }
    bool is_exact() const override { return true; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        ExternalProgram program = program_;
        if (program.command.empty()) {
            require_known_extras(options, name(),
                                 {"rows", "command", "memory", "python", "format", "answer"});
            choose_formats(options, program);
        } else {
            require_known_extras(options, name(), {"rows", "command", "memory", "python"});
        }
        if (const auto it = options.extra.find("command"); it != options.extra.end()) {
            program.command = it->second;
        }
        if (program.command.empty()) {
            throw InputError("solver external needs the option 'command'");
        }
        return ExternalRun(program, problem, options).run();
    }

private:
    static void choose_formats(const SolveOptions& options, ExternalProgram& program) {
        if (const auto it = options.extra.find("format"); it != options.extra.end()) {
            program.problem_format = problem_format("problem." + it->second);
        }
        const auto it = options.extra.find("answer");
        if (it == options.extra.end()) return;
        static const std::map<std::string, AnswerFormat> kAnswers{
            {"worker", AnswerFormat::Worker},
            {"glpk", AnswerFormat::Glpk},
            {"pb", AnswerFormat::PseudoBoolean},
            {"toulbar2", AnswerFormat::Toulbar2},
            {"columns", AnswerFormat::Columns}};
        const auto answer = kAnswers.find(it->second);
        if (answer == kAnswers.end()) {
            throw InputError("option answer: '" + it->second +
                             "' is not worker, glpk, pb, toulbar2 or columns");
        }
        program.answer_format = answer->second;
    }

    ExternalProgram program_;
};

}  // namespace

std::shared_ptr<const Solver> make_external_solver(ExternalProgram program) {
    return std::make_shared<ExternalSolver>(std::move(program));
}

}  // namespace labeling
