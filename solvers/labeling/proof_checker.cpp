// Cutting planes (Cook, Coullard, Turan 1987) and reverse unit propagation over pseudo-Boolean
// constraints sum c_v x_v >= d, in the text form of VeriPB 2.0. Constraints are kept with signed
// coefficients; division and saturation go through the form with positive coefficients on literals.
// Propagation keeps one slack a constraint: what the best assignment of the free variables leaves
// above d.
#include "labeling/proof_checker.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace labeling {
namespace {

__extension__ using Wide = __int128;
constexpr Wide kLargest = Wide{1} << 100;

struct Rejected : std::runtime_error {
    using std::runtime_error::runtime_error;
};

[[noreturn]] void reject(const std::string& message) { throw Rejected(message); }

Wide guarded(Wide value) {
    if (value > kLargest || value < -kLargest) reject("a number exceeds 2^100");
    return value;
}

Wide product(Wide a, Wide b) {
    const Wide size = b < 0 ? -b : b;
    if (size > 1 && (a > kLargest / size || a < -kLargest / size)) {
        reject("a number exceeds 2^100");
    }
    return a * b;
}

struct Constraint {
    std::map<int, Wide> coefficients;  ///< by variable, none zero
    Wide degree = 0;

    void add(int variable, Wide coefficient) {
        Wide& c = coefficients[variable];
        c = guarded(c + coefficient);
        if (c == 0) coefficients.erase(variable);
    }

    /// coefficient * literal on the left-hand side.
    void add_literal(int variable, bool is_negated, Wide coefficient) {
        if (!is_negated) return add(variable, coefficient);
        add(variable, -coefficient);
        degree = guarded(degree - coefficient);
    }

    void add(const Constraint& other) {
        for (const auto& [v, c] : other.coefficients) add(v, c);
        degree = guarded(degree + other.degree);
    }

    void multiply(Wide factor) {
        for (auto& [v, c] : coefficients) c = product(c, factor);
        degree = product(degree, factor);
        if (factor == 0) coefficients.clear();
    }

    /// Degree over literals with positive coefficients.
    Wide literal_degree() const {
        Wide result = degree;
        for (const auto& [v, c] : coefficients) {
            if (c < 0) result = guarded(result - c);
        }
        return result;
    }

    /// Sets |coefficients| and the degree over literals.
    template <class Change>
    void change_literals(Change change, Wide new_degree) {
        degree = new_degree;
        for (auto it = coefficients.begin(); it != coefficients.end();) {
            const bool is_negated = it->second < 0;
            const Wide size = change(is_negated ? -it->second : it->second);
            if (is_negated) degree = guarded(degree - size);
            it->second = is_negated ? -size : size;
            it = size == 0 ? coefficients.erase(it) : std::next(it);
        }
    }

    void divide(Wide divisor) {
        const auto up = [&](Wide x) { return x > 0 ? (x + divisor - 1) / divisor : x / divisor; };
        const Wide whole = literal_degree();
        change_literals(up, up(whole));
    }

    void saturate() {
        const Wide whole = std::max<Wide>(0, literal_degree());
        change_literals([&](Wide x) { return std::min(x, whole); }, whole);
    }

    /// What is left above the degree when every variable does its best.
    Wide slack() const {
        Wide result = -degree;
        for (const auto& [v, c] : coefficients) {
            if (c > 0) result = guarded(result + c);
        }
        return result;
    }
};

/// Words of a line.
class Words {
public:
    explicit Words(std::string_view line) : rest_(line) {}
    std::string_view next() {
        const std::size_t begin = rest_.find_first_not_of(" \t\r");
        if (begin == std::string_view::npos) return {};
        rest_.remove_prefix(begin);
        const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r"));
        rest_.remove_prefix(word.size());
        return word;
    }

private:
    std::string_view rest_;
};

std::int64_t to_number(std::string_view word) {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
        reject("'" + std::string(word) + "' is not an integer");
    }
    return value;
}

