#include "app/common_arguments.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>

namespace fcn::app {

int CommonArguments::thread_count() const {
    if (threads > 0) return threads;
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void add_common_arguments(CLI::App& parser, CommonArguments& arguments) {
    constexpr const char* kGroup = "Everywhere";
    parser.add_flag("--json", arguments.is_json, "Print one JSON object instead of text")
        ->group(kGroup);
    parser.add_option("--seed", arguments.seed, "Seed of everything random")
        ->group(kGroup)
        ->capture_default_str();
    parser
        .add_option("--threads", arguments.threads,
                    "Threads; 0 = all processors. The result does not depend on it")
        ->group(kGroup)
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    parser
        .add_flag("--no-timings", arguments.is_timeless,
                  "Leave out every time, so that equal runs give equal bytes")
        ->group(kGroup);
    parser.add_flag("-q,--quiet", arguments.is_quiet, "No notes, no progress bar")->group(kGroup);
    parser.get_help_ptr()->group(kGroup);
}

ReadOptions MeshArguments::read_options() const {
    ReadOptions options;
    options.weld_tolerance = weld;
    options.is_repairing = !is_strict;
    return options;
}

void add_mesh_arguments(CLI::App& parser, MeshArguments& arguments) {
    constexpr const char* kGroup = "Reading meshes";
    parser
        .add_option("--weld", arguments.weld,
                    "Merge vertices closer than this share of the diagonal (0: equal ones)")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 0.1))
        ->capture_default_str();
    parser
        .add_flag("--strict", arguments.is_strict,
                  "Refuse a mesh that needs repair instead of repairing it")
        ->group(kGroup);
}

void print_note(const CommonArguments& common, const std::string& message) {
    if (!common.is_quiet) fmt::print(stderr, "note: {}\n", message);
}

void print_warning(const CommonArguments& common, const std::string& message) {
    if (!common.is_quiet) fmt::print(stderr, "warning: {}\n", message);
}

}  // namespace fcn::app
