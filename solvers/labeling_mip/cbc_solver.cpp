// CBC (https://github.com/coin-or/Cbc) on the linear model, as one peer among others and as a
// second opinion. It runs in a child process: it overruns its own limits, prints, and must not take
// our process down. The child sends every incumbent and bound; the parent rounds, completes by
// propagation where CBC's preprocessing removed columns, checks exactly, and kills the child at the
// time limit.
//
// What the bound is worth: CBC computes in doubles. We ask it to prune only nodes that cannot be
// half a unit better than the incumbent (option `increment`), so with integer values its claim of
// optimality stands as long as its LP bounds are exact to half a unit. That is assumed while all
// positive terms sum to at most 2^40 units (relative error 4.5e-13); above that, and for bounds of
// unfinished runs, the bound is raised by 2^-40 of that sum plus one unit, so it never cuts off a
// true optimum on account of rounding.
//
// Dying: left alone, CBC starts with Clp's "idiot" crash method, whose crossover reads outside of
// its arrays on dense problems of ours (Clp 1.17.6, a segmentation fault in presolve). We ask for
// the dual simplex, which is also faster here. A child that dies all the same is started once more
// without presolve and preprocessing; what the first one had found stays.
#include "labeling_mip/cbc_solver.h"

#include <CbcEventHandler.hpp>
#include <CbcModel.hpp>
#include <ClpSolve.hpp>
#include <OsiClpSolverInterface.hpp>
#include <cmath>
#include <cstring>

#include "labeling/errors.h"
#include "labeling/greedy.h"
#include "labeling/linear_model.h"
#include "labeling/run_control.h"
#include "labeling_mip/child_process.h"

namespace labeling {
namespace {

constexpr std::int64_t kTicksPerNode = 10000;

enum class MessageKind : std::uint8_t { Labels, Bound, Optimal, Infeasible, Stopped };

/// Fixed head, followed by one entry per label for Labels.
struct MessageHead {
    MessageKind kind = MessageKind::Stopped;
    double number = 0;
    std::int64_t nodes = 0;
};

void send(const ChildProcess::Send& sender, const MessageHead& head,
          const std::vector<std::int8_t>& labels = {}) {
    std::vector<std::uint8_t> bytes(sizeof head + labels.size());
    std::memcpy(bytes.data(), &head, sizeof head);
    if (!labels.empty()) std::memcpy(bytes.data() + sizeof head, labels.data(), labels.size());
    sender(bytes);
}

/// Reports incumbents and bounds from inside CBC.
class Reporter final : public CbcEventHandler {
public:
    Reporter(const ChildProcess::Send& sender, Label label_count)
        : sender_(&sender), label_count_(label_count) {}
    CbcEventHandler* clone() const override { return new Reporter(*this); }

    CbcAction event(CbcEvent kind) override {
        if (model_ == nullptr || model_->specialOptions() & 2048) return noAction;  // sub-search
        if (kind == solution || kind == heuristicSolution) {
            report_incumbent();
        } else if (kind == treeStatus) {
            send(*sender_, {MessageKind::Bound, -model_->getBestPossibleObjValue(), 0});
        }
        return noAction;
    }

private:
    void report_incumbent() const {
        const double* values = model_->bestSolution();
        if (values == nullptr) return;
        std::vector<std::int8_t> labels(label_count_, -1);
        const int* original = model_->originalColumns();
        for (int c = 0; c < model_->getNumCols(); ++c) {
            const int column = original != nullptr ? original[c] : c;
            if (column < label_count_) labels[column] = values[c] > 0.5 ? 1 : 0;
        }
        send(*sender_, {MessageKind::Labels, 0, 0}, labels);
    }

