#pragma once

#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "adaptation/scale.h"
#include "geometry/mesh_io.h"
#include "labeling/solver.h"
#include "network/network.h"

namespace fcn {

enum class AdaptationMode { Paper, Best };
enum class LabelUnit { Segment, Curve };
enum class ThinWalls { Exempt, Conflict };

struct AdaptationSurface;

/// Every constant of the paper and of DESIGN section 4.
struct AdaptationOptions {
    double rmin = 0;     ///< scale, mesh units, > 0
    double ratio = 1.5;  ///< rmax / rmin in [1.01, sqrt(3))
    AdaptationMode mode = AdaptationMode::Best;
    ElementType target = ElementType::Triangle;
    LabelUnit unit = LabelUnit::Segment;
    ThinWalls thin_walls = ThinWalls::Exempt;
    double lambda0 = 100;  ///< weight of smoothness U_s, >= 0
    double lambda1 = -1;   ///< weight of U_par,perp; -1: 0 for triangles, 10 for quads
    double alpha_sym = 2;
    double alpha_loop = -1;              ///< -1: 100 in paper mode, 4 in best mode
    double smooth_power = 2;             ///< p of a_s = cos^p(2 gamma)
    double ortho_radius = 2;             ///< reach of a_par,perp in rmax
    int max_iterations = 50;             ///< safety net with its own status
    bool is_recording_problems = false;  ///< keep every iteration's problem in the report
    bool is_recording_steps = false;     ///< keep what every iteration looks like in the report
    int threads = 1;
    labeling::SolveOptions solve;                    ///< limits, seed
    std::shared_ptr<const labeling::Solver> solver;  ///< required
    std::function<void(const std::string& phase, double fraction)> progress;
    std::stop_token stop;
    const AdaptationSurface* surface = nullptr;  ///< of the mesh, made already; not owned
};

enum class AdaptationStatus {
    Converged,       ///< every label kept and no short edge left
    IterationLimit,  ///< the safety net
    SolverFailed,    ///< a solver returned no solution within its limits
    Interrupted
};
const char* to_string(AdaptationStatus status);

/// What one iteration saw and did. Counts first, seconds last (see --no-timings).
struct IterationReport {
    int iteration = 0;  ///< 1-based
    std::size_t segments = 0, short_segments = 0, long_segments = 0, extraordinary_nodes = 0;
    std::size_t angle_conflicts = 0, distance_conflicts = 0, crossing_conflicts = 0,
                node_conflicts = 0, vertex_conflicts = 0, exempt_pairs = 0;
    std::size_t labels = 0, conflicts = 0, bonuses = 0, rules = 0, components = 0;
    std::size_t kept = 0, dropped = 0, collapsed = 0;
    labeling::SolveStatus status = labeling::SolveStatus::NoSolution;
    labeling::StopReason stop_reason = labeling::StopReason::Finished;
    double value = 0, bound = 0;  ///< real units; bound = NaN when none was proven
    double units_per_one = 1;
    std::map<std::string, double>
        seconds;  ///< by phase: resample, conflicts, weights, solve, collapse
};

/// Two segments of the final network that a thin wall parts although they are close in space.
struct ThinWallPair {
    int first = -1, second = -1;
    double distance = 0;
};

/// A conflict of the first labeling problem, as it lies in space.
struct ConflictPlace {
    std::string kind;                                  ///< "angle", "distance", "crossing", "nodes"
    Vec3 first = Vec3::Zero(), second = Vec3::Zero();  ///< midpoints of the two segments
    double measured = 0;  ///< between the two: radians for an angle, else mesh units
    std::array<int, 2> origin_arcs{-1, -1};  ///< arcs of the initial network
    std::array<double, 2> weights{0, 0};     ///< of the two segments, real units
    std::array<bool, 2> is_kept{false, false};
};

/// What one iteration looks like, as the ends of straight segments (the paper's Figure 5).
struct AdaptationStep {
    using Chords = std::vector<std::array<Vec3, 2>>;
    Chords resampled, brief;  ///< before anything is decided; brief: arcs too short for the scale
    Chords kept, dropped;     ///< after labeling
};

struct AdaptationReport {
    AdaptationStatus status = AdaptationStatus::Converged;
    std::vector<IterationReport> iterations;
    /// Per iteration when is_recording_problems: the problem and the solver's answer.
    std::vector<labeling::LabelingProblem> problems;
    std::vector<labeling::Solution> solutions;
    /// Of the first iteration when is_recording_problems; every k-th if there are too many.
    std::vector<ConflictPlace> conflict_places;
    std::vector<AdaptationStep> steps;  ///< by iteration when is_recording_steps
    bool is_optimal = false;            ///< every iteration proven optimal
    /// Sharpness-weighted share of the initial feature length within rmin of the final network.
    double coverage = 0;
    double initial_length = 0, final_length = 0;
    std::vector<ThinWallPair> exempt;  ///< at the end
    std::vector<std::string> warnings;
    double seconds = 0;
};

struct AdaptationResult {
    FeatureCurveNetwork network;
    AdaptationReport report;
};

/// Adapts an initial network to the scale (paper sections 4 and 5 as decided in DESIGN 4).
/// Throws InputError on options out of range or a network that fails validate().
AdaptationResult adapt_network(const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
                               const AdaptationOptions& options);

}  // namespace fcn
