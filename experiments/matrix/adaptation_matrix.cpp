// Adapts networks of many meshes at many scales, several ways: best mode with the default solver,
// best mode with greedy selection, paper mode, and best mode for quads. Prints one row a run as
// CSV: status, conformity by the independent checker, coverage, crumbs, and how much of the
// isolated creases is there; then, as Markdown, the sums, how the labeling problems were solved
// (the first of a run, and those of later iterations, where most is known), every run with a
// problem that was not proven, and every case in which best mode falls short of something. The exit
// code is 1 if best mode left anything that does not conform.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "adaptation/adaptation.h"
#include "adaptation/conformity.h"
#include "features/features.h"
#include "geometry/models.h"
#include "labeling/formats.h"
#include "labeling_mip/mip_solvers.h"
#include "visible_creases.h"

namespace {

using namespace fcn;

struct Arguments {
    std::vector<std::string> meshes;
    std::vector<std::string> detectors{"sharp", "100", "200"};
    std::vector<double> scales{1, 2, 3, 5, 8};
    std::vector<std::string> variants{"best", "greedy", "paper"};
    std::string csv, problem_folder;
    double ratio = 1.5, lambda0 = 100, alpha_loop = -1;
    int threads = 1;
    std::int64_t work = 0;
};

struct Row {
    std::string mesh, detector, variant;
    double scale = 0;
    std::size_t segments = 0, counted = 0, input_forced = 0, exempt = 0;
    std::string status;
    bool is_optimal = false;
    double coverage = 0, isolated = 0, isolated_covered = 0;
    int creases_short = 0;  ///< isolated creases covered by less than 98 %
    Vec3 uncovered_at = Vec3::Zero();
    int crumbs = 0;
    double seconds = 0;
    std::string violation;  ///< the first
    /// Seconds of each iteration's solving, and whether all of it was proven.
    std::vector<double> solving;
};

LoadedMesh load(const std::string& name) {
    const std::string prefix = "model:";
    return name.starts_with(prefix) ? make_model(name.substr(prefix.size())) : read_mesh(name);
}

std::string short_name(const std::string& name) {
    const std::size_t slash = name.find_last_of("/:");
    const std::string tail = slash == std::string::npos ? name : name.substr(slash + 1);
    return tail.substr(0, tail.find('.'));
}

FeatureCurveNetwork detect(const LoadedMesh& mesh, const std::string& detector) {
    FeatureCurveNetwork network;
    if (detector == "sharp") {
        network = detect_sharp(mesh);
    } else {
        VsaOptions options;
        options.patch_count = std::stoi(detector);
        network = detect_vsa(mesh, options);
    }
    return add_boundaries(network, mesh, BoundaryPolicy::Keep);
}

AdaptationOptions adaptation_options(const Arguments& arguments, const std::string& variant,
                                     double rmin) {
    AdaptationOptions options;
    options.rmin = rmin;
    options.ratio = arguments.ratio;
    options.lambda0 = arguments.lambda0;
    options.alpha_loop = arguments.alpha_loop;
    options.threads = arguments.threads;
    if (arguments.work > 0) options.solve.work_limit = arguments.work;
    options.mode = variant == "paper" ? AdaptationMode::Paper : AdaptationMode::Best;
    if (variant == "quad") options.target = ElementType::Quad;
    options.is_recording_problems = !arguments.problem_folder.empty();
    options.solver = labeling::all_solvers().find(variant == "greedy" ? "greedy" : "auto");
    return options;
}

/// What was not proven of a run, for a closer look.
void save_problems(const AdaptationReport& report, const std::string& folder,
                   const std::string& title) {
    for (std::size_t k = 0; k < report.problems.size(); ++k) {
        if (report.iterations[k].status == labeling::SolveStatus::Optimal) continue;
        const auto file = std::filesystem::path(folder) / (title + "_" + std::to_string(k + 1));
        labeling::write_problem(report.problems[k], file.string() + ".lab.gz");
    }
}

Row run(const LoadedMesh& mesh, const FeatureCurveNetwork& initial, const std::string& variant,
        double scale, const std::string& title, const Arguments& arguments) {
    const double rmin = scale / 100 * bounding_box(mesh.mesh).diagonal();
    const AdaptationOptions options = adaptation_options(arguments, variant, rmin);
    const AdaptationResult result = adapt_network(mesh, initial, options);
    ConformityOptions conformity;
    conformity.rmin = rmin;
    conformity.ratio = options.ratio;
    conformity.is_quad_target = options.target == ElementType::Quad;
    const ConformityReport report = check_conformity(result.network, conformity, &mesh.mesh);
    Row row;
    row.variant = variant;
    row.scale = scale;
    row.segments = result.network.segments.size();
    row.counted = report.counted;
    row.input_forced = report.input_forced;
    row.exempt = report.exempt;
    for (const Violation& v : report.violations) {
        if (v.is_exempt || v.is_input_forced || !row.violation.empty()) continue;
        char text[200];
        std::snprintf(text, sizeof text, "%s %d %d: %.9g, required %.9g, near (%.5g, %.5g, %.5g)",
                      to_string(v.kind), v.first, v.second, v.measured, v.required,
                      v.witness_first.x(), v.witness_first.y(), v.witness_first.z());
        row.violation = text;
    }
    row.status = to_string(result.report.status);
    row.is_optimal = result.report.is_optimal;
    row.coverage = result.report.coverage;
    row.seconds = result.report.seconds;
    for (const IterationReport& iteration : result.report.iterations) {
        const auto seconds = iteration.seconds.find("solve");
        row.solving.push_back(seconds == iteration.seconds.end() ? 0 : seconds->second);
    }
    if (!row.is_optimal) save_problems(result.report, arguments.problem_folder, title);
    row.crumbs = experiments::count_crumbs(initial, result.network, rmin);
    for (const auto& crease : experiments::isolated_creases(mesh, result.network, rmin)) {
        row.isolated += crease.length / rmin;
        row.isolated_covered += crease.covered / rmin;
        if (crease.covered < 0.98 * crease.length) {
            ++row.creases_short;
            row.uncovered_at = crease.uncovered_at;
        }
    }
    return row;
}

void write_row(std::FILE* file, const Row& row) {
    std::fprintf(file, "%s,%s,%g,%s,%s,%d,%zu,%zu,%zu,%zu,%.4f,%d,%d,%.2f,%.2f,%.2f\n",
                 row.mesh.c_str(), row.detector.c_str(), row.scale, row.variant.c_str(),
                 row.status.c_str(), row.is_optimal, row.segments, row.counted, row.input_forced,
                 row.exempt, row.coverage, row.crumbs, row.creases_short, row.isolated,
                 row.isolated_covered, row.seconds);
    std::fflush(file);
}

/// The runs of one mesh, detector and scale by variant.
using Case = std::map<std::string, Row>;

void print_sums(const std::vector<Case>& cases, const std::vector<std::string>& variants) {
    std::printf(
        "\n| variant | runs | conforming | proven optimal | mean coverage | crumbs | "
        "isolated creases, rmin | of these covered | creases under 98 %% | seconds |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& variant : variants) {
        int runs = 0, conforming = 0, optimal = 0, crumbs = 0, creases = 0;
        double coverage = 0, isolated = 0, covered = 0, seconds = 0;
        for (const Case& c : cases) {
            const Row& row = c.at(variant);
            ++runs;
            conforming += row.counted == 0;
            optimal += row.is_optimal;
            crumbs += row.crumbs;
            creases += row.creases_short;
            coverage += row.coverage;
            isolated += row.isolated;
            covered += row.isolated_covered;
            seconds += row.seconds;
        }
        std::printf("| %s | %d | %d | %d | %.4f | %d | %.0f | %.4f | %d | %.0f |\n",
                    variant.c_str(), runs, conforming, optimal, coverage / runs, crumbs, isolated,
                    isolated > 0 ? covered / isolated : 1.0, creases, seconds);
    }
}

/// Which runs are proven, and how long later iterations take, where little has changed.
void print_solving(const std::vector<Case>& cases, const std::vector<std::string>& variants) {
    constexpr double kPatience = 10, kResolve = 0.05;
    std::printf(
        "\n| variant | runs | every problem proven | also in %g s each | longest problem, s "
        "| later problems | median, ms | longest, ms | under %g ms |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        kPatience, 1000 * kResolve);
    for (const std::string& variant : variants) {
        int runs = 0, proven = 0, soon = 0;
        double longest = 0;
        std::vector<double> later;
        for (const Case& c : cases) {
            const Row& row = c.at(variant);
            if (row.solving.empty()) continue;
            const double most = *std::max_element(row.solving.begin(), row.solving.end());
            ++runs;
            proven += row.is_optimal;
            soon += row.is_optimal && most <= kPatience;
            longest = std::max(longest, most);
            later.insert(later.end(), row.solving.begin() + 1, row.solving.end());
        }
        if (runs == 0) continue;
        std::sort(later.begin(), later.end());
        const auto quick = std::upper_bound(later.begin(), later.end(), kResolve) - later.begin();
        std::printf("| %s | %d | %.1f %% | %.1f %% | %.2f | %zu | %.1f | %.1f | %.1f %% |\n",
                    variant.c_str(), runs, 100.0 * proven / runs, 100.0 * soon / runs, longest,
                    later.size(), later.empty() ? 0.0 : 1000 * later[later.size() / 2],
                    later.empty() ? 0.0 : 1000 * later.back(),
                    later.empty()
                        ? 100.0
                        : 100.0 * static_cast<double>(quick) / static_cast<double>(later.size()));
    }
    std::printf("\nNot proven:\n");
    for (const Case& c : cases) {
        for (const std::string& variant : variants) {
            const Row& row = c.at(variant);
            if (variant == "greedy" || row.is_optimal) continue;
            std::printf("- %s %s, %g %%, %s\n", row.mesh.c_str(), row.detector.c_str(), row.scale,
                        variant.c_str());
        }
    }
}

/// What a network has that best mode may not keep.
std::string what_it_keeps(const Row& row) {
    if (row.counted == 0 && row.crumbs == 0) return "";
    return " (" + std::to_string(row.counted) + " violations, " + std::to_string(row.crumbs) +
           " crumbs)";
}

void print_exceptions(const std::vector<Case>& cases, const std::vector<std::string>& variants) {
    std::printf("\nBest mode falls short in:\n");
    int count = 0;
    for (const Case& c : cases) {
        const auto best = c.find("best");
        if (best == c.end()) return;
        const Row& row = best->second;
        const auto list = [&](const char* what, double value, double other) {
            ++count;
            std::printf("- %s %s, %g %%: %s %.4f, against %.4f\n", row.mesh.c_str(),
                        row.detector.c_str(), row.scale, what, value, other);
        };
        if (row.counted > 0) {
            list("violations", static_cast<double>(row.counted), 0);
            std::printf("  %s\n", row.violation.c_str());
        }
        if (row.status != "converged") list(row.status.c_str(), 1, 0);
        if (row.crumbs > 0) list("crumbs", row.crumbs, 0);
        if (row.creases_short > 0) {
            list("isolated creases covered", row.isolated_covered / row.isolated, 0.98);
            std::printf("  near (%.5g, %.5g, %.5g)\n", row.uncovered_at.x(), row.uncovered_at.y(),
                        row.uncovered_at.z());
        }
        for (const std::string& variant : variants) {
            const Row& other = c.at(variant);
            if (other.coverage > row.coverage + 5e-5) {
                list(("coverage below " + variant + what_it_keeps(other)).c_str(), row.coverage,
                     other.coverage);
            }
        }
    }
    std::printf("%d entries in %zu cases\n", count, cases.size());
}

int run_all(const Arguments& arguments) {
    std::FILE* csv = arguments.csv.empty() ? stdout : std::fopen(arguments.csv.c_str(), "w");
    if (csv == nullptr) {
        std::fprintf(stderr, "%s: cannot be written\n", arguments.csv.c_str());
        return 4;
    }
    std::fprintf(csv,
                 "mesh,detector,scale_percent,variant,status,optimal,segments,violations,"
                 "input_forced,exempt,coverage,crumbs,creases_short,isolated_rmin,"
                 "isolated_covered_rmin,seconds\n");
    std::vector<Case> cases;
    bool is_conforming = true;
    for (const std::string& name : arguments.meshes) {
        const LoadedMesh mesh = load(name);
        for (const std::string& detector : arguments.detectors) {
            const FeatureCurveNetwork initial = detect(mesh, detector);
            for (double scale : arguments.scales) {
                Case rows;
                for (const std::string& variant : arguments.variants) {
                    char title[200];
                    std::snprintf(title, sizeof title, "%s_%s_%g_%s", short_name(name).c_str(),
                                  detector.c_str(), scale, variant.c_str());
                    Row row = run(mesh, initial, variant, scale, title, arguments);
                    row.mesh = short_name(name);
                    row.detector = detector;
                    is_conforming = is_conforming && (variant == "paper" || row.counted == 0);
                    write_row(csv, row);
                    rows[variant] = std::move(row);
                }
                cases.push_back(std::move(rows));
            }
        }
    }
    if (csv != stdout) std::fclose(csv);
    print_sums(cases, arguments.variants);
    print_solving(cases, arguments.variants);
    print_exceptions(cases, arguments.variants);
    return is_conforming ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app{"Adapts networks of many meshes at many scales and sums up"};
    app.add_option("meshes", arguments.meshes, "mesh files, or model:NAME")->required();
    app.add_option("--detectors", arguments.detectors, "sharp, or a VSA patch count")
        ->delimiter(',');
    app.add_option("--scales", arguments.scales, "rmin, percent of the diagonal")->delimiter(',');
    app.add_option("--variants", arguments.variants, "best, greedy, paper, quad")->delimiter(',');
    app.add_option("--ratio", arguments.ratio, "rmax / rmin");
    app.add_option("--lambda0", arguments.lambda0, "weight of smoothness");
    app.add_option("--alpha-loop", arguments.alpha_loop, "weight factor of loops");
    app.add_option("--threads", arguments.threads, "threads of one run");
    app.add_option("--work", arguments.work, "work limit of the solver for one adaptation");
    app.add_option("--csv", arguments.csv, "file for the rows; standard output without it");
    app.add_option("--save-unproven", arguments.problem_folder,
                   "folder for the problems that were not proven");
    CLI11_PARSE(app, argc, argv);
    try {
        return run_all(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
}