    const ChildProcess::Send* sender_;
    Label label_count_;
};

void load(const LinearModel& model, OsiClpSolverInterface& lp) {
    const int columns = model.column_count();
    std::vector<double> lower(columns, 0.0), upper(columns, 1.0), objective(columns);
    for (int c = 0; c < columns; ++c) objective[c] = -static_cast<double>(model.objective[c]);
    std::vector<CoinBigIndex> starts{0};
    std::vector<int> indices;
    std::vector<double> coefficients, row_lower, row_upper;
    for (const ModelRow& row : model.rows) {
        for (const ModelTerm& t : row.terms) {
            indices.push_back(t.column);
            coefficients.push_back(static_cast<double>(t.coefficient));
        }
        starts.push_back(static_cast<CoinBigIndex>(indices.size()));
        const auto side = static_cast<double>(row.right_hand_side);
        row_lower.push_back(row.relation == Relation::LessEqual ? -COIN_DBL_MAX : side);
        row_upper.push_back(row.relation == Relation::GreaterEqual ? COIN_DBL_MAX : side);
    }
    CoinPackedMatrix matrix;
    matrix.setDimensions(0, columns);
    matrix.appendRows(static_cast<int>(model.rows.size()), starts.data(), indices.data(),
                      coefficients.data());
    lp.loadProblem(matrix, lower.data(), upper.data(), objective.data(), row_lower.data(),
                   row_upper.data());
    lp.setObjSense(1);
    for (int c = 0; c < model.label_count; ++c) lp.setInteger(c);
    for (int c = 0; c < columns; ++c) lp.setColName(c, model.column_name(c));
}

struct ChildLimits {
    double seconds = 0;  ///< 0 = none
    std::int64_t nodes = 0;
    double gap = 0;
    bool is_careful = false;  ///< without presolve and preprocessing
};

void pass_start(const LinearModel& model, const Solution& start, CbcModel& cbc) {
    std::vector<std::pair<std::string, double>> values;
    for (std::int32_t c = 0; c < model.column_count(); ++c) {
        bool is_on = false;
        if (c < model.label_count) {
            is_on = start.labels[c] != 0;
        } else {
            const Bonus& b = model.bonuses[c - model.label_count];
            is_on = start.labels[b.first] != 0 && start.labels[b.second] != 0;
        }
        values.emplace_back(model.column_name(c), is_on ? 1.0 : 0.0);
    }
    cbc.setMIPStart(values);
}

/// Body of the child process.
void run_cbc(const LinearModel& model, const std::optional<Solution>& start,
             const ChildLimits& limits, const ChildProcess::Send& sender) {
    OsiClpSolverInterface lp;
    load(model, lp);
    ClpSolve first_lp;
    first_lp.setSolveType(ClpSolve::useDual);
    if (limits.is_careful) first_lp.setPresolveType(ClpSolve::presolveOff);
    lp.setSolveOptions(first_lp);
    CbcModel cbc(lp);
    CbcMain0(cbc);
    cbc.setLogLevel(0);
    Reporter reporter(sender, model.label_count);
    cbc.passInEventHandler(&reporter);
    if (start) pass_start(model, *start, cbc);
    std::vector<std::string> words{"labeling", "-log", "0", "-increment", "0.5"};
    auto add = [&words](const char* key, const std::string& value) {
        words.emplace_back(key);
        words.push_back(value);
    };
    if (limits.seconds > 0) {
        add("-timeMode", "elapsed");
        add("-seconds", std::to_string(limits.seconds));
    }
    if (limits.nodes > 0) add("-maxNodes", std::to_string(limits.nodes));
    if (limits.gap > 0) add("-ratioGap", std::to_string(limits.gap));
    if (limits.is_careful) {
        add("-presolve", "off");
        add("-preprocess", "off");
    }
    words.emplace_back("-solve");
    words.emplace_back("-quit");
    std::vector<const char*> arguments;
    for (const std::string& w : words) arguments.push_back(w.c_str());
    CbcMain1(static_cast<int>(arguments.size()), arguments.data(), cbc);

    const std::int64_t nodes = cbc.getNodeCount();
    if (cbc.bestSolution() != nullptr) {
        std::vector<std::int8_t> labels(model.label_count);
        for (Label i = 0; i < model.label_count; ++i) labels[i] = cbc.bestSolution()[i] > 0.5;
        send(sender, {MessageKind::Labels, 0, nodes}, labels);
    }
    if (cbc.isProvenOptimal() && limits.gap <= 0) {
        send(sender, {MessageKind::Optimal, 0, nodes});
    } else if (cbc.isProvenInfeasible()) {
        send(sender, {MessageKind::Infeasible, 0, nodes});
    } else {
        send(sender, {MessageKind::Bound, -cbc.getBestPossibleObjValue(), nodes});
        send(sender, {MessageKind::Stopped, 0, nodes});
    }
}

/// The parent's side of one run.
class CbcRun {
public:
    CbcRun(const LabelingProblem& problem, const SolveOptions& options, std::int64_t node_limit,
           RowStyle rows, const CbcChildHook& in_child)
        : problem_(problem),
          options_(without_work_limit(options)),
          in_child_(in_child),
          control_(options_),
          rows_(problem),
          model_(linear_model(problem, rows)),
          nodes_(node_limit) {
        for (Value v : model_.objective) total_ += std::max(Value{0}, v);
        bound_ = total_;
    }

