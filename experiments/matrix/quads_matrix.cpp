// Quads on many meshes at many scales:
//   quads_matrix --list FILE | MESH... --scales 2,4,6,8
//                [--meshes FOLDER] [--ways own,pairing,own-plain] [--results FILE]
//                [--pictures FOLDER] [--expect SHARE]
// Features are sharp edges and boundaries; each scale, in percent of the diagonal, is adapted to
// for quads and is their edge length h. Ways are those of `scalefcn compare --type quad`. A list
// has lines "KIND MESH SCALE..." (quads_matrix.txt). Cases that FILE holds are not made again, new
// ones are added one by one, so that a run may be stopped and go on. Prints Markdown: a row a way
// and kind with averages and worst cases; a row a mesh and scale; why ways fell back. Hausdorff
// distances are two-sided and sampled every h / 10; alignment is the mean angle between kept
// segments and the nearest direction of the quads; `triangles` is the distance of the triangle
// remesh of the same network. Exit code 3 with --expect if a mesh is not sound, or if less than
// SHARE of `own` are made by a field; 77 if a mesh is not there.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include "geometry/errors.h"
#include "quad_cases.h"

namespace {

using namespace fcn;

constexpr int kNotThere = 77, kNotAsExpected = 3;

struct Arguments {
    std::vector<std::string> meshes, ways{"own", "pairing", "own-plain"};
    std::vector<double> scales{2, 4, 6, 8};
    std::string list, folder, results, pictures;
    double expected_share = -1;
};

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? std::nan("") : sum / static_cast<double>(values.size());
}

