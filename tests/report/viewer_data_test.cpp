#include "report/viewer_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include "geometry/errors.h"
#include "geometry/file_content.h"
#include "geometry/models.h"
#include "report/drawn_curves.h"
#include "report/field_crosses.h"
#include "report/html.h"
#include "report/quad_words.h"
#include "report/report_viewer.h"
#include "report/viewer_decimation.h"
#include "report/viewer_mesh.h"

namespace fcn {
namespace {

using Json = nlohmann::json;

/// A reader of blocks that shares no code with the writer.
struct Block {
    Json header;
    std::string arrays;

    explicit Block(const std::string& bytes) {
        const std::string plain = decompress(bytes, "block");
        EXPECT_EQ(plain.substr(0, 4), "FCNV");
        std::size_t size = 0;
        for (std::size_t i = 0; i < 4; ++i)
            size += static_cast<std::size_t>(static_cast<unsigned char>(plain[4 + i])) << 8 * i;
        header = Json::parse(plain.substr(8, size));
        arrays = plain.substr(8 + size);
    }

    std::vector<std::int64_t> numbers(std::size_t at, std::size_t count) const {
        std::vector<std::int64_t> result;
        while (result.size() < count) {
            std::int64_t number = 0, factor = 1;
            for (bool is_more = true; is_more; factor *= 128) {
                const auto byte = static_cast<unsigned char>(arrays.at(at++));
                number += factor * (byte % 128);
                is_more = byte >= 128;
            }
            result.push_back(number);
        }
        return result;
    }

    std::vector<Vec3> points(const Json& place, const Json& grid) const {
        const std::size_t count = place[1];
        const auto codes = numbers(place[0], 3 * count);
        std::vector<Vec3> result(count, Vec3::Zero());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::int64_t step = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const std::int64_t code = codes[axis * count + i];
                step += code % 2 == 1 ? -(code + 1) / 2 : code / 2;
                result[i][static_cast<Eigen::Index>(axis)] =
                    grid["min"][axis].get<double>() +
                    static_cast<double>(step) * grid["step"].get<double>();
            }
        }
        return result;
    }

    std::vector<std::array<Vec3, 3>> triangles(const Json& mesh, const Json& grid) const {
        const std::vector<Vec3> corners = points(mesh["points"], grid);
        std::int64_t next = 0;
        std::vector<std::array<Vec3, 3>> result;
        const auto codes = numbers(mesh["corners"][0], mesh["corners"][1]);
        for (std::size_t i = 0; i < codes.size(); ++i) {
            if (i % 3 == 0) result.emplace_back();
            const std::int64_t vertex = codes[i] == 0 ? next++ : next - codes[i];
            result.back()[i % 3] = corners.at(static_cast<std::size_t>(vertex));
        }
        EXPECT_EQ(next, static_cast<std::int64_t>(corners.size()));
        return result;
    }
};

Mesh small_sphere() {
    ModelOptions options;
    options.resolution = 0.06;
    return make_model("sphere", options).mesh;
}

MeshRecord record_of(Mesh mesh) {
    MeshRecord record;
    record.mesh.mesh = std::move(mesh);
    record.mesh.name = "part";
    return record;
}

Mesh random_soup(std::mt19937& random, int count) {
    Mesh mesh;
    std::uniform_real_distribution<double> coordinate(-3, 5);
    for (int i = 0; i < count; ++i) {
        std::array<VertexHandle, 3> corners;
        for (VertexHandle& corner : corners)
            corner =
                mesh.add_vertex(Vec3(coordinate(random), coordinate(random), coordinate(random)));
        mesh.add_face(corners[0], corners[1], corners[2]);
    }
    return mesh;
}

/// Over all triangles of the mesh, the distance of its corners to those of the nearest written one,
/// turned but not turned over.
double worst_corner_error(const Mesh& mesh, std::vector<std::array<Vec3, 3>> written) {
    double worst = 0;
    for (const FaceHandle face : mesh.faces()) {
        const auto corners = face_vertices(mesh, face);
        double best = std::numeric_limits<double>::infinity();
        for (const auto& triangle : written)
            for (std::size_t turn = 0; turn < 3; ++turn) {
                double error = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    error = std::max(
                        error,
                        (mesh.point(corners[k]) - triangle[(k + turn) % 3]).cwiseAbs().maxCoeff());
                best = std::min(best, error);
            }
        worst = std::max(worst, best);
    }
    return worst;
}

