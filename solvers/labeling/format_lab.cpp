// The native format, one record per line: p (sizes), s (units), l (labels), x (conflicts),
// b (bonuses), r (rules), c (comments). The sizes must come first and are checked at the end.
// Conflicts, bonuses and rules may precede the labels' own lines: two passes read the text.
#include <array>
#include <charconv>
#include <limits>

#include "labeling/errors.h"
#include "labeling/formats_detail.h"
#include "labeling/text_file.h"

namespace labeling::detail {
namespace {

struct Sizes {
    std::int64_t labels = 0, conflicts = 0, bonuses = 0, rules = 0;
};

Sizes parse_sizes(const LineReader& reader, std::size_t text_size) {
    if (reader.words().size() != 6 || reader.words()[1] != "labeling") {
        reader.fail("expected 'p labeling <labels> <conflicts> <bonuses> <rules>'");
    }
    Sizes sizes{reader.integer(2, "number of labels"), reader.integer(3, "number of conflicts"),
                reader.integer(4, "number of bonuses"), reader.integer(5, "number of rules")};
    // A record takes at least two bytes: anything larger is damage, and must not cost memory.
    for (std::int64_t size : {sizes.labels, sizes.conflicts, sizes.bonuses, sizes.rules}) {
        if (size < 0) reader.fail("negative size " + std::to_string(size));
        if (static_cast<std::uint64_t>(size) > text_size) {
            reader.fail("size " + std::to_string(size) + " exceeds the file's length");
        }
    }
    return sizes;
}

Label label_at(const LineReader& reader, std::size_t index, const Sizes& sizes) {
    const std::int64_t label = reader.integer(index, "label");
    if (label < 1 || label > sizes.labels) {
        reader.fail("label " + std::to_string(label) + " is out of range 1.." +
                    std::to_string(sizes.labels));
    }
    return static_cast<Label>(label - 1);
}

void parse_labels(std::string_view text, std::string_view source, ProblemBuilder& builder,
                  Sizes& sizes) {
    LineReader reader(text, source);
    std::vector<Value> weights;
    std::vector<std::string> names;
    std::vector<std::uint8_t> is_seen;
    bool has_sizes = false, has_units = false;
    while (reader.next()) {
        if (reader.words().empty()) continue;
        const std::string_view kind = reader.words()[0];
        if (kind == "c") continue;
        if (kind == "p") {
            if (has_sizes) reader.fail("second line 'p'");
            sizes = parse_sizes(reader, text.size());
            weights.resize(sizes.labels);
            names.resize(sizes.labels);
            is_seen.resize(sizes.labels, 0);
            has_sizes = true;
            continue;
        }
        if (!has_sizes) reader.fail("expected 'p labeling ...' before anything else");
        if (kind == "s") {
            if (has_units) reader.fail("second line 's'");
            if (reader.words().size() != 2) reader.fail("expected 's <units>'");
            has_units = true;
            try {
                builder.set_units_per_one(reader.real(1, "units"));
            } catch (const InputError& error) {
                reader.fail(error.what());
            }
        } else if (kind == "l") {
            const Label i = label_at(reader, 1, sizes);
            if (is_seen[i]) reader.fail("label " + std::to_string(i + 1) + " is given twice");
            is_seen[i] = 1;
            weights[i] = reader.integer(2, "weight");
            if (weights[i] < -kMaxTotal || weights[i] > kMaxTotal) {
                reader.fail("the weight exceeds 2^53");
            }
            names[i] = reader.rest(3);
        } else if (kind != "x" && kind != "b" && kind != "r") {
            reader.fail("unknown record '" + std::string(kind) + "'");
        }
    }
    if (!has_sizes) throw InputError(std::string(source) + ": no line 'p labeling ...'");
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!is_seen[i]) {
            throw InputError(std::string(source) + ": label " + std::to_string(i + 1) +
                             " has no line 'l'");
        }
        builder.add_label(weights[i], std::move(names[i]));
    }
}

