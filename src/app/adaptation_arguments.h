#pragma once

#include <string>

#include "adaptation/adaptation.h"
#include "app/common_arguments.h"
#include "app/length.h"
#include "labeling/solver.h"

namespace CLI {
class App;
}

namespace fcn::app {

/// --scale or --edge-length.
struct ScaleArguments {
    std::string scale;
    std::string edge_length;

    bool is_given() const { return !scale.empty() || !edge_length.empty(); }
    /// UsageError unless exactly one of the two was given.
    ScaleRequest request() const;
};
void add_scale_arguments(CLI::App& parser, ScaleArguments& arguments);

/// Limits of one labeling problem.
struct LimitArguments {
    double time_limit = 0;        ///< seconds; 0 = none
    std::int64_t work_limit = 0;  ///< ticks; 0 = the solver's own default
    double gap = 0;

    labeling::SolveOptions solve_options(const CommonArguments& common) const;
};
void add_limit_arguments(CLI::App& parser, LimitArguments& arguments);

/// What conformity depends on besides rmin.
struct CriteriaArguments {
    double ratio = 1.5;
    std::string target = "tri";
    std::string thin_walls = "exempt";

    bool is_quad() const { return target == "quad"; }
};
void add_criteria_arguments(CLI::App& parser, CriteriaArguments& arguments);

struct AdaptationArguments {
    CriteriaArguments criteria;
    LimitArguments limits;
    std::string mode = "best";
    std::string unit = "segment";
    std::string solver = "auto";
    double lambda0 = 100;
    double lambda1 = -1;
    double alpha_sym = 2;
    double alpha_loop = -1;
    double smooth_power = 2;
    double ortho_radius = 2;
    int max_iterations = 50;

    /// Everything but rmin and the progress callback. UsageError on an unknown solver.
    AdaptationOptions options(const CommonArguments& common) const;
};
void add_adaptation_arguments(CLI::App& parser, AdaptationArguments& arguments);

/// Throws UsageError that lists the known names.
std::shared_ptr<const labeling::Solver> find_solver(const std::string& name);

/// All solvers of this program, one line each, for --help.
std::string solver_names();

}  // namespace fcn::app