TEST(ViewerData, EveryTriangleComesBackWithinHalfAStep) {
    const unsigned seed = 7;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (const Mesh& mesh :
         {random_soup(random, 60), make_model("gear", {}).mesh, random_soup(random, 1)}) {
        const MeshRecord record = record_of(mesh);
        const Block block(ViewerData(record, 1'000'000).model());
        const Json& grid = block.header["grid"];
        const auto triangles = block.triangles(block.header["meshes"][0], grid);
        ASSERT_EQ(triangles.size(), mesh.n_faces());
        EXPECT_EQ(block.header["meshes"][0]["shown"], mesh.n_faces());
        if (mesh.n_faces() < 5000) {
            EXPECT_LE(worst_corner_error(mesh, triangles), 0.5001 * grid["step"].get<double>());
        }
        EXPECT_LT(grid["step"].get<double>(), 1e-5 * bounding_box(mesh).diagonal());
    }
}

TEST(ViewerData, LargeMeshesAreDecimatedNearTheirSurface) {
    const Mesh mesh = small_sphere();
    const std::size_t limit = mesh.n_faces() / 4;
    const MeshRecord record = record_of(mesh);
    const Block block(ViewerData(record, limit).model());
    const Json& entry = block.header["meshes"][0];
    const auto triangles = block.triangles(entry, block.header["grid"]);
    EXPECT_LE(triangles.size(), limit);
    EXPECT_GT(triangles.size(), limit / 2);
    EXPECT_EQ(entry["faces"], mesh.n_faces());
    EXPECT_EQ(entry["shown"], triangles.size());
    const SurfaceQueries surface(mesh);
    for (const auto& triangle : triangles)
        for (const Vec3& corner : triangle)
            EXPECT_LT(surface.closest(corner).distance, 0.01 * bounding_box(mesh).diagonal());
}

TEST(ViewerDecimation, CreasesAndCornersStaySharp) {
    ModelOptions options;
    options.resolution = 0.02;
    const Mesh box = make_model("box", options).mesh;
    const TriangleArrays all = triangle_arrays(box);
    const TriangleArrays few = decimate_for_display(all, all.triangles.size() / 5);
    EXPECT_LE(few.triangles.size(), all.triangles.size() / 5);
    EXPECT_GT(few.triangles.size(), all.triangles.size() / 20);
    const BoundingBox bounds = bounding_box(box);
    for (int corner = 0; corner < 8; ++corner) {
        Vec3 place;
        for (int axis = 0; axis < 3; ++axis)
            place[axis] = (corner >> axis & 1) == 1 ? bounds.max[axis] : bounds.min[axis];
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& point : few.points) nearest = std::min(nearest, (point - place).norm());
        EXPECT_LT(nearest, 0.1 * options.resolution);
    }
    const SurfaceQueries surface(box);
    for (const auto& triangle : few.triangles)
        for (const int vertex : triangle)
            EXPECT_LT(surface.closest(few.points[static_cast<std::size_t>(vertex)]).distance,
                      0.1 * options.resolution);
}

TEST(ViewerDecimation, AnyMeshKeepsToAnyLimit) {
    const unsigned seed = 13;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const TriangleArrays soup = triangle_arrays(random_soup(random, 300));
    TriangleArrays spot = soup, line = soup;
    for (Vec3& point : spot.points) point = Vec3(1, 2, 3);
    for (Vec3& point : line.points) point = Vec3(point[0], 0, 0);
    for (const TriangleArrays& mesh : {soup, spot, line})
        for (const std::size_t limit : {0U, 1U, 7U, 100U, 299U, 300U, 1000U}) {
            const TriangleArrays few = decimate_for_display(mesh, limit);
            EXPECT_LE(few.triangles.size(), limit);
            if (limit >= 300) {
                EXPECT_EQ(few.triangles.size(), 300U);
            }
            for (const Vec3& point : few.points) EXPECT_TRUE(point.allFinite());
        }
}

