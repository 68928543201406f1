#include "labeling/solver_fuzz.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "labeling/generators.h"
#include "labeling/problems.h"
#include "labeling/registry.h"

namespace labeling_test {
namespace {

using labeling::Label;
using labeling::Solution;
using labeling::SolveOptions;
using labeling::SolveResult;
using labeling::SolveStatus;
using labeling::StopReason;

constexpr Label kMostLabels = 12;
constexpr std::int64_t kHeuristicWork = 2000;

LabelingProblem generated(std::mt19937_64& engine, std::size_t family) {
    std::map<std::string, std::string> options{{"seed", std::to_string(engine() >> 1)}};
    const auto set = [&](const char* key, std::int64_t low, std::int64_t high) {
        options[key] = std::to_string(pick(engine, low, high));
    };
    const std::string name = labeling::problem_families()[family];
    if (name == "chain") {
        set("labels", 3, 11);
        set("reach", 1, 4);
        set("lambda0", 0, 5);
    } else if (name == "planted") {
        set("cliques", 2, 3);
        set("clique_size", 2, 4);
        set("bonuses", 0, 3);
        set("rules", 0, 2);
    } else if (name == "unit-disks") {
        set("labels", 4, 12);
        set("degree", 1, 6);
    } else {
        set("bundles", 1, 2);
        set("curves", 2, 3);
        set("extent", 2, 3);
        set("lambda0", 0, 100);
    }
    return labeling::generate_problem(name, options).problem;
}

LabelingProblem of_some_family(std::mt19937_64& engine) {
    const auto families = static_cast<std::int64_t>(labeling::problem_families().size());
    const std::int64_t kind = pick(engine, 0, 7 + families);
    if (kind < 3) return random_problem(engine, static_cast<int>(pick(engine, 2, 10)));
    if (kind < 6) return frustrated_problem(engine, static_cast<int>(pick(engine, 5, 10)));
    if (kind < 8) {
        BundleOptions bundle;
        bundle.curves = 2;
        bundle.segments = static_cast<int>(pick(engine, 2, 4));
        bundle.crossings = static_cast<int>(pick(engine, 0, 3));
        bundle.short_percent = 60;
        return curve_bundle(engine, bundle);
    }
    return generated(engine, static_cast<std::size_t>(std::min(kind - 8, families - 1)));
}

/// Same optimum, other text: some constraints twice, the terms of rules in another order.
void add_duplicates(std::mt19937_64& engine, ProblemParts& parts) {
    const auto some = [&](auto& list) {
        for (std::size_t k = 0, count = list.size(); k < count; ++k) {
            if (pick(engine, 0, 2) == 0) list.push_back(list[k]);
        }
    };
    some(parts.conflicts);
    some(parts.bonuses);
    some(parts.rules);
    for (auto& rule : parts.rules) std::reverse(rule.terms.begin(), rule.terms.end());
}

/// Values as large as they may be.
void magnify(ProblemParts& parts) {
    Value total = 1;
    for (Value w : parts.weights) total += std::abs(w);
    for (const auto& b : parts.bonuses) total += b.value;
    const Value factor = labeling::kMaxTotal / total;
    for (Value& w : parts.weights) w *= factor;
    for (auto& b : parts.bonuses) b.value *= factor;
}

/// Values so small that labelings differ by one.
void coarsen(ProblemParts& parts) {
    for (Value& w : parts.weights) w %= 4;
    for (auto& b : parts.bonuses) b.value %= 5;
}

enum class Start { None, Best, Partial, Random };
enum class Limit { None, Work, Clock, Stop };

/// What is drawn for a solve; the options themselves depend on the problem too, which shrinks.
struct Configuration {
    std::string solver;
    std::map<std::string, std::string> extra;
    std::uint64_t seed = 1;
    Start start = Start::None;
    Limit limit = Limit::None;
    std::int64_t amount = 0;  ///< ticks, or readings of the clock
    double gap = 0;
    bool is_repeated = false;