    SolveResult run() {
        if (problem_.label_count() == 0) return run_empty();
        start();
        if (is_infeasible_)
            return finish(problem_, kName, control_, std::nullopt, std::nullopt, true);
        bool has_verdict = false;
        int attempts = 0;
        while (!has_verdict && attempts < kMostAttempts && !control_.is_over()) {
            has_verdict = run_child(attempts++);
        }
        if (!has_verdict && !control_.is_over()) {
            control_.end(StopReason::SolverFailed);
            message_ = "CBC ended without a result";
        }
        if (best_ && bound_ < best_->value) bound_ = best_->value;
        const bool is_infeasible = is_infeasible_ && !best_;
        SolveResult result =
            finish(problem_, kName, control_, std::move(best_), bound_, is_infeasible);
        result.statistics["nodes"] = static_cast<double>(node_count_);
        result.statistics["attempts"] = attempts;
        result.message = message_;
        return result;
    }

private:
    static constexpr const char* kName = "cbc";

    /// CBC counts nodes, not ticks; the node limit stands for the work limit.
    static SolveOptions without_work_limit(SolveOptions options) {
        options.work_limit.reset();
        return options;
    }

    SolveResult run_empty() {
        Solution empty;
        const SolutionCheck check = check_solution(problem_, empty);
        if (!check.is_feasible) {
            return finish(problem_, kName, control_, std::nullopt, std::nullopt, true);
        }
        return finish(problem_, kName, control_, empty, 0);
    }

    void start() {
        GreedyOptions greedy;
        greedy.start = options_.warm_start;
        GreedyResult found = greedy_labeling(problem_, rows_, control_, greedy);
        is_infeasible_ = found.is_infeasible;
        best_ = std::move(found.solution);
        if (best_) control_.report(best_->value, std::nullopt);
    }

    /// True when CBC came to an end of its own or the run is over.
    bool run_child(int attempt) {
        ChildLimits limits;
        limits.nodes = nodes_;
        limits.gap = options_.relative_gap;
        limits.is_careful = attempt > 0;
        if (options_.time_limit && !options_.clock) {
            limits.seconds = std::max(0.01, 0.97 * control_.seconds_left() - 0.05);
        }
        ChildProcess child([&](const ChildProcess::Send& sender) {
            if (in_child_) in_child_(attempt);
            run_cbc(model_, best_, limits, sender);
        });
        return listen(child);
    }

    bool listen(ChildProcess& child) {
        std::vector<std::uint8_t> message;
        bool has_verdict = false;
        while (true) {
            control_.check();
            if (control_.is_over()) return true;
            const double patience = options_.clock ? 0.02 : std::min(0.05, control_.seconds_left());
            const auto event = child.wait(patience, message);
            if (event == ChildProcess::Event::Ended) break;
            if (event == ChildProcess::Event::Message) has_verdict = handle(message) || has_verdict;
        }
        return child.has_succeeded() && has_verdict;
    }