/// A network of two arcs of one curve and an arc of none.
MeshRecord record_with_network() {
    MeshRecord record = record_of(small_sphere());
    FeatureCurveNetwork& network = record.initial;
    for (const Vec3& p : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)})
        network.nodes.push_back({p, {}});
    const int ends[3][2] = {{0, 1}, {1, 2}, {2, 0}};
    for (int a = 0; a < 3; ++a) {
        NetworkArc arc;
        arc.nodes = {ends[a][0], ends[a][1]};
        for (const int node : arc.nodes)
            arc.samples.push_back({network.nodes[static_cast<std::size_t>(node)].position, {}});
        arc.curve = a < 2 ? 0 : -1;
        network.arcs.push_back(arc);
    }
    network.curves.push_back({{0, 1}, {false, false}, false, 2 * std::sqrt(2.0)});
    return record;
}

ScaleRecord scale_of(const FeatureCurveNetwork& initial) {
    ScaleRecord scale;
    scale.label = "5%";
    scale.rmin = 0.25;
    FeatureCurveNetwork& adapted = scale.adaptation.network;
    adapted = initial;
    adapted.arcs = {initial.arcs[1]};
    adapted.arcs[0].origins = {1};
    adapted.segments.push_back({{1, 2}, 0, 0, 1, 4.5, false});
    DroppedPiece piece;
    piece.polyline = {{0, 0, 1}, {0.5, 0, 0.5}, {1, 0, 0}};
    piece.origin_arc = 0;
    piece.reason = "conflict";
    piece.weight = 1.25;
    piece.margin = 0.5;
    piece.blockers = {{3, 1, 4.5, "distance", 0.125}};
    adapted.dropped = {piece};
    ConflictPlace place;
    place.kind = "angle";
    place.measured = 0.25;
    place.is_kept = {false, true};
    scale.adaptation.report.conflict_places = {place};
    scale.adaptation.report.iterations.emplace_back().angle_conflicts = 9;
    scale.remesh.mesh = make_model("gear", {}).mesh;
    scale.has_remesh = true;
    scale.compared.push_back({"another", {}});
    scale.compared.back().row.mesh.mesh = small_sphere();
    return scale;
}

TEST(ViewerData, LevelsSayWhatBecameOfEachCurve) {
    const MeshRecord record = record_with_network();
    const ScaleRecord scale = scale_of(record.initial);
    const ViewerData data(record, 1000);
    const Block model(data.model()), level(data.level(scale));
    EXPECT_EQ(model.header["initial"]["curve"], (Json{0, 0, 1}));
    EXPECT_NEAR(model.header["curve_length"][0].get<double>(), 2 * std::sqrt(2.0), 1e-4);
    EXPECT_NEAR(level.header["curve_kept"][0].get<double>(), std::sqrt(2.0), 1e-4);
    EXPECT_EQ(level.header["curve_kept"][1], 0);
    EXPECT_EQ(level.header["adapted"]["curve"], Json{0});
    const Json& dropped = level.header["dropped"];
    EXPECT_EQ(dropped["reasons"][dropped["reason"][0].get<std::size_t>()], "conflict");
    EXPECT_EQ(dropped["margin"][0], 0.5);
    EXPECT_EQ(dropped["blockers"][0][0], (Json{1, 4.5, 0, 0.125}));
    EXPECT_EQ(dropped["conflicts"], Json{"distance"});
    EXPECT_EQ(level.header["conflicts"]["kept"], Json{2});
    EXPECT_EQ(level.header["conflicts"]["total"], 9);
    ASSERT_EQ(level.header["meshes"].size(), 2U);
    EXPECT_EQ(level.header["meshes"][1]["name"], "another");
    const auto sizes = level.numbers(dropped["lines"]["sizes"][0], 1);
    EXPECT_EQ(sizes, std::vector<std::int64_t>{2});  // the middle point lies on the straight line
}