    bool is_exact() const { return every_solver().find(solver)->is_exact(); }
};

Configuration draw(const std::string& solver, std::mt19937_64& engine) {
    Configuration c;
    c.solver = solver;
    c.seed = engine();
    if (c.is_exact() && solver != "cbc") {
        // One technique off, or any subset.
        const std::vector<std::string> techniques{
            "heuristics", "clique-cuts", "triple-cuts",      "rank-two-cuts", "gomory-cuts",
            "fixing",     "restarts",    "strong-branching", "reductions",    "treewidth"};
        const auto count = static_cast<std::int64_t>(techniques.size());
        const std::int64_t off = pick(engine, 0, 2 * count + 1);
        for (std::size_t k = 0; k < techniques.size(); ++k) {
            const bool is_off = off < count ? static_cast<std::int64_t>(k) == off
                                            : off < 2 * count && pick(engine, 0, 1) == 0;
            if (is_off) c.extra[techniques[k]] = "off";
        }
        // An optimal start would hide wrong cuts and fixings; small problems seldom get as far as
        // these unless what settles them before is off.
        if (pick(engine, 0, 2) == 0) c.extra["heuristics"] = "off";
        if (pick(engine, 0, 2) == 0) c.extra["reductions"] = c.extra["treewidth"] = "off";
        const std::int64_t tree = pick(engine, 0, 3);
        if (tree < 3) c.extra["tree-size"] = std::to_string(tree * 4);
        if (pick(engine, 0, 1) == 0) c.extra["many-bonuses"] = "0";
        if (pick(engine, 0, 1) == 0) c.extra["tree-lanes"] = std::to_string(pick(engine, 1, 5));
    } else if (solver == "greedy") {
        const std::vector<std::string> rules{"best", "weight", "blocked", "gain", "curve"};
        c.extra["rule"] = rules[static_cast<std::size_t>(pick(engine, 0, 4))];
    }
    c.start = static_cast<Start>(pick(engine, 0, 3));
    const std::int64_t limit = pick(engine, 0, 9);
    c.limit = limit < 5    ? Limit::None
              : limit < 8  ? Limit::Work
              : limit == 8 ? Limit::Clock
                           : Limit::Stop;
    c.amount = pick(engine, 0, 3) == 0 ? 0 : pick(engine, 1, c.limit == Limit::Work ? 300 : 6);
    if (pick(engine, 0, 4) == 0) c.gap = static_cast<double>(pick(engine, 1, 40)) / 100;
    c.is_repeated = pick(engine, 0, 7) == 0;
    return c;
}

std::string described(const Configuration& c) {
    constexpr const char* kStarts[] = {"none", "best", "partial", "random"};
    constexpr const char* kLimits[] = {"none", "work", "clock readings", "stop after readings"};
    std::ostringstream out;
    out << "solver " << c.solver << ", seed " << c.seed << ", start "
        << kStarts[static_cast<int>(c.start)] << ", limit " << kLimits[static_cast<int>(c.limit)]
        << ' ' << c.amount << ", gap " << c.gap;
    for (const auto& [key, value] : c.extra) out << ", " << key << '=' << value;
    return out.str();
}

std::vector<std::int8_t> warm_start(const Configuration& c, const LabelingProblem& problem,
                                    const std::optional<Solution>& best) {
    std::vector<std::int8_t> start;
    if (c.start == Start::None || (c.start != Start::Random && !best)) return start;
    std::mt19937_64 engine(c.seed);
    for (std::size_t i = 0; i < static_cast<std::size_t>(problem.label_count()); ++i) {
        std::int64_t label = c.start == Start::Random ? pick(engine, -1, 1) : best->labels[i];
        if (c.start == Start::Partial && pick(engine, 0, 1) == 0) label = -1;
        start.push_back(static_cast<std::int8_t>(label));
    }
    return start;
}

struct Run {
    SolveResult result;
    std::vector<labeling::TracePoint> reported;
};

Run solve(const Configuration& c, const LabelingProblem& problem,
          const std::optional<Solution>& best, int threads) {
    Run run;
    SolveOptions options;
    options.extra = c.extra;
    options.seed = c.seed;
    options.threads = threads;
    options.relative_gap = c.gap;
    options.warm_start = warm_start(c, problem, best);
    options.on_improvement = [&run](const auto& point) { run.reported.push_back(point); };
    std::stop_source source;
    options.stop = source.get_token();
    std::int64_t readings = 0;
    if (c.limit == Limit::Work || !c.is_exact()) {
        options.work_limit = c.limit == Limit::Work ? c.amount : kHeuristicWork;
    }
    if (c.limit == Limit::Clock) {
        options.time_limit = std::chrono::duration<double>(static_cast<double>(c.amount));
    }
    options.clock = [&] {
        if (c.limit == Limit::Stop && readings >= c.amount) source.request_stop();
        return static_cast<double>(readings++);
    };
    run.result = every_solver().find(c.solver)->solve(problem, options);
    return run;
}

void check_trace(std::ostream& why, const Run& run, std::optional<Value> optimum) {
    const auto& trace = run.result.trace;
    if (run.reported.size() != trace.size()) why << "not all improvements were told; ";
    for (std::size_t k = 0; k < trace.size(); ++k) {
        const auto& point = trace[k];
        if (point.value && !optimum) why << "the trace has a value, the problem none; ";
        if (point.value && optimum && *point.value > *optimum) why << "trace above the optimum; ";
        if (point.bound && optimum && *point.bound < *optimum) why << "trace cuts the optimum; ";
        if (k == 0) continue;
        const auto& before = trace[k - 1];
        const bool is_ordered = point.work >= before.work && point.seconds >= before.seconds &&
                                (!before.value || (point.value && *point.value >= *before.value)) &&
                                (!before.bound || (point.bound && *point.bound <= *before.bound));
        if (!is_ordered) why << "the trace is not monotone; ";
    }
    if (trace.empty()) return;
    const auto& result = run.result;
    if (trace.back().value && !result.solution) why << "the solution was lost; ";
    if (trace.back().value && result.solution && *trace.back().value > result.solution->value) {
        why << "worse than the trace; ";
    }
    if (trace.back().bound && result.bound && *trace.back().bound < *result.bound) {
        why << "bound worse than in the trace; ";
    }
}

void check_status(std::ostream& why, const Configuration& c, const SolveResult& result,
                  std::optional<Value> optimum) {
    if (result.status == SolveStatus::Infeasible && optimum) why << "called infeasible; ";
    if (result.status == SolveStatus::Optimal) {
        const bool is_right = result.solution && optimum && result.solution->value == *optimum;
        if (!is_right) why << "called optimal but is not; ";
    }
    if (result.solution.has_value() !=
        (result.status == SolveStatus::Optimal || result.status == SolveStatus::Feasible)) {
        why << "status and solution disagree; ";
    }
    if (!c.is_exact()) {
        if (result.bound) why << "a heuristic claims a bound; ";
        return;
    }
    if (c.limit != Limit::None) return;
    if (optimum && c.gap > 0 && result.status == SolveStatus::Feasible) {
        if (result.stop_reason != StopReason::GapReached) why << "stopped for another reason; ";
        if (!result.relative_gap() || *result.relative_gap() > c.gap) why << "gap too large; ";
        return;
    }
    const auto expected = optimum ? SolveStatus::Optimal : SolveStatus::Infeasible;
    if (result.status != expected) why << "not solved; ";
}

/// A best labeling by means that share as little as possible with what is tested.
std::optional<Solution> reference(const LabelingProblem& problem) {
    if (problem.label_count() <= kMostLabels) return enumerate_best(problem);
    SolveOptions options;
    options.extra = {{"tree-size", "1000000"},
                     {"heuristics", "off"},
                     {"reductions", "off"},
                     {"treewidth", "off"}};
    const SolveResult result = every_solver().find("branch-and-bound")->solve(problem, options);
    if (result.status != SolveStatus::Optimal && result.status != SolveStatus::Infeasible) {
        throw std::runtime_error("the depth-first tree did not finish");
    }
    return result.solution;
}

std::string failure(const Configuration& c, const LabelingProblem& problem) try {
    const auto best = reference(problem);
    const auto optimum = best ? std::optional(best->value) : std::nullopt;
    const Run run = solve(c, problem, best, 1);
    const SolveResult& result = run.result;
    std::ostringstream why;
    if (result.solution) {
        const auto check = check_solution(problem, *result.solution);
        if (!check.is_feasible || !check.value_matches) why << "wrong solution; ";
        if (result.bound && *result.bound < result.solution->value) why << "bound < value; ";
    }
    if (result.bound && optimum && *result.bound < *optimum) why << "the bound cuts the optimum; ";
    if (c.start == Start::Best && best && (!result.solution || result.solution->value < *optimum)) {
        const bool needs_no_start = c.extra.contains("heuristics");
        if (!needs_no_start) why << "the start was lost; ";
    }
    check_status(why, c, result, optimum);
    check_trace(why, run, optimum);
    if (c.is_repeated) {
        // More threads read the clock more often, so its limits are kept to one.
        const bool counts_readings = c.limit == Limit::Clock || c.limit == Limit::Stop;
        const SolveResult again = solve(c, problem, best, counts_readings ? 1 : 2).result;
        const auto labels = [](const SolveResult& r) {
            return r.solution ? r.solution->labels : std::vector<std::uint8_t>{2};
        };
        const bool is_same = labels(again) == labels(result) && again.bound == result.bound &&
                             again.status == result.status && again.work == result.work &&
                             again.stop_reason == result.stop_reason &&
                             again.trace.size() == result.trace.size();
        if (!is_same) why << "another run differs; ";
    }
    return why.str();
} catch (const std::exception& error) {
    return std::string("exception: ") + error.what();
}

}  // namespace

LabelingProblem fuzz_problem(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    ProblemParts parts(of_some_family(engine));
    while (std::ssize(parts.weights) > kMostLabels) {
        parts.remove_label(static_cast<Label>(pick(engine, 0, std::ssize(parts.weights) - 1)));
    }
    if (pick(engine, 0, 2) == 0) add_duplicates(engine, parts);
    const std::int64_t values = pick(engine, 0, 19);
    if (values == 0) magnify(parts);
    if (values >= 14) coarsen(parts);
    LabelingProblem problem = parts.build();
    if (pick(engine, 0, 1) == 0) return problem;
    std::vector<Label> order(static_cast<std::size_t>(problem.label_count()));
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[engine() % k]);
    return permuted(problem, order);
}

