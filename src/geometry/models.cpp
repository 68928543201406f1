#include "geometry/models.h"

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/errors.h"
#include "geometry/model_shapes.h"
#include "geometry/polygon_soup.h"

namespace fcn {

namespace {

struct Model {
    const char* name;
    const char* description;
    ModelSurface (*make)(const ModelOptions&);
    int least_count;
};

constexpr Model kModels[] = {
    {"skyscraper", "tower of `count` tiers with set-backs of 1/4, 1/2, 1, 2 and 4 spacings",
     make_skyscraper, 2},
    {"ribs", "plate with `count` sharp ribs, `spacing` from rib to rib", make_ribs, 1},
    {"holes", "plate with `count` square holes, `spacing` wide and apart", make_holes, 1},
    {"steps", "stair of `count` steps, `spacing` high and deep", make_steps, 1},
    {"step", "block with a step `spacing` high across it: two creases at that distance", make_step,
     0},
    {"gear", "gear wheel with bore and `count` teeth, `spacing` wide at the tip and high",
     make_gear, 3},
    {"octaflower", "lens-shaped flower of `count` petals: sharp rim, creases that fade inwards",
     make_octaflower, 3},
    {"thin-wall", "plate of a tenth of `spacing` with `count` strips on either side",
     make_thin_wall, 1},
    {"noisy-plane", "open unit square with noise (0.2 edge lengths unless given)", make_noisy_plane,
     0},
    {"box", "1 by 0.8 by 0.6", make_box, 0},
    {"cylinder", "radius 0.5, height 1, closed", make_cylinder, 0},
    {"torus", "radii 0.35 and 0.15", make_torus, 0},
    {"superellipse-torus",
     "radius 0.35, tube |x|^4 + |z|^4 = 0.15^4: four crest circles, 8 pi 0.35 long together",
     make_superellipse_torus, 0},
    {"sphere", "radius 0.5", make_sphere, 0},
};

const Model& model_of_name(std::string_view name) {
    std::string known;
    for (const Model& model : kModels) {
        if (name == model.name) return model;
        if (!known.empty()) known += ", ";
        known += model.name;
    }
    throw InputError("unknown model '" + std::string(name) + "'; known are " + known);
}

void check(const Model& model, const ModelOptions& options) {
    const auto fail = [&](const std::string& what) {
        throw InputError("model " + std::string(model.name) + ": " + what);
    };
    if (!(options.resolution > 0 && options.resolution <= 0.5)) {
        fail("resolution must lie in (0, 0.5], got " + std::to_string(options.resolution));
    }
    if (!(options.spacing > 0 && options.spacing <= 10)) {
        fail("spacing must lie in (0, 10], got " + std::to_string(options.spacing));
    }
    if (options.count < model.least_count || options.count > 100000) {
        fail("count must lie in [" + std::to_string(model.least_count) + ", 100000], got " +
             std::to_string(options.count));
    }
    if (!(options.noise >= 0 && options.noise <= 10)) {
        fail("noise must lie in [0, 10], got " + std::to_string(options.noise));
    }
}

/// Standard normal numbers by Box and Muller, from 53 bits each: the distributions of the standard
/// library differ from one library to another.
class NormalNumbers {
public:
    explicit NormalNumbers(std::uint64_t seed) : engine_(seed) {}
    double next() {
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }

private:
    double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }
    std::mt19937_64 engine_;
};

/// Moves every vertex along its normal.
void add_noise(std::vector<Vec3>& points, const Mesh& mesh, double deviation, std::uint64_t seed) {
    NormalNumbers numbers(seed);
    for (const auto vertex : mesh.vertices()) {
        Vec3 normal = Vec3::Zero();
        for (const auto face : mesh.vf_range(vertex)) {
            normal += face_area(mesh, face) * face_normal(mesh, face);
        }
        points[static_cast<std::size_t>(vertex.idx())] +=
            deviation * numbers.next() * normal.normalized();
    }
}

}  // namespace

std::vector<ModelInfo> model_list() {
    std::vector<ModelInfo> list;
    for (const Model& model : kModels) list.push_back({model.name, model.description});
    return list;
}

LoadedMesh make_model(std::string_view name, const ModelOptions& options) {
    const Model& model = model_of_name(name);
    check(model, options);
    ModelSurface surface = model.make(options);
    PolygonSoup soup;
    soup.points = std::move(surface.points);
    for (const auto& corners : surface.triangles) {
        soup.corners.insert(soup.corners.end(), corners.begin(), corners.end());
        soup.close_polygon();
    }
    // The pieces meet in equal points.
    soup.is_unconnected = true;
    ReadOptions read_options;
    read_options.weld_tolerance = 1e-12;
    LoadedMesh result = mesh_from_polygons(std::move(soup), "model", read_options);
    const double default_noise = name == "noisy-plane" ? 0.2 : 0.0;
    const double noise = options.noise > 0 ? options.noise : default_noise;
    if (noise > 0) {
        std::vector<Vec3> points;
        std::vector<std::array<int, 3>> triangles;
        for (const auto vertex : result.mesh.vertices())
            points.push_back(result.mesh.point(vertex));
        for (const auto face : result.mesh.faces()) {
            const auto [a, b, c] = face_vertices(result.mesh, face);
            triangles.push_back({a.idx(), b.idx(), c.idx()});
        }
        add_noise(points, result.mesh, noise * options.resolution, options.seed);
        result = mesh_from_soup(points, triangles);
    }
    result.repairs = {};
    result.name = name;
    return result;
}

}  // namespace fcn
