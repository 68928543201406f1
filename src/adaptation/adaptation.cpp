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

#include "adaptation/blockers.h"
#include "adaptation/collapse.h"
#include "adaptation/conflict_places.h"
#include "adaptation/conflicts.h"
#include "adaptation/explanation.h"
#include "adaptation/incremental_solver.h"
#include "adaptation/initial_state.h"
#include "adaptation/labeling_bridge.h"
#include "adaptation/network_output.h"
#include "adaptation/orbits.h"
#include "adaptation/refill.h"
#include "adaptation/thin_wall.h"
#include "adaptation/weights.h"
#include "geometry/errors.h"

namespace fcn {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kBestLoopFactor = 4;
constexpr double kPaperLoopFactor = 100;
constexpr double kQuadOrthogonality = 10;
/// A thin wall's surface distance, in rmin.
constexpr double kThinWallDistance = 3;
/// A point this close to an edge or a vertex of the mesh lies on it, in rmin.
constexpr double kTouch = 1e-3;
/// Rounds of forbidding crumbs and solving again; what is left then is dropped with the next round.
constexpr int kCrumbRounds = 20;
/// Rounds of refilling after the loop has converged; each ends in a converged loop again.
constexpr int kRefillRounds = 3;
/// A dropped piece of which this share came back is no longer listed as dropped.
constexpr double kCameBack = 0.5;
/// Conflicts that are recorded with their places.
constexpr std::size_t kMostPlaces = 20000;
/// More samples than this do not fit into memory.
constexpr double kMostSamples = 5e7;

AdaptationOptions with_defaults(AdaptationOptions options) {
    if (options.lambda1 < 0) {
        options.lambda1 = options.target == ElementType::Quad ? kQuadOrthogonality : 0;
    }
    if (options.alpha_loop < 0) {
        options.alpha_loop =
            options.mode == AdaptationMode::Paper ? kPaperLoopFactor : kBestLoopFactor;
    }
    return options;
}

void require(bool condition, const std::string& message) {
    if (!condition) throw InputError(message);
}

void check_options(const AdaptationOptions& options) {
    require(options.solver != nullptr, "adaptation needs a solver");
    require(options.lambda0 >= 0 && std::isfinite(options.lambda0), "lambda0 must be >= 0");
    require(std::isfinite(options.lambda1), "lambda1 must be finite");
    require(options.alpha_sym > 0 && std::isfinite(options.alpha_sym), "alpha-sym must be > 0");
    require(options.alpha_loop != 0 && std::isfinite(options.alpha_loop), "alpha-loop must be > 0");
    require(options.smooth_power > 0 && std::isfinite(options.smooth_power),
            "smooth-power must be > 0");
    require(options.ortho_radius > 0 && std::isfinite(options.ortho_radius),
            "ortho-radius must be > 0");
    require(options.max_iterations >= 1, "at least one iteration is needed");
}

class Adapter {
public:
    Adapter(const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
            const AdaptationOptions& options)
        : initial_(initial),
          options_(with_defaults(options)),
          scale_(make_scale(options.rmin, options.ratio, options.target)),
          queries_(mesh.mesh),
          thin_wall_(mesh.mesh, queries_, kThinWallDistance * options.rmin, kTouch * options.rmin),
          solver_(*options.solver, solve_options(options)),
          state_(make_initial_state(mesh, queries_, initial, scale_, options_)) {
        dropped_ = state_.dropped;
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
            return segment_weight(attributes_of_stretch(arc, first, last, length), scale_,
                                  options_);
        };
        std::vector<WorkingArc> found = find_refills(input);
        for (WorkingArc& arc : found) {
            const bool is_loop = arc.points.front() == arc.points.back();
            if (arc.nodes[0] < 0) arc.nodes[0] = new_node(arc.points.front());
            if (arc.nodes[1] < 0)
                arc.nodes[1] = is_loop ? arc.nodes[0] : new_node(arc.points.back());
            network().arcs.push_back(std::move(arc));
        }
        network().merge_regular_nodes([](int) { return false; });
        return !found.empty();
    }

