// One reader per way of answering. They take a number for what it says only after it has been
// parsed whole, is finite and in range: the text comes from a program that may have crashed in the
// middle of a line, or be another program than we think.
#include "labeling_mip/external_answer.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "labeling/errors.h"
#include "labeling/text_file.h"

namespace labeling {
namespace {

using Claim = ExternalAnswer::Claim;

constexpr std::int8_t kUnset = -1;

std::optional<double> number(std::string_view word) {
    double value = 0;
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

/// Labels that arrive one by one.
class Assignment {
public:
    explicit Assignment(Label label_count) : labels_(label_count, kUnset) {}

    void set(const LineReader& at, std::int64_t label, bool is_on) {
        if (label < 1 || label > static_cast<std::int64_t>(labels_.size())) {
            at.fail("label " + std::to_string(label) + " is out of range 1.." +
                    std::to_string(labels_.size()));
        }
        labels_[label - 1] = is_on ? 1 : 0;
        has_any_ = true;
    }
    void set_others(bool is_on) {
        for (std::int8_t& label : labels_) {
            if (label == kUnset) label = is_on ? 1 : 0;
        }
        has_any_ = true;
    }
    bool has_any() const { return has_any_; }
    /// Throws unless all are set or none.
    std::vector<std::uint8_t> take(std::string_view source) const {
        if (!has_any_) return {};
        if (std::count(labels_.begin(), labels_.end(), kUnset) > 0) {
            throw InputError(std::string(source) + ": not every label has a value");
        }
        return {labels_.begin(), labels_.end()};
    }

private:
    std::vector<std::int8_t> labels_;
    bool has_any_ = false;
};

/// 0 or 1, with the tolerance of programs that compute in floating point.
bool rounded(const LineReader& at, std::string_view word) {
    const auto value = number(word);
    if (!value || std::abs(*value - std::round(*value)) > 0.01 || std::round(*value) < 0 ||
        std::round(*value) > 1) {
        at.fail("'" + std::string(word) + "' is neither 0 nor 1");
    }
    return *value > 0.5;
}

double finite(const LineReader& at, std::string_view word) {
    const auto value = number(word);
    if (!value) at.fail("'" + std::string(word) + "' is not a finite number");
    return *value;
}

ExternalAnswer read_worker(std::string_view solution, Label label_count) {
    LineReader reader(solution, "solution file");
    ExternalAnswer answer;
    Assignment labels(label_count);
    bool has_end = false, has_status = false;
    while (!has_end && reader.next()) {
        const auto& words = reader.words();
        if (words.empty()) continue;
        const std::string_view key = words[0];
        if (key == "message") {
            answer.message = words.size() > 1 ? std::string(reader.rest(1)) : std::string();
            continue;
        }
        if (key == "end") {
            has_end = true;
            continue;
        }
        if (words.size() != 2) reader.fail("expected '<key> <value>'");
        if (key == "status") {
            has_status = true;
            const std::string_view status = words[1];
            answer.claim =
                status == "optimal"      ? Claim::Optimal
                : status == "feasible"   ? Claim::Feasible
                : status == "infeasible" ? Claim::Infeasible
                : status == "unknown"    ? Claim::Nothing
                : status == "failed"
                    ? Claim::Failed
                    : (reader.fail("unknown status '" + std::string(status) + "'"), Claim::Failed);
        } else if (key == "value") {
            answer.value = finite(reader, words[1]);
            labels.set_others(false);
        } else if (key == "bound") {
            answer.bound = finite(reader, words[1]);
        } else if (key == "seconds") {
            answer.seconds = finite(reader, words[1]);
        } else if (key == "nodes") {
            answer.nodes = finite(reader, words[1]);
        } else if (key == "label") {
            if (!answer.value) reader.fail("a label before 'value'");
            labels.set(reader, reader.integer(1, "label"), true);
        } else {
            reader.fail("unknown key '" + std::string(key) + "'");
        }
    }
    if (!has_status || !has_end) throw InputError("solution file: cut short");
    answer.labels = labels.take("solution file");
    return answer;
}

/// The last `<= bound` of a progress line `+ 12: mip = 5 <= 7 ...`, and the time.
void read_glpk_output(std::string_view output, ExternalAnswer& answer) {
    LineReader reader(output, "standard output");
    while (reader.next()) {
        const auto& words = reader.words();
        if (words.size() < 3) continue;
        if (words[0].starts_with('+')) {
            for (std::size_t k = 0; k + 1 < words.size(); ++k) {
                if (words[k] != "<=") continue;
                answer.bound = number(words[k + 1]);  // none once the "tree is empty"
            }
        } else if (words[0] == "Time" && words[1] == "used:") {
            answer.seconds = number(words[2]);
        }
    }
}

ExternalAnswer read_glpk(std::string_view solution, std::string_view output, Label label_count) {
    LineReader reader(solution, "solution file");
    ExternalAnswer answer;
    Assignment labels(label_count);
    bool has_head = false, has_end = false;
    while (!has_end && reader.next()) {
        const auto& words = reader.words();
        if (words.empty() || words[0] == "c" || words[0] == "i") continue;
        if (words[0] == "s") {
            if (words.size() != 6 || words[1] != "mip") reader.fail("expected 's mip ...'");
            has_head = true;
            const std::string_view status = words[4];
            answer.claim = status == "o"   ? Claim::Optimal
                           : status == "f" ? Claim::Feasible
                           : status == "n" ? Claim::Infeasible
                                           : Claim::Nothing;
            if (answer.claim == Claim::Optimal || answer.claim == Claim::Feasible) {
                answer.value = finite(reader, words[5]);
            }
        } else if (words[0] == "j" && words.size() == 3) {
            const std::int64_t column = reader.integer(1, "column");
            if (answer.value && column <= label_count) {
                labels.set(reader, column, rounded(reader, words[2]));
            }
        } else if (words[0] == "e") {
            has_end = true;
        } else {
            reader.fail("unknown record '" + std::string(words[0]) + "'");
        }
    }
    if (!has_head || !has_end) throw InputError("solution file: cut short");
    answer.labels = labels.take("solution file");
    read_glpk_output(output, answer);
    return answer;
}

/// `0.12s` or `0.12`.
std::optional<double> duration(std::string_view word) {
    if (word.ends_with('s')) word.remove_suffix(1);
    return number(word);
}

ExternalAnswer read_pseudo_boolean(std::string_view output, Label label_count) {
    LineReader reader(output, "standard output");
    ExternalAnswer answer;
    Assignment labels(label_count);
    bool has_status = false;
    while (reader.next()) {
        const auto& words = reader.words();
        if (words.empty()) continue;
        if (words[0] == "o" && words.size() == 2) {
            answer.value = -finite(reader, words[1]);
        } else if (words[0] == "s") {
            const std::string_view status = reader.rest(1);
            has_status = true;
            answer.claim = status == "OPTIMUM FOUND"   ? Claim::Optimal
                           : status == "SATISFIABLE"   ? Claim::Feasible
                           : status == "UNSATISFIABLE" ? Claim::Infeasible
                                                       : Claim::Nothing;
        } else if (words[0] == "v") {
            for (std::size_t k = 1; k < words.size(); ++k) {
                std::string_view word = words[k];
                const bool is_on = !word.starts_with('-');
                if (!is_on) word.remove_prefix(1);
                const auto variable = word.starts_with('x') ? number(word.substr(1)) : std::nullopt;
                if (!variable || *variable < 1) {
                    reader.fail("'" + std::string(words[k]) + "' is no variable");
                }
                if (*variable > label_count) continue;  // a bonus
                labels.set(reader, static_cast<std::int64_t>(*variable), is_on);
            }
        } else if (words[0] == "c" && words.size() > 3 && words[1] == "Time" && words[2] == ":") {
            answer.seconds = duration(words[3]);
        }
    }
    if (!has_status) throw InputError("standard output: no line 's <status>'");
    answer.labels = labels.take("standard output");
    return answer;
}

void read_toulbar2_output(std::string_view output, ExternalAnswer& answer) {
    LineReader reader(output, "standard output");
    while (reader.next()) {
        const auto& words = reader.words();
        if (words.empty()) continue;
        if (words[0] == "Optimum:" && words.size() > 1) {
            answer.claim = Claim::Optimal;
            answer.value = -finite(reader, words[1]);
            answer.bound.reset();  // gaps printed on the way are closed
        } else if (words[0] == "No" && words.size() > 1 && words[1] == "solution") {
            answer.claim = Claim::Infeasible;
        } else if (words[0] == "Optimality" && words.size() > 3 && words[1] == "gap:") {
            std::string_view lower = words[2];  // "[-12," and the upper bound behind it
            if (lower.starts_with('[')) lower.remove_prefix(1);
            if (lower.ends_with(',')) lower.remove_suffix(1);
            answer.bound = -finite(reader, lower);
        } else if (words[0] == "New" && words.size() > 2 && words[1] == "solution:") {
            answer.value = -finite(reader, words[2]);
        }
        const bool is_last = words[0] == "Optimum:" || words[0] == "No";
        for (std::size_t k = 0; is_last && k + 1 < words.size(); ++k) {
            if (words[k + 1].starts_with("seconds")) answer.seconds = number(words[k]);
            if (words[k + 1].starts_with("nodes")) answer.nodes = number(words[k]);
        }
    }
}

ExternalAnswer read_toulbar2(std::string_view solution, std::string_view output,
                             Label label_count) {
    ExternalAnswer answer;
    read_toulbar2_output(output, answer);
    LineReader reader(solution, "solution file");
    Assignment labels(label_count);
    std::int64_t count = 0;
    while (reader.next()) {
        for (std::string_view word : reader.words()) {
            labels.set(reader, ++count, rounded(reader, word));
        }
    }
    answer.labels = labels.take("solution file");
    if (answer.claim == Claim::Nothing) {
        if (answer.labels.empty() && output.find("toulbar2") == std::string_view::npos) {
            throw InputError("standard output: nothing that toulbar2 says");
        }
        if (!answer.labels.empty()) answer.claim = Claim::Feasible;
    }
    return answer;
}

ExternalAnswer read_columns(std::string_view solution, Label label_count) {
    LineReader reader(solution, "solution file");
    ExternalAnswer answer;
    Assignment labels(label_count);
    while (reader.next()) {
        const auto& words = reader.words();
        // Some programs put the column's number before its name.
        for (std::size_t k = 0; k + 1 < words.size() && k < 2; ++k) {
            if (!words[k].starts_with('b')) continue;
            const auto column = number(words[k].substr(1));
            if (!column || std::floor(*column) != *column) continue;
            if (*column < 1 || *column > label_count) {
                reader.fail("column '" + std::string(words[k]) + "' is no label");
            }
            labels.set(reader, static_cast<std::int64_t>(*column), rounded(reader, words[k + 1]));
            break;
        }
    }
    if (!labels.has_any()) throw InputError("solution file: no line 'b<label> <value>'");
    labels.set_others(false);
    answer.labels = labels.take("solution file");
    answer.claim = Claim::Feasible;
    return answer;
}

}  // namespace

ExternalAnswer read_answer(AnswerFormat format, std::string_view solution, std::string_view output,
                           Label label_count) {
    switch (format) {
        case AnswerFormat::Worker:
            return read_worker(solution, label_count);
        case AnswerFormat::Glpk:
            return read_glpk(solution, output, label_count);
        case AnswerFormat::PseudoBoolean:
            return read_pseudo_boolean(output, label_count);
        case AnswerFormat::Toulbar2:
            return read_toulbar2(solution, output, label_count);
        case AnswerFormat::Columns:
            return read_columns(solution, label_count);
    }
    throw LogicError("unknown answer format");
}

}  // namespace labeling
