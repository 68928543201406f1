// Three labels in a row, neighbours exclude each other: the two ends (3 + 4) beat the middle (5).
#include <iostream>

#include "labeling/solver.h"

int main() {
    labeling::ProblemBuilder builder;
    const auto left = builder.add_label(3);
    const auto middle = builder.add_label(5);
    const auto right = builder.add_label(4);
    builder.add_conflict(left, middle);
    builder.add_conflict(middle, right);
    const labeling::LabelingProblem problem = builder.build();
    const auto solver = labeling::builtin_solvers().find("branch-and-bound");
    const labeling::SolveResult result = solver->solve(problem);
    std::cout << "value " << result.solution->value << "\n";
}