    /// One round; false when the loop ends.
    bool iterate(IterationReport& iteration) {
        timed(iteration, "resample", [&] { resample(iteration.iteration); });
        NetworkGraph graph = make_graph(network());
        ConflictResult conflicts;
        timed(iteration, "conflicts", [&] {
            conflicts = detect_conflicts(graph.graph, scale_, conflict_options_);
            if (is_best()) collapse_clusters(iteration, graph, conflicts);
        });
        count(iteration, graph, conflicts);
        const auto attributes = timed(iteration, "weights", [&] { return attributes_of(graph); });
        LabelingBridge bridge = make_bridge(graph, conflicts, attributes);
        const auto kept =
            timed(iteration, "solve", [&] { return label(iteration, graph, conflicts, bridge); });
        if (!kept) {
            report_.status = options_.stop.stop_requested() ? AdaptationStatus::Interrupted
                                                            : AdaptationStatus::SolverFailed;
            return false;
        }
        bool has_changed =
            timed(iteration, "collapse", [&] { return apply(iteration, graph, conflicts, *kept); });
        if (!has_changed && is_best()) has_changed = drop_idle_short_arcs(iteration);
        if (!has_changed) report_.status = AdaptationStatus::Converged;
        return has_changed;
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
            keep_small_loop(arc);
            return;
        }
        DroppedPiece piece;
        piece.polyline = arc.points;
        piece.origin_arc = majority_origin(arc, 0, static_cast<int>(arc.points.size()) - 1);
        piece.iteration = iteration;
        piece.reason = "closed arc without three segments";
        dropped_.push_back(std::move(piece));
        arc = WorkingArc{};
        arc.is_alive = false;
    }

    void keep_small_loop(WorkingArc& arc) {
        const double length = arc.length();
        const int last = static_cast<int>(arc.points.size()) - 1;
        arc.chain = {0};
        double along = 0;
        for (int k = 1; k < last && arc.chain.size() < 3; ++k) {
            along += (arc.points[k] - arc.points[k - 1]).norm();
            const bool is_due = along >= length * static_cast<double>(arc.chain.size()) / 3;
            const bool is_last_chance = last - k <= 3 - static_cast<int>(arc.chain.size());
            if (is_due || is_last_chance) arc.chain.push_back(k);
        }
        arc.chain.push_back(last);
        char text[160];
        std::snprintf(text, sizeof text,
                      "pinned loop of length %.6g near (%.6g, %.6g, %.6g) is too small for three "
                      "segments at this scale; kept as it is",
                      length, arc.points[0].x(), arc.points[0].y(), arc.points[0].z());
        report_.warnings.emplace_back(text);
    }

    /// Best mode: clusters that may collapse do so before the labeling, until none is left.
    void collapse_clusters(IterationReport& iteration, NetworkGraph& graph,
                           ConflictResult& conflicts) {
        for (;;) {
            const std::vector<int> arcs =
                find_collapsible_clusters(network(), graph, conflicts.conflicts, scale_);
            if (arcs.empty()) return;
            for (int a : arcs) record_short(a, 0, {});
            iteration.collapsed += collapse_short_arcs(network(), arcs, scale_, queries_);
            network().merge_regular_nodes([](int) { return true; });
            resample(iteration.iteration);
            graph = make_graph(network());
            conflicts = detect_conflicts(graph.graph, scale_, conflict_options_);
        }
    }

    /// `piece` holds what is known of its label.
    void record_short(int a, int iteration, DroppedPiece piece) {
        const WorkingArc& arc = network().arcs[a];
        piece.polyline = arc.points;
        piece.origin_arc = majority_origin(arc, 0, static_cast<int>(arc.points.size()) - 1);
        piece.iteration = iteration;
        piece.reason = "short arc";
        dropped_.push_back(std::move(piece));
    }

    void count(IterationReport& iteration, const NetworkGraph& graph,
               const ConflictResult& conflicts) {
        iteration.segments = graph.graph.segments.size();
        for (const GraphSegment& segment : graph.graph.segments) {
            iteration.short_segments += segment.is_short;
            iteration.long_segments += segment.is_long;
        }
        for (std::size_t v = 0; v < graph.graph.nodes.size(); ++v) {
            iteration.extraordinary_nodes +=
                graph.graph.nodes[v].is_extraordinary && !graph.graph.incident[v].empty();
        }
        for (const Conflict& conflict : conflicts.conflicts) {
            iteration.angle_conflicts += conflict.kind == ConflictKind::Angle;
            iteration.distance_conflicts += conflict.kind == ConflictKind::Distance;
            iteration.crossing_conflicts += conflict.kind == ConflictKind::Crossing;
            iteration.node_conflicts += conflict.kind == ConflictKind::Nodes;
        }
        iteration.vertex_conflicts = conflicts.vertex_conflicts.size();
        iteration.exempt_pairs = conflicts.exempt.size();
    }

    SegmentAttributes attributes_of_stretch(const WorkingArc& arc, int first, int last,
                                            double chord) const {
        SegmentAttributes result;
        double length = 0, loop = 0, symmetric = 0, log_contrast = 0;
        for (int k = first; k < last; ++k) {
            const double piece = (arc.points[k + 1] - arc.points[k]).norm();
            const OriginAttributes& origin = state_.origins[arc.origins[k]];
            const double crease = (arc.crease[k] + arc.crease[k + 1]) / 2;
            length += piece;
            result.sharpness += piece * (arc.sharpness[k] + arc.sharpness[k + 1]) / 2;
            log_contrast += piece * std::log(crease_contrast(crease));
            result.curve_length += piece * origin.curve_length;
            loop += origin.is_on_loop ? piece : 0;
            symmetric += origin.is_symmetric ? piece : 0;
        }
        if (length > 0) {
            result.sharpness /= length;
            result.curve_length /= length;
            result.contrast = std::exp(log_contrast / length);
        }
        result.is_on_loop = loop > length / 2;
        result.is_symmetric = symmetric > length / 2;
        result.length = chord;
        return result;
    }

    std::vector<SegmentAttributes> attributes_of(const NetworkGraph& graph) const {
        std::vector<SegmentAttributes> result;
        result.reserve(graph.sources.size());
        for (std::size_t s = 0; s < graph.sources.size(); ++s) {
            const SegmentSource& source = graph.sources[s];
            result.push_back(attributes_of_stretch(state_.network.arcs[source.arc],
                                                   source.first_sample, source.last_sample,
                                                   graph.graph.length(static_cast<int>(s))));
        }
        return result;
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
        input.groups = groups_of(graph, conflicts);
        weights_ = input.weights;
        return LabelingBridge(input);
    }

    /// Segments that share a label: whole curves, or members of symmetry orbits.
    std::vector<int> groups_of(const NetworkGraph& graph, const ConflictResult& conflicts) {
        const int count = static_cast<int>(graph.sources.size());
        std::map<int, std::vector<std::array<int, 4>>> members;  // rank, arc, position, segment
        for (int s = 0; s < count; ++s) {
            const SegmentSource& source = graph.sources[s];
            const WorkingArc& arc = network().arcs[source.arc];
            if (arc.is_pinned) continue;
            if (options_.unit == LabelUnit::Curve) {
                const OriginAttributes& origin =
                    state_.origins[majority_origin(arc, source.first_sample, source.last_sample)];
                const int along = origin.is_reversed_in_curve ? -source.position : source.position;
                members[origin.curve].push_back({origin.rank_in_curve, source.arc, along, s});
            } else if (!arc.orbit_classes.empty() && arc.orbit_classes[source.position] >= 0) {
                members[arc.orbit_classes[source.position]].push_back({0, 0, 0, s});
            }
        }
        if (members.empty()) return {};
        std::vector<std::vector<int>> order;
        for (auto& [key, list] : members) {
            std::ranges::sort(list);
            order.emplace_back();
            for (const auto& entry : list) order.back().push_back(entry[3]);
        }
        const bool splits = is_best();
        return split_groups(order, count, splits ? conflicts.conflicts : std::vector<Conflict>{},
                            options_.unit == LabelUnit::Segment);
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
                record_solve(iteration, result, bridge);
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

    void record_solve(IterationReport& iteration, const labeling::SolveResult& result,
                      const LabelingBridge& bridge) {
        const double units = problem_.units_per_one();
        iteration.labels = static_cast<std::size_t>(bridge.label_count());
        iteration.conflicts = problem_.conflict_count();
        iteration.bonuses = problem_.bonus_count();
        iteration.rules = problem_.rule_count();
        const auto components = result.statistics.find("components");
        if (components != result.statistics.end()) {
            iteration.components = static_cast<std::size_t>(components->second);
        }
        iteration.status = result.status;
        iteration.stop_reason = result.stop_reason;
        iteration.value = static_cast<double>(solution_.value) / units;
        iteration.bound = result.bound ? static_cast<double>(*result.bound) / units
                                       : std::numeric_limits<double>::quiet_NaN();
        iteration.units_per_one = units;
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
                record_short(source.arc, iteration.iteration, std::move(why));
                continue;
            }
            DroppedPiece piece = std::move(why);
            piece.polyline.assign(arc.points.begin() + source.first_sample,
                                  arc.points.begin() + source.last_sample + 1);
            piece.origin_arc = majority_origin(arc, source.first_sample, source.last_sample);
            piece.iteration = iteration.iteration;
            const bool has_conflict = std::ranges::any_of(
                problem_.conflicts_of(label), [&](int l) { return solution_.labels[l] == 1; });
            piece.reason = has_conflict                                    ? "conflict"
                           : crumb_segments_.contains(static_cast<int>(s)) ? "crumb"
                                                                           : "rule";
            dropped_.push_back(std::move(piece));
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
                split(a, flags);
            }
        }
        prune_dangling(given_up);
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
            record_short(a, iteration.iteration, {});
            arc = WorkingArc{};
            arc.is_alive = false;
            has_dropped = true;
        }
        if (has_dropped) network().merge_regular_nodes([](int) { return true; });
        return has_dropped;
    }

    /// Replaces an arc by its runs of kept segments; in best mode they keep their chains.
    void split(int a, const std::vector<bool>& flags) {
        WorkingArc arc = std::move(network().arcs[a]);
        network().arcs[a] = WorkingArc{};
        network().arcs[a].is_alive = false;
        const int count = static_cast<int>(flags.size());
        if (arc.is_closed() && flags.front() && flags.back()) {
            rotate_to_gap(arc, flags, a);
            return;
        }
        for (int k = 0; k < count;) {
            if (!flags[k]) {
                ++k;
                continue;
            }
            int end = k;
            while (end < count && flags[end]) ++end;
            add_run(arc, k, end);
            k = end;
        }
    }

    /// A closed arc's kept run may pass its start: the run is put together from both ends, unless
    /// other arcs meet at the start node.
    void rotate_to_gap(WorkingArc& arc, const std::vector<bool>& flags, int a) {
        const int node = arc.nodes[0];
        const bool is_junction = std::ranges::any_of(network().arcs, [&](const WorkingArc& other) {
            return other.is_alive && (other.nodes[0] == node || other.nodes[1] == node);
        });
        const int count = static_cast<int>(flags.size());
        int gap = 0;
        while (flags[gap]) ++gap;
        if (is_junction) {
            for (int k = 0; k < count;) {
                int end = k;
                while (end < count && flags[end] == flags[k]) ++end;
                if (flags[k]) add_run(arc, k, end);
                k = end;
            }
            return;
        }
        const int shift = arc.chain[gap];
        const int last = static_cast<int>(arc.points.size()) - 1;
        network().arcs[a] = std::move(arc);
        network().rotate_closed(a, shift);
        WorkingArc& rotated = network().arcs[a];
        std::vector<int> chain;
        for (int k = gap; k < count; ++k) chain.push_back(rotated.chain[k] - shift);
        for (int k = 0; k <= gap; ++k) chain.push_back(rotated.chain[k] + last - shift);
        rotated.chain = std::move(chain);
        if (rotated.long_segment >= 0) {
            rotated.long_segment = (rotated.long_segment - gap + count) % count;
        }
        std::vector<bool> shifted(flags.begin() + gap, flags.end());
        shifted.insert(shifted.end(), flags.begin(), flags.begin() + gap);
        if (!rotated.orbit_classes.empty()) {
            std::ranges::rotate(rotated.orbit_classes, rotated.orbit_classes.begin() + gap);
        }
        split(a, shifted);
    }

    /// New arc from segments [first, end) of an arc's chain.
    void add_run(const WorkingArc& arc, int first, int end) {
        const int count = arc.segment_count();
        const int from = arc.chain[first], to = arc.chain[end];
        WorkingArc run;
        run.points.assign(arc.points.begin() + from, arc.points.begin() + to + 1);
        run.sharpness.assign(arc.sharpness.begin() + from, arc.sharpness.begin() + to + 1);
        run.crease.assign(arc.crease.begin() + from, arc.crease.begin() + to + 1);
        run.origins.assign(arc.origins.begin() + from, arc.origins.begin() + to);
        run.is_pinned = arc.is_pinned;
        run.nodes[0] = first == 0 ? arc.nodes[0] : new_node(run.points.front());
        run.nodes[1] = end == count ? arc.nodes[1] : new_node(run.points.back());
        if (is_best()) {
            for (int k = first; k <= end; ++k) run.chain.push_back(arc.chain[k] - from);
            if (arc.long_segment >= first && arc.long_segment < end) {
                run.long_segment = arc.long_segment - first;
            }
            if (!arc.orbit_classes.empty()) {
                run.orbit_classes.assign(arc.orbit_classes.begin() + first,
                                         arc.orbit_classes.begin() + end);
            }
        }
        network().arcs.push_back(std::move(run));
    }

    int new_node(const Vec3& position) {
        network().nodes.push_back({position});
        return static_cast<int>(network().nodes.size()) - 1;
    }

    /// Takes out given-up short arcs that lead nowhere; the others wait for their collapse.
    void prune_dangling(std::vector<int>& given_up) {
        for (bool is_pruning = true; is_pruning;) {
            is_pruning = false;
            const auto stars = network().stars();
            std::vector<int> rest;
            for (int a : given_up) {
                WorkingArc& arc = network().arcs[a];
                const bool is_dangling =
                    stars[arc.nodes[0]].size() < 2 || stars[arc.nodes[1]].size() < 2;
                if (is_dangling) {
                    arc = WorkingArc{};
                    arc.is_alive = false;
                    is_pruning = true;
                } else {
                    rest.push_back(a);
                }
            }
            given_up = std::move(rest);
        }
    }

    /// Refilling brings dropped samples back; their pieces are not dropped any more.
    void forget_returned_pieces() {
        std::set<std::array<double, 3>> present;
        for (const WorkingArc& arc : network().arcs) {
            for (const Vec3& p : arc.points) present.insert({p.x(), p.y(), p.z()});
        }
        std::erase_if(dropped_, [&](const DroppedPiece& piece) {
            std::size_t back = 0;
            for (const Vec3& p : piece.polyline) back += present.contains({p.x(), p.y(), p.z()});
            return piece.polyline.size() > 2 &&
                   static_cast<double>(back) >
                       kCameBack * static_cast<double>(piece.polyline.size());
        });
    }

    AdaptationResult finish() {
        for (WorkingArc& arc : network().arcs) {
            // Only an interrupted loop leaves arcs unsampled.
            if (arc.needs_resampling()) resample_arcs(network(), scale_, options_.threads);
        }
        for (WorkingArc& arc : network().arcs) {
            if (arc.is_alive && arc.chain.empty()) {
                arc = WorkingArc{};
                arc.is_alive = false;
            }
        }
        const NetworkGraph graph = make_graph(network());
        const auto attributes = attributes_of(graph);
        std::vector<double> weights;
        for (const auto& a : attributes) weights.push_back(segment_weight(a, scale_, options_));
        AdaptationResult result;
        result.network = make_adapted_network(initial_, network(), graph, weights, queries_);
        result.network.scale = scale_.rmin;
        result.network.ratio = scale_.ratio();
        forget_returned_pieces();
        result.network.dropped = std::move(dropped_);
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
    SurfaceQueries queries_;
    ThinWallTest thin_wall_;
    IncrementalSolver solver_;
    InitialState state_;
    ConflictOptions conflict_options_;
    AdaptationReport report_;
    std::vector<DroppedPiece> dropped_;
    std::vector<WorkingArc> dense_initial_;  ///< as sampled, before anything happened
    bool is_first_resampling_ = true;
    // Of the current iteration:
    std::vector<double> weights_;
    labeling::LabelingProblem problem_;
    labeling::Solution solution_;
    std::set<int> crumb_segments_;
};

void check_size(const FeatureCurveNetwork& initial, const AdaptationOptions& options) {
    const double spacing = sample_spacing(make_scale(options.rmin, options.ratio, options.target));
    const double length = initial.total_length();
    require(length / spacing <= kMostSamples,
            "scale " + std::to_string(options.rmin) + " is too small for curves of length " +
                std::to_string(length) + ": they would need more than " +
                std::to_string(static_cast<long>(kMostSamples)) + " samples");
}

}  // namespace

const char* to_string(AdaptationStatus status) {
    switch (status) {
        case AdaptationStatus::Converged:
            return "converged";
        case AdaptationStatus::IterationLimit:
            return "iteration limit";
        case AdaptationStatus::SolverFailed:
            return "solver failed";
        case AdaptationStatus::Interrupted:
            return "interrupted";
    }
    return "unknown";
}

AdaptationResult adapt_network(const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
                               const AdaptationOptions& options) {
    check_options(options);
    const std::vector<std::string> problems = validate(initial);
    if (!problems.empty()) throw InputError("the network is not valid: " + problems.front());
    check_size(initial, options);
    return Adapter(mesh, initial, options).run();
}

}  // namespace fcn
