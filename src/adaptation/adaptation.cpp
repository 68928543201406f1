// The adaptation loop (paper section 5, Figure 2): resample, detect conflicts, label, collapse,
// again until nothing changes. The paper argues that every round removes a segment, but resampling
// can add segments. Here a round that changes anything drops a stretch of an arc, collapses a short
// arc, or fuses two arcs at a node, and none of these can go on for ever; a round that does none of
// them ends the loop. Arcs that nothing touched keep their chain, so their labels stay compatible
// and are not solved again. Refilling may follow, a fixed number of times.

#include "adaptation/adaptation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "adaptation/adaptation_options.h"
#include "adaptation/arc_runs.h"
#include "adaptation/blockers.h"
#include "adaptation/collapse.h"
#include "adaptation/conflict_places.h"
#include "adaptation/conflicts.h"
#include "adaptation/dropped_pieces.h"
#include "adaptation/explanation.h"
#include "adaptation/incremental_solver.h"
#include "adaptation/initial_state.h"
#include "adaptation/iteration_record.h"
#include "adaptation/labeling_bridge.h"
#include "adaptation/network_output.h"
#include "adaptation/orbits.h"
#include "adaptation/refill.h"
#include "adaptation/segment_attributes.h"
#include "adaptation/thin_wall.h"
#include "adaptation/weights.h"
#include "geometry/errors.h"

namespace fcn {

namespace {

using Clock = std::chrono::steady_clock;

/// A thin wall's surface distance, in rmin.
constexpr double kThinWallDistance = 3;
/// A point this close to an edge or a vertex of the mesh lies on it, in rmin.
constexpr double kTouch = 1e-3;
/// Rounds of forbidding crumbs and solving again; what is left then is dropped with the next round.
constexpr int kCrumbRounds = 20;
/// Rounds of refilling after the loop has converged; each ends in a converged loop again.
constexpr int kRefillRounds = 3;
constexpr const char* kShortArc = "short arc";
/// Conflicts that are recorded with their places.
constexpr std::size_t kMostPlaces = 20000;

std::string small_loop_warning(const WorkingArc& arc) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "pinned loop of length %.6g near (%.6g, %.6g, %.6g) is too small for three "
                  "segments at this scale; kept as it is",
                  arc.length(), arc.points[0].x(), arc.points[0].y(), arc.points[0].z());
    return text;
}

class Adapter {
public:
    Adapter(const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
            const AdaptationOptions& options)
        : initial_(initial),
          options_(with_defaults(options)),
          scale_(make_scale(options.rmin, options.ratio, options.target)),
          own_surface_(options.surface ? nullptr : std::make_unique<AdaptationSurface>(mesh.mesh)),
          surface_(options.surface ? *options.surface : *own_surface_),
          queries_(surface_.queries),
          thin_wall_(mesh.mesh, queries_, kThinWallDistance * options.rmin, kTouch * options.rmin),
          solver_(*options.solver, solve_options(options)),
          state_(make_initial_state(mesh, surface_, initial, scale_, options_)),
          dropped_(state_.dropped) {
        dense_initial_ = state_.network.arcs;
        conflict_options_.mode = options_.mode;
        conflict_options_.threads = options_.threads;
        if (options_.mode == AdaptationMode::Best && options_.thin_walls == ThinWalls::Exempt) {
            conflict_options_.is_thin_wall = [this](const Vec3& a, const Vec3& b) {
                return thin_wall_(a, b);
            };
        }
    }

    AdaptationResult run() {
        const auto start = Clock::now();
        state_.network.merge_regular_nodes([](int) { return true; });
        run_to_fixpoint();
        const bool refills = is_best() && options_.unit == LabelUnit::Segment;
        for (int k = 0; refills && k < kRefillRounds; ++k) {
            if (report_.status != AdaptationStatus::Converged || !refill()) break;
            run_to_fixpoint();
        }
        AdaptationResult result = finish();
        result.report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
        return result;
    }

private:
    static labeling::SolveOptions solve_options(const AdaptationOptions& options) {
        labeling::SolveOptions result = options.solve;
        result.stop = options.stop;
        return result;
    }

    bool is_best() const { return options_.mode == AdaptationMode::Best; }
    WorkingNetwork& network() { return state_.network; }

