// Crest lines against CGAL's Ridge_approximation on Monge_via_jet_fitting, in one run:
//   features_crest_vs_cgal [RESOLUTION ...]
// prints a table for the superellipse torus, whose crests are four circles, and for the plain
// torus, which has none; each clean and with noise of 0.03% and 0.1% of the diagonal. Precision is
// the share of the lines' length within half a mean edge of the truth, recall the share of the
// truth that has a line that close. CGAL's lines are judged as they come, and with the threshold on
// their strength that is best for them in hindsight. Seconds are processor seconds on one thread.
// CGAL fits jets of degree four to the vertices within three rings.

#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Ridges.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "features/crest.h"
#include "geometry/models.h"

namespace {

using fcn::Vec3;
using Kernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Fitting = CGAL::Monge_via_jet_fitting<Kernel>;
using NumberMap = CgalMesh::Property_map<CgalMesh::Vertex_index, double>;
using VectorMap = CgalMesh::Property_map<CgalMesh::Vertex_index, Kernel::Vector_3>;
using Ridges = CGAL::Ridge_approximation<CgalMesh, NumberMap, VectorMap>;
using Polylines = std::vector<std::vector<Vec3>>;

constexpr double kRadius = 0.35, kTube = 0.15;  // of the models
constexpr int kRings = 3;
constexpr int kBins = 2000;  // per circle

struct Score {
    std::size_t line_count = 0;
    double length = 0;
    double precision = 1;
    double recall = 0;
    double f_score() const {
        return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
    }
};

/// The four crest circles of the superellipse torus, or nothing.
class Truth {
public:
    Truth(bool has_crests, double tolerance)
        : has_crests_(has_crests), tolerance_(tolerance), is_covered_(4 * kBins, false) {}

    void add(const std::vector<Vec3>& line) {
        ++score_.line_count;
        for (std::size_t i = 1; i < line.size(); ++i) {
            const double length = (line[i] - line[i - 1]).norm();
            const int count = std::max(1, static_cast<int>(std::ceil(4 * length / tolerance_)));
            for (int k = 0; k < count; ++k) {
                const Vec3 at = line[i - 1] + (k + 0.5) / count * (line[i] - line[i - 1]);
                score_.length += length / count;
                if (has_crests_ && cover(at)) matched_ += length / count;
            }
        }
    }

    Score score() const {
        Score score = score_;
        if (score.length > 0) score.precision = matched_ / score.length;
        double covered = 0, all = 0;
        for (std::size_t bin = 0; bin < is_covered_.size(); ++bin) {
            const double weight = radius(static_cast<int>(bin) / kBins);
            all += weight;
            covered += is_covered_[bin] ? weight : 0;
        }
        score.recall = has_crests_ ? covered / all : 1;
        return score;
    }

private:
    static double offset() { return kTube * std::pow(2, -0.25); }
    static double radius(int circle) { return kRadius + (circle % 2 == 0 ? 1 : -1) * offset(); }

    bool cover(const Vec3& at) {
        const double rho = std::hypot(at.x(), at.y());
        const int circle = (rho > kRadius ? 0 : 1) + (at.z() > 0 ? 0 : 2);
        const double height = (at.z() > 0 ? 1 : -1) * offset();
        if (std::hypot(rho - radius(circle), at.z() - height) > tolerance_) return false;
        const double turn = std::atan2(at.y(), at.x()) / (2 * std::numbers::pi) + 1;
        const int reach = static_cast<int>(
            std::ceil(tolerance_ / (2 * std::numbers::pi * radius(circle)) * kBins));
        for (int k = -reach; k <= reach; ++k) {
            const int bin = (static_cast<int>(turn * kBins) + k + kBins) % kBins;
            is_covered_[static_cast<std::size_t>(circle * kBins + bin)] = true;
        }
        return true;
    }

