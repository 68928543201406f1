// Sharp edges and curvatures beside CGAL's, in one run:
//   features_sharp_vs_cgal PART[:FACES] ...
// A part is the name of a built-in model (10000 faces unless told) or a mesh NAME.off with its
// curves in NAME.cadedges.txt. Two tables.
//
// Creases, with noise of 0, 5 and 10% of the mean edge: precision, recall and number of arcs of
// detect_sharp and of CGAL's detect_sharp_edges at the same 40 degrees, and at the angle that is
// best for it in hindsight (by F-score, in steps of 5 degrees). CGAL marks edges; its arcs are what
// the same tracing makes of them. The last four columns compare the same work: marking the edges
// above 40 degrees, and also numbering the patches between them, by edges_above and patches_between
// and by CGAL's detect_sharp_edges and sharp_edges_segmentation; nanoseconds an edge.
// See detectors_noise_scale for the measures.
//
// Curvatures on the torus of radii 0.35 and 0.15, whose curvatures are known: root mean square
// error of the two principal ones over their root mean square, of our fits (three edges; cubic) and
// of CGAL's Monge_via_jet_fitting (three rings; jets of degree 3, and of 4). Seconds are processor
// seconds on one thread, conversion of the mesh aside.

#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <numbers>
#include <utility>

#include "features/edge_chains.h"
#include "features/features.h"
#include "features/local_fit.h"
#include "geometry/errors.h"
#include "known_curves.h"