    /// Runs `work` and books its time under `phase`.
    template <class Work>
    auto timed(IterationReport& iteration, const std::string& phase, Work work) {
        if (options_.progress) options_.progress(phase, 0);
        struct Booking {
            double& seconds;
            Clock::time_point start = Clock::now();
            ~Booking() { seconds += std::chrono::duration<double>(Clock::now() - start).count(); }
        } booking{iteration.seconds[phase]};
        return work();
    }

    void run_to_fixpoint() {
        report_.status = AdaptationStatus::IterationLimit;
        while (static_cast<int>(report_.iterations.size()) < options_.max_iterations) {
            IterationReport iteration;
            iteration.iteration = static_cast<int>(report_.iterations.size()) + 1;
            const bool goes_on = iterate(iteration);
            report_.iterations.push_back(std::move(iteration));
            if (!goes_on) return;
            if (options_.stop.stop_requested()) {
                report_.status = AdaptationStatus::Interrupted;
                return;
            }
        }
    }

    /// Adds what still fits between the kept arcs; false when nothing does.
    bool refill() {
        const NetworkGraph graph = make_graph(network());
        RefillInput input;
        input.network = &network();
        input.graph = &graph;
        input.initial = &dense_initial_;
        input.scale = scale_;
        input.min_length = state_.crumbs.min_length;
        input.threads = options_.threads;
        input.worth = [this](const WorkingArc& arc, int first, int last) {
            const double length = (arc.points[last] - arc.points[first]).norm();
            return segment_weight(attributes_of_stretch(arc, first, last, length, state_.origins),
                                  scale_, options_);
        };
        std::vector<WorkingArc> found = find_refills(input);
        for (WorkingArc& arc : found) {
            const bool is_loop = arc.points.front() == arc.points.back();
            if (arc.nodes[0] < 0) arc.nodes[0] = network().add_node(arc.points.front());
            if (arc.nodes[1] < 0)
                arc.nodes[1] = is_loop ? arc.nodes[0] : network().add_node(arc.points.back());
            network().arcs.push_back(std::move(arc));
        }
        network().merge_regular_nodes([](int) { return false; });
        return !found.empty();
    }

    /// One round; false when the loop ends.
    bool iterate(IterationReport& iteration) {
        timed(iteration, "resample", [&] { resample(iteration.iteration); });
        NetworkGraph graph = make_graph(network());
        if (options_.is_recording_steps) record_resampled(graph.graph);
        ConflictResult conflicts;
        timed(iteration, "conflicts", [&] {
            conflicts = detect_conflicts(graph.graph, scale_, conflict_options_);
            if (is_best()) collapse_clusters(iteration, graph, conflicts);
        });
        record_counts(iteration, graph, conflicts);
        const auto attributes = timed(
            iteration, "weights", [&] { return attributes_of(graph, network(), state_.origins); });
        LabelingBridge bridge = make_bridge(graph, conflicts, attributes);
        const auto kept =
            timed(iteration, "solve", [&] { return label(iteration, graph, conflicts, bridge); });
        if (!kept) {
            report_.status = options_.stop.stop_requested() ? AdaptationStatus::Interrupted
                                                            : AdaptationStatus::SolverFailed;
            return false;
        }
        if (options_.is_recording_steps) record_labeled(graph.graph, *kept);
        bool has_changed =
            timed(iteration, "collapse", [&] { return apply(iteration, graph, conflicts, *kept); });
        if (!has_changed && is_best()) has_changed = drop_idle_short_arcs(iteration);
        if (!has_changed) report_.status = AdaptationStatus::Converged;
        return has_changed;
    }

    static std::array<Vec3, 2> chord_of(const SegmentGraph& graph, std::size_t segment) {
        const auto& nodes = graph.segments[segment].nodes;
        return {graph.nodes[nodes[0]].position, graph.nodes[nodes[1]].position};
    }

    void record_resampled(const SegmentGraph& graph) {
        AdaptationStep& step = report_.steps.emplace_back();
        for (std::size_t s = 0; s < graph.segments.size(); ++s)
            (graph.segments[s].is_short ? step.brief : step.resampled)
                .push_back(chord_of(graph, s));
    }

