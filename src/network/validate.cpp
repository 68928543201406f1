// The invariants of a feature curve network. Every message starts with the place as a JSON pointer
// into the network's own format ("/arcs/3/samples/5: ..."), so that the same words serve a
// programmer and the reader of a broken file. Checks that need indices to be in range are skipped
// for elements whose indices are not, so one fault gives one message.

#include <cmath>
#include <sstream>

#include "network/network.h"

namespace fcn {
namespace {

/// Tolerances relative to the network's extent.
constexpr double kCoincidence = 1e-9;
constexpr double kOnSurface = 1e-6;
constexpr double kBarycentric = 1e-9;

bool is_finite(const Vec3& p) { return p.allFinite(); }

class Validator {
public:
    Validator(const FeatureCurveNetwork& network, const Mesh* mesh)
        : network_(network), mesh_(mesh) {}

    std::vector<std::string> run() {
        check_header();
        coincidence_ = kCoincidence * extent();
        on_surface_ = kOnSurface * (mesh_ ? bounding_box(*mesh_).diagonal() : extent());
        check_nodes();
        for (std::size_t a = 0; a < network_.arcs.size(); ++a) check_arc(a);
        check_segments();
        check_nodes_used();
        check_curves();
        check_orbits();
        check_dropped();
        return std::move(problems_);
    }

private:
    template <typename... Parts>
    void report(const Parts&... parts) {
        std::ostringstream out;
        (out << ... << parts);
        problems_.push_back(out.str());
    }

    bool has_node(int node) const {
        return node >= 0 && node < static_cast<int>(network_.nodes.size());
    }
    bool has_arc(int arc) const { return arc >= 0 && arc < static_cast<int>(network_.arcs.size()); }
    std::string no_node(int node) const {
        return "node " + std::to_string(node) + " does not exist (the network has " +
               std::to_string(network_.nodes.size()) + ")";
    }
    std::string no_arc(int arc) const {
        return "arc " + std::to_string(arc) + " does not exist (the network has " +
               std::to_string(network_.arcs.size()) + ")";
    }

    double extent() const {
        if (network_.diagonal > 0 && std::isfinite(network_.diagonal)) return network_.diagonal;
        Eigen::AlignedBox3d box;
        for (const NetworkNode& node : network_.nodes)
            if (is_finite(node.position)) box.extend(node.position);
        for (const NetworkArc& arc : network_.arcs)
            for (const ArcSample& sample : arc.samples)
                if (is_finite(sample.position)) box.extend(sample.position);
        return box.isEmpty() ? 0 : box.diagonal().norm();
    }

    void check_header() {
        if (!std::isfinite(network_.diagonal) || network_.diagonal < 0)
            report("/diagonal: ", network_.diagonal, " is not a length");
        if (!std::isfinite(network_.scale) || network_.scale < 0)
            report("/scale: ", network_.scale, " is not a length");
        if (!std::isfinite(network_.ratio) || network_.ratio < 0)
            report("/ratio: ", network_.ratio, " is not a ratio");
    }

    void check_point(const std::string& where, const Vec3& point, const SurfacePoint& surface) {
        if (!is_finite(point)) {
            report(where, ": position is not finite");
            return;
        }
        if (surface.face < -1) {
            report(where, ": face ", surface.face, " is negative");
            return;
        }
        if (surface.face < 0) return;
        const Vec3& b = surface.barycentric;
        if (!is_finite(b) || b.minCoeff() < -kBarycentric || std::abs(b.sum() - 1) > kBarycentric) {
            report(where, ": barycentric coordinates (", b[0], ", ", b[1], ", ", b[2],
                   ") are not >= 0 with sum 1");
            return;
        }
        if (!mesh_) return;
        if (surface.face >= static_cast<int>(mesh_->n_faces())) {
            report(where, ": face ", surface.face, " does not exist (the mesh has ",
                   mesh_->n_faces(), ")");
            return;
        }
        const double distance = (position(*mesh_, surface) - point).norm();
        if (!(distance <= on_surface_))
            report(where, ": position lies ", distance, " from its point on face ", surface.face);
    }

