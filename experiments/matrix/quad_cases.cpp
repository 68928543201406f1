#include "quad_cases.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "adaptation/adaptation.h"
#include "features/features.h"
#include "geometry/errors.h"
#include "geometry/models.h"
#include "labeling_mip/mip_solvers.h"
#include "meshing/quad_comparison.h"
#include "meshing/reference_surface.h"
#include "report/drawn_curves.h"
#include "report/picture.h"

namespace fcn {
namespace {

using Json = nlohmann::json;

constexpr double kSampleSpacing = 0.1;  ///< of distances and angles, in h

void draw(const std::string& folder, const QuadCase& which, const std::string& way,
          const QuadMesh& quads, const LoadedMesh& input) {
    const auto point = [&](int v) { return quads.points[static_cast<std::size_t>(v)]; };
    PictureLayer features{{}, {200, 40, 40}, 2}, fewer{{}, {200, 30, 60}, 6},
        more{{}, {40, 60, 200}, 6};
    for (const QuadFeatureEdge& edge : quads.feature_edges)
        features.polylines.push_back({point(edge.from), point(edge.to)});
    for (const IrregularVertex& irregular : irregular_vertices(quads))
        (irregular.valence < 4 ? fewer : more).polylines.push_back({point(irregular.vertex)});
    PictureOptions options;
    options.seen_as = &input.mesh;
    options.width = 1100;
    options.height = 900;
    std::filesystem::create_directories(folder);
    std::ostringstream file;
    file << which.mesh << '-' << which.scale << '-' << way << ".png";
    write_file_atomically(
        std::filesystem::path(folder) / file.str(),
        render_png(triangle_mesh(quads), {quad_edges(quads), features, fewer, more}, options));
}

QuadOutcome outcome_of(const QuadComparisonRow& row, double h) {
    QuadOutcome outcome;
    outcome.failure = row.failure;
    outcome.is_by_field = row.result.tier == QuadTier::Field && row.failure.empty();
    outcome.reason = row.result.reason;
    outcome.faces = row.quality.faces;
    outcome.inverted_corners = row.quality.inverted_corners;
    outcome.close_pairs = row.quality.close_singularities;
    outcome.mean_jacobian = row.quality.mean_scaled_jacobian;
    outcome.least_jacobian = row.quality.min_scaled_jacobian;
    outcome.irregular = row.quality.share_irregular;
    outcome.hausdorff = row.distance.hausdorff / h;
    outcome.alignment_degrees = row.alignment.mean_degrees;
    outcome.cpu_seconds = row.cpu_seconds;
    return outcome;
}

}  // namespace

std::string quad_input_name(const std::string& mesh) {
    const std::string prefix = "model:";
    if (!mesh.starts_with(prefix)) return std::filesystem::path(mesh).stem().string();
    std::string name = mesh.substr(prefix.size());
    const std::size_t count = name.find("count=");
    const std::size_t comma = name.find(',');
    if (comma == std::string::npos) return name;
    const std::string number =
        count == std::string::npos
            ? ""
            : " " + name.substr(count + 6, name.find(',', count) - count - 6);
    return name.substr(0, comma) + number;
}

std::vector<QuadTask> read_quad_tasks(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw InputError(path + ": cannot be opened");
    std::vector<QuadTask> tasks;
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        std::istringstream words(line.substr(0, line.find('#')));
        QuadTask task;
        if (!(words >> task.kind)) continue;
        words >> task.mesh;
        for (double scale = 0; words >> scale;) task.scales.push_back(scale);
        if (task.scales.empty() || !words.eof())
            throw InputError(path + ":" + std::to_string(number) + ": not KIND MESH SCALE...");
        tasks.push_back(std::move(task));
    }
    return tasks;
}

LoadedMesh load_quad_input(const std::string& name, const std::string& folder) {
    const std::string prefix = "model:";
    if (!name.starts_with(prefix)) {
        const std::filesystem::path inside = std::filesystem::path(folder) / name;
        return read_mesh(!folder.empty() && std::filesystem::exists(inside) ? inside.string()
                                                                            : name);
    }
    std::istringstream words(name.substr(prefix.size()));
    std::string model, word;
    std::getline(words, model, ',');
    ModelOptions options;
    while (std::getline(words, word, ',')) {
        const std::size_t equals = word.find('=');
        const std::string key = word.substr(0, equals);
        const double value =
            std::atof(word.c_str() + (equals == std::string::npos ? word.size() : equals + 1));
        if (key == "count")
            options.count = static_cast<int>(value);
        else if (key == "spacing")
            options.spacing = value;
        else if (key == "resolution")
            options.resolution = value;
        else
            throw InputError(name + ": models have no option " + key);
    }
    return make_model(model, options);
}