    /// True for the last word of the child.
    bool handle(const std::vector<std::uint8_t>& message) {
        MessageHead head;
        if (message.size() < sizeof head) return false;
        std::memcpy(&head, message.data(), sizeof head);
        node_count_ = std::max(node_count_, head.nodes);
        switch (head.kind) {
            case MessageKind::Labels:
                take_labels(message);
                return false;
            case MessageKind::Bound:
                take_bound(head.number);
                return false;
            case MessageKind::Optimal:
                if (best_ && total_ <= kExactTotal) {
                    bound_ = best_->value;
                } else if (best_) {
                    take_bound(static_cast<double>(best_->value));
                }
                control_.report(std::nullopt, bound_);
                return true;
            case MessageKind::Infeasible:
                // With a start that is feasible, CBC only says that nothing better exists.
                if (best_) {
                    bound_ = total_ <= kExactTotal ? best_->value : bound_;
                } else {
                    is_infeasible_ = true;
                }
                return true;
            case MessageKind::Stopped:
                control_.end(nodes_ > 0                  ? StopReason::WorkLimit
                             : options_.relative_gap > 0 ? StopReason::GapReached
                                                         : StopReason::TimeLimit);
                return true;
        }
        return false;
    }

    void take_labels(const std::vector<std::uint8_t>& message) {
        if (message.size() != sizeof(MessageHead) + problem_.label_count()) return;
        std::vector<std::int8_t> labels(problem_.label_count());
        std::memcpy(labels.data(), message.data() + sizeof(MessageHead), labels.size());
        GreedyOptions greedy;
        greedy.start = labels;
        GreedyResult found = greedy_labeling(problem_, rows_, control_, greedy);
        if (!found.solution || (best_ && found.solution->value <= best_->value)) return;
        best_ = std::move(found.solution);
        control_.report(best_->value, std::nullopt);
    }

    void take_bound(double bound) {
        const double safe = std::ceil(bound + 1.0 + std::ldexp(static_cast<double>(total_), -40));
        if (!(std::abs(safe) < 9e15)) return;
        bound_ = std::min(bound_, static_cast<Value>(safe));
        if (best_) bound_ = std::max(bound_, best_->value);
        control_.report(std::nullopt, bound_);
    }

    static constexpr Value kExactTotal = Value{1} << 40;
    static constexpr int kMostAttempts = 2;

    const LabelingProblem& problem_;
    const SolveOptions options_;
    const CbcChildHook& in_child_;
    RunControl control_;
    const RowSystem rows_;
    const LinearModel model_;
    std::int64_t nodes_ = 0, node_count_ = 0;
    Value total_ = 0, bound_ = 0;
    std::optional<Solution> best_;
    bool is_infeasible_ = false;
    std::string message_;
};

class CbcSolver final : public Solver {
public:
    explicit CbcSolver(CbcChildHook in_child) : in_child_(std::move(in_child)) {}
    std::string name() const override { return "cbc"; }
    std::string description() const override {
        return "CBC on the mixed-integer model, in a child process";
    }
    bool is_exact() const override { return true; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        require_known_extras(options, name(), {"rows", "nodes"});
        RowStyle rows = RowStyle::Strengthened;
        if (const auto it = options.extra.find("rows"); it != options.extra.end()) {
            if (it->second == "paper") {
                rows = RowStyle::Paper;
            } else if (it->second != "strengthened") {
                throw InputError("option rows: '" + it->second + "' is not paper or strengthened");
            }
        }
        constexpr std::int64_t kMostNodes = std::numeric_limits<std::int32_t>::max();
        std::int64_t nodes = extra_integer(options, "nodes", 0, 1, kMostNodes);
        if (options.work_limit) {
            const std::int64_t by_work =
                std::clamp<std::int64_t>(*options.work_limit / kTicksPerNode, 1, kMostNodes);
            nodes = nodes > 0 ? std::min(nodes, by_work) : by_work;
        }
        return CbcRun(problem, options, nodes, rows, in_child_).run();
    }

private:
    CbcChildHook in_child_;
};

}  // namespace

std::shared_ptr<const Solver> make_cbc_solver(CbcChildHook in_child) {
    return std::make_shared<CbcSolver>(std::move(in_child));
}

}  // namespace labeling
