#include "experiment/ablation.h"

#include <map>
#include <set>

namespace experiment {
namespace {

/// What `variant` does otherwise than `parent`, one text for each option.
std::vector<std::string> differences(const SolverConfig& parent, const SolverConfig& variant) {
    std::set<std::string> keys;
    for (const auto& [key, value] : parent.options) keys.insert(key);
    for (const auto& [key, value] : variant.options) keys.insert(key);
    std::vector<std::string> texts;
    for (const std::string& key : keys) {
        const auto before = parent.options.find(key), after = variant.options.find(key);
        if (after == variant.options.end()) {
            texts.push_back("without " + key);
        } else if (before == parent.options.end() || before->second != after->second) {
            texts.push_back(key + "=" + after->second);
        }
    }
    return texts;
}

bool are_alike(const SolverConfig& a, const SolverConfig& b) {
    return a.solver == b.solver && a.program.empty() && b.program.empty() && a.start == b.start &&
           a.threads == b.threads && a.limits.seconds == b.limits.seconds &&
           a.limits.ticks == b.limits.ticks && a.limits.gap == b.limits.gap;
}

}  // namespace

std::vector<Ablation> find_ablations(const Plan& plan) {
    std::vector<Ablation> found;
    for (std::size_t v = 1; v < plan.solvers.size(); ++v) {
        for (std::size_t p = 0; p < v; ++p) {
            const SolverConfig& parent = plan.solvers[p];
            const SolverConfig& variant = plan.solvers[v];
            if (!are_alike(parent, variant)) continue;
            const auto texts = differences(parent, variant);
            if (variant.name.starts_with(parent.name + ":")) {
                found.push_back({p, v, variant.name.substr(parent.name.size() + 1)});
            } else if (texts.size() == 1) {
                found.push_back({p, v, texts[0]});
            }
            break;  // the first one alike is the parent
        }
    }
    return found;
}

}  // namespace experiment
