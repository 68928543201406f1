// Fuzz target for the readers of labeling problems (.lab, MPS, LP, OPB, CFN, METIS) and of
// solutions: each input goes to all of them. Only InputError may escape. What a reader accepts must
// come back the same from every format, and the solvers must live through it.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/solver.h"

namespace {

using labeling::LabelingProblem;
using labeling::ProblemFormat;
using labeling::RowStyle;

constexpr labeling::Label kMostSolvedLabels = 200;

[[noreturn]] void fail(const char* what, const std::string& text) {
    std::fprintf(stderr, "%s:\n%s\n", what, text.c_str());
    std::abort();
}

void check_round_trips(const LabelingProblem& problem) {
    for (ProblemFormat format :
         {ProblemFormat::Lab, ProblemFormat::Mps, ProblemFormat::Lp, ProblemFormat::Cfn}) {
        const bool needs_label = format == ProblemFormat::Lp || format == ProblemFormat::Cfn;
        if (needs_label && problem.label_count() == 0) continue;
        const std::string text = labeling::format_problem(problem, format, RowStyle::Paper);
        const LabelingProblem again = labeling::parse_problem(text, format, "again");
        if (again.hash() != problem.hash()) fail("comes back as another problem", text);
        labeling::parse_problem(labeling::format_problem(problem, format, RowStyle::Strengthened),
                                format, "strengthened");
    }
}

void check_solving(const LabelingProblem& problem) {
    if (problem.label_count() > kMostSolvedLabels) return;
    static const labeling::SolverRegistry solvers = labeling::builtin_solvers();
    labeling::SolveOptions options;
    options.work_limit = 300;
    for (const char* name : {"local-search", "auto"}) {
        const labeling::SolveResult result = solvers.find(name)->solve(problem, options);
        if (result.solution && !check_solution(problem, *result.solution).is_feasible) {
            fail(name, labeling::format_problem(problem, ProblemFormat::Lab));
        }
    }
}

void check_solution_reader(const std::string& text) {
    static const LabelingProblem problem = [] {
        labeling::ProblemBuilder builder;
        for (int k = 0; k < 5; ++k) builder.add_label(k);
        return builder.build();
    }();
    try {
        const labeling::Solution solution = labeling::parse_solution(text, "fuzz", problem);
        const std::string written = labeling::format_solution(solution);
        if (labeling::parse_solution(written, "again", problem).labels != solution.labels) {
            fail("comes back as another solution", written);
        }
    } catch (const labeling::InputError&) {
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    for (ProblemFormat format : {ProblemFormat::Lab, ProblemFormat::Mps, ProblemFormat::Lp,
                                 ProblemFormat::Opb, ProblemFormat::Cfn, ProblemFormat::Metis}) {
        LabelingProblem problem;
        try {
            problem = labeling::parse_problem(text, format, "fuzz");
        } catch (const labeling::InputError&) {
            continue;
        }
        check_round_trips(problem);
        check_solving(problem);
    }
    check_solution_reader(text);
    return 0;
}