    void check_nodes() {
        for (std::size_t n = 0; n < network_.nodes.size(); ++n)
            check_point("/nodes/" + std::to_string(n), network_.nodes[n].position,
                        network_.nodes[n].surface);
    }

    void check_arc(std::size_t a) {
        const NetworkArc& arc = network_.arcs[a];
        const std::string where = "/arcs/" + std::to_string(a);
        for (std::size_t s = 0; s < arc.samples.size(); ++s)
            check_point(where + "/samples/" + std::to_string(s), arc.samples[s].position,
                        arc.samples[s].surface);
        for (std::size_t s = 1; s < arc.samples.size(); ++s)
            if (arc.samples[s].position == arc.samples[s - 1].position)
                report(where, "/samples/", s, ": equals the sample before it");
        check_arc_ends(arc, where);
        if (!arc.origins.empty() && arc.origins.size() + 1 != arc.samples.size())
            report(where, "/origins: ", arc.origins.size(), " entries for ", arc.samples.size(),
                   " samples (must be one fewer)");
        for (std::size_t o = 0; o < arc.origins.size(); ++o)
            if (arc.origins[o] < 0)
                report(where, "/origins/", o, ": ", arc.origins[o], " is negative");
        for (int k = 0; k < 2; ++k)
            if (arc.patches[k] < -1)
                report(where, "/patches/", k, ": ", arc.patches[k], " is less than -1");
        if (!std::isfinite(arc.dihedral)) report(where, "/dihedral: not finite");
    }

    void check_arc_ends(const NetworkArc& arc, const std::string& where) {
        bool has_both = true;
        for (int k = 0; k < 2; ++k)
            if (!has_node(arc.nodes[k])) {
                report(where, "/nodes/", k, ": ", no_node(arc.nodes[k]));
                has_both = false;
            }
        const std::size_t least = has_both && arc.is_closed() ? 4 : 2;
        if (arc.samples.size() < least) {
            report(where, "/samples: ", arc.samples.size(), " samples, ",
                   least == 4 ? "a closed arc" : "an arc", " needs ", least);
            return;
        }
        if (!has_both) return;
        if (arc.is_closed() && arc.samples.front().position != arc.samples.back().position) {
            report(where, "/samples: closed arc whose last sample does not repeat the first");
            return;
        }
        for (int k = 0; k < 2; ++k) {
            const Vec3& end = (k == 0 ? arc.samples.front() : arc.samples.back()).position;
            const double distance = (end - network_.nodes[arc.nodes[k]].position).norm();
            if (distance > coincidence_)
                report(where, "/nodes/", k, ": arc ends ", distance, " from node ", arc.nodes[k]);
        }
    }

    bool check_segment_indices(std::size_t s) {
        const NetworkSegment& segment = network_.segments[s];
        const std::string where = "/segments/" + std::to_string(s);
        const std::size_t before = problems_.size();
        for (int k = 0; k < 2; ++k)
            if (!has_node(segment.nodes[k]))
                report(where, "/nodes/", k, ": ", no_node(segment.nodes[k]));
        if (!std::isfinite(segment.weight)) report(where, "/weight: not finite");
        if (!has_arc(segment.arc)) {
            report(where, "/arc: ", no_arc(segment.arc));
            return false;
        }
        const int sample_count = static_cast<int>(network_.arcs[segment.arc].samples.size());
        if (segment.first_sample < 0 || segment.last_sample >= sample_count ||
            segment.first_sample >= segment.last_sample)
            report(where, ": samples ", segment.first_sample, " to ", segment.last_sample,
                   " are no range within the ", sample_count, " samples of arc ", segment.arc);
        return problems_.size() == before;
    }

