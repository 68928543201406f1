#include "labeling/techniques.h"

#include <array>

#include "labeling/errors.h"
#include "labeling/run_control.h"

namespace labeling {
namespace {

struct Switch {
    const char* key;
    bool Techniques::*field;
};

constexpr std::array kSwitches{
    Switch{"heuristics", &Techniques::heuristics},
    Switch{"reductions", &Techniques::reductions},
    Switch{"treewidth", &Techniques::treewidth},
    Switch{"clique-cuts", &Techniques::clique_cuts},
    Switch{"triple-cuts", &Techniques::triple_cuts},
    Switch{"rank-two-cuts", &Techniques::rank_two_cuts},
    Switch{"gomory-cuts", &Techniques::gomory_cuts},
    Switch{"late-bonuses", &Techniques::late_bonuses},
    Switch{"fixing", &Techniques::fixing},
    Switch{"restarts", &Techniques::restarts},
    Switch{"strong-branching", &Techniques::strong_branching},
};

}  // namespace

Techniques techniques_of(const SolveOptions& options, std::string_view solver) {
    require_known_extras(options, solver,
                         {"tree-size", "tree-lanes", "many-bonuses", "heuristics", "reductions",
                          "treewidth", "clique-cuts", "triple-cuts", "rank-two-cuts", "gomory-cuts",
                          "late-bonuses", "fixing", "restarts", "strong-branching"});
    Techniques techniques;
    for (const Switch& s : kSwitches) {
        const auto it = options.extra.find(s.key);
        if (it == options.extra.end()) continue;
        if (it->second != "on" && it->second != "off") {
            throw InputError("option " + it->first + ": '" + it->second + "' is not on or off");
        }
        techniques.*s.field = it->second == "on";
    }
    constexpr std::int64_t kMost = 1'000'000;
    techniques.tree_size =
        static_cast<Label>(extra_integer(options, "tree-size", techniques.tree_size, 0, kMost));
    constexpr std::int64_t kMostLanes = 16;
    techniques.tree_lanes = static_cast<int>(
        extra_integer(options, "tree-lanes", techniques.tree_lanes, 1, kMostLanes));
    techniques.many_bonuses =
        extra_integer(options, "many-bonuses", techniques.many_bonuses, 0, kMost);
    return techniques;
}

}  // namespace labeling