    bool has_crests_;
    double tolerance_;
    std::vector<bool> is_covered_;
    Score score_;
    double matched_ = 0;
};

double seconds_since(std::clock_t start) {
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

Vec3 to_vector(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

CgalMesh cgal_mesh(const fcn::Mesh& mesh) {
    CgalMesh result;
    for (const auto vertex : mesh.vertices()) {
        const Vec3& p = mesh.point(vertex);
        result.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
    }
    for (const auto face : mesh.faces()) {
        const auto corners = fcn::face_vertices(mesh, face);
        result.add_face(CgalMesh::Vertex_index(corners[0].idx()),
                        CgalMesh::Vertex_index(corners[1].idx()),
                        CgalMesh::Vertex_index(corners[2].idx()));
    }
    return result;
}

std::vector<CgalMesh::Vertex_index> rings(const CgalMesh& mesh, CgalMesh::Vertex_index vertex,
                                          std::vector<int>& mark) {
    std::vector<CgalMesh::Vertex_index> found{vertex};
    mark[vertex] = static_cast<int>(vertex) + 1;
    std::size_t begin = 0;
    for (int ring = 0; ring < kRings; ++ring) {
        const std::size_t end = found.size();
        for (; begin < end; ++begin) {
            for (const auto next :
                 CGAL::vertices_around_target(mesh.halfedge(found[begin]), mesh)) {
                if (mark[next] == static_cast<int>(vertex) + 1) continue;
                mark[next] = static_cast<int>(vertex) + 1;
                found.push_back(next);
            }
        }
    }
    return found;
}

struct CgalLine {
    std::vector<Vec3> points;
    double strength = 0;
};

std::vector<CgalLine> cgal_crests(CgalMesh& mesh, const std::vector<Kernel::Vector_3>& normals) {
    const auto number = [&](const char* name) {
        return mesh.add_property_map<CgalMesh::Vertex_index, double>(name, 0).first;
    };
    const auto vector = [&](const char* name) {
        return mesh
            .add_property_map<CgalMesh::Vertex_index, Kernel::Vector_3>(name, CGAL::NULL_VECTOR)
            .first;
    };
    NumberMap k1 = number("v:k1"), k2 = number("v:k2"), b0 = number("v:b0"), b3 = number("v:b3");
    NumberMap p1 = number("v:p1"), p2 = number("v:p2");
    VectorMap d1 = vector("v:d1"), d2 = vector("v:d2");
    std::vector<int> mark(mesh.number_of_vertices(), 0);
    for (const auto v : mesh.vertices()) {
        std::vector<Kernel::Point_3> points;
        for (const auto near : rings(mesh, v, mark)) points.push_back(mesh.point(near));
        Fitting fitting;
        auto form = fitting(points.begin(), points.end(), 4, 4);
        form.comply_wrt_given_normal(normals[v]);
        k1[v] = form.principal_curvatures(0);
        k2[v] = form.principal_curvatures(1);
        b0[v] = form.third_order_coefficients(0);
        b3[v] = form.third_order_coefficients(3);
        d1[v] = form.maximal_principal_direction();
        d2[v] = form.minimal_principal_direction();
        const double b1 = form.third_order_coefficients(1), b2 = form.third_order_coefficients(2);
        p1[v] = 3 * b1 * b1 +
                (k1[v] - k2[v]) * (form.fourth_order_coefficients(0) - 3 * k1[v] * k1[v] * k1[v]);
        p2[v] = 3 * b2 * b2 +
                (k2[v] - k1[v]) * (form.fourth_order_coefficients(4) - 3 * k2[v] * k2[v] * k2[v]);
    }
    Ridges approximation(mesh, k1, k2, b0, b3, d1, d2, p1, p2);
    std::vector<CGAL::Ridge_line<CgalMesh>*> lines;
    approximation.compute_crest_ridges(std::back_inserter(lines), CGAL::Ridge_order_3);
    std::vector<CgalLine> result;
    for (auto* raw : lines) {
        const std::unique_ptr<CGAL::Ridge_line<CgalMesh>> line(raw);
        CgalLine kept;
        kept.strength = std::abs(line->strength());
        for (const auto& [halfedge, share] : *line->line()) {
            kept.points.push_back(share * to_vector(mesh.point(mesh.source(halfedge))) +
                                  (1 - share) * to_vector(mesh.point(mesh.target(halfedge))));
        }
        result.push_back(std::move(kept));
    }
    return result;
}

struct Outcome {
    double seconds = 0;
    Score score;
    Score best;  ///< with the best threshold on strength
};

Outcome run_ours(const fcn::LoadedMesh& mesh, bool has_crests, double tolerance) {
    const std::clock_t start = std::clock();
    const auto network = fcn::detect_crest(mesh);
    Outcome outcome;
    outcome.seconds = seconds_since(start);
    Truth truth(has_crests, tolerance);
    for (const auto& arc : network.arcs) {
        std::vector<Vec3> line;
        for (const auto& sample : arc.samples) line.push_back(sample.position);
        truth.add(line);
    }
    outcome.score = outcome.best = truth.score();
    return outcome;
}

Outcome run_cgal(const fcn::LoadedMesh& mesh, bool has_crests, double tolerance) {
    CgalMesh surface = cgal_mesh(mesh.mesh);
    std::vector<Kernel::Vector_3> normals;
    for (const auto vertex : mesh.mesh.vertices()) {
        Vec3 normal = Vec3::Zero();
        for (const auto face : mesh.mesh.vf_range(vertex))
            normal += fcn::face_area(mesh.mesh, face) * fcn::face_normal(mesh.mesh, face);
        normals.emplace_back(normal.x(), normal.y(), normal.z());
    }
    const std::clock_t start = std::clock();
    std::vector<CgalLine> lines = cgal_crests(surface, normals);
    Outcome outcome;
    outcome.seconds = seconds_since(start);
    std::sort(lines.begin(), lines.end(),
              [](const CgalLine& a, const CgalLine& b) { return a.strength > b.strength; });
    Truth truth(has_crests, tolerance);
    for (const CgalLine& line : lines) {
        truth.add(line.points);
        const Score score = truth.score();
        if (score.f_score() > outcome.best.f_score()) outcome.best = score;
    }
    outcome.score = truth.score();
    return outcome;
}

fcn::LoadedMesh noisy(const fcn::LoadedMesh& mesh, double deviation) {
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal(0, deviation);
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const auto v : mesh.mesh.vertices()) {
        points.push_back(mesh.mesh.point(v));
        for (int i = 0; i < 3 && deviation > 0; ++i) points.back()[i] += normal(engine);
    }
    for (const auto f : mesh.mesh.faces()) {
        const auto [a, b, c] = fcn::face_vertices(mesh.mesh, f);
        triangles.push_back({a.idx(), b.idx(), c.idx()});
    }
    return fcn::mesh_from_soup(points, triangles);
}

void print_row(const std::string& name, double noise, double resolution) {
    const bool has_crests = name != "torus";
    fcn::ModelOptions options;
    options.resolution = resolution;
    const fcn::LoadedMesh clean = fcn::make_model(name, options);
    const fcn::LoadedMesh mesh = noisy(clean, noise * fcn::bounding_box(clean.mesh).diagonal());
    const Outcome ours = run_ours(mesh, has_crests, 0.5 * resolution);
    const Outcome cgal = run_cgal(mesh, has_crests, 0.5 * resolution);
    std::printf(
        "| %s | %zu | %.2f | %.2f | %zu | %.3f | %.3f | %.3f | %.2f | %zu | %.3f | %.3f |"
        " %.3f | %zu | %.3f | %.3f | %.1f |\n",
        name.c_str(), mesh.mesh.n_faces(), 100 * noise, ours.seconds, ours.score.line_count,
        ours.score.length, ours.score.precision, ours.score.recall, cgal.seconds,
        cgal.score.line_count, cgal.score.length, cgal.score.precision, cgal.score.recall,
        has_crests ? cgal.best.line_count : 0, has_crests ? cgal.best.precision : 1,
        has_crests ? cgal.best.recall : 1, cgal.seconds / ours.seconds);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        std::vector<double> resolutions;
        for (int i = 1; i < argc; ++i) resolutions.push_back(std::stod(argv[i]));
        if (resolutions.empty()) resolutions = {0.02};
        std::printf(
            "| model | faces | noise %% | ours s | lines | length | precision | recall | CGAL s | "
            "lines | length | precision | recall | best lines | precision | recall | time ratio |\n"
            "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
        for (const double resolution : resolutions)
            for (const std::string name : {"superellipse-torus", "torus"})
                for (const double noise : {0.0, 0.0003, 0.001}) print_row(name, noise, resolution);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
    return 0;
}