/// A cube of 3 x 3 quads a side with a field along its edges on the quads cut in two.
QuadRecord cube_quads(QuadTier tier) {
    QuadRecord record;
    QuadMesh& mesh = record.result.mesh;
    std::map<std::array<int, 3>, int> numbers;
    const auto vertex = [&](const std::array<int, 3>& p) {
        const auto [at, is_new] = numbers.emplace(p, static_cast<int>(mesh.points.size()));
        if (is_new) mesh.points.emplace_back(p[0], p[1], p[2]);
        return at->second;
    };
    constexpr int kSide = 3;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int level : {0, kSide})
            for (int i = 0; i < kSide; ++i)
                for (int j = 0; j < kSide; ++j) {
                    std::array<int, 4> face{};
                    const std::array<std::array<int, 2>, 4> corners{
                        {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
                    for (std::size_t k = 0; k < 4; ++k) {
                        std::array<int, 3> p{};
                        p[axis] = level;
                        p[(axis + 1) % 3] = corners[k][0];
                        p[(axis + 2) % 3] = corners[k][1];
                        face[level == 0 ? 3 - k : k] = vertex(p);
                    }
                    mesh.faces.push_back(face);
                }
    // Off the plane of two of its quads, so that diagonals differ.
    mesh.points[static_cast<std::size_t>(numbers.at({1, 1, kSide}))] += Vec3(0.3, 0.1, 0.2);
    EXPECT_EQ(check_topology(mesh).fault, "");
    record.quality = measure_quads(mesh, 1);
    record.result.tier = tier;
    record.result.edge_length = 1;
    if (tier == QuadTier::Pairing) {
        record.result.attempts = {{1.5, 100, 8, "map", "it folds"}, {1.2, 0, 0, "domain", "torn"}};
        return record;
    }
    QuadField& field = record.result.field.emplace();
    field.mesh.mesh = triangle_mesh(mesh);
    for (const FaceHandle face : field.mesh.mesh.faces()) {
        const Vec3 normal = face_normal(field.mesh.mesh, face);
        field.arms.push_back(normal.cross(Vec3(0.2, 0.3, 0.5)).normalized());
    }
    return record;
}

TEST(ViewerData, QuadsComeBackWithTheirIrregularVertices) {
    MeshRecord record = record_of(triangle_mesh(cube_quads(QuadTier::Field).result.mesh));
    record.scales.emplace_back();
    record.scales[0].quads = cube_quads(QuadTier::Field);
    const QuadMesh& quads = record.scales[0].quads->result.mesh;
    const ViewerData data(record, 1000);
    const Block model(data.model()), level(data.level(record.scales[0]));
    const Json& grid = model.header["grid"];
    const double step = grid["step"].get<double>();
    EXPECT_EQ(model.header["has_quads"], true);
    const Json& entry = level.header["meshes"][0];
    EXPECT_EQ(entry["sides"], 4);
    EXPECT_EQ(entry["faces"], 54);
    EXPECT_EQ(entry["shown"], 54);
    EXPECT_NEAR(entry["quality"]["min_scaled_jacobian"].get<double>(),
                record.scales[0].quads->quality.min_scaled_jacobian, 1e-4);
    // Every quad is there once, turned but not turned over, its better cut first.
    const std::vector<Vec3> points = level.points(entry["points"], grid);
    EXPECT_EQ(points.size(), quads.points.size());
    const auto codes = level.numbers(entry["corners"][0], entry["corners"][1]);
    ASSERT_EQ(codes.size(), 4 * quads.faces.size());
    std::int64_t next = 0;
    std::vector<int> found(quads.faces.size(), 0);
    const std::vector<std::array<int, 3>> cut = cut_into_triangles(quads);
    for (std::size_t f = 0; f < quads.faces.size(); ++f) {
        std::array<Vec3, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::int64_t code = codes[4 * f + k];
            corners[k] = points.at(static_cast<std::size_t>(code == 0 ? next++ : next - code));
        }
        for (std::size_t g = 0; g < quads.faces.size(); ++g) {
            const auto first = std::ranges::find(quads.faces[g], cut[2 * g][0]);
            double error = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto at = (static_cast<std::size_t>(first - quads.faces[g].begin()) + k) % 4;
                const Vec3& p = quads.points[static_cast<std::size_t>(quads.faces[g][at])];
                error = std::max(error, (p - corners[k]).cwiseAbs().maxCoeff());
            }
            found[g] += error <= 0.5001 * step;
        }
    }
    EXPECT_EQ(found, std::vector<int>(quads.faces.size(), 1));
    const Json& singular = level.header["singularities"];
    EXPECT_EQ(singular["valence"], Json(std::vector<int>(8, 3)));
    for (const Vec3& p : level.points(singular["points"], grid))
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(std::abs(p[axis] - 1.5), 1.5, 0.5001 * step);
    // Two lines a cross, as long as each other, at right angles, through the same point.
    const Json& lines = level.header["field"]["lines"];
    const std::size_t count = lines["sizes"][1];
    const std::vector<Vec3> ends = level.points(lines["points"], grid);
    ASSERT_EQ(ends.size(), 2 * count);
    ASSERT_GT(count, 20U);
    ASSERT_EQ(count % 2, 0U);
    for (std::size_t i = 0; i < ends.size(); i += 4) {
        const Vec3 along = ends[i + 1] - ends[i], across = ends[i + 3] - ends[i + 2];
        EXPECT_NEAR(along.norm(), across.norm(), 4 * step);
        EXPECT_NEAR(along.dot(across), 0, 4 * step);
        EXPECT_LT((ends[i] + ends[i + 1] - ends[i + 2] - ends[i + 3]).norm(), 4 * step);
        EXPECT_GT(along.norm(), 0.4);
    }
    EXPECT_EQ(level.header["quads"]["tier"], "field");
}