QuadCase run_quad_case(const QuadTask& task, double scale, const LoadedMesh& mesh,
                       const std::vector<std::string>& ways, const std::string& pictures) {
    QuadCase result;
    result.kind = task.kind;
    result.mesh = quad_input_name(task.mesh);
    result.scale = scale;
    result.faces = mesh.mesh.n_faces();
    const double h = scale / 100 * bounding_box(mesh.mesh).diagonal();
    const FeatureCurveNetwork initial =
        add_boundaries(detect_sharp(mesh), mesh, BoundaryPolicy::Keep);
    const ReferenceSurface reference(mesh.mesh);
    AdaptationOptions adaptation;
    adaptation.rmin = h / kEdgeLengthFactor;
    adaptation.target = ElementType::Quad;
    adaptation.solver = labeling::all_solvers().find("auto");
    const FeatureCurveNetwork adapted = adapt_network(mesh, initial, adaptation).network;
    result.has_network = !adapted.segments.empty();
    ComparisonInput input{mesh, initial, adapted, adaptation.rmin};
    input.sample_spacing = kSampleSpacing * h;
    input.reference = &reference;
    RemeshOptions triangles;
    triangles.edge_length = h;
    triangles.reference = &reference;
    result.triangle_hausdorff =
        measure_distance(remesh_triangles(mesh, adapted, triangles).mesh.mesh, mesh.mesh, reference,
                         input.sample_spacing)
            .hausdorff /
        h;
    for (const std::string& way : ways) {
        const QuadComparisonRow row = run_quad_way(way, input);
        result.ways[way] = outcome_of(row, h);
        if (!pictures.empty() && row.failure.empty())
            draw(pictures, result, way, row.result.mesh, mesh);
    }
    return result;
}

std::string to_line(const QuadCase& one) {
    Json ways = Json::object();
    for (const auto& [name, way] : one.ways)
        ways[name] = {{"failure", way.failure},
                      {"is_by_field", way.is_by_field},
                      {"reason", way.reason},
                      {"faces", way.faces},
                      {"inverted_corners", way.inverted_corners},
                      {"close_pairs", way.close_pairs},
                      {"mean_jacobian", way.mean_jacobian},
                      {"least_jacobian", way.least_jacobian},
                      {"irregular", way.irregular},
                      {"hausdorff", way.hausdorff},
                      {"alignment_degrees", way.alignment_degrees},
                      {"cpu_seconds", way.cpu_seconds}};
    return Json{{"kind", one.kind},
                {"mesh", one.mesh},
                {"scale", one.scale},
                {"faces", one.faces},
                {"triangle_hausdorff", one.triangle_hausdorff},
                {"has_network", one.has_network},
                {"ways", ways}}
        .dump();
}

QuadCase from_line(const std::string& line) {
    const Json json = Json::parse(line);
    QuadCase one;
    json.at("kind").get_to(one.kind);
    json.at("mesh").get_to(one.mesh);
    json.at("scale").get_to(one.scale);
    json.at("faces").get_to(one.faces);
    json.at("triangle_hausdorff").get_to(one.triangle_hausdorff);
    json.at("has_network").get_to(one.has_network);
    for (const auto& [name, way] : json.at("ways").items()) {
        QuadOutcome& outcome = one.ways[name];
        way.at("failure").get_to(outcome.failure);
        way.at("is_by_field").get_to(outcome.is_by_field);
        way.at("reason").get_to(outcome.reason);
        way.at("faces").get_to(outcome.faces);
        way.at("inverted_corners").get_to(outcome.inverted_corners);
        way.at("close_pairs").get_to(outcome.close_pairs);
        way.at("mean_jacobian").get_to(outcome.mean_jacobian);
        way.at("least_jacobian").get_to(outcome.least_jacobian);
        way.at("irregular").get_to(outcome.irregular);
        way.at("hausdorff").get_to(outcome.hausdorff);
        way.at("alignment_degrees").get_to(outcome.alignment_degrees);
        way.at("cpu_seconds").get_to(outcome.cpu_seconds);
    }
    return one;
}

}  // namespace fcn