    void record_labeled(const SegmentGraph& graph, const std::vector<bool>& kept) {
        AdaptationStep& step = report_.steps.back();
        for (std::size_t s = 0; s < kept.size(); ++s)
            (kept[s] ? step.kept : step.dropped).push_back(chord_of(graph, s));
    }

    void resample(int iteration) {
        const std::vector<int> lost = resample_arcs(network(), scale_, options_.threads);
        for (int a : lost) give_up_closed_arc(a, iteration);
        if (!is_first_resampling_) return;
        is_first_resampling_ = false;
        std::vector<int> arc_of_origin(initial_.arcs.size(), -1);
        for (std::size_t a = 0; a < network().arcs.size(); ++a) {
            const WorkingArc& arc = network().arcs[a];
            if (!arc.is_alive) continue;
            const bool is_unmerged =
                std::ranges::all_of(arc.origins, [&](int o) { return o == arc.origins[0]; });
            if (is_unmerged) arc_of_origin[arc.origins[0]] = static_cast<int>(a);
        }
        if (options_.unit == LabelUnit::Segment) {
            transport_orbits(network(), initial_.orbits, arc_of_origin, scale_, report_.warnings);
        }
    }

    /// A closed arc without three segments is dropped with its reason; a pinned one is kept with
    /// three segments below the scale, and reported.
    void give_up_closed_arc(int a, int iteration) {
        WorkingArc& arc = network().arcs[a];
        if (arc.is_pinned) {
            chain_small_loop(arc);
            report_.warnings.push_back(small_loop_warning(arc));
            return;
        }
        dropped_.add(arc, iteration, "closed arc without three segments");
        network().remove_arc(a);
    }

    /// Best mode: clusters that may collapse do so before the labeling, until none is left.
    void collapse_clusters(IterationReport& iteration, NetworkGraph& graph,
                           ConflictResult& conflicts) {
        for (;;) {
            const std::vector<int> arcs =
                find_collapsible_clusters(network(), graph, conflicts.conflicts, scale_);
            if (arcs.empty()) return;
            for (int a : arcs) dropped_.add(network().arcs[a], 0, kShortArc);
            iteration.collapsed += collapse_short_arcs(network(), arcs, scale_, queries_);
            network().merge_regular_nodes([](int) { return true; });
            resample(iteration.iteration);
            graph = make_graph(network());
            conflicts = detect_conflicts(graph.graph, scale_, conflict_options_);
        }
    }

    LabelingBridge make_bridge(const NetworkGraph& graph, const ConflictResult& conflicts,
                               const std::vector<SegmentAttributes>& attributes) {
        BridgeInput input;
        input.graph = &graph.graph;
        input.conflicts = &conflicts;
        for (const SegmentAttributes& a : attributes) {
            input.weights.push_back(segment_weight(a, scale_, options_));
        }
        std::vector<std::pair<int, int>> excluded;
        for (const Conflict& c : conflicts.conflicts) excluded.emplace_back(c.first, c.second);
        for (const Conflict& c : conflicts.input_forced) excluded.emplace_back(c.first, c.second);
        std::ranges::sort(excluded);
        input.bonuses = pair_bonuses(graph.graph, attributes, excluded, scale_, options_);
        input.groups =
            label_groups(graph, network(), state_.origins, conflicts.conflicts, options_);
        weights_ = input.weights;
        return LabelingBridge(input);
    }

