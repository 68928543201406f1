#include "labeling/solver.h"

#include <algorithm>

#include "labeling/errors.h"

namespace labeling {

std::string_view to_string(SolveStatus status) {
    switch (status) {
        case SolveStatus::Optimal:
            return "optimal";
        case SolveStatus::Feasible:
            return "feasible";
        case SolveStatus::Infeasible:
            return "infeasible";
        case SolveStatus::NoSolution:
            return "no-solution";
    }
    throw LogicError("unknown solve status");
}

std::string_view to_string(StopReason reason) {
    switch (reason) {
        case StopReason::Finished:
            return "finished";
        case StopReason::TimeLimit:
            return "time-limit";
        case StopReason::WorkLimit:
            return "work-limit";
        case StopReason::GapReached:
            return "gap-reached";
        case StopReason::Interrupted:
            return "interrupted";
        case StopReason::SolverFailed:
            return "solver-failed";
    }
    throw LogicError("unknown stop reason");
}

std::optional<double> SolveResult::relative_gap() const {
    if (!solution || !bound) return std::nullopt;
    const double value = static_cast<double>(solution->value);
    return static_cast<double>(*bound - solution->value) / std::max(1.0, std::abs(value));
}

void SolverRegistry::add(std::shared_ptr<const Solver> solver) {
    if (!solver) throw InputError("the registry was given no solver");
    std::string name = solver->name();
    solvers_[std::move(name)] = std::move(solver);
}

std::shared_ptr<const Solver> SolverRegistry::find(std::string_view name) const {
    const auto it = solvers_.find(name);
    if (it != solvers_.end()) return it->second;
    std::string known;
    for (const auto& [key, solver] : solvers_) known += (known.empty() ? "" : ", ") + key;
    throw InputError("unknown solver '" + std::string(name) + "'; known: " + known);
}

std::vector<std::string> SolverRegistry::names() const {
    std::vector<std::string> names;
    for (const auto& [key, solver] : solvers_) names.push_back(key);
    return names;
}

}  // namespace labeling
