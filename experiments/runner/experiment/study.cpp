// The study of what optimality is worth: the same mesh, scale and detector, another solver of the
// labeling problems, and then everything that follows from it, measured on the final mesh.
#include "experiment/study.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "experiment/mesh_sources.h"
#include "experiment/programs.h"
#include "labeling/errors.h"
#include "labeling/text_file.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json read_json(const fs::path& file) {
    const json j = json::parse(labeling::read_text_file(file), nullptr, false);
    if (j.is_discarded()) throw labeling::InputError(file.string() + ": not JSON");
    return j;
}

std::vector<std::string> adapt_words(const StudyRequest& request, const fs::path& out) {
    std::vector<std::string> words{own_program("scalefcn").string(), "run", request.mesh.string(),
                                   "--scales", request.scale};
    for (const std::string& word : detector_words(request.detector)) words.push_back(word);
    words.insert(words.end(), {"--mode", request.mode, "--target", request.target});
    words.insert(words.end(), {"--solver", request.solver, "--seed", request.seed});
    if (!request.work.empty()) words.insert(words.end(), {"--work-limit", request.work});
    if (!request.gap.empty()) words.insert(words.end(), {"--gap", request.gap});
    std::istringstream options(request.options);
    for (std::string word; options >> word;) words.push_back(word);
    words.insert(words.end(),
                 {"--solvers", "none", "--json", "--threads", "1", "-o", out.string()});
    return words;
}

/// End points of all segments of a network file, as text, sorted.
std::vector<std::string> segment_lines(const json& network) {
    const auto point = [&](const json& node) {
        const json& numbers = network.at("nodes").at(node.get<std::size_t>());
        char text[80];
        std::snprintf(text, sizeof text, "%.6g %.6g %.6g", numbers.at(0).get<double>(),
                      numbers.at(1).get<double>(), numbers.at(2).get<double>());
        return std::string(text);
    };
    std::vector<std::string> lines;
    for (const json& segment : network.at("segments")) {
        std::string from = point(segment.at("nodes").at(0)), to = point(segment.at("nodes").at(1));
        if (to < from) std::swap(from, to);
        lines.push_back(from + "  " + to);
    }
    std::sort(lines.begin(), lines.end());
    return lines;
}

/// The one file of that name below a folder, or nothing.
fs::path find_file(const fs::path& folder, const char* name) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().filename() == name) return entry.path();
    }
    return {};
}

void take(json& statistics, const json& from, const char* key, const char* name) {
    const auto it = from.find(key);
    if (it != from.end() && it->is_number()) statistics[name] = *it;
    if (it != from.end() && it->is_boolean()) statistics[name] = it->get<bool>() ? 1 : 0;
}

}  // namespace

void run_study(const StudyRequest& request, const fs::path& segments, const fs::path& result) {
    const fs::path out = fs::current_path() / "study";
    run_own_program(adapt_words(request, out), "run.json");
    const json scale = read_json("run.json").at("meshes").at(0).at("scales").at(0);
    const fs::path remesh = find_file(out, "remesh.obj");
    json statistics;
    take(statistics, scale, "coverage", "coverage");
    take(statistics, scale, "segments", "segments");
    take(statistics, scale, "conforming", "conforming");
    take(statistics, scale, "value", "value_real");
    take(statistics, scale, "optimal", "all_optimal");
    take(statistics, scale, "seconds", "adaptation_seconds");
    if (const auto it = scale.find("remesh"); it != scale.end() && it->is_object()) {
        take(statistics, *it, "min_angle_degrees", "min_angle_degrees");
        take(statistics, *it, "mean_min_angle_degrees", "mean_min_angle_degrees");
        take(statistics, *it, "share_under_30_degrees", "share_under_30_degrees");
        take(statistics, *it, "faces", "triangles");
    }
    if (!remesh.empty()) {
        run_own_program({own_program("scalefcn").string(), "measure", remesh.string(),
                         request.mesh.string(), "--json", "--threads", "1"},
                        "measure.json");
        const json distance = read_json("measure.json").at("distance");
        take(statistics, distance, "hausdorff_over_diagonal", "hausdorff_over_diagonal");
    }
    const json network = read_json(find_file(out, "adapted.fcn.json"));
    std::string lines;
    for (const std::string& line : segment_lines(network)) lines += line + "\n";
    labeling::write_text_file(segments, lines);

    const json& first =
        scale.at("iterations").empty() ? json::object() : scale.at("iterations").at(0);
    const double units = first.value("units_per_one", 1.0);
    json answer{{"solver", request.solver},
                {"status", scale.value("optimal", false) ? "optimal" : "feasible"},
                {"stop_reason", first.value("stop_reason", "")},
                {"message", ""},
                {"work", 0},
                {"seconds", scale.value("seconds", 0.0)},
                {"statistics", statistics},
                {"trace", json::array()}};
    const auto units_of = [&](const char* key) {
        const auto it = first.find(key);
        return it != first.end() && it->is_number()
                   ? json(static_cast<std::int64_t>(std::llround(it->get<double>() * units)))
                   : json();
    };
    answer["value"] = units_of("value");
    answer["bound"] = units_of("bound");
    labeling::write_text_file(result, answer.dump() + "\n");
}

}  // namespace experiment