    /// Solves, forbids crumbs and solves again; nullopt without a solution.
    std::optional<std::vector<bool>> label(IterationReport& iteration, const NetworkGraph& graph,
                                           const ConflictResult& conflicts,
                                           LabelingBridge& bridge) {
        crumb_segments_.clear();
        std::vector<std::int8_t> warm_start;
        for (int round = 0;; ++round) {
            problem_ = bridge.build();
            labeling::SolveResult result = solver_.solve(problem_, warm_start);
            if (!result.solution) {
                iteration.status = result.status;
                iteration.stop_reason = result.stop_reason;
                report_.warnings.push_back("no labeling found: " + result.message);
                return std::nullopt;
            }
            solution_ = *result.solution;
            bridge.relax_node_labels(solution_);
            std::vector<bool> kept = bridge.kept_segments(solution_);
            std::vector<Crumb> crumbs;
            if (is_best() && round < kCrumbRounds) {
                crumbs = find_crumbs(network(), graph, kept, state_.crumbs);
            }
            if (crumbs.empty()) {
                record_solve(iteration, problem_, result, solution_, bridge.label_count());
                remember_problem(bridge);
                record_dropped(iteration, graph, conflicts, bridge, kept);
                if (options_.is_recording_problems && iteration.iteration == 1) {
                    report_.conflict_places =
                        conflict_places(conflicts.conflicts, graph.graph, weights_, kept,
                                        origin_of_segment(graph), kMostPlaces);
                }
                return kept;
            }
            for (const Crumb& crumb : crumbs) {
                bridge.forbid_alone(crumb.segments, crumb.neighbours);
                crumb_segments_.insert(crumb.segments.begin(), crumb.segments.end());
            }
            warm_start.assign(solution_.labels.begin(), solution_.labels.end());
        }
    }

    void remember_problem(const LabelingBridge& bridge) {
        for (const auto& inner : bridge.inner_conflicts()) {
            report_.warnings.push_back("segments " + std::to_string(inner.first) + " and " +
                                       std::to_string(inner.second) +
                                       " share a label and conflict; the label is left out");
        }
        if (options_.is_recording_problems) {
            report_.problems.push_back(problem_);
            report_.solutions.push_back(solution_);
        }
    }

    /// The arc of the initial network that a segment comes from, for as long as `graph` lives.
    std::function<int(int)> origin_of_segment(const NetworkGraph& graph) {
        return [this, &graph](int segment) {
            const SegmentSource& source = graph.sources[segment];
            return majority_origin(network().arcs[source.arc], source.first_sample,
                                   source.last_sample);
        };
    }

    void record_dropped(IterationReport& iteration, const NetworkGraph& graph,
                        const ConflictResult& conflicts, const LabelingBridge& bridge,
                        const std::vector<bool>& kept) {
        const std::function<int(int)> origin_of = origin_of_segment(graph);
        for (std::size_t s = 0; s < kept.size(); ++s) {
            if (kept[s]) {
                ++iteration.kept;
                continue;
            }
            ++iteration.dropped;
            const SegmentSource& source = graph.sources[s];
            const WorkingArc& arc = network().arcs[source.arc];
            const int label = bridge.label_of_segment(static_cast<int>(s));
            const std::vector<int> labels = find_blockers(problem_, solution_, label);
            DroppedPiece why;
            why.label = label;
            why.weight = weights_[s];
            why.blockers = describe_blockers(labels, static_cast<int>(s), bridge, conflicts,
                                             problem_, origin_of);
            const auto margin = swap_margin(problem_, solution_, label, labels);
            if (margin) why.margin = static_cast<double>(*margin) / problem_.units_per_one();
            if (arc.is_short) {
                dropped_.add(arc, iteration.iteration, kShortArc, std::move(why));
                continue;
            }
            const bool has_conflict = std::ranges::any_of(
                problem_.conflicts_of(label), [&](int l) { return solution_.labels[l] == 1; });
            why.reason = has_conflict                                    ? "conflict"
                         : crumb_segments_.contains(static_cast<int>(s)) ? "crumb"
                                                                         : "rule";
            dropped_.add(arc, source.first_sample, source.last_sample, iteration.iteration,
                         std::move(why));
        }
    }

    /// Takes dropped segments out, collapses, joins; true when anything changed.
    bool apply(IterationReport& iteration, const NetworkGraph& graph,
               const ConflictResult& conflicts, const std::vector<bool>& kept) {
        std::set<int> must_resample;
        for (const VertexConflict& conflict : conflicts.vertex_conflicts) {
            must_resample.insert({conflict.first, conflict.second});
        }
        bool has_changed = iteration.collapsed > 0;
        std::vector<int> given_up;
        std::map<int, std::vector<bool>> kept_of_arc;
        for (std::size_t s = 0; s < kept.size(); ++s) {
            kept_of_arc[graph.sources[s].arc].push_back(kept[s]);
        }
        for (const auto& [a, flags] : kept_of_arc) {
            if (std::ranges::all_of(flags, [](bool k) { return k; })) continue;
            has_changed = true;
            if (network().arcs[a].is_short) {
                given_up.push_back(a);
            } else {
                keep_runs(network(), a, flags, is_best());
            }
        }
        remove_dangling(network(), given_up);
        iteration.collapsed +=
            static_cast<std::size_t>(collapse_short_arcs(network(), given_up, scale_, queries_));
        const int joins = network().merge_regular_nodes(
            [&](int v) { return !is_best() || must_resample.contains(v); });
        // A join alone is progress only if it asks for a new chain.
        const bool has_fresh = std::ranges::any_of(
            network().arcs, [](const WorkingArc& arc) { return arc.needs_resampling(); });
        return has_changed || (joins > 0 && has_fresh);
    }

