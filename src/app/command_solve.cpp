#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "app/adaptation_arguments.h"
#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "labeling/formats.h"
#include "labeling/proving_search.h"
#include "labeling_mip/mip_solvers.h"

namespace fcn::app {
namespace {

struct SolveArguments {
    CommonArguments common;
    LimitArguments limits;
    std::string problem_path;
    std::string solver = "auto";
    std::string start_path;
    std::string output;
    std::string proof_path;
    std::vector<std::string> extra;
};

void add_extra_options(labeling::SolveOptions& options, const std::vector<std::string>& extra) {
    for (const std::string& entry : extra) {
        const std::size_t equals = entry.find('=');
        if (equals == std::string::npos || equals == 0)
            throw UsageError(fmt::format("--option: '{}' is not of the form NAME=VALUE", entry));
        options.extra[entry.substr(0, equals)] = entry.substr(equals + 1);
    }
}

labeling::SolveOptions solve_options(const SolveArguments& arguments,
                                     const labeling::LabelingProblem& problem) {
    labeling::SolveOptions options = arguments.limits.solve_options(arguments.common);
    options.threads = arguments.common.thread_count();
    add_extra_options(options, arguments.extra);
    if (!arguments.start_path.empty()) {
        const labeling::Solution start = labeling::read_solution(arguments.start_path, problem);
        options.warm_start.assign(start.labels.begin(), start.labels.end());
    }
    return options;
}

std::string in_real_units(const labeling::LabelingProblem& problem, labeling::Value value) {
    if (problem.units_per_one() == 1) return fmt::format("{}", value);
    return fmt::format("{} ({:.6f} real)", value,
                       static_cast<double>(value) / problem.units_per_one());
}

void print_result(const labeling::LabelingProblem& problem, const labeling::SolveResult& result,
                  bool has_timings) {
    fmt::print("problem    {} labels, {} conflicts, {} bonuses, {} rules\n", problem.label_count(),
               problem.conflict_count(), problem.bonus_count(), problem.rule_count());
    fmt::print("solver     {}\nstatus     {} ({})\n", result.solver,
               labeling::to_string(result.status), labeling::to_string(result.stop_reason));
    if (result.solution)
        fmt::print("value      {}\n", in_real_units(problem, result.solution->value));
    if (result.bound) fmt::print("bound      {}\n", in_real_units(problem, *result.bound));
    if (const auto gap = result.relative_gap()) fmt::print("gap        {:.4f} %\n", 100 * *gap);
    if (has_timings) fmt::print("seconds    {:.3f}\n", result.seconds);
    if (!result.message.empty()) fmt::print("note       {}\n", result.message);
}

labeling::SolveResult run_solver(const labeling::LabelingProblem& problem,
                                 const SolveArguments& arguments) {
    labeling::SolveOptions options = solve_options(arguments, problem);
    ProgressBar bar(!arguments.common.is_quiet && !arguments.common.is_json);
    const double limit = arguments.limits.time_limit;
    options.on_improvement = [&](const labeling::TracePoint& point) {
        bar.show(fmt::format("{} value {}", arguments.solver, point.value.value_or(0)),
                 limit > 0 ? point.seconds / limit : 0);
    };
    return find_solver(arguments.solver)->solve(problem, options);
}

/// Writes the proof; false when there is none (interrupted, or larger than ProofOptions allows).
bool write_proof(const labeling::LabelingProblem& problem, const labeling::SolveResult& result,
                 const SolveArguments& arguments) {
    labeling::ProofOptions options;
    options.stop = arguments.limits.solve_options(arguments.common).stop;
    const labeling::ProofResult proof =
        labeling::prove_optimality(problem, result.solution, labeling::clp_factory(), options);
    if (!proof.is_complete) {
        print_note(arguments.common, fmt::format("no proof after {} nodes", proof.nodes));
        return false;
    }
    save_text(arguments.proof_path, proof.proof);
    print_note(arguments.common,
               fmt::format("{}: {}, {} nodes, {} bytes", arguments.proof_path,
                           proof.solution ? fmt::format("value {} proven", proof.solution->value)
                                          : std::string("infeasibility proven"),
                           proof.nodes, proof.proof.size()));
    return true;
}

/// Taking millions of rules apart takes longer than an answer to Ctrl-C may.
const labeling::LabelingProblem& kept_to_the_end(labeling::LabelingProblem problem) {
    static const auto* const kept = new labeling::LabelingProblem(std::move(problem));
    return *kept;
}

int solve(const SolveArguments& arguments) {
    if (!arguments.output.empty())
        prepare_output(arguments.output, OutputKind::Other, arguments.common);
    if (!arguments.proof_path.empty())
        prepare_output(arguments.proof_path, OutputKind::Other, arguments.common);
    const labeling::LabelingProblem& problem =
        kept_to_the_end(load_problem(arguments.problem_path));
    const labeling::SolveResult result = run_solver(problem, arguments);
    if (result.solution && !arguments.output.empty())
        save_text(arguments.output, labeling::format_solution(*result.solution));
    if (arguments.common.is_json)
        print_json(solve_result_json(problem, result, !arguments.common.is_timeless));
    else if (arguments.output != "-")
        print_result(problem, result, !arguments.common.is_timeless);
    if (result.stop_reason == labeling::StopReason::Interrupted && result.solution)
        print_note(arguments.common, "interrupted: this is the best solution so far");
    const bool is_answered = result.solution || result.status == labeling::SolveStatus::Infeasible;
    if (!is_answered) return kNoResult;
    if (arguments.proof_path.empty()) return kDone;
    return write_proof(problem, result, arguments) ? kDone : kNoResult;
}

}  // namespace

Command add_solve_command(CLI::App& program) {
    auto arguments = std::make_shared<SolveArguments>();
    CLI::App* parser = program.add_subcommand("solve", "Solve a labeling problem");
    parser
        ->add_option("PROBLEM", arguments->problem_path,
                     ".lab, .mps, .lp or .opb, .gz allowed; - for .lab on standard input")
        ->required();
    parser->add_option("--solver", arguments->solver, "One of: " + solver_names())
        ->capture_default_str();
    parser->add_option("-o,--output", arguments->output, "Solution file (- for standard output)");
    parser->add_option("--start", arguments->start_path, "Solution file to start from");
    parser->add_option("--proof", arguments->proof_path,
                       "Then prove the value optimal by a search of its own and write the proof "
                       "(VeriPB 2.0, against the problem as .opb)");
    parser->add_option("--option", arguments->extra, "Option of the solver, NAME=VALUE; repeatable")
        ->expected(1)
        ->take_all();
    add_limit_arguments(*parser, arguments->limits);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n"
        "  scalefcn solve problem_1.lab.gz --solver local-search --time-limit 10 -o best.sol");
    return {parser, [arguments] { return solve(*arguments); }};
}

}  // namespace fcn::app
