// METIS graphs with vertex weights, which solvers of maximum weight independent set read. Without
// rules and negative weights a labeling problem is one: a vertex per label, then one per bonus; a
// bonus stands for both of its labels, so it excludes what either of them excludes, and some best
// set contains the labels of each of its bonuses. Read back, every vertex is a label: the optimum
// stays, labels and bonuses do not. A problem without bonuses comes back as it was.
#include <algorithm>

#include "labeling/errors.h"
#include "labeling/formats_detail.h"
#include "labeling/text_file.h"

namespace labeling::detail {
namespace {

/// Moves to the next line that is not a comment.
bool next_line(LineReader& reader) {
    while (reader.next()) {
        if (reader.words().empty() || reader.words()[0][0] != '%') return true;
    }
    return false;
}

std::int64_t size(const LineReader& reader, std::size_t word, std::string_view what,
                  std::size_t most) {
    const std::int64_t number = reader.integer(word, what);
    if (number < 0 || number > static_cast<std::int64_t>(most)) {
        reader.fail(std::string(what) + " " + std::to_string(number) +
                    " exceeds the file's length");
    }
    return number;
}

/// Neighbours of every vertex, ascending.
std::vector<std::vector<std::int32_t>> vertex_neighbours(const LabelingProblem& problem) {
    const auto n = problem.label_count();
    const auto bonuses = problem.bonuses();
    const auto count = static_cast<std::int32_t>(static_cast<std::size_t>(n) + bonuses.size());
    std::vector<std::vector<std::int32_t>> bonus_of(n), neighbours(count);
    for (std::size_t k = 0; k < bonuses.size(); ++k) {
        const auto vertex = static_cast<std::int32_t>(n + k);
        bonus_of[bonuses[k].first].push_back(vertex);
        bonus_of[bonuses[k].second].push_back(vertex);
    }
    for (const Conflict& c : problem.conflicts()) {
        std::vector<std::int32_t> with_first = bonus_of[c.first], with_second = bonus_of[c.second];
        with_first.push_back(c.first);
        with_second.push_back(c.second);
        for (std::int32_t a : with_first) {
            for (std::int32_t b : with_second) {
                neighbours[a].push_back(b);
                neighbours[b].push_back(a);
            }
        }
    }
    for (auto& list : neighbours) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return neighbours;
}

}  // namespace

LabelingProblem parse_metis(std::string_view text, std::string_view source) {
    LineReader reader(text, source);
    if (!next_line(reader)) throw InputError(std::string(source) + ": empty file");
    const auto& head = reader.words();
    if (head.size() < 2 || head.size() > 4) reader.fail("expected '<vertices> <edges> 10'");
    const std::int64_t vertices = size(reader, 0, "number of vertices", text.size());
    const std::int64_t edges = size(reader, 1, "number of edges", text.size());
    const std::string_view kind = head.size() > 2 ? head[2] : "0";
    const bool has_weights = kind == "10" || kind == "010";
    if (!has_weights && kind != "0" && kind != "000" && kind != "00") {
        reader.fail("kind '" + std::string(kind) + "' is not 0 or 10 (vertex weights alone)");
    }
    if (head.size() > 3 && head[3] != "1") reader.fail("more than one weight per vertex");
    std::vector<std::pair<std::int64_t, std::int64_t>> ends;
    ProblemBuilder builder;
    for (std::int64_t v = 1; v <= vertices; ++v) {
        if (!next_line(reader)) {
            throw InputError(std::string(source) + ": vertex " + std::to_string(v) +
                             " has no line: the file is cut short");
        }
        const std::int64_t weight = has_weights ? reader.integer(0, "weight") : 1;
        if (weight < 0 || weight > kMaxTotal) reader.fail("the weight is not in 0 .. 2^53");
        builder.add_label(weight);
        for (std::size_t k = has_weights ? 1 : 0; k < reader.words().size(); ++k) {
            const std::int64_t other = reader.integer(k, "vertex");
            if (other < 1 || other > vertices || other == v) {
                reader.fail("vertex " + std::to_string(v) + " cannot have the neighbour " +
                            std::to_string(other));
            }
            ends.emplace_back(v, other);
        }
    }
    std::sort(ends.begin(), ends.end());
    for (const auto& [a, b] : ends) {
        if (!std::binary_search(ends.begin(), ends.end(), std::pair(b, a))) {
            throw InputError(std::string(source) + ": vertex " + std::to_string(a) +
                             " names the neighbour " + std::to_string(b) +
                             ", which does not name it");
        }
        if (a < b) builder.add_conflict(static_cast<Label>(a - 1), static_cast<Label>(b - 1));
    }
    LabelingProblem problem = [&] {
        try {
            return builder.build();
        } catch (const InputError& error) {
            throw InputError(std::string(source) + ": " + error.what());
        }
    }();
    if (static_cast<std::int64_t>(problem.conflict_count()) != edges) {
        throw InputError(std::string(source) + ": announces " + std::to_string(edges) +
                         " edges, holds " + std::to_string(problem.conflict_count()));
    }
    return problem;
}

std::string format_metis(const LabelingProblem& problem) {
    if (problem.rule_count() > 0) {
        throw InputError("a METIS graph holds no rules; this problem has " +
                         std::to_string(problem.rule_count()));
    }
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (problem.weight(i) < 0) {
            throw InputError("a METIS graph holds no negative weights; label " +
                             std::to_string(i + 1) + " has " + std::to_string(problem.weight(i)));
        }
    }
    const auto neighbours = vertex_neighbours(problem);
    std::size_t ends = 0;
    for (const auto& list : neighbours) ends += list.size();
    std::string out = std::to_string(neighbours.size()) + " " + std::to_string(ends / 2) + " 10\n";
    for (std::size_t v = 0; v < neighbours.size(); ++v) {
        const auto n = static_cast<std::size_t>(problem.label_count());
        append(out, v < n ? problem.weight(static_cast<Label>(v)) : problem.bonuses()[v - n].value);
        for (std::int32_t other : neighbours[v]) {
            out += ' ';
            append(out, other + 1);
        }
        out += '\n';
    }
    return out;
}

}  // namespace labeling::detail
