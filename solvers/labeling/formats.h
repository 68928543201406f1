#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "labeling/linear_model.h"
#include "labeling/problem.h"
#include "labeling/solution.h"

namespace labeling {

/// Lab: the native text format. Mps: free MPS. Lp: CPLEX LP. Opb: pseudo-Boolean. Cfn: cost
/// function network of toulbar2. Metis: graph with vertex weights, for maximum weight
/// independent set; refuses rules and negative weights.
enum class ProblemFormat { Lab, Mps, Lp, Opb, Cfn, Metis };

/// By file name: .lab, .mps, .lp, .opb, .cfn, .graph, each also with .gz behind it. Throws
/// InputError on another name.
ProblemFormat problem_format(const std::filesystem::path& file);

/// Reads a problem; .gz is decompressed. MPS, LP and OPB are read as far as write_problem writes
/// them: binary columns are labels, continuous columns y with rows y <= b_i, y <= b_j are bonuses.
/// CFN: variables of two values, costs on at most two of them, tables on up to eight that forbid,
/// knapsacks and cliques; a constant cost becomes one more label that a rule holds at 1.
/// Throws InputError "file:line: ..." on anything else.
LabelingProblem read_problem(const std::filesystem::path& file);

/// The same from text; `source` stands for the file in messages.
LabelingProblem parse_problem(std::string_view text, ProblemFormat format, std::string_view source);

/// Text of a problem. `rows` matters for MPS, LP and OPB alone. MPS minimises the negated
/// objective, because not every reader knows OBJSENSE; LP maximises. Names of labels are kept by
/// Lab alone.
std::string format_problem(const LabelingProblem& problem, ProblemFormat format,
                           RowStyle rows = RowStyle::Strengthened);

/// Writes atomically (temporary name, then rename), gzip for .gz.
void write_problem(const LabelingProblem& problem, const std::filesystem::path& file,
                   RowStyle rows = RowStyle::Strengthened);

/// `v <value>`, then one label per line (from 1) that is 1; `c` lines are comments. Reading checks
/// the numbers against the problem's label count, not feasibility (see check_solution).
Solution read_solution(const std::filesystem::path& file, const LabelingProblem& problem);
Solution parse_solution(std::string_view text, std::string_view source,
                        const LabelingProblem& problem);
std::string format_solution(const Solution& solution);
void write_solution(const Solution& solution, const std::filesystem::path& file);

}  // namespace labeling
