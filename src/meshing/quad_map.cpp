// From a cross field to a map that quads can be read from (Ebke, Campen, Bommes, Kobbelt 2014,
// "Level-of-detail quad meshing", section 5): the nearest seamless map, untangled; its integers
// chosen; the rest solved again and untangled; coordinates on a grid of 2^-30, where seams and
// orientations are exact (Ebke, Bommes, Campen, Kobbelt 2013, section 3.1). Untangling can leave
// vertices that the map winds around twice: all faces positive, other singularities. Then the
// integers are reached from the seamless map in small steps, each untangled.
#include "meshing/quad_map.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "meshing/coarse_layout.h"
#include "meshing/quantisation.h"
#include "meshing/seamless_map.h"
#include "meshing/untangling.h"

namespace fcn {
namespace {

using Eigen::VectorXd;

constexpr double kGrid = 1073741824.0;  ///< 2^30 coordinates a unit
constexpr double kLargest = 4194304.0;  ///< 2^22: of a coordinate
constexpr double kFirstStep = 0.1;      ///< of the way from the seamless map to the integers
constexpr double kLeastStep = 0.004;

class Stopwatch {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> result = now - start_;
        start_ = now;
        return result.count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

VectorXd snapped(const VectorXd& values) { return (values * kGrid).array().round() / kGrid; }

std::string counted(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

class MapMaker {
public:
    MapMaker(const Mesh& mesh, const CrossField& field, const QuadMapOptions& options)
        : mesh_(mesh), indices_(vertex_indices(mesh, field)) {
        problem_ = make_map_problem(mesh, field, options);
        result_.fault = problem_.fault;
        const auto& singular = problem_.cut.is_singular;
        statistics().singular_vertices =
            static_cast<int>(std::count(singular.begin(), singular.end(), 1));
        statistics().cutting = watch_.lap();
        if (has_fault() || !make_seamless() || !choose_integers()) return;
        reach_integers();
        statistics().untangling += watch_.lap();
        finish();
    }
    QuadMapResult take() { return std::move(result_); }

private:
    bool has_fault() const { return !result_.fault.empty(); }
    QuadMapStatistics& statistics() { return result_.statistics; }
    const std::vector<bool>& is_integer() const { return problem_.unknowns.is_integer; }
    CornerMap map_of(const VectorXd& free) const {
        return corner_map(problem_, problem_.unknowns.basis * free);
    }

    std::size_t wrong_windings(const CornerMap& map) const {
        std::size_t count = 0;
        for (const VertexHandle vertex : mesh_.vertices()) {
            if (mesh_.is_isolated(vertex)) continue;
            const int regular = mesh_.is_boundary(vertex) ? 2 : 4;
            const int index = indices_[static_cast<std::size_t>(vertex.idx())];
            if (quarters_around(mesh_, map, vertex) != regular - index) ++count;
        }
        return count;
    }

    bool make_seamless() {
        energy_ = reduced(alignment_energy(problem_), problem_);
        const std::vector<bool> none(is_integer().size(), false);
        const VectorXd zero = VectorXd::Zero(static_cast<int>(none.size()));
        const VectorXd values = minimum(energy_, none, zero);
        statistics().solving = watch_.lap();
        if (values.size() == 0) {
            result_.fault = "no seamless map: the linear system cannot be solved";
            return false;
        }
        const UntanglingResult untangled = untangle(problem_, values, none);
        seamless_ = untangled.values;
        statistics().seamless_before = untangled.turned_over_before;
        statistics().seamless_after = untangled.turned_over;
        statistics().seamless_windings = wrong_windings(map_of(seamless_));
        statistics().newton_steps = untangled.iterations;
        statistics().untangling = watch_.lap();
        return true;
    }

    bool choose_integers() {
        const IntegerEnergy integers = integer_energy(energy_, is_integer());
        statistics().integers = static_cast<int>(integers.unknowns.size());
        CoarseLayout layout;
        layout.free_values = seamless_;
        if (statistics().seamless_after == 0)
            layout = make_coarse_layout(mesh_, problem_, seamless_);
        statistics().layout_triangles = static_cast<int>(layout.triangles.size());
        const Quantisation chosen = quantise(integers, layout);
        statistics().collapsed_triangles = chosen.collapsed;
        target_ = seamless_;
        for (std::size_t i = 0; i < integers.unknowns.size(); ++i)
            target_[integers.unknowns[i]] = chosen.integers[static_cast<int>(i)];
        statistics().quantising = watch_.lap();
        return true;
    }

    bool is_sound(const UntanglingResult& untangled) const {
        return untangled.turned_over == 0 && wrong_windings(map_of(untangled.values)) == 0;
    }

    void reach_integers() {
        const VectorXd values = minimum(energy_, is_integer(), target_);
        if (values.size() == 0) {
            result_.fault = "no map for the integers: the linear system cannot be solved";
            return;
        }
        integral_ = untangle(problem_, values, is_integer());
        statistics().newton_steps += integral_.iterations;
        statistics().quantised_before = integral_.turned_over_before;
        if (!is_sound(integral_)) walk_to_integers();
        statistics().quantised_after = integral_.turned_over;
    }

    /// From the seamless map to the integers; a step that cannot be untangled is halved.
    void walk_to_integers() {
        if (statistics().seamless_after + statistics().seamless_windings > 0) return;
        QuadraticEnergy stretch = energy_;
        stretch.right.setZero();
        const VectorXd way = minimum(stretch, is_integer(), target_ - seamless_);
        if (way.size() == 0) return;
        UntanglingOptions options;
        options.iterations = 20;
        VectorXd now = seamless_;
        double gone = 0, step = kFirstStep;
        while (gone < 1 && step > kLeastStep) {
            const double next = std::min(1.0, gone + step);
            VectorXd values = now + (next - gone) * way;
            for (std::size_t i = 0; i < is_integer().size() && next == 1; ++i)
                if (is_integer()[i]) values[static_cast<int>(i)] = target_[static_cast<int>(i)];
            const UntanglingResult tried = untangle(problem_, values, is_integer(), options);
            statistics().newton_steps += tried.iterations;
            ++statistics().integer_steps;
            if (!is_sound(tried)) {
                step /= 2;
                continue;
            }
            now = tried.values;
            gone = next;
            step = std::min(kFirstStep, 1.5 * step);
            if (gone == 1) integral_ = tried;
        }
    }

    void finish() {
        if (has_fault()) return;
        if (integral_.turned_over > 0) {
            result_.fault =
                counted(integral_.turned_over, "face of the map stays", "faces of the map stay") +
                " turned over";
        } else {
            const VectorXd all = problem_.unknowns.basis * snapped(integral_.values);
            result_.map = corner_map(problem_, all);
            const std::size_t windings = wrong_windings(result_.map);
            if (!(all.cwiseAbs().maxCoeff() < kLargest))
                result_.fault = "the map is too large for exact coordinates";
            else if (windings > 0)
                result_.fault = "the map winds otherwise than the field around " +
                                counted(windings, "vertex", "vertices");
            else
                result_.fault = corner_map_faults(mesh_, result_.map).message();
        }
        if (has_fault())
            result_.fault += "; before integers " + std::to_string(statistics().seamless_after) +
                             " turned over, " + std::to_string(statistics().seamless_windings) +
                             " windings; of the layout's " +
                             std::to_string(statistics().layout_triangles) + " triangles " +
                             std::to_string(statistics().collapsed_triangles) + " have no area";
    }

    const Mesh& mesh_;
    std::vector<int> indices_;
    MapProblem problem_;
    QuadraticEnergy energy_;
    VectorXd seamless_, target_;
    UntanglingResult integral_;
    QuadMapResult result_;
    Stopwatch watch_;
};

}  // namespace

QuadMapResult make_quad_map(const Mesh& mesh, const CrossField& field,
                            const QuadMapOptions& options) {
    if (mesh.n_faces() > 0 && options.edge_length > 0) return MapMaker(mesh, field, options).take();
    QuadMapResult result;
    result.fault = mesh.n_faces() == 0 ? "no faces to map" : "no edge length to map for";
    return result;
}

}  // namespace fcn
