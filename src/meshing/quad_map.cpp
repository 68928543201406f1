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
constexpr int kMostIntegers = 1500;     ///< their matrices are dense
constexpr int kStiffRings = 10;         ///< around singular vertices
constexpr double kFirstStep = 0.1;      ///< of the way from the seamless map to the integers
constexpr int kSeamlessAttempts = 5;    ///< at a seamless map that winds as the field does
constexpr int kHardAttempts = 2;        ///< the same with hard edges inside, which can give way
constexpr double kTightStep = 0.02;     ///< below, everything moves to make room
constexpr double kLeastStep = 0.001;
constexpr int kRelaxingSteps = 15;

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
        : mesh_(mesh), field_(field), indices_(vertex_indices(mesh, field)), guidance_(options) {
        for (bool is_complete = false; !is_complete;) {
            if (!make_seamless()) return;
            is_complete = !add_corners();
        }
        keep_boundary();
        if (!choose_integers()) return;
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

    /// Around a boundary vertex the field's index may be uncertain by half a turn: there the map
    /// decides, as long as the vertex stays a corner or none.
    bool is_winding_right(const CornerMap& map, VertexHandle vertex) const {
        const int index = indices_[static_cast<std::size_t>(vertex.idx())];
        const int quarters = quarters_around(mesh_, map, vertex);
        if (!mesh_.is_boundary(vertex)) return quarters == 4 - index;
        if (!boundary_quarters_.empty())
            return quarters == boundary_quarters_[static_cast<std::size_t>(vertex.idx())];
        return quarters >= 1 && quarters <= 4 && ((quarters - index) & 1) == 0;
    }
    /// Vertices around which the map winds otherwise than the field.
    std::vector<VertexHandle> wrong_windings(const CornerMap& map) const {
        std::vector<VertexHandle> result;
        for (const VertexHandle vertex : mesh_.vertices())
            if (!mesh_.is_isolated(vertex) && !is_winding_right(map, vertex))
                result.push_back(vertex);
        return result;
    }

    bool make_seamless() {
        problem_ = make_map_problem(mesh_, field_, guidance_);
        result_.fault = problem_.fault;
        if (has_fault()) return false;
        const auto& singular = problem_.cut.is_singular;
        statistics().singular_vertices =
            static_cast<int>(std::count(singular.begin(), singular.end(), 1));
        statistics().cutting += watch_.lap();
        energy_ = reduced(alignment_energy(problem_), problem_);
        const std::vector<bool> none(is_integer().size(), false);
        const VectorXd zero = VectorXd::Zero(static_cast<int>(none.size()));
        std::vector<double> stiffness(mesh_.n_faces(), 1);
        const int attempts = has_hard_edges() ? kHardAttempts : kSeamlessAttempts;
        UntanglingOptions untangling;
        untangling.is_all_moving = !has_hard_edges();
        for (int attempt = 0; attempt < attempts; ++attempt) {
            const QuadraticEnergy stiff =
                attempt == 0 ? energy_ : reduced(alignment_energy(problem_, stiffness), problem_);
            const VectorXd values = minimum(stiff, none, zero);
            if (values.size() == 0) {
                result_.fault = "no seamless map: the linear system cannot be solved";
                return false;
            }
            statistics().solving += watch_.lap();
            const UntanglingResult untangled = untangle(problem_, values, none, untangling);
            const auto windings = wrong_windings(map_of(untangled.values));
            statistics().newton_steps += untangled.iterations;
            statistics().untangling += watch_.lap();
            const bool is_better =
                attempt == 0 || untangled.turned_over + windings.size() <
                                    statistics().seamless_after + statistics().seamless_windings;
            if (is_better) {
                seamless_ = untangled.values;
                statistics().seamless_before = untangled.turned_over_before;
                statistics().seamless_after = untangled.turned_over;
                statistics().seamless_windings = windings.size();
            }
            if (untangled.turned_over + windings.size() == 0) break;
            stiffen(values, windings, stiffness);
        }
        if (!has_hard_edges() || statistics().seamless_after + statistics().seamless_windings == 0)
            return true;
        result_.fault = "no seamless map with these hard edges";
        blame(seamless_);
        return false;
    }

    bool has_hard_edges() const {
        return std::any_of(guidance_.is_hard.begin(), guidance_.is_hard.end(),
                           [](std::uint8_t hard) { return hard != 0; });
    }
    /// Where the fault is: at what has no area in the layout, or else what is turned over or winds
    /// otherwise than the field.
    void blame(const VectorXd& values) {
        auto& where = result_.fault_vertices;
        where = collapsed_;
        for (const VertexHandle vertex : wrong_windings(map_of(values)))
            where.push_back(vertex.idx());
        const std::vector<double> dets = map_determinants(problem_, values);
        for (std::size_t f = 0; f < dets.size(); ++f)
            if (!(dets[f] > 0))
                for (const int vertex : problem_.cut.corners[f]) where.push_back(vertex);
        std::sort(where.begin(), where.end());
        where.erase(std::unique(where.begin(), where.end()), where.end());
    }

    /// More weight for what is turned over in the nearest map, and near wrong windings (Bommes,
    /// Zimmer, Kobbelt 2009, section 5.3, with the faces' neighbourhoods instead of a smoothed
    /// distortion).
    void stiffen(const VectorXd& values, const std::vector<VertexHandle>& windings,
                 std::vector<double>& stiffness) const {
        std::vector<std::uint8_t> is_near(mesh_.n_vertices(), 0);
        for (const VertexHandle vertex : windings)
            is_near[static_cast<std::size_t>(vertex.idx())] = 1;
        const std::vector<double> dets = map_determinants(problem_, values);
        const auto& corners = problem_.cut.corners;
        for (std::size_t f = 0; f < dets.size(); ++f)
            for (std::size_t i = 0; i < 3 && !(dets[f] > 0.05); ++i)
                is_near[static_cast<std::size_t>(corners[f][i])] = 1;
        for (int ring = 0; ring < 3; ++ring) {
            const auto before = is_near;
            for (std::size_t f = 0; f < dets.size(); ++f) {
                const bool is_in = std::any_of(corners[f].begin(), corners[f].end(), [&](int v) {
                    return before[static_cast<std::size_t>(v)] != 0;
                });
                if (!is_in) continue;
                stiffness[f] *= 1.7;
                for (const int v : corners[f]) is_near[static_cast<std::size_t>(v)] = 1;
            }
        }
    }

    /// Corners of the boundary that came about in the seamless map, and are not bound to be grid
    /// points so far: true if there are any.
    bool add_corners() {
        if (!guidance_.grid_vertices.empty()) return false;
        const CornerMap map = map_of(seamless_);
        for (const VertexHandle vertex : mesh_.vertices())
            if (!mesh_.is_isolated(vertex) && mesh_.is_boundary(vertex) &&
                quarters_around(mesh_, map, vertex) == 4)
                guidance_.grid_vertices.push_back(vertex.idx());
        return !guidance_.grid_vertices.empty();
    }

    /// From now on the boundary turns as in the seamless map.
    void keep_boundary() {
        const CornerMap map = map_of(seamless_);
        boundary_quarters_.assign(mesh_.n_vertices(), 0);
        for (const VertexHandle vertex : mesh_.vertices())
            if (mesh_.is_boundary(vertex) && !mesh_.is_isolated(vertex))
                boundary_quarters_[static_cast<std::size_t>(vertex.idx())] =
                    quarters_around(mesh_, map, vertex);
    }

    bool choose_integers() {
        const auto count = std::count(is_integer().begin(), is_integer().end(), true);
        statistics().integers = static_cast<int>(count);
        if (count > kMostIntegers) {
            result_.fault = std::to_string(count) + " integers to choose, more than " +
                            std::to_string(kMostIntegers);
            return false;
        }
        const IntegerEnergy integers = integer_energy(energy_, is_integer());
        CoarseLayout layout;
        layout.free_values = seamless_;
        if (statistics().seamless_after == 0)
            layout = make_coarse_layout(mesh_, problem_, seamless_);
        statistics().layout_triangles = static_cast<int>(layout.triangles.size());
        const Quantisation chosen = quantise(integers, layout);
        statistics().collapsed_triangles = chosen.collapsed.size();
        for (const int t : chosen.collapsed)
            collapsed_.push_back(layout.triangles[static_cast<std::size_t>(t)].tip);
        target_ = seamless_;
        for (std::size_t i = 0; i < integers.unknowns.size(); ++i)
            target_[integers.unknowns[i]] = chosen.integers[static_cast<int>(i)];
        statistics().quantising = watch_.lap();
        return true;
    }

    bool is_sound(const UntanglingResult& untangled) const {
        return untangled.turned_over == 0 && wrong_windings(map_of(untangled.values)).empty();
    }

    void reach_integers() {
        QuadraticEnergy stretch =
            reduced(alignment_energy(problem_, stiffness_at_grid_points()), problem_);
        stretch.right.setZero();
        way_ = minimum(stretch, is_integer(), target_ - seamless_);
        if (way_.size() == 0) {
            result_.fault = "no map for the integers: the linear system cannot be solved";
            return;
        }
        UntanglingOptions options;
        options.iterations = 30;
        options.is_all_moving = false;
        integral_ = untangle(problem_, seamless_ + way_, is_integer(), options);
        statistics().newton_steps += integral_.iterations;
        statistics().quantised_before = integral_.turned_over_before;
        if (!is_sound(integral_) && (!has_hard_edges() || collapsed_.empty())) walk_to_integers();
        statistics().quantised_after = integral_.turned_over;
    }

    /// Falls with the square of the rings from singular vertices: a displacement that
    /// is harmonic would move them without their surroundings.
    std::vector<double> stiffness_at_grid_points() const {
        const auto& corners = problem_.cut.corners;
        std::vector<int> ring(mesh_.n_vertices(), kStiffRings);
        for (std::size_t v = 0; v < ring.size(); ++v)
            if (problem_.cut.is_singular[v] != 0) ring[v] = 0;
        std::vector<double> result(mesh_.n_faces(), 1);
        std::vector<bool> is_seen(mesh_.n_faces(), false);
        for (int r = 0; r < kStiffRings; ++r) {
            for (std::size_t f = 0; f < result.size(); ++f) {
                const bool is_in = std::any_of(corners[f].begin(), corners[f].end(), [&](int v) {
                    return ring[static_cast<std::size_t>(v)] == r;
                });
                if (is_seen[f] || !is_in) continue;
                is_seen[f] = true;
                const double near = kStiffRings / (r + 0.5);
                result[f] = near * near;
                for (const int v : corners[f]) {
                    int& own = ring[static_cast<std::size_t>(v)];
                    own = std::min(own, r + 1);
                }
            }
        }
        return result;
    }

    /// From the seamless map to the integers; a step that cannot be untangled is halved.
    void walk_to_integers() {
        if (statistics().seamless_after + statistics().seamless_windings > 0) return;
        UntanglingOptions options;
        options.iterations = 20;
        options.is_all_moving = false;
        VectorXd now = seamless_;
        double gone = 0, step = kFirstStep;
        bool is_relaxed = false;
        while (gone < 1 && step > kLeastStep) {
            const double next = std::min(1.0, gone + step);
            VectorXd values = now + (next - gone) * way_;
            for (std::size_t i = 0; i < is_integer().size() && next == 1; ++i)
                if (is_integer()[i]) values[static_cast<int>(i)] = target_[static_cast<int>(i)];
            const UntanglingResult tried = untangle(problem_, values, is_integer(), options);
            statistics().newton_steps += tried.iterations;
            ++statistics().integer_steps;
            if (!is_sound(tried)) {
                stuck_ = tried.values;
                step /= 2;
                if (step < kTightStep && !is_relaxed) {
                    const UntanglingResult relaxed =
                        relax(problem_, now, is_integer(), kRelaxingSteps);
                    statistics().newton_steps += relaxed.iterations;
                    if (is_sound(relaxed)) now = relaxed.values;
                    is_relaxed = true;
                    step = kTightStep;
                }
                continue;
            }
            is_relaxed = false;
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
            const std::size_t windings = wrong_windings(result_.map).size();
            if (!(all.cwiseAbs().maxCoeff() < kLargest))
                result_.fault = "the map is too large for exact coordinates";
            else if (windings > 0)
                result_.fault = "the map winds otherwise than the field around " +
                                counted(windings, "vertex", "vertices");
            else
                result_.fault = corner_map_faults(mesh_, result_.map).message();
        }
        if (has_fault()) blame(stuck_.size() > 0 ? stuck_ : integral_.values);
        if (has_fault())
            result_.fault += "; before integers " + std::to_string(statistics().seamless_after) +
                             " turned over, " + std::to_string(statistics().seamless_windings) +
                             " windings; of the layout's " +
                             std::to_string(statistics().layout_triangles) + " triangles " +
                             std::to_string(statistics().collapsed_triangles) + " have no area";
    }

    const Mesh& mesh_;
    const CrossField& field_;
    std::vector<int> indices_;
    std::vector<int> boundary_quarters_;  ///< per vertex, once there is a seamless map
    MapGuidance guidance_;
    MapProblem problem_;
    QuadraticEnergy energy_;
    VectorXd seamless_, target_;
    std::vector<int> collapsed_;  ///< tips of triangles of the layout
    VectorXd way_;                ///< from the one to the other
    VectorXd stuck_;              ///< where the last step of that way failed
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
