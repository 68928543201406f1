#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "labeling/problem.h"
#include "labeling/solution.h"

namespace labeling {

/// A synthetic problem and, for some families, an optimal solution.
struct GeneratedProblem {
    LabelingProblem problem;
    std::optional<Solution> optimum;
};

/// Bundles of parallel curves on a surface, cut into segments; lengths are in units of the scale
/// rmin, at which segments of different curves are in conflict.
struct CurveFamilyOptions {
    enum class Surface { Plane, Sphere };
    Surface surface = Surface::Plane;
    int bundles = 4;
    int curves = 6;        ///< per bundle
    double extent = 20;    ///< side of the square, diameter of the sphere; 2 to 1000
    double spacing = 0.7;  ///< between neighbours in a bundle; below 1 they conflict
    double density = 1.2;  ///< segments per unit of length; above 1 segments are short
    double lambda0 = 100;  ///< bonus of two successive segments over their mean weight
    std::uint64_t seed = 1;
};

/// Labels are segments (weight: length times a random strength of the curve) and one keep-label per
/// crossing. Rules: valence at crossings, support and inherited conflicts of short segments.
GeneratedProblem curve_family(const CurveFamilyOptions& options = {});

/// Maximum weight independent set of disks: random points, weights 1 .. 1000, no bonuses or rules.
struct UnitDiskOptions {
    int labels = 1000;
    double degree = 8;  ///< mean number of conflicts of a label
    std::uint64_t seed = 1;
};
GeneratedProblem unit_disks(const UnitDiskOptions& options = {});

/// Conflicts, bonuses and rules reach over a window that moves along a chain, whose labels are then
/// renamed at random. The optimum comes from dynamic programming over the window.
struct ChainOptions {
    int labels = 200;
    int reach = 4;  ///< 1 to 10: farthest label in one conflict, bonus or rule
    double lambda0 = 2;
    std::uint64_t seed = 1;
};
GeneratedProblem chain(const ChainOptions& options = {});

/// A hidden solution that is optimal by construction: a member of each of many hidden cliques,
/// worth as much as any other member with all bonuses that member could earn.
struct PlantedOptions {
    int cliques = 60;
    int clique_size = 5;
    double conflicts = 3;  ///< further random conflicts per label
    double bonuses = 2;    ///< random bonuses per label
    double rules = 0.3;    ///< random rules per label
    std::uint64_t seed = 1;
};
GeneratedProblem planted(const PlantedOptions& options = {});

/// By name (curves-plane, curves-sphere, unit-disks, chain, planted), with options by the names of
/// their fields. Throws InputError on an unknown name and a value out of range.
GeneratedProblem generate_problem(std::string_view family,
                                  const std::map<std::string, std::string>& options);

/// Names of the families.
std::vector<std::string> problem_families();

}  // namespace labeling
