#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "labeling/problem.h"

namespace labeling {

/// How a program says what it found.
enum class AnswerFormat {
    Worker,         ///< solution file of our Python worker, see solvers/python/labeling_worker.py
    Glpk,           ///< file of `glpsol --write` (GLPK 4.65 and later)
    PseudoBoolean,  ///< standard output of the pseudo-Boolean competitions: lines o, s, v
    Toulbar2,       ///< file of `toulbar2 -w=`, and its standard output
    Columns,        ///< solution file with a line `b<i> <number>` for each label that is not 0
};

/// What a program claims; nothing of it has been checked.
struct ExternalAnswer {
    enum class Claim { Nothing, Feasible, Optimal, Infeasible, Failed };
    Claim claim = Claim::Nothing;
    std::vector<std::uint8_t> labels;  ///< all of them, or none
    std::optional<double> value;       ///< maximised
    std::optional<double> bound;       ///< upper bound
    std::optional<double> seconds;     ///< its own solve time
    std::optional<double> nodes;
    std::string message;
};

/// Reads an answer. `solution` is the text of the solution file, `output` of standard output;
/// either may be empty. Throws InputError that names the line on numbers out of range,
/// contradictions and text in which nothing is an answer.
ExternalAnswer read_answer(AnswerFormat format, std::string_view solution, std::string_view output,
                           Label label_count);

}  // namespace labeling