double percent_of(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// One way over the cases of a kind; empty: all.
void print_summary_row(const std::vector<QuadCase>& cases, const std::string& name,
                       const std::string& kind) {
    std::size_t runs = 0, sound = 0, by_field = 0, near = 0, near_enough = 0;
    std::vector<double> jacobians, irregular, alignment;
    double least = 1, quads = 0, seconds = 0;
    for (const QuadCase& one : cases) {
        const auto found = one.ways.find(name);
        if (found == one.ways.end() || (!kind.empty() && one.kind != kind)) continue;
        const QuadOutcome& way = found->second;
        ++runs;
        seconds += way.cpu_seconds;
        if (!way.is_sound()) continue;
        ++sound;
        by_field += way.is_by_field;
        near += way.hausdorff <= 0.5;
        near_enough += way.hausdorff <= std::max(0.5, 1.1 * one.triangle_hausdorff);
        jacobians.push_back(way.mean_jacobian);
        irregular.push_back(100 * way.irregular);
        if (one.has_network) alignment.push_back(way.alignment_degrees);
        least = std::min(least, way.least_jacobian);
        quads += static_cast<double>(way.faces);
    }
    std::printf(
        "| %s | %s | %zu | %zu | %.0f %% | %.3f | %.3f | %.2f %% | %.0f %% | %.0f %% | %.1f | %.0f "
        "| %.1f |\n",
        name.c_str(), kind.empty() ? "all" : kind.c_str(), runs, sound, percent_of(by_field, runs),
        mean(jacobians), least, mean(irregular), percent_of(near, runs),
        percent_of(near_enough, runs), mean(alignment), quads, seconds);
}

void print_summary(const std::vector<QuadCase>& cases, const std::vector<std::string>& ways) {
    std::vector<std::string> kinds;
    for (const QuadCase& one : cases)
        if (std::ranges::find(kinds, one.kind) == kinds.end()) kinds.push_back(one.kind);
    std::printf(
        "| way | meshes | runs | sound | by field | scaled Jacobian: mean | least | irregular | "
        "Hausdorff <= h/2 | or <= 1.1 triangles' | alignment | quads | CPU s |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& way : ways) {
        print_summary_row(cases, way, "");
        if (kinds.size() > 1)
            for (const std::string& kind : kinds) print_summary_row(cases, way, kind);
    }
}

void print_cases(const std::vector<QuadCase>& cases) {
    std::printf(
        "\n| mesh | scale | way | tier | quads | scaled Jacobian: mean | least | irregular | "
        "Hausdorff/h | triangles | alignment | close pairs | CPU s |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const QuadCase& one : cases)
        for (const auto& [name, way] : one.ways) {
            if (!way.failure.empty()) {
                std::printf("| %s | %g %% | %s | failed: %s | | | | | | | | | |\n",
                            one.mesh.c_str(), one.scale, name.c_str(), way.failure.c_str());
                continue;
            }
            std::printf(
                "| %s | %g %% | %s | %d | %zu | %.3f | %.3f | %.2f %% | %.3f | %.3f | %.1f | %zu | "
                "%.1f |\n",
                one.mesh.c_str(), one.scale, name.c_str(), way.is_by_field ? 1 : 0, way.faces,
                way.mean_jacobian, way.least_jacobian, 100 * way.irregular, way.hausdorff,
                one.triangle_hausdorff, way.alignment_degrees, way.close_pairs, way.cpu_seconds);
        }
}

void print_reasons(const std::vector<QuadCase>& cases) {
    std::printf(
        "\nWhat attempts at a field ended with:\n\n| mesh | scale | way | tier | reason |\n"
        "|---|---|---|---|---|\n");
    for (const QuadCase& one : cases)
        for (const auto& [name, way] : one.ways)
            if (!way.reason.empty())
                std::printf("| %s | %g %% | %s | %d | %s |\n", one.mesh.c_str(), one.scale,
                            name.c_str(), way.is_by_field ? 1 : 0, way.reason.c_str());
}

bool is_same(const QuadCase& a, const QuadCase& b) {
    return a.kind == b.kind && a.mesh == b.mesh && a.scale == b.scale;
}

/// Cases of earlier runs, and where new ones go. Ways of a case may have come one by one.
class Results {
public:
    explicit Results(const std::string& path) : path_(path) {
        std::ifstream file(path);
        for (std::string line; std::getline(file, line);)
            if (!line.empty()) keep(from_line(line));
    }

    /// The case with the ways of it that are known.
    QuadCase find(const QuadCase& like) const {
        const auto found =
            std::ranges::find_if(known_, [&](const QuadCase& one) { return is_same(one, like); });
        return found == known_.end() ? like : *found;
    }

    void add(const QuadCase& one) {
        if (!path_.empty()) std::ofstream(path_, std::ios::app) << to_line(one) << '\n';
        keep(one);
    }

private:
    void keep(const QuadCase& one) {
        const auto found = std::ranges::find_if(
            known_, [&](const QuadCase& other) { return is_same(one, other); });
        if (found == known_.end())
            known_.push_back(one);
        else
            for (const auto& [name, way] : one.ways) found->ways[name] = way;
    }

    std::string path_;
    std::vector<QuadCase> known_;
};

std::vector<QuadTask> tasks_of(const Arguments& arguments) {
    if (!arguments.list.empty()) return read_quad_tasks(arguments.list);
    std::vector<QuadTask> tasks;
    for (const std::string& mesh : arguments.meshes)
        tasks.push_back({"all", mesh, arguments.scales});
    return tasks;
}

bool is_there(const QuadTask& task, const Arguments& arguments) {
    return task.mesh.starts_with("model:") || std::filesystem::exists(task.mesh) ||
           std::filesystem::exists(std::filesystem::path(arguments.folder) / task.mesh);
}

void report(const QuadCase& one) {
    for (const auto& [name, way] : one.ways)
        std::fprintf(stderr, "%s %g %% %s: %zu quads, %.1f s%s%s\n", one.mesh.c_str(), one.scale,
                     name.c_str(), way.faces, way.cpu_seconds, way.is_by_field ? "" : ", no field",
                     way.is_sound() ? "" : ", NOT SOUND");
}

std::vector<QuadCase> run(const Arguments& arguments, const std::vector<QuadTask>& tasks) {
    Results results(arguments.results);
    std::vector<QuadCase> cases;
    for (const QuadTask& task : tasks) {
        std::optional<LoadedMesh> mesh;
        for (const double scale : task.scales) {
            QuadCase one;
            one.kind = task.kind;
            one.mesh = quad_input_name(task.mesh);
            one.scale = scale;
            std::vector<std::string> missing = arguments.ways;
            std::erase_if(missing, [known = results.find(one).ways](const std::string& way) {
                return known.contains(way);
            });
            if (!missing.empty()) {
                if (!mesh) mesh = load_quad_input(task.mesh, arguments.folder);
                const QuadCase made =
                    run_quad_case(task, scale, *mesh, missing, arguments.pictures);
                report(made);
                results.add(made);
            }
            one = results.find(one);
            std::erase_if(one.ways, [&](const auto& way) {
                return std::ranges::find(arguments.ways, way.first) == arguments.ways.end();
            });
            cases.push_back(std::move(one));
        }
    }
    return cases;
}

bool is_as_expected(const std::vector<QuadCase>& cases, double share) {
    std::size_t runs = 0, by_field = 0;
    for (const QuadCase& one : cases)
        for (const auto& [name, way] : one.ways) {
            if (!way.is_sound()) return false;
            runs += name == "own";
            by_field += name == "own" && way.is_by_field;
        }
    return static_cast<double>(by_field) >= share * static_cast<double>(runs);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App parser("Quads on many meshes at many scales");
    Arguments arguments;
    auto* list = parser.add_option("--list", arguments.list, "Lines KIND MESH SCALE...");
    parser.add_option("MESH", arguments.meshes, "Meshes, or model:NAME,count=8,...")
        ->excludes(list);
    parser.add_option("--scales", arguments.scales, "In percent of the diagonal")->delimiter(',');
    parser.add_option("--meshes", arguments.folder, "Folder of the meshes")
        ->envname("SCALEFCN_MESHES");
    parser.add_option("--ways", arguments.ways, "As scalefcn compare --type quad")->delimiter(',');
    parser.add_option("--results", arguments.results, "Cases that are known; new ones are added");
    parser.add_option("--pictures", arguments.pictures, "A picture of each mesh in this folder");
    parser.add_option("--expect", arguments.expected_share, "Least share by a field, 0 to 1");
    CLI11_PARSE(parser, argc, argv);
    try {
        const std::vector<QuadTask> tasks = tasks_of(arguments);
        for (const QuadTask& task : tasks)
            if (!is_there(task, arguments)) {
                std::fprintf(stderr, "quads_matrix: no %s (scripts/fetch_meshes.sh)\n",
                             task.mesh.c_str());
                return kNotThere;
            }
        const std::vector<QuadCase> cases = run(arguments, tasks);
        print_summary(cases, arguments.ways);
        print_cases(cases);
        print_reasons(cases);
        if (arguments.expected_share >= 0 && !is_as_expected(cases, arguments.expected_share))
            return kNotAsExpected;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "quads_matrix: %s\n", error.what());
        return 1;
    }
}