namespace {

using namespace fcn;
using Kernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Fitting = CGAL::Monge_via_jet_fitting<Kernel>;

constexpr double kTorusRadius = 0.35, kTubeRadius = 0.15;
constexpr int kRings = 3;
constexpr int kRepeats = 3;  // of fast runs, whose mean is printed
constexpr int kThresholdRepeats = 20;
constexpr double kThresholdDegrees = 40;

double seconds_since(std::clock_t start) {
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

CgalMesh cgal_mesh(const Mesh& mesh) {
    CgalMesh result;
    for (const auto vertex : mesh.vertices()) {
        const Vec3& p = mesh.point(vertex);
        result.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
    }
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        result.add_face(CgalMesh::Vertex_index(a.idx()), CgalMesh::Vertex_index(b.idx()),
                        CgalMesh::Vertex_index(c.idx()));
    }
    return result;
}

struct Creases {
    double seconds = 0;
    double threshold_seconds = 0;     ///< marking edges alone
    double segmentation_seconds = 0;  ///< marking edges and numbering patches
    CurveScore score;
    double f_score() const {
        const double sum = score.precision + score.recall;
        return sum > 0 && score.length > 0 ? 2 * score.precision * score.recall / sum : 0;
    }
};

Creases our_creases(const LoadedMesh& mesh, const KnownCurves& known, double tolerance) {
    Creases result;
    const std::clock_t start = std::clock();
    FeatureCurveNetwork network;
    for (int i = 0; i < kRepeats; ++i) network = detect_sharp(mesh);
    result.seconds = seconds_since(start) / kRepeats;
    result.score = score(network, known, tolerance);
    const double angle = kThresholdDegrees * std::numbers::pi / 180;
    std::vector<bool> marks;
    const std::clock_t threshold_start = std::clock();
    for (int i = 0; i < kThresholdRepeats; ++i) marks = edges_above(mesh.mesh, angle);
    result.threshold_seconds = seconds_since(threshold_start) / kThresholdRepeats;
    std::vector<int> patches;
    const std::clock_t segmentation_start = std::clock();
    for (int i = 0; i < kThresholdRepeats; ++i)
        patches = patches_between(mesh.mesh, edges_above(mesh.mesh, angle));
    result.segmentation_seconds = seconds_since(segmentation_start) / kThresholdRepeats;
    if (patches.empty() || marks.empty()) throw LogicError("a mesh without faces");
    return result;
}

Creases cgal_creases(const LoadedMesh& mesh, CgalMesh& surface, double degrees,
                     const KnownCurves& known, double tolerance) {
    Creases result;
    auto marks = surface.add_property_map<CgalMesh::Edge_index, bool>("e:sharp", false).first;
    const int repeats = degrees == kThresholdDegrees ? kThresholdRepeats : 1;
    const std::clock_t start = std::clock();
    for (int i = 0; i < repeats; ++i) {
        for (const auto edge : surface.edges()) marks[edge] = false;
        CGAL::Polygon_mesh_processing::detect_sharp_edges(surface, degrees, marks);
    }
    result.threshold_seconds = seconds_since(start) / repeats;
    auto patches = surface.add_property_map<CgalMesh::Face_index, int>("f:patch", 0).first;
    const std::clock_t segmentation_start = std::clock();
    for (int i = 0; i < repeats; ++i) {
        for (const auto edge : surface.edges()) marks[edge] = false;
        CGAL::Polygon_mesh_processing::sharp_edges_segmentation(surface, degrees, marks, patches);
    }
    result.segmentation_seconds = seconds_since(segmentation_start) / repeats;
    std::vector<bool> is_marked(mesh.mesh.n_edges(), false);
    for (const auto edge : mesh.mesh.edges()) {
        const auto h = mesh.mesh.halfedge_handle(edge, 0);
        const auto found =
            surface.halfedge(CgalMesh::Vertex_index(mesh.mesh.from_vertex_handle(h).idx()),
                             CgalMesh::Vertex_index(mesh.mesh.to_vertex_handle(h).idx()));
        is_marked[edge.idx()] = marks[surface.edge(found)];
    }
    result.score = score(network_from_edges(mesh.mesh, is_marked, {}, "cgal"), known, tolerance);
    return result;
}

void compare_creases(const std::string& argument) {
    const std::size_t colon = argument.find(':');
    const int faces = colon == std::string::npos ? 10000 : std::stoi(argument.substr(colon + 1));
    const std::string name = argument.substr(0, colon);
    const bool is_file = name.find('.') != std::string::npos;
    const KnownPart part = is_file ? cad_part(name) : model_part(name, faces);
    const KnownCurves known = known_curves(part);
    const double tolerance = 0.5 * part.mean_edge();
    for (double noise : {0.0, 0.05, 0.1}) {
        const LoadedMesh mesh = noisy_mesh(part, noise, 1);
        const Creases ours = our_creases(mesh, known, tolerance);
        CgalMesh surface = cgal_mesh(mesh.mesh);
        const Creases cgal = cgal_creases(mesh, surface, kThresholdDegrees, known, tolerance);
        Creases best = cgal;
        for (double degrees = 20; degrees <= 85; degrees += 5) {
            const Creases other = cgal_creases(mesh, surface, degrees, known, tolerance);
            if (other.f_score() > best.f_score()) best = other;
        }
        std::printf("| %s | %zu | %.0f | %zu |", part.name.c_str(), part.triangles.size(),
                    100 * noise, known.required.arcs.size());
        for (const Creases& c : {ours, cgal, best})
            std::printf(" %.3f | %.3f | %zu |", c.score.precision, c.score.recall,
                        c.score.curve_count);
        const double edges = static_cast<double>(mesh.mesh.n_edges());
        std::printf(" %.4f | %.1f | %.1f | %.1f | %.1f |\n", ours.seconds,
                    1e9 * ours.threshold_seconds / edges, 1e9 * cgal.threshold_seconds / edges,
                    1e9 * ours.segmentation_seconds / edges,
                    1e9 * cgal.segmentation_seconds / edges);
        std::fflush(stdout);
    }
}

/// Principal curvatures of the torus at a point near it, the larger first, outward normals.
std::pair<double, double> torus_curvatures(const Vec3& at) {
    const double rho = std::hypot(at.x(), at.y()) - kTorusRadius;
    const double cosine = rho / std::hypot(rho, at.z());
    return {1 / kTubeRadius, cosine / (kTorusRadius + kTubeRadius * cosine)};
}

/// Errors of curvatures, whose sign is the fit's choice.
class CurvatureError {
public:
    void add(const Vec3& at, double first, double second) {
        const auto [larger, smaller] = torus_curvatures(at);
        const auto off = [&](double a, double b) {
            return std::pow(a - larger, 2) + std::pow(b - smaller, 2);
        };
        errors_ += std::min(
            {off(first, second), off(second, first), off(-first, -second), off(-second, -first)});
        sum_ += larger * larger + smaller * smaller;
    }
    double relative() const { return std::sqrt(errors_ / sum_); }

private:
    double errors_ = 0, sum_ = 0;
};

std::vector<CgalMesh::Vertex_index> rings(const CgalMesh& mesh, CgalMesh::Vertex_index vertex,
                                          std::vector<int>& mark) {
    const int stamp = static_cast<int>(vertex.idx()) + 1;
    std::vector<CgalMesh::Vertex_index> found{vertex};
    mark[vertex] = stamp;
    std::size_t begin = 0;
    for (int ring = 0; ring < kRings; ++ring) {
        const std::size_t end = found.size();
        for (; begin < end; ++begin) {
            for (const auto next :
                 CGAL::vertices_around_target(mesh.halfedge(found[begin]), mesh)) {
                if (mark[next] == stamp) continue;
                mark[next] = stamp;
                found.push_back(next);
            }
        }
    }
    return found;
}

std::pair<double, double> cgal_fits(const CgalMesh& mesh, int degree) {
    CurvatureError error;
    std::vector<int> mark(mesh.number_of_vertices(), 0);
    std::vector<std::pair<double, double>> curvatures;
    const std::clock_t start = std::clock();
    for (const auto v : mesh.vertices()) {
        std::vector<Kernel::Point_3> points;
        for (const auto near : rings(mesh, v, mark)) points.push_back(mesh.point(near));
        Fitting fitting;
        const auto form = fitting(points.begin(), points.end(), static_cast<std::size_t>(degree),
                                  static_cast<std::size_t>(degree));
        curvatures.emplace_back(form.principal_curvatures(0), form.principal_curvatures(1));
    }
    const double seconds = seconds_since(start);
    for (const auto v : mesh.vertices()) {
        const auto& p = mesh.point(v);
        error.add({p.x(), p.y(), p.z()}, curvatures[v].first, curvatures[v].second);
    }
    return {error.relative(), seconds};
}

std::pair<double, double> our_fits(const Mesh& mesh) {
    const std::clock_t start = std::clock();
    const MeshArrays arrays = mesh_arrays(mesh);
    const LocalFitter fitter(arrays, std::vector<bool>(arrays.edge_count(), false));
    const std::vector<VertexFit> fits = fitter.fit_all({.rings = kRings, .threads = 1});
    const double seconds = seconds_since(start);
    CurvatureError error;
    for (int v = 0; v < arrays.vertex_count(); ++v)
        error.add(arrays.points[v], fits[v].kappa_max, fits[v].kappa_min);
    return {error.relative(), seconds};
}

void compare_fits(int faces, double noise) {
    const KnownPart part = model_part("torus", faces);
    const LoadedMesh mesh = noisy_mesh(part, noise, 1);
    const CgalMesh surface = cgal_mesh(mesh.mesh);
    const auto ours = our_fits(mesh.mesh);
    const auto cubic = cgal_fits(surface, 3), quartic = cgal_fits(surface, 4);
    std::printf("| %zu | %.1f | %.5f | %.5f | %.5f | %.3f | %.3f | %.3f |\n", part.triangles.size(),
                100 * noise, ours.first, cubic.first, quartic.first, ours.second, cubic.second,
                quartic.second);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        std::printf(
            "| part | faces | noise %% | known | precision | recall | arcs | CGAL 40: precision |"
            " recall | arcs | CGAL best: precision | recall | arcs | seconds | marks ns |"
            " CGAL ns | patches ns | CGAL ns |\n"
            "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
        for (int i = 1; i < argc; ++i) compare_creases(argv[i]);
        std::printf(
            "\n| faces | noise %% | error | CGAL 3: error | CGAL 4: error | seconds | CGAL 3 s |"
            " CGAL 4 s |\n|---|---|---|---|---|---|---|---|\n");
        for (int faces : {2000, 10000, 50000})
            for (double noise : {0.0, 0.001, 0.01}) compare_fits(faces, noise);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
    return 0;
}
