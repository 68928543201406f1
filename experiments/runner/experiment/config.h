#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace experiment {

/// What one run may use. Zero or nullopt: no limit.
struct Limits {
    std::optional<double> seconds;      ///< told to the solver; enforced from outside with a margin
    std::optional<std::int64_t> ticks;  ///< deterministic work
    double gap = 0;                     ///< relative gap at which the solver may stop
    std::int64_t memory_mib = 8192;     ///< resident memory of all its processes together
    std::int64_t disk_mib = 4096;       ///< what it may write
    double margin_seconds = 5;          ///< over its time before it is ended, plus a tenth
};

/// A solver with its options. Either a solver of this project by name, or a program of one's own.
struct SolverConfig {
    std::string name;                            ///< as it appears in tables; unique
    std::string solver;                          ///< of `labeling-solve`
    std::string program;                         ///< or a command, see docs/experiments.md
    std::map<std::string, std::string> options;  ///< of the solver
    std::string start;  ///< "" or "local-search": start from what a short local search finds
    int threads = 1;
    Limits limits;
    std::vector<std::uint64_t> seeds;
    std::vector<std::uint64_t> renamings;
    std::vector<std::string> problems;  ///< patterns of the names it runs on; empty = all
};

/// Where problems come from; one of files, family and meshes is given.
struct ProblemConfig {
    std::vector<std::string> files;  ///< patterns, relative to the configuration's folder
    bool drops_rules = false;        ///< conflicts, weights and bonuses alone
    std::string group;               ///< "", or the one group of all of them

    std::string family;
    std::map<std::string, std::vector<std::string>> family_options;  ///< every combination is made

    std::vector<std::string> meshes;     ///< patterns of files; cgal:NAME; model:NAME
    std::vector<std::string> scales;     ///< as for --scale
    std::vector<std::string> detectors;  ///< "sharp", "vsa 200"
    std::vector<std::string> modes;      ///< best, paper
    std::vector<std::string> targets;    ///< tri, quad
    std::vector<std::string> adapt_options;
    std::string iterations = "all";  ///< all, first
    bool is_study = false;  ///< the problem is the mesh itself: adapt, remesh and measure it
    int line = 0;
};

/// How the report compares.
struct ReportConfig {
    std::string baseline;         ///< solver that the others are compared with; "" = the first
    double floor_seconds = 0.05;  ///< times below count as this much in ratios
    double shift_seconds = 1;     ///< of the shifted geometric mean
    int resamplings = 1000;       ///< of the bootstrap
    std::string clock = "cpu";    ///< cpu or wall: which seconds the tables compare
};

struct CampaignConfig {
    std::string name, description;
    std::filesystem::path file;
    std::string text;
    std::uint64_t shuffle = 1;
    std::vector<ProblemConfig> problems;
    std::vector<SolverConfig> solvers;
    ReportConfig report;
};

/// Reads a TOML file. Throws InputError "file:line: ..." on anything unknown, misspelt, out of
/// range or missing.
CampaignConfig read_config(const std::filesystem::path& file);
CampaignConfig parse_config(const std::string& text, const std::filesystem::path& file);

}  // namespace experiment
