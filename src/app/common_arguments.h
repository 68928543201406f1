#pragma once

#include <cstdint>
#include <string>

#include "geometry/mesh_io.h"

namespace CLI {
class App;
}

namespace fcn::app {

/// What every command understands.
struct CommonArguments {
    bool is_json = false;      ///< one JSON object on standard output instead of text
    bool is_quiet = false;     ///< no notes, no warnings, no progress
    bool is_timeless = false;  ///< --no-timings: leave out every field that holds seconds
    std::uint64_t seed = 1;
    int threads = 0;  ///< 0 = all processors

    int thread_count() const;
};
void add_common_arguments(CLI::App& parser, CommonArguments& arguments);

/// How meshes are read.
struct MeshArguments {
    double weld = 0;
    bool is_strict = false;  ///< refuse what would have to be repaired

    ReadOptions read_options() const;
};
void add_mesh_arguments(CLI::App& parser, MeshArguments& arguments);

/// One line on standard error, "note: ..." or "warning: ...", unless --quiet.
void print_note(const CommonArguments& common, const std::string& message);
void print_warning(const CommonArguments& common, const std::string& message);

}  // namespace fcn::app