LabelingProblem larger_fuzz_problem(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    ProblemParts parts = [&] {
        const std::int64_t kind = pick(engine, 0, 3);
        if (kind == 0) {
            return ProblemParts(frustrated_problem(engine, static_cast<int>(pick(engine, 14, 22))));
        }
        if (kind == 1) return ProblemParts(random_problem(engine, 25));
        BundleOptions bundle;
        bundle.curves = static_cast<int>(pick(engine, 3, 6));
        bundle.segments = static_cast<int>(pick(engine, 4, 8));
        bundle.crossings = static_cast<int>(pick(engine, 0, 8));
        bundle.short_percent = static_cast<int>(pick(engine, 0, 60));
        bundle.reach = static_cast<int>(pick(engine, 1, 3));
        bundle.bonus = pick(engine, 0, 1) == 0 ? 1000 : 60;
        return ProblemParts(curve_bundle(engine, bundle));
    }();
    if (pick(engine, 0, 2) == 0) add_duplicates(engine, parts);
    const std::int64_t values = pick(engine, 0, 19);
    if (values == 0) magnify(parts);
    if (values >= 14) coarsen(parts);
    return parts.build();
}

std::string fuzz_failure(const std::string& solver, std::uint64_t seed, FuzzSize size) {
    std::mt19937_64 engine(seed ^ 0x5eed);
    const Configuration configuration = draw(solver, engine);
    const LabelingProblem problem =
        size == FuzzSize::Small ? fuzz_problem(seed) : larger_fuzz_problem(seed);
    const std::string why = failure(configuration, problem);
    if (why.empty()) return {};
    const auto fails = [&](const LabelingProblem& p) { return !failure(configuration, p).empty(); };
    return "seed " + std::to_string(seed) + ": " + why + '\n' + described(configuration) + '\n' +
           shrunk(problem, fails);
}

}  // namespace labeling_test
