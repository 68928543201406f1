#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "labeling/formats.h"
#include "labeling/proof_checker.h"

namespace fcn::app {
namespace {

struct VerifyArguments {
    CommonArguments common;
    std::string problem_path;
    std::string solution_path;
    std::string proof_path;
};

/// What is wrong with the proof that no labeling is better than `value`; empty: nothing.
std::string fault_of_proof(const labeling::LabelingProblem& problem, labeling::Value value,
                           const std::string& path) {
    const labeling::ProofCheck check = labeling::check_proof(
        labeling::format_problem(problem, labeling::ProblemFormat::Opb), read_text(path));
    if (!check.is_valid) return path + ": " + check.message;
    if (!check.lower) return path + " proves that there is no solution";
    if (*check.lower != -value)
        return fmt::format("{} proves that no labeling is better than {}, not {}", path,
                           -*check.lower, value);
    return {};
}

int verify(const VerifyArguments& arguments) {
    if (arguments.problem_path == "-" && arguments.solution_path == "-")
        throw UsageError("verify: only one of PROBLEM and SOLUTION can be standard input");
    const labeling::LabelingProblem problem = load_problem(arguments.problem_path);
    const labeling::Solution solution = labeling::parse_solution(read_text(arguments.solution_path),
                                                                 arguments.solution_path, problem);
    const labeling::SolutionCheck check = labeling::check_solution(problem, solution);
    std::string fault = check.is_feasible && check.value_matches ? "" : check.message;
    const bool has_proof = !arguments.proof_path.empty();
    if (fault.empty() && has_proof)
        fault = fault_of_proof(problem, solution.value, arguments.proof_path);
    const bool is_right = fault.empty();
    if (arguments.common.is_json) {
        Json conflicts = Json::array();
        for (const labeling::Conflict& conflict : check.violated_conflicts)
            conflicts.push_back({conflict.first + 1, conflict.second + 1});
        Json rules = Json::array();
        for (const std::int32_t rule : check.violated_rules) rules.push_back(rule + 1);
        print_json({{"feasible", check.is_feasible},
                    {"value", check.value},
                    {"claimed_value", solution.value},
                    {"value_matches", check.value_matches},
                    {"violated_conflicts", conflicts},
                    {"violated_rules", rules},
                    {"proven_optimal", has_proof && is_right},
                    {"message", fault}});
    } else if (is_right) {
        fmt::print("feasible, value {}{}\n", check.value, has_proof ? ", proven optimal" : "");
    } else {
        fmt::print("WRONG: {}\n", fault);
    }
    return is_right ? kDone : kViolation;
}

}  // namespace

Command add_verify_command(CLI::App& program) {
    auto arguments = std::make_shared<VerifyArguments>();
    CLI::App* parser = program.add_subcommand(
        "verify", "Check a solution of a labeling problem in exact integers");
    parser
        ->add_option("PROBLEM", arguments->problem_path,
                     "Labeling problem (- for .lab on "
                     "standard input)")
        ->required();
    parser->add_option("SOLUTION", arguments->solution_path, "Solution (- for standard input)")
        ->required();
    parser->add_option("--proof", arguments->proof_path,
                       "Proof of optimality in VeriPB's format, to be checked as well");
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Exit code 5 when the solution is infeasible, its stated value is wrong, or the\n"
        "proof does not show that it is optimal.\n"
        "Example:\n  scalefcn verify problem_1.lab.gz best.sol");
    return {parser, [arguments] { return verify(*arguments); }};
}

}  // namespace fcn::app
