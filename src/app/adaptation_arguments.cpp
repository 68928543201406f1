#include "app/adaptation_arguments.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>

#include "app/command.h"
#include "app/interrupt.h"
#include "labeling/errors.h"
#include "labeling_mip/mip_solvers.h"

namespace fcn::app {
namespace {

constexpr double kHuge = 1e12;

void add_objective_arguments(CLI::App& parser, AdaptationArguments& arguments) {
    constexpr const char* kGroup = "Objective";
    parser
        .add_option("--lambda0", arguments.lambda0,
                    "Weight of smoothness (mode best: in hundredths)")
        ->group(kGroup)
        ->check(CLI::Range(0.0, kHuge))
        ->capture_default_str();
    parser
        .add_option("--lambda1", arguments.lambda1,
                    "Weight of parallel and orthogonal pairs (default: 0 for tri, 10 for quad)")
        ->group(kGroup)
        ->check(CLI::Range(0.0, kHuge));
    parser.add_option("--alpha-sym", arguments.alpha_sym, "Factor for symmetric segments")
        ->group(kGroup)
        ->check(CLI::Range(0.0, kHuge))
        ->capture_default_str();
    parser
        .add_option("--alpha-loop", arguments.alpha_loop,
                    "Factor for closed curves (default: 4 in mode best, 100 in mode paper)")
        ->group(kGroup)
        ->check(CLI::Range(0.0, kHuge));
    parser
        .add_option("--smooth-power", arguments.smooth_power,
                    "p of the smoothness cos^p(2 gamma) of two segments that meet at gamma")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    parser
        .add_option("--ortho-radius", arguments.ortho_radius,
                    "Reach of the parallel and orthogonal term, in rmax")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
}

}  // namespace

ScaleRequest ScaleArguments::request() const {
    if (scale.empty() == edge_length.empty())
        throw UsageError("give either --scale (rmin) or --edge-length (of the mesh to be made)");
    ScaleRequest request;
    request.is_edge_length = !edge_length.empty();
    request.length = request.is_edge_length ? parse_length(edge_length, "--edge-length")
                                            : parse_length(scale, "--scale");
    return request;
}

void add_scale_arguments(CLI::App& parser, ScaleArguments& arguments) {
    auto* scale = parser.add_option("--scale", arguments.scale,
                                    "Scale rmin: mesh units, or 2% of the diagonal");
    parser
        .add_option("--edge-length", arguments.edge_length,
                    "Instead of --scale: edge length L of the mesh to be made (rmin = L / 1.2)")
        ->excludes(scale);
}

labeling::SolveOptions LimitArguments::solve_options(const CommonArguments& common) const {
    labeling::SolveOptions options;
    if (time_limit > 0) options.time_limit = std::chrono::duration<double>(time_limit);
    if (work_limit > 0) options.work_limit = work_limit;
    options.relative_gap = gap;
    options.seed = common.seed;
    options.stop = interrupt_token();
    return options;
}

void add_limit_arguments(CLI::App& parser, LimitArguments& arguments) {
    constexpr const char* kGroup = "Limits of one labeling problem";
    parser
        .add_option("--time-limit", arguments.time_limit,
                    "Seconds (default: none; a limit in seconds makes results depend on the "
                    "machine)")
        ->group(kGroup)
        ->check(CLI::Range(1e-3, 1e9));
    parser
        .add_option("--work-limit", arguments.work_limit,
                    "Deterministic ticks, about 10^7 a second (default: the solver's own)")
        ->group(kGroup)
        ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()));
    parser.add_option("--gap", arguments.gap, "Stop at this relative gap between bound and value")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
}

void add_criteria_arguments(CLI::App& parser, CriteriaArguments& arguments) {
    constexpr const char* kGroup = "Conformity";
    const CLI::Validator ratio_range(
        [](std::string& text) -> std::string {
            double ratio = 0;
            if (CLI::detail::lexical_cast(text, ratio) && ratio >= 1.01 && ratio < std::sqrt(3.0))
                return {};
            return fmt::format("'{}' is not in [1.01, sqrt(3))", text);
        },
        "FLOAT in [1.01, sqrt(3))");
    parser.add_option("--ratio", arguments.ratio, "rmax / rmin")
        ->group(kGroup)
        ->check(ratio_range)
        ->capture_default_str();
    parser.add_option("--target", arguments.target, "Elements of the mesh to be made: tri, quad")
        ->group(kGroup)
        ->check(CLI::IsMember({"tri", "quad"}))
        ->capture_default_str();
    parser
        .add_option("--thin-walls", arguments.thin_walls,
                    "Curves close in space, far apart on the surface: exempt, conflict")
        ->group(kGroup)
        ->check(CLI::IsMember({"exempt", "conflict"}))
        ->capture_default_str();
}

AdaptationOptions AdaptationArguments::options(const CommonArguments& common) const {
    AdaptationOptions options;
    options.ratio = criteria.ratio;
    options.target = criteria.is_quad() ? ElementType::Quad : ElementType::Triangle;
    options.thin_walls =
        criteria.thin_walls == "conflict" ? ThinWalls::Conflict : ThinWalls::Exempt;
    options.mode = mode == "paper" ? AdaptationMode::Paper : AdaptationMode::Best;
    options.unit = unit == "curve" ? LabelUnit::Curve : LabelUnit::Segment;
    options.lambda0 = lambda0;
    options.lambda1 = lambda1;
    options.alpha_sym = alpha_sym;
    options.alpha_loop = alpha_loop;
    options.smooth_power = smooth_power;
    options.ortho_radius = ortho_radius;
    options.max_iterations = max_iterations;
    options.threads = common.thread_count();
    options.solve = limits.solve_options(common);
    options.solver = find_solver(solver);
    options.stop = interrupt_token();
    return options;
}

void add_adaptation_arguments(CLI::App& parser, AdaptationArguments& arguments) {
    parser.add_option("--mode", arguments.mode, "best (strictly conforming), paper (as published)")
        ->check(CLI::IsMember({"best", "paper"}))
        ->capture_default_str();
    parser.add_option("--unit", arguments.unit, "Keep or drop by segment, or by whole curve")
        ->check(CLI::IsMember({"segment", "curve"}))
        ->capture_default_str();
    parser.add_option("--solver", arguments.solver, "One of: " + solver_names())
        ->capture_default_str();
    parser
        .add_option("--max-iterations", arguments.max_iterations,
                    "Safety net of the adaptation loop")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    add_limit_arguments(parser, arguments.limits);
    add_criteria_arguments(parser, arguments.criteria);
    add_objective_arguments(parser, arguments);
}

std::shared_ptr<const labeling::Solver> find_solver(const std::string& name) {
    try {
        return labeling::all_solvers().find(name);
    } catch (const labeling::InputError& error) {
        throw UsageError(error.what());
    }
}

std::string solver_names() {
    return fmt::format("{}", fmt::join(labeling::all_solvers().names(), ", "));
}

}  // namespace fcn::app