TEST(ViewerData, ManyQuadsAreShownAsFewTriangles) {
    MeshRecord record = record_of(small_sphere());
    ScaleRecord scale;
    scale.quads = cube_quads(QuadTier::Field);
    const Block level(ViewerData(record, 40).level(scale));
    const Json& entry = level.header["meshes"][0];
    EXPECT_FALSE(entry.contains("sides"));
    EXPECT_EQ(entry["faces"], 54);
    EXPECT_LE(entry["shown"].get<int>(), 40);
    EXPECT_TRUE(entry["quality"].contains("mean_scaled_jacobian"));
}

TEST(ViewerData, QuadsWithoutAFieldSayWhy) {
    const MeshRecord record = record_of(small_sphere());
    ScaleRecord scale;
    scale.quads = cube_quads(QuadTier::Pairing);
    const Block level(ViewerData(record, 1000).level(scale));
    EXPECT_FALSE(level.header.contains("field"));
    EXPECT_EQ(level.header["quads"]["tier"], "pairing");
    const std::string words = level.header["quads"]["words"];
    for (const char* part : {"By pairing", "1.5", "no map to the plane", "1.2", "no triangles"})
        EXPECT_NE(words.find(part), std::string::npos) << part << " in " << words;
    scale.quads->result.attempts.clear();
    EXPECT_NE(tier_words(scale.quads->result).find("as asked for"), std::string::npos);
    scale.quads->result.tier = QuadTier::Field;
    scale.quads->result.attempts = {{1.1, 100, 8, "smoothing", "2 inverted corners"},
                                    {1, 90, 8, "", ""}};
    const std::string shorter = tier_words(scale.quads->result);
    EXPECT_NE(shorter.find("edge length 1, shorter than asked for: edge length 1.1"),
              std::string::npos)
        << shorter;
}

