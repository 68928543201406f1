// Our remesher beside others, in one run:
//   remeshing_vs_peers MESH... [--scales 1,2,4,6,8] [--ways own,cgal,...]
//                      [--peer meshlab=COMMAND] [--folder DIR] [--csv FILE]
// Features are sharp edges (of more than 18 degrees, chains with one of 40) and boundaries; each
// scale, in percent of the diagonal, is adapted to once. A peer's COMMAND is started as
// COMMAND IN.obj OUT.off LENGTH on the bare mesh and prints its CPU seconds. Prints Markdown: a
// row a way with medians and worst cases over all meshes and scales, where `own` loses against
// the best of the other ways on the adapted network, and every case in which it has triangles
// under 30 degrees. CPU seconds include embedding.
//   remeshing_vs_peers --speed MESH --faces N [--iterations 3]
// refines MESH to N faces and more, remeshes it to as many again, and prints CPU seconds, peak
// memory and angles.

#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "adaptation/adaptation.h"
#include "features/features.h"
#include "geometry/models.h"
#include "labeling_mip/mip_solvers.h"
#include "meshing/comparison.h"
#include "meshing/self_intersections.h"

namespace {

using namespace fcn;

struct Arguments {
    std::vector<std::string> meshes, ways, peers;
    std::vector<double> scales{1, 2, 4, 6, 8};
    std::string csv, folder = "build/remeshes", speed_mesh;
    std::size_t faces = 100000;
    int iterations = 10;
    bool is_plain = false;
};

struct Case {
    std::string mesh;
    double scale = 0, edge_length = 0, diagonal = 0;
    std::size_t input_intersections = 0;
    std::map<std::string, ComparisonRow> rows;
};

LoadedMesh load(const std::string& name) {
    const std::string prefix = "model:";
    return name.starts_with(prefix) ? make_model(name.substr(prefix.size())) : read_mesh(name);
}

/// The row of an external program.
ComparisonRow run_peer(const std::string& peer, const ComparisonInput& input,
                       const Arguments& arguments) {
    ComparisonRow row;
    const std::size_t sign = peer.find('=');
    row.name = peer.substr(0, sign);
    const std::filesystem::path folder = arguments.folder;
    const std::string from = (folder / "in.obj").string(), to = (folder / "out.off").string();
    try {
        LoadedMesh bare;
        bare.mesh = input.mesh.mesh;
        write_mesh(from, bare);
        std::filesystem::remove(to);
        const std::string command = "timeout 120 " + peer.substr(sign + 1) + " " + from + " " + to +
                                    " " + std::to_string(kEdgeLengthFactor * input.rmin) + " 2> " +
                                    (folder / "errors.txt").string();
        std::FILE* pipe = popen(command.c_str(), "r");
        if (pipe == nullptr || std::fscanf(pipe, "%lf", &row.cpu_seconds) != 1)
            row.failure = "the program failed";
        if (pipe != nullptr) pclose(pipe);
        if (!row.failure.empty()) return row;
        row.mesh = read_mesh(to);
        measure_row(input, row);
    } catch (const std::exception& error) {
        row.failure = error.what();
    }
    return row;
}

void print_csv(std::FILE* file, const Case& which, const ComparisonRow& row) {
    std::fprintf(
        file, "%s,%g,%s,%s,%zu,%.3f,%.3f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%zu,%zu,%zu,%.3f\n",
        which.mesh.c_str(), which.scale, row.name.c_str(), row.failure.empty() ? "ok" : "failed",
        row.quality.faces, row.quality.min_angle_degrees, row.quality.mean_min_angle_degrees,
        row.quality.share_under_15, row.quality.share_under_30,
        row.distance.hausdorff / which.diagonal, row.distance.mean_forward / which.diagonal,
        row.features.max / which.edge_length, row.features.mean / which.edge_length,
        row.broken_segments, row.forced_faces, row.self_intersections, row.cpu_seconds);
    std::fflush(file);
}

FeatureCurveNetwork features_of(const LoadedMesh& mesh) {
    return add_boundaries(detect_sharp(mesh), mesh, BoundaryPolicy::Keep);
}

Case run_case(const std::string& name, const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
              double percent, const Arguments& arguments, std::FILE* csv) {
    Case result;
    result.mesh = std::filesystem::path(name).stem().string();
    result.scale = percent;
    result.diagonal = bounding_box(mesh.mesh).diagonal();
    result.input_intersections = self_intersections(mesh.mesh).size();
    AdaptationOptions adaptation;
    adaptation.rmin = percent / 100 * result.diagonal;
    adaptation.solver = labeling::all_solvers().find("auto");
    const FeatureCurveNetwork adapted = adapt_network(mesh, initial, adaptation).network;
    result.edge_length = kEdgeLengthFactor * adaptation.rmin;
    const ComparisonInput input{mesh,
                                initial,
                                adapted,
                                adaptation.rmin,
                                adaptation.ratio,
                                arguments.iterations,
                                std::max(0.1 * result.edge_length, 0.001 * result.diagonal)};
    std::size_t vertices = 1000;
    const auto add = [&](ComparisonRow row) {
        if (row.name == "own") vertices = row.quality.vertices;
        if (csv != nullptr) print_csv(csv, result, row);
        row.mesh = {};
        result.rows[row.name] = std::move(row);
    };
    for (const std::string& way : arguments.ways) add(run_remesher(way, input, vertices));
    for (const std::string& peer : arguments.peers) add(run_peer(peer, input, arguments));
    return result;
}

double median(std::vector<double> values) {
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

using Value = std::function<double(const Case&, const ComparisonRow&)>;

std::vector<double> collect(const std::vector<Case>& cases, const std::string& way,
                            const Value& value) {
    std::vector<double> values;
    for (const Case& one : cases) {
        const auto it = one.rows.find(way);
        if (it != one.rows.end() && it->second.failure.empty())
            values.push_back(value(one, it->second));
    }
    return values;
}

void print_summary(const std::vector<Case>& cases, const std::vector<std::string>& ways) {
    std::printf(
        "| way | runs | failed | smallest angle: least | median | under 25: runs | under 30: runs "
        "| under 15: triangles | under 30: share | crossings: runs | pairs | Hausdorff/diag | "
        "mean/diag | curves/L | mean curves/L | faces | CPU s |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    // Angles that two curves of the input force are left out where it is known that there are no
    // others.
    const Value angle = [](const Case&, const ComparisonRow& r) {
        const double under_30 = r.quality.share_under_30 * static_cast<double>(r.quality.faces);
        const bool is_all_forced =
            r.forced_faces > 0 && std::lround(under_30) <= std::lround(1.0 * r.forced_faces);
        return is_all_forced ? std::max(30.0, r.quality.min_angle_degrees)
                             : r.quality.min_angle_degrees;
    };
    for (const std::string& way : ways) {
        const std::vector<double> angles = collect(cases, way, angle);
        int crossing_runs = 0;
        std::size_t crossings = 0;
        const auto middle = [&](const Value& value) { return median(collect(cases, way, value)); };
        double slivers = 0, seconds = 0, under_30 = 0, faces = 0;
        for (const Case& one : cases) {
            const auto it = one.rows.find(way);
            if (it == one.rows.end()) continue;
            const TriangleQuality& q = it->second.quality;
            slivers += std::round(q.share_under_15 * static_cast<double>(q.faces));
            under_30 += std::round(q.share_under_30 * static_cast<double>(q.faces));
            faces += static_cast<double>(q.faces);
            seconds += it->second.cpu_seconds;
            const std::size_t pairs = it->second.self_intersections;
            if (pairs <= one.input_intersections) continue;
            ++crossing_runs;
            crossings += pairs - one.input_intersections;
        }
        const auto below = [&](double limit) {
            return std::count_if(angles.begin(), angles.end(),
                                 [&](double value) { return value < limit; });
        };
        std::printf(
            "| %s | %zu | %zu | %.2f | %.2f | %td | %td | %.0f | %.4f %% | %d | %zu | %.5f | "
            "%.6f | %.4f | %.4f | %.0f | %.1f |\n",
            way.c_str(), angles.size(), cases.size() - angles.size(),
            angles.empty() ? 0 : *std::min_element(angles.begin(), angles.end()), median(angles),
            below(25), below(30), slivers, 100 * under_30 / std::max(1.0, faces), crossing_runs,
            crossings, middle([](const Case& c, const ComparisonRow& r) {
                return r.distance.hausdorff / c.diagonal;
            }),
            middle([](const Case& c, const ComparisonRow& r) {
                return r.distance.mean_forward / c.diagonal;
            }),
            middle([](const Case& c, const ComparisonRow& r) {
                return r.features.max / c.edge_length;
            }),
            middle([](const Case& c, const ComparisonRow& r) {
                return r.features.mean / c.edge_length;
            }),
            faces, seconds);
    }
}

void print_bad_cases(const std::vector<Case>& cases) {
    std::printf(
        "\nCases in which `own` has a triangle under 30 degrees:\n\n"
        "| mesh | scale | smallest angle | under 30 | of them forced |\n|---|---|---|---|---|\n");
    for (const Case& one : cases) {
        const auto it = one.rows.find("own");
        if (it == one.rows.end() || it->second.quality.share_under_30 <= 0) continue;
        const TriangleQuality& q = it->second.quality;
        std::printf("| %s | %g %% | %.2f | %.0f | %zu |\n", one.mesh.c_str(), one.scale,
                    q.min_angle_degrees, q.share_under_30 * static_cast<double>(q.faces),
                    it->second.forced_faces);
    }
}

void print_cut_cases(const std::vector<Case>& cases) {
    std::printf(
        "\nCases in which a segment is not a single edge in `own`:\n\n| mesh | scale | segments |\n"
        "|---|---|---|\n");
    for (const Case& one : cases) {
        const auto it = one.rows.find("own");
        if (it != one.rows.end() && it->second.broken_segments > 0)
            std::printf("| %s | %g %% | %zu |\n", one.mesh.c_str(), one.scale,
                        it->second.broken_segments);
    }
}

void print_losses(const std::vector<Case>& cases, const std::vector<std::string>& rivals) {
    std::printf("\nWhere `own` loses against the best of");
    for (const std::string& rival : rivals) std::printf(" `%s`", rival.c_str());
    std::printf(
        " (smallest angle by more than 0.5 degrees; Hausdorff by more than 5 %%):\n\n"
        "| mesh | scale | what | own | best other |\n|---|---|---|---|---|\n");
    for (const Case& one : cases) {
        const auto own = one.rows.find("own");
        if (own == one.rows.end()) continue;
        double angle = 0, distance = INFINITY;
        for (const std::string& rival : rivals) {
            const auto it = one.rows.find(rival);
            if (it == one.rows.end() || !it->second.failure.empty()) continue;
            angle = std::max(angle, it->second.quality.min_angle_degrees);
            distance = std::min(distance, it->second.distance.hausdorff / one.diagonal);
        }
        const double own_angle = own->second.quality.min_angle_degrees;
        const double own_distance = own->second.distance.hausdorff / one.diagonal;
        if (own_angle < angle - 0.5)
            std::printf("| %s | %g %% | smallest angle | %.2f | %.2f |\n", one.mesh.c_str(),
                        one.scale, own_angle, angle);
        if (own_distance > 1.05 * distance)
            std::printf("| %s | %g %% | Hausdorff/diag | %.5f | %.5f |\n", one.mesh.c_str(),
                        one.scale, own_distance, distance);
    }
}

void run_corpus(const Arguments& arguments) {
    std::filesystem::create_directories(arguments.folder);
    std::FILE* csv = arguments.csv.empty() ? nullptr : std::fopen(arguments.csv.c_str(), "w");
    if (csv != nullptr)
        std::fprintf(
            csv,
            "mesh,scale,way,status,faces,min_angle,mean_min_angle,under_15,under_30,"
            "hausdorff_over_diagonal,mean_over_diagonal,feature_max_over_l,"
            "feature_mean_over_l,broken_segments,forced_faces,self_intersections,cpu_seconds\n");
    std::vector<Case> cases;
    for (const std::string& name : arguments.meshes) {
        const LoadedMesh mesh = load(name);
        const FeatureCurveNetwork initial = features_of(mesh);
        for (const double percent : arguments.scales) {
            std::fprintf(stderr, "%s %g %%\n", name.c_str(), percent);
            cases.push_back(run_case(name, mesh, initial, percent, arguments, csv));
        }
    }
    if (csv != nullptr) std::fclose(csv);
    std::vector<std::string> ways = arguments.ways;
    for (const std::string& peer : arguments.peers) ways.push_back(peer.substr(0, peer.find('=')));
    print_summary(cases, ways);
    print_bad_cases(cases);
    print_cut_cases(cases);
    std::vector<std::string> rivals;
    for (const std::string& way : ways)
        if (way == "cgal" || way == "cgal-constrained") rivals.push_back(way);
    print_losses(cases, rivals);
}

/// Each face into four, until there are enough.
LoadedMesh refined(const LoadedMesh& mesh, std::size_t faces) {
    LoadedMesh result = mesh;
    while (result.mesh.n_faces() < faces) {
        std::vector<Vec3> points;
        std::vector<std::array<int, 3>> triangles;
        for (const VertexHandle v : result.mesh.vertices()) points.push_back(result.mesh.point(v));
        const int first = static_cast<int>(points.size());
        for (const EdgeHandle e : result.mesh.edges())
            points.push_back(result.mesh.calc_edge_midpoint(e));
        for (const FaceHandle face : result.mesh.faces()) {
            std::array<int, 3> corner{}, middle{};
            std::size_t i = 0;
            for (const HalfedgeHandle h : result.mesh.fh_range(face)) {
                corner[i] = result.mesh.from_vertex_handle(h).idx();
                middle[i++] = first + result.mesh.edge_handle(h).idx();
            }
            for (std::size_t k = 0; k < 3; ++k)
                triangles.push_back({corner[k], middle[k], middle[(k + 2) % 3]});
            triangles.push_back(middle);
        }
        result = mesh_from_soup(points, triangles);
    }
    return result;
}

long peak_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

void run_speed(const Arguments& arguments) {
    const LoadedMesh mesh = refined(load(arguments.speed_mesh), arguments.faces);
    double area = 0;
    for (const FaceHandle face : mesh.mesh.faces()) area += face_area(mesh.mesh, face);
    RemeshOptions options;
    options.iterations = arguments.iterations;
    options.edge_length =
        std::sqrt(area / static_cast<double>(mesh.mesh.n_faces()) * 4 / std::sqrt(3.0));
    FeatureCurveNetwork network;
    if (!arguments.is_plain) network = features_of(mesh);
    options.is_protecting = !arguments.is_plain;
    std::printf(
        "| way | faces in | faces out | iterations | features | CPU s | peak MB so far | "
        "smallest angle | under 30 |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& way : arguments.ways) {
        const std::clock_t start = std::clock();
        options.is_improving_angles = way != "own-rough";
        const RemeshResult result = way == "cgal" ? remesh_with_cgal(mesh, network, options)
                                                  : remesh_triangles(mesh, network, options);
        const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        const TriangleQuality quality = measure_triangles(result.mesh.mesh);
        std::printf("| %s | %zu | %zu | %d | %zu | %.1f | %ld | %.2f | %.4f %% |\n", way.c_str(),
                    mesh.mesh.n_faces(), quality.faces, options.iterations,
                    result.feature_edges.size(), seconds, peak_megabytes(),
                    quality.min_angle_degrees, 100 * quality.share_under_30);
        std::fprintf(stderr, "embedding %.2f coarsening %.2f iterating %.2f improving %.2f s\n",
                     result.statistics.embedding, result.statistics.coarsening,
                     result.statistics.iterating, result.statistics.improving);
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App parser("Our remesher beside others");
    Arguments arguments;
    parser.add_option("MESH", arguments.meshes, "Meshes, or model:NAME");
    parser.add_option("--scales", arguments.scales, "In percent of the diagonal")->delimiter(',');
    parser.add_option("--ways", arguments.ways, "Of the comparison; default: all")->delimiter(',');
    parser.add_option("--peer", arguments.peers, "NAME=COMMAND of an external program");
    parser.add_option("--folder", arguments.folder, "For files passed to peers");
    parser.add_option("--csv", arguments.csv, "All rows");
    parser.add_option("--speed", arguments.speed_mesh, "Measure speed on this mesh, refined");
    parser.add_option("--faces", arguments.faces, "At least, for --speed");
    parser.add_option("--iterations", arguments.iterations, "Of every remesher");
    parser.add_flag("--plain", arguments.is_plain, "Speed without features");
    CLI11_PARSE(parser, argc, argv);
    try {
        const bool is_speed = !arguments.speed_mesh.empty();
        if (arguments.ways.empty())
            arguments.ways =
                is_speed ? std::vector<std::string>{"own", "own-rough", "cgal"} : remesher_names();
        if (is_speed)
            run_speed(arguments);
        else
            run_corpus(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "remeshing_vs_peers: %s\n", error.what());
        return 1;
    }
}