    void check_segments() {
        if (network_.segments.empty()) return;
        std::vector<std::vector<std::size_t>> of_arc(network_.arcs.size());
        std::vector<bool> is_faulty(network_.arcs.size(), false);
        for (std::size_t s = 0; s < network_.segments.size(); ++s) {
            const bool is_sound = check_segment_indices(s);
            const int arc = network_.segments[s].arc;
            if (!has_arc(arc)) continue;
            of_arc[arc].push_back(s);
            if (!is_sound) is_faulty[arc] = true;
        }
        for (std::size_t a = 0; a < network_.arcs.size(); ++a)
            if (!is_faulty[a]) check_tiling(a, of_arc[a]);
    }

    void check_tiling(std::size_t a, const std::vector<std::size_t>& chain) {
        const NetworkArc& arc = network_.arcs[a];
        if (chain.empty()) {
            report("/arcs/", a, ": has no segments in an adapted network");
            return;
        }
        int sample = 0;
        int node = arc.nodes[0];
        int long_count = 0;
        for (std::size_t s : chain) {
            const NetworkSegment& segment = network_.segments[s];
            const std::string where = "/segments/" + std::to_string(s);
            if (segment.first_sample != sample)
                report(where, "/first_sample: ", segment.first_sample, " where arc ", a,
                       " continues at sample ", sample);
            if (segment.nodes[0] != node)
                report(where, "/nodes/0: ", segment.nodes[0], " where arc ", a,
                       " continues at node ", node);
            const Vec3& end = arc.samples[segment.last_sample].position;
            if (!((end - network_.nodes[segment.nodes[1]].position).norm() <= coincidence_))
                report(where, "/nodes/1: node ", segment.nodes[1], " is not at sample ",
                       segment.last_sample, " of arc ", a);
            sample = segment.last_sample;
            node = segment.nodes[1];
            long_count += segment.is_long;
        }
        if (sample + 1 != static_cast<int>(arc.samples.size()))
            report("/arcs/", a, ": its segments end at sample ", sample, " of ",
                   arc.samples.size());
        if (node != arc.nodes[1])
            report("/arcs/", a, ": its segments end at node ", node, ", not at ", arc.nodes[1]);
        if (long_count > 1) report("/arcs/", a, ": has ", long_count, " long segments");
    }

    void check_nodes_used() {
        std::vector<bool> is_used(network_.nodes.size(), false);
        const auto use = [&](int node) {
            if (has_node(node)) is_used[node] = true;
        };
        for (const NetworkArc& arc : network_.arcs)
            for (int node : arc.nodes) use(node);
        for (const NetworkSegment& segment : network_.segments)
            for (int node : segment.nodes) use(node);
        for (std::size_t n = 0; n < is_used.size(); ++n)
            if (!is_used[n]) report("/nodes/", n, ": no arc or segment uses it");
    }

    void check_curves() {
        std::vector<int> curve_of(network_.arcs.size(), -1);
        for (std::size_t c = 0; c < network_.curves.size(); ++c) check_curve(c, curve_of);
        for (std::size_t a = 0; a < network_.arcs.size(); ++a)
            if (network_.arcs[a].curve != curve_of[a])
                report("/arcs/", a, "/curve: ", network_.arcs[a].curve, " but ",
                       curve_of[a] < 0 ? std::string("no curve lists the arc")
                                       : "curve " + std::to_string(curve_of[a]) + " lists it");
    }

