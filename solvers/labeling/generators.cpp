#include "labeling/generators.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "labeling/errors.h"

namespace labeling {
namespace {

/// Options by name; remembers which were asked for, so that unknown ones can be refused.
class NamedOptions {
public:
    explicit NamedOptions(const std::map<std::string, std::string>& values) : values_(values) {}

    template <class Number>
    void take(const std::string& key, Number& into, double low, double high) {
        known_.insert(key);
        const auto it = values_.find(key);
        if (it == values_.end()) return;
        const std::string& text = it->second;
        Number number{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        const auto real = static_cast<double>(number);
        if (error != std::errc() || end != text.data() + text.size() ||
            !(real >= low && real <= high)) {
            throw InputError("option " + key + ": '" + text + "' is not a number in [" +
                             shown(low) + ", " + shown(high) + "]");
        }
        into = number;
    }

    void take_seed(std::uint64_t& seed) {
        take("seed", seed, 0, static_cast<double>(std::numeric_limits<std::uint64_t>::max()));
    }

    void require_known(std::string_view family) const {
        for (const auto& [key, value] : values_) {
            if (known_.contains(key)) continue;
            std::string names;
            for (const std::string& name : known_) names += (names.empty() ? "" : ", ") + name;
            throw InputError("family " + std::string(family) + " has no option '" + key +
                             "'; known: " + names);
        }
    }

private:
    static std::string shown(double number) {
        char text[32];
        return {text, std::to_chars(text, text + sizeof text, number).ptr};
    }

    const std::map<std::string, std::string>& values_;
    std::set<std::string> known_;
};

GeneratedProblem named_curves(NamedOptions& named, CurveFamilyOptions::Surface surface) {
    CurveFamilyOptions options;
    options.surface = surface;
    named.take("bundles", options.bundles, 1, 1000);
    named.take("curves", options.curves, 1, 1000);
    named.take("extent", options.extent, 2, 1000);
    named.take("spacing", options.spacing, 0.05, 100);
    named.take("density", options.density, 0.1, 100);
    named.take("lambda0", options.lambda0, 0, 1e6);
    named.take_seed(options.seed);
    named.require_known("of curves");
    return curve_family(options);
}

GeneratedProblem named_unit_disks(NamedOptions& named) {
    UnitDiskOptions options;
    named.take("labels", options.labels, 1, 1e7);
    named.take("degree", options.degree, 0, 1000);
    named.take_seed(options.seed);
    named.require_known("unit-disks");
    return unit_disks(options);
}

GeneratedProblem named_chain(NamedOptions& named) {
    ChainOptions options;
    named.take("labels", options.labels, 1, 1e6);
    named.take("reach", options.reach, 1, 10);
    named.take("lambda0", options.lambda0, 0, 1e6);
    named.take_seed(options.seed);
    named.require_known("chain");
    return chain(options);
}

GeneratedProblem named_planted(NamedOptions& named) {
    PlantedOptions options;
    named.take("cliques", options.cliques, 1, 1e6);
    named.take("clique_size", options.clique_size, 1, 100);
    named.take("conflicts", options.conflicts, 0, 100);
    named.take("bonuses", options.bonuses, 0, 100);
    named.take("rules", options.rules, 0, 100);
    named.take_seed(options.seed);
    named.require_known("planted");
    return planted(options);
}

}  // namespace

GeneratedProblem generate_problem(std::string_view family,
                                  const std::map<std::string, std::string>& options) {
    NamedOptions named(options);
    if (family == "curves-plane") return named_curves(named, CurveFamilyOptions::Surface::Plane);
    if (family == "curves-sphere") return named_curves(named, CurveFamilyOptions::Surface::Sphere);
    if (family == "unit-disks") return named_unit_disks(named);
    if (family == "chain") return named_chain(named);
    if (family == "planted") return named_planted(named);
    std::string known;
    for (const std::string& name : problem_families()) known += (known.empty() ? "" : ", ") + name;
    throw InputError("unknown family '" + std::string(family) + "'; known: " + known);
}

std::vector<std::string> problem_families() {
    return {"chain", "curves-plane", "curves-sphere", "planted", "unit-disks"};
}

}  // namespace labeling