class Checker {
public:
    void read_opb(std::string_view text) {
        for_each_line(text, [&](std::string_view line) { read_statement(line); });
        for (const auto& [id, stored] : constraints_) inputs_.push_back(stored.constraint);
    }

    ProofCheck check(std::string_view text) {
        for_each_line(text, [&](std::string_view line) { read_step(line); });
        if (!has_ended_) reject("the proof does not end");
        result_.is_valid = true;
        return result_;
    }

    std::int64_t line() const { return line_; }

private:
    template <class Read>
    void for_each_line(std::string_view text, Read read) {
        line_ = 0;
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++line_;
            const std::string_view line = text.substr(0, end);
            if (!line.empty() && line[0] != '*') read(line);
            text.remove_prefix(std::min(end + 1, text.size()));
        }
    }

    struct Literal {
        int variable = 0;
        bool is_negated = false;
    };

    Literal literal(std::string_view word, bool may_be_new) {
        const bool is_negated = !word.empty() && word[0] == '~';
        if (is_negated) word.remove_prefix(1);
        if (word.size() < 2 || word[0] != 'x') reject("'" + std::string(word) + "' is no literal");
        const auto found = variables_.find(std::string(word));
        if (found != variables_.end()) return {found->second, is_negated};
        if (!may_be_new) reject("unknown variable " + std::string(word));
        const int variable = static_cast<int>(variables_.size());
        variables_.emplace(word, variable);
        uses_.emplace_back();
        return {variable, is_negated};
    }

    void read_statement(std::string_view line) {
        Words words(line);
        std::string_view word = words.next();
        if (word.empty()) return;
        const bool is_objective = word == "min:";
        if (is_objective) word = words.next();
        Constraint constraint;
        for (; word != ">=" && word != "=" && word != ";"; word = words.next()) {
            if (word.empty()) reject("a statement without an end");
            const std::int64_t coefficient = to_number(word);
            const Literal l = literal(words.next(), true);
            constraint.add_literal(l.variable, l.is_negated, coefficient);
        }
        if (is_objective) {
            if (word != ";" || constraint.degree != 0) reject("a malformed objective");
            objective_ = std::move(constraint);
            return;
        }
        if (word == ";") reject("a constraint without >= or =");
        constraint.degree = guarded(constraint.degree + to_number(words.next()));
        if (words.next() != ";") reject("';' expected");
        if (word == "=") {
            Constraint opposite = constraint;
            opposite.multiply(-1);
            insert(std::move(constraint));
            insert(std::move(opposite));
        } else {
            insert(std::move(constraint));
        }
    }

    void read_step(std::string_view line) {
        Words words(line);
        const std::string_view step = words.next();
        if (step.empty()) return;
        if (has_ended_) reject("text after the end");
        if (!has_header_) {
            if (line != "pseudo-Boolean proof version 2.0") reject("not a proof of version 2.0");
            has_header_ = true;
        } else if (step == "f") {
            if (to_number(words.next()) != static_cast<std::int64_t>(inputs_.size())) {
                reject("the problem has " + std::to_string(inputs_.size()) + " constraints");
            }
        } else if (step == "soli") {
            read_solution(words);
        } else if (step == "pol") {
            insert(read_polish(words));
        } else if (step == "rup") {
            read_rup(words);
        } else if (step == "del") {
            read_deletion(words);
        } else if (step == "output") {
            if (words.next() != "NONE") reject("only output NONE is known");
        } else if (step == "conclusion") {
            read_conclusion(words);
        } else if (step == "end") {
            if (!has_conclusion_) reject("no conclusion before the end");
            has_ended_ = true;
        } else {
            reject("unknown step '" + std::string(step) + "'");
        }
        if (has_ended_ && step != "end") reject("text after the end");
    }

    void read_solution(Words& words) {
        std::vector<int> value(variables_.size(), -1);
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            const Literal l = literal(word, false);
            if (value[l.variable] >= 0) reject("a variable given twice");
            value[l.variable] = l.is_negated ? 0 : 1;
        }
        if (std::ranges::count(value, -1) > 0) reject("a solution that leaves variables open");
        const auto sum = [&](const Constraint& c) {
            Wide total = 0;
            for (const auto& [v, coefficient] : c.coefficients) {
                if (value[v] == 1) total = guarded(total + coefficient);
            }
            return total;
        };
        // Deleted constraints bind solutions as well; those derived since bind only better ones.
        for (std::size_t k = 0; k < inputs_.size(); ++k) {
            if (sum(inputs_[k]) < inputs_[k].degree) {
                reject("the solution violates constraint " + std::to_string(k + 1));
            }
        }
        const auto objective = static_cast<std::int64_t>(sum(objective_));
        if (best_ && objective >= *best_) reject("the solution is not better than the last");
        best_ = objective;
        Constraint better = objective_;
        better.multiply(-1);
        better.degree = -static_cast<Wide>(objective) + 1;
        insert(std::move(better));
    }

    const Constraint& constraint(std::int64_t id) const {
        const auto found = constraints_.find(id);
        if (found == constraints_.end()) reject("no constraint " + std::to_string(id));
        return found->second.constraint;
    }

    Constraint read_polish(Words& words) {
        // Numbers mean constraints, but the top of the stack is a factor when * or d follows.
        std::vector<Constraint> stack;
        const auto top = [&]() -> Constraint& {
            if (stack.empty()) reject("an operation on an empty stack");
            return stack.back();
        };
        for (std::string_view word = words.next(); !word.empty();) {
            std::string_view following = words.next();
            if (following == "*" || following == "d") {
                const std::int64_t number = to_number(word);
                if (following == "*" && number < 0) reject("a negative factor");
                if (following == "d" && number <= 0) reject("a divisor that is not positive");
                if (following == "*") top().multiply(number);
                if (following == "d") top().divide(number);
                following = words.next();
            } else if (word == "+") {
                const Constraint last = top();
                stack.pop_back();
                top().add(last);
            } else if (word == "s") {
                top().saturate();
            } else if (word[0] == 'x' || word[0] == '~') {
                const Literal l = literal(word, false);
                stack.emplace_back();
                stack.back().add_literal(l.variable, l.is_negated, 1);
            } else {
                stack.push_back(constraint(to_number(word)));
            }
            word = following;
        }
        if (stack.size() != 1) reject("the stack does not end with one constraint");
        return std::move(stack.back());
    }

    void read_rup(Words& words) {
        Constraint claim;
        std::string_view word = words.next();
        for (; word != ">="; word = words.next()) {
            if (word.empty()) reject("a constraint without >=");
            const std::int64_t coefficient = to_number(word);
            const Literal l = literal(words.next(), false);
            claim.add_literal(l.variable, l.is_negated, coefficient);
        }
        claim.degree = guarded(claim.degree + to_number(words.next()));
        if (words.next() != ";" || !words.next().empty()) reject("';' expected at the end");
        Constraint negation = claim;
        negation.multiply(-1);
        negation.degree = guarded(negation.degree + 1);
        if (!leads_to_conflict(negation)) reject("propagation does not lead to a conflict");
        insert(std::move(claim));
    }

    void read_deletion(Words& words) {
        if (words.next() != "id") reject("only del id is known");
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            const std::int64_t id = to_number(word);
            const Constraint gone = constraint(id);
            for (const auto& [v, c] : gone.coefficients) std::erase(uses_[v], id);
            constraints_.erase(id);
            std::erase(eager_, id);
        }
    }

    void read_conclusion(Words& words) {
        if (has_conclusion_) reject("a second conclusion");
        has_conclusion_ = true;
        const bool is_contradiction = std::ranges::any_of(
            constraints_, [](const auto& entry) { return entry.second.slack < 0; });
        if (words.next() != "BOUNDS") reject("only conclusion BOUNDS is known");
        const std::string_view lower = words.next(), upper = words.next();
        if (!words.next().empty()) reject("text after the bounds");
        if (!is_contradiction) reject("the bounds need a contradiction");
        if (lower == "INF" && upper == "INF") {
            if (best_) reject("infeasible, but there was a solution");
            return;
        }
        result_.lower = to_number(lower);
        result_.upper = to_number(upper);
        if (!best_ || *result_.upper < *best_) reject("no solution is that good");
        if (*result_.lower > *best_) reject("the lower bound is not proven");
    }

    struct Stored {
        Constraint constraint;
        Wide slack = 0;
    };

    void insert(Constraint constraint) {
        const std::int64_t id = ++last_id_;
        const Wide slack = constraint.slack();
        for (const auto& [v, c] : constraint.coefficients) uses_[v].push_back(id);
        const bool is_eager =
            slack < 0 || std::ranges::any_of(constraint.coefficients, [&](const auto& term) {
                return (term.second < 0 ? -term.second : term.second) > slack;
            });
        if (is_eager) eager_.push_back(id);
        constraints_.emplace(id, Stored{std::move(constraint), slack});
    }

    /// Unit propagation from the database and one more constraint.
    bool leads_to_conflict(const Constraint& extra) {
        std::vector<signed char> value(variables_.size(), -1);
        std::unordered_map<std::int64_t, Wide> slacks;  // of constraints that assignments touched
        Wide extra_slack = extra.slack();
        std::vector<int> queue;
        const auto assign_forced = [&](const Constraint& c, Wide slack) {
            for (const auto& [v, coefficient] : c.coefficients) {
                const Wide size = coefficient < 0 ? -coefficient : coefficient;
                if (size <= slack || value[v] >= 0) continue;
                value[v] = coefficient > 0 ? 1 : 0;
                queue.push_back(v);
            }
        };
        const auto lost = [&](Wide coefficient, int v) -> Wide {
            return (coefficient > 0) == (value[v] == 1) ? 0
                   : coefficient < 0                    ? -coefficient
                                                        : coefficient;
        };
        if (extra_slack < 0) return true;
        assign_forced(extra, extra_slack);
        for (std::int64_t id : eager_) {
            const Stored& stored = constraints_.at(id);
            if (stored.slack < 0) return true;
            assign_forced(stored.constraint, stored.slack);
        }
        for (std::size_t head = 0; head < queue.size(); ++head) {
            const int v = queue[head];
            const auto in_extra = extra.coefficients.find(v);
            if (in_extra != extra.coefficients.end()) {
                extra_slack -= lost(in_extra->second, v);
                if (extra_slack < 0) return true;
                assign_forced(extra, extra_slack);
            }
            for (std::int64_t id : uses_[v]) {
                const Stored& stored = constraints_.at(id);
                const Wide loss = lost(stored.constraint.coefficients.at(v), v);
                if (loss == 0) continue;
                const auto [slack, is_new] = slacks.try_emplace(id, stored.slack);
                slack->second -= loss;
                if (slack->second < 0) return true;
                assign_forced(stored.constraint, slack->second);
            }
        }
        return false;
    }

    std::unordered_map<std::string, int> variables_;
    std::vector<std::vector<std::int64_t>> uses_;  ///< per variable: constraints
    std::map<std::int64_t, Stored> constraints_;
    std::vector<std::int64_t> eager_;  ///< constraints that propagate before any decision
    std::vector<Constraint> inputs_;   ///< of the problem; deleting does not forget them
    Constraint objective_;
    std::int64_t last_id_ = 0, line_ = 0;
    std::optional<std::int64_t> best_;
    bool has_header_ = false, has_conclusion_ = false, has_ended_ = false;
    ProofCheck result_;
};

}  // namespace

ProofCheck check_proof(std::string_view opb, std::string_view proof) {
    Checker checker;
    const char* text = "OPB";
    try {
        checker.read_opb(opb);
        text = "proof";
        return checker.check(proof);
    } catch (const Rejected& rejected) {
        ProofCheck result;
        result.message =
            std::string(text) + " line " + std::to_string(checker.line()) + ": " + rejected.what();
        return result;
    }
}

}  // namespace labeling