    void check_curve(std::size_t c, std::vector<int>& curve_of) {
        const NetworkCurve& curve = network_.curves[c];
        const std::string where = "/curves/" + std::to_string(c);
        if (curve.arcs.empty()) report(where, "/arcs: empty");
        if (curve.arcs.size() != curve.is_reversed.size()) {
            report(where, "/is_reversed: ", curve.is_reversed.size(), " entries for ",
                   curve.arcs.size(), " arcs");
            return;
        }
        if (!std::isfinite(curve.length) || curve.length < 0) report(where, "/length: no length");
        bool is_sound = true;
        for (std::size_t k = 0; k < curve.arcs.size(); ++k) {
            const int arc = curve.arcs[k];
            if (!has_arc(arc)) {
                report(where, "/arcs/", k, ": ", no_arc(arc));
                is_sound = false;
            } else if (curve_of[arc] >= 0) {
                report(where, "/arcs/", k, ": arc ", arc, " is already in curve ", curve_of[arc]);
            } else {
                curve_of[arc] = static_cast<int>(c);
            }
        }
        if (!is_sound || curve.arcs.empty()) return;
        const auto end_node = [&](std::size_t k, bool is_last) {
            return network_.arcs[curve.arcs[k]].nodes[is_last != curve.is_reversed[k] ? 1 : 0];
        };
        for (std::size_t k = 1; k < curve.arcs.size(); ++k)
            if (end_node(k - 1, true) != end_node(k, false))
                report(where, "/arcs/", k, ": arc ", curve.arcs[k],
                       " does not start where the arc before it ends");
        if (curve.is_closed && end_node(curve.arcs.size() - 1, true) != end_node(0, false))
            report(where, "/is_closed: the curve does not return to its start");
    }

    void check_orbits() {
        std::vector<int> orbit_of(network_.arcs.size(), -1);
        for (std::size_t o = 0; o < network_.orbits.size(); ++o) {
            const auto& members = network_.orbits[o].members;
            const std::string where = "/orbits/" + std::to_string(o);
            if (members.empty()) report(where, "/members: empty");
            for (std::size_t m = 0; m < members.size(); ++m) {
                const OrbitMember& member = members[m];
                const std::string at = where + "/members/" + std::to_string(m);
                if (!member.linear.allFinite() || !member.translation.allFinite())
                    report(at, ": transform is not finite");
                if (!has_arc(member.arc))
                    report(at, "/arc: ", no_arc(member.arc));
                else if (orbit_of[member.arc] >= 0)
                    report(at, "/arc: arc ", member.arc, " is already in orbit ",
                           orbit_of[member.arc]);
                else
                    orbit_of[member.arc] = static_cast<int>(o);
            }
            if (!members.empty() &&
                (members[0].linear != Eigen::Matrix3d::Identity() ||
                 members[0].translation != Vec3::Zero() || members[0].is_reversed))
                report(where, "/members/0: the representative's transform is not the identity");
        }
    }

    void check_dropped() {
        for (std::size_t d = 0; d < network_.dropped.size(); ++d) {
            const DroppedPiece& piece = network_.dropped[d];
            const std::string where = "/dropped/" + std::to_string(d);
            if (piece.polyline.size() < 2)
                report(where, "/polyline: ", piece.polyline.size(), " points, needs 2");
            for (std::size_t p = 0; p < piece.polyline.size(); ++p)
                if (!is_finite(piece.polyline[p]))
                    report(where, "/polyline/", p, ": position is not finite");
            if (!std::isfinite(piece.weight)) report(where, "/weight: not finite");
            if (piece.origin_arc < -1) report(where, "/origin_arc: ", piece.origin_arc);
            if (piece.iteration < 0) report(where, "/iteration: ", piece.iteration);
            if (piece.label < -1) report(where, "/label: ", piece.label);
            if (piece.margin && !std::isfinite(*piece.margin)) report(where, "/margin: not finite");
            for (std::size_t b = 0; b < piece.blockers.size(); ++b) {
                const Blocker& blocker = piece.blockers[b];
                if (!std::isfinite(blocker.weight) || !std::isfinite(blocker.measured))
                    report(where, "/blockers/", b, ": not finite");
            }
        }
    }

    const FeatureCurveNetwork& network_;
    const Mesh* mesh_;
    double coincidence_ = 0;
    double on_surface_ = 0;
    std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> validate(const FeatureCurveNetwork& network) {
    return Validator(network, nullptr).run();
}

std::vector<std::string> validate(const FeatureCurveNetwork& network, const Mesh& mesh) {
    return Validator(network, &mesh).run();
}

}  // namespace fcn
