// Fuzz target for the proof checker: an input is an OPB problem, a line of '=', and a proof. The
// checker must live through anything, and what it calls valid must be true of the problem, which is
// enumerated where it has few variables.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/proof_checker.h"

namespace {

constexpr labeling::Label kMostLabels = 12;

[[noreturn]] void fail(const char* what, const std::string& input) {
    std::fprintf(stderr, "%s:\n%s\n", what, input.c_str());
    std::abort();
}

/// Least cost; nullopt when there is no solution.
std::optional<labeling::Value> least_cost(const labeling::LabelingProblem& problem) {
    std::optional<labeling::Value> most;
    labeling::Solution solution;
    solution.labels.resize(static_cast<std::size_t>(problem.label_count()));
    for (std::uint32_t set = 0; set < (1U << problem.label_count()); ++set) {
        for (std::size_t i = 0; i < solution.labels.size(); ++i) solution.labels[i] = set >> i & 1U;
        const auto check = check_solution(problem, solution);
        if (check.is_feasible && (!most || check.value > *most)) most = check.value;
    }
    return most ? std::optional(-*most) : std::nullopt;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string input(reinterpret_cast<const char*>(data), size);
    const std::size_t line = input.find("\n=\n");
    if (line == std::string::npos) return 0;
    const std::string opb = input.substr(0, line + 1);
    const labeling::ProofCheck check = labeling::check_proof(opb, input.substr(line + 3));
    if (!check.is_valid) {
        if (check.message.empty()) fail("rejected without a word", input);
        return 0;
    }
    labeling::LabelingProblem problem;
    try {
        problem = labeling::parse_problem(opb, labeling::ProblemFormat::Opb, "fuzz");
    } catch (const labeling::InputError&) {
        return 0;  // the checker knows more of OPB than the reader of labeling problems
    }
    if (problem.label_count() > kMostLabels) return 0;
    const auto cost = least_cost(problem);
    if (!check.lower && !check.upper) {
        if (cost) fail("proven infeasible, but it has a solution", input);
        return 0;
    }
    if (!cost) fail("bounds of an infeasible problem", input);
    if ((check.lower && *check.lower > *cost) || (check.upper && *check.upper < *cost)) {
        fail("the optimum is outside the proven bounds", input);
    }
    return 0;
}
