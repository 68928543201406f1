#include "labeling/formats.h"

#include <charconv>

#include "labeling/errors.h"
#include "labeling/formats_detail.h"
#include "labeling/text_file.h"

namespace labeling {

void detail::append(std::string& out, std::int64_t number) {
    char digits[24];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    out.append(digits, end);
}

ProblemFormat problem_format(const std::filesystem::path& file) {
    std::filesystem::path name = file.filename();
    if (name.extension() == ".gz") name = name.stem();
    const std::string extension = name.extension().string();
    if (extension == ".lab") return ProblemFormat::Lab;
    if (extension == ".mps") return ProblemFormat::Mps;
    if (extension == ".lp") return ProblemFormat::Lp;
    if (extension == ".opb") return ProblemFormat::Opb;
    if (extension == ".cfn") return ProblemFormat::Cfn;
    if (extension == ".graph") return ProblemFormat::Metis;
    throw InputError(file.string() +
                     ": unknown kind of labeling problem; expected .lab, .mps, .lp, .opb, "
                     ".cfn or .graph, or one of these with .gz");
}

LabelingProblem parse_problem(std::string_view text, ProblemFormat format,
                              std::string_view source) {
    switch (format) {
        case ProblemFormat::Lab:
            return detail::parse_lab(text, source);
        case ProblemFormat::Mps:
            return detail::parse_mps(text, source);
        case ProblemFormat::Lp:
            return detail::parse_lp(text, source);
        case ProblemFormat::Opb:
            return detail::parse_opb(text, source);
        case ProblemFormat::Cfn:
            return detail::parse_cfn(text, source);
        case ProblemFormat::Metis:
            return detail::parse_metis(text, source);
    }
    throw LogicError("unknown problem format");
}

LabelingProblem read_problem(const std::filesystem::path& file) {
    const ProblemFormat format = problem_format(file);
    return parse_problem(read_text_file(file), format, file.string());
}

std::string format_problem(const LabelingProblem& problem, ProblemFormat format, RowStyle rows) {
    switch (format) {
        case ProblemFormat::Lab:
            return detail::format_lab(problem);
        case ProblemFormat::Mps:
            return detail::format_mps(linear_model(problem, rows));
        case ProblemFormat::Lp:
            return detail::format_lp(linear_model(problem, rows));
        case ProblemFormat::Opb:
            return detail::format_opb(linear_model(problem, rows));
        case ProblemFormat::Cfn:
            return detail::format_cfn(problem);
        case ProblemFormat::Metis:
            return detail::format_metis(problem);
    }
    throw LogicError("unknown problem format");
}

void write_problem(const LabelingProblem& problem, const std::filesystem::path& file,
                   RowStyle rows) {
    write_text_file(file, format_problem(problem, problem_format(file), rows));
}

Solution parse_solution(std::string_view text, std::string_view source,
                        const LabelingProblem& problem) {
    LineReader reader(text, source);
    Solution solution;
    solution.labels.assign(problem.label_count(), 0);
    bool has_value = false;
    while (reader.next()) {
        const auto& words = reader.words();
        if (words.empty() || words[0] == "c") continue;
        if (words[0] == "v") {
            if (has_value) reader.fail("second line 'v'");
            if (words.size() != 2) reader.fail("expected 'v <value>'");
            solution.value = reader.integer(1, "value");
            has_value = true;
            continue;
        }
        if (!has_value) reader.fail("expected 'v <value>' before the labels");
        if (words.size() != 1) reader.fail("expected one label per line");
        const std::int64_t label = reader.integer(0, "label");
        if (label < 1 || label > problem.label_count()) {
            reader.fail("label " + std::to_string(label) + " is out of range 1.." +
                        std::to_string(problem.label_count()));
        }
        if (solution.labels[label - 1] != 0) {
            reader.fail("label " + std::to_string(label) + " is listed twice");
        }
        solution.labels[label - 1] = 1;
    }
    if (!has_value) throw InputError(std::string(source) + ": no line 'v <value>'");
    return solution;
}

Solution read_solution(const std::filesystem::path& file, const LabelingProblem& problem) {
    return parse_solution(read_text_file(file), file.string(), problem);
}

std::string format_solution(const Solution& solution) {
    std::string text = "v ";
    detail::append(text, solution.value);
    text += '\n';
    for (std::size_t i = 0; i < solution.labels.size(); ++i) {
        if (solution.labels[i] == 0) continue;
        detail::append(text, static_cast<std::int64_t>(i) + 1);
        text += '\n';
    }
    return text;
}

void write_solution(const Solution& solution, const std::filesystem::path& file) {
    write_text_file(file, format_solution(solution));
}

}  // namespace labeling