TEST(FieldCrosses, AreApartAndFew) {
    const QuadField field = *cube_quads(QuadTier::Field).result.field;
    for (const double spacing : {0.4, 1.0, 2.5}) {
        const std::vector<Polyline> crosses = field_crosses(field, spacing, 1000);
        ASSERT_GT(crosses.size(), 5U);
        const auto middle = [&](std::size_t i) {
            return Vec3((crosses[2 * i][0] + crosses[2 * i][1]) / 2);
        };
        const auto normal = [&](std::size_t i) {
            return (crosses[2 * i][1] - crosses[2 * i][0])
                .cross(crosses[2 * i + 1][1] - crosses[2 * i + 1][0]);
        };
        for (std::size_t i = 0; i < crosses.size() / 2; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                if (normal(i).dot(normal(j)) <= 1e-9) continue;
                EXPECT_GE((middle(i) - middle(j)).norm(), spacing);
            }
    }
    EXPECT_LE(field_crosses(field, 0.01, 10).size(), 20U);
    EXPECT_TRUE(field_crosses(field, 0, 10).empty());
}

TEST(ViewerData, SameRecordGivesSameBytes) {
    const MeshRecord record = record_with_network();
    const ScaleRecord scale = scale_of(record.initial);
    EXPECT_EQ(ViewerData(record, 500).level(scale), ViewerData(record, 500).level(scale));
}

TEST(ViewerData, EmptyRecordsAndWildNumbersAreWritten) {
    std::mt19937 random(1);
    const MeshRecord record = record_of(random_soup(random, 1));
    ScaleRecord scale;
    scale.rmin = std::numeric_limits<double>::quiet_NaN();
    scale.label = "a\xff";  // no UTF-8
    DroppedPiece far;
    far.polyline = {{1e300, 0, 0}, {0, -1e300, 0}};
    scale.adaptation.network.dropped = {far};
    const ViewerData data(record, 10);
    EXPECT_EQ(Block(data.model()).header["initial"]["curve"], Json::array());
    const Block level(data.level(scale));
    EXPECT_TRUE(level.header["rmin"].is_null());
    EXPECT_EQ(level.header["dropped"]["curve"], Json{-1});
}

TEST(ViewerData, FacesAreSharedFairly) {
    EXPECT_EQ(fair_face_limit({10, 100, 1000}, 5000), 5000U);  // everything fits
    const unsigned seed = 11;
    std::mt19937 random(seed);
    for (int round = 0; round < 200; ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        std::vector<std::size_t> counts(1 + random() % 8);
        for (std::size_t& count : counts) count = random() % 1000;
        const std::size_t budget = 1 + random() % 3000;
        const std::size_t limit = fair_face_limit(counts, budget);
        const auto total = [&](std::size_t most) {
            return std::accumulate(
                counts.begin(), counts.end(), std::size_t{0},
                [&](std::size_t sum, std::size_t count) { return sum + std::min(count, most); });
        };
        EXPECT_LE(total(limit), budget);
        const bool is_whole = total(limit) == total(1000);
        EXPECT_TRUE(is_whole || total(limit + 1) > budget);
    }
}

TEST(DrawnCurves, SimplifiedCurvesStayClose) {
    const unsigned seed = 3;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.01);
    Polyline points;
    for (int i = 0; i <= 400; ++i)
        points.push_back({std::cos(0.02 * i), std::sin(0.03 * i), noise(random)});
    for (const double tolerance : {0.0, 0.005, 0.02, 0.1, 10.0}) {
        const Polyline result = simplified(points, tolerance);
        EXPECT_EQ(result.front(), points.front());
        EXPECT_EQ(result.back(), points.back());
        for (const Vec3& point : points) {
            double nearest = std::numeric_limits<double>::infinity();
            for (std::size_t i = 1; i < result.size(); ++i) {
                const Vec3 along = result[i] - result[i - 1];
                const double t =
                    std::clamp((point - result[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
                nearest = std::min(nearest, (point - result[i - 1] - t * along).norm());
            }
            EXPECT_LE(nearest, tolerance + 1e-12);
        }
    }
    EXPECT_EQ(simplified(points, 10).size(), 2U);
}

TEST(ReportViewer, ScriptsThatWouldEndThePageAreRefused) {
    HtmlWriter html;
    EXPECT_THROW(write_viewer_script(html, "var a = '</script>';"), InputError);
}

}  // namespace
}  // namespace fcn