    /// An arc that no chain represents and that is kept all the same, its ends being far apart
    /// (projection after a collapse can leave a gap in its samples), must not be the end of the
    /// loop. True when there was one.
    bool drop_idle_short_arcs(const IterationReport& iteration) {
        bool has_dropped = false;
        for (int a = 0; a < static_cast<int>(network().arcs.size()); ++a) {
            WorkingArc& arc = network().arcs[a];
            if (!arc.is_alive || !arc.is_short || arc.is_pinned) continue;
            dropped_.add(arc, iteration.iteration, kShortArc);
            network().remove_arc(a);
            has_dropped = true;
        }
        if (has_dropped) network().merge_regular_nodes([](int) { return true; });
        return has_dropped;
    }

    AdaptationResult finish() {
        // Only an interrupted loop leaves arcs unsampled.
        resample_arcs(network(), scale_, options_.threads);
        for (int a = 0; a < static_cast<int>(network().arcs.size()); ++a) {
            if (network().arcs[a].needs_resampling()) network().remove_arc(a);
        }
        const NetworkGraph graph = make_graph(network());
        const auto attributes = attributes_of(graph, network(), state_.origins);
        std::vector<double> weights;
        for (const auto& a : attributes) weights.push_back(segment_weight(a, scale_, options_));
        AdaptationResult result;
        result.network = make_adapted_network(initial_, network(), graph, weights, queries_);
        result.network.scale = scale_.rmin;
        result.network.ratio = scale_.ratio();
        dropped_.forget_returned(network());
        result.network.dropped = dropped_.take();
        for (const NetworkArc& arc : initial_.arcs)
            result.network.origin_curves.push_back(arc.curve);
        for (const std::string& warning : report_.warnings) {
            result.network.notes.push_back(warning);
        }
        const ConflictResult conflicts = detect_conflicts(graph.graph, scale_, conflict_options_);
        for (const ExemptPair& pair : conflicts.exempt) {
            report_.exempt.push_back({pair.first, pair.second, pair.distance});
        }
        report_.is_optimal = std::ranges::all_of(report_.iterations, [](const IterationReport& i) {
            return i.status == labeling::SolveStatus::Optimal;
        });
        report_.coverage = measure_coverage(state_.coverage, result.network, scale_.rmin);
        report_.initial_length = initial_.total_length();
        report_.final_length = result.network.total_length();
        result.report = std::move(report_);
        return result;
    }

    const FeatureCurveNetwork& initial_;
    AdaptationOptions options_;
    ScaleInterval scale_;
    std::unique_ptr<AdaptationSurface> own_surface_;
    const AdaptationSurface& surface_;
    const SurfaceQueries& queries_;
    ThinWallTest thin_wall_;
    IncrementalSolver solver_;
    InitialState state_;
    ConflictOptions conflict_options_;
    AdaptationReport report_;
    DroppedPieces dropped_;
    std::vector<WorkingArc> dense_initial_;  ///< as sampled, before anything happened
    bool is_first_resampling_ = true;
    // Of the current iteration:
    std::vector<double> weights_;
    labeling::LabelingProblem problem_;
    labeling::Solution solution_;
    std::set<int> crumb_segments_;
};

}  // namespace

AdaptationResult adapt_network(const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
                               const AdaptationOptions& options) {
    const std::vector<std::string> problems = validate(initial);
    if (!problems.empty()) throw InputError("the network is not valid: " + problems.front());
    require_valid(options, initial);
    return Adapter(mesh, initial, options).run();
}

}  // namespace fcn