Rule parse_rule(const LineReader& reader, const Sizes& sizes) {
    const auto& words = reader.words();
    if (words.size() < 4) reader.fail("expected 'r le|ge|eq <rhs> <k> <coef> <label> ...'");
    Rule rule;
    if (words[1] == "le") {
        rule.relation = Relation::LessEqual;
    } else if (words[1] == "ge") {
        rule.relation = Relation::GreaterEqual;
    } else if (words[1] == "eq") {
        rule.relation = Relation::Equal;
    } else {
        reader.fail("relation '" + std::string(words[1]) + "' is not le, ge or eq");
    }
    rule.right_hand_side = reader.integer(2, "right-hand side");
    const std::int64_t count = reader.integer(3, "number of terms");
    if (count < 0 || static_cast<std::uint64_t>(count) != (words.size() - 4) / 2 ||
        words.size() % 2 != 0) {
        reader.fail("the rule announces " + std::to_string(count) + " terms, the line holds " +
                    std::to_string(words.size() - 4) + " words after that");
    }
    for (std::size_t k = 4; k < words.size(); k += 2) {
        const std::int64_t coefficient = reader.integer(k, "coefficient");
        constexpr std::int64_t kLargest = std::numeric_limits<std::int32_t>::max();
        if (coefficient < -kLargest || coefficient > kLargest) {
            reader.fail("coefficient " + std::to_string(coefficient) + " exceeds 2^31 - 1");
        }
        rule.terms.push_back(
            {static_cast<std::int32_t>(coefficient), label_at(reader, k + 1, sizes)});
    }
    return rule;
}

void require_count(std::string_view source, std::int64_t found, std::int64_t announced,
                   const char* what) {
    if (found == announced) return;
    throw InputError(std::string(source) + ": announces " + std::to_string(announced) + " " + what +
                     ", holds " + std::to_string(found));
}

}  // namespace

LabelingProblem parse_lab(std::string_view text, std::string_view source) {
    ProblemBuilder builder;
    Sizes sizes;
    parse_labels(text, source, builder, sizes);
    Sizes found;
    LineReader reader(text, source);
    while (reader.next()) {
        const auto& words = reader.words();
        if (words.empty()) continue;
        try {
            if (words[0] == "x") {
                if (words.size() != 3) reader.fail("expected 'x <i> <j>'");
                builder.add_conflict(label_at(reader, 1, sizes), label_at(reader, 2, sizes));
                ++found.conflicts;
            } else if (words[0] == "b") {
                if (words.size() != 4) reader.fail("expected 'b <i> <j> <q>'");
                builder.add_bonus(label_at(reader, 1, sizes), label_at(reader, 2, sizes),
                                  reader.integer(3, "bonus"));
                ++found.bonuses;
            } else if (words[0] == "r") {
                builder.add_rule(parse_rule(reader, sizes));
                ++found.rules;
            }
        } catch (const InputError& error) {
            const std::string message = error.what();
            if (message.starts_with(source)) throw;
            reader.fail(message);
        }
    }
    require_count(source, found.conflicts, sizes.conflicts, "conflicts");
    require_count(source, found.bonuses, sizes.bonuses, "bonuses");
    require_count(source, found.rules, sizes.rules, "rules");
    try {
        return builder.build();
    } catch (const InputError& error) {
        throw InputError(std::string(source) + ": " + error.what());
    }
}

std::string format_lab(const LabelingProblem& problem) {
    std::string out = "p labeling";
    auto word = [&out](std::int64_t number) {
        out += ' ';
        append(out, number);
    };
    word(problem.label_count());
    word(static_cast<std::int64_t>(problem.conflict_count()));
    word(static_cast<std::int64_t>(problem.bonus_count()));
    word(static_cast<std::int64_t>(problem.rule_count()));
    std::array<char, 32> units{};
    const auto end =
        std::to_chars(units.data(), units.data() + units.size(), problem.units_per_one()).ptr;
    out += "\ns " + std::string(units.data(), end) + "\n";
    for (Label i = 0; i < problem.label_count(); ++i) {
        out += 'l';
        word(i + 1);
        word(problem.weight(i));
        if (!problem.name(i).empty()) out += ' ' + problem.name(i);
        out += '\n';
    }
    for (const Conflict& c : problem.conflicts()) {
        out += 'x';
        word(c.first + 1);
        word(c.second + 1);
        out += '\n';
    }
    for (const Bonus& b : problem.bonuses()) {
        out += 'b';
        word(b.first + 1);
        word(b.second + 1);
        word(b.value);
        out += '\n';
    }
    for (const Rule& rule : problem.rules()) {
        out += rule.relation == Relation::LessEqual ? "r le"
               : rule.relation == Relation::Equal   ? "r eq"
                                                    : "r ge";
        word(rule.right_hand_side);
        word(static_cast<std::int64_t>(rule.terms.size()));
        for (const Term& t : rule.terms) {
            word(t.coefficient);
            word(t.label + 1);
        }
        out += '\n';
    }
    return out;
}

}  // namespace labeling::detail
