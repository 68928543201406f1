// Pins from a user's hand. Numbers pin whole arcs. Boxes and painted importance pin places: each
// interval of an arc is cut where it enters or leaves a box and where the importance, linear
// between two samples, passes a threshold; stretches of one mind become arcs of their own. A
// stretch too short to be carried joins the longer of its neighbours, or paint that flickers would
// leave crumbs that no scale can hold.

#include "features/pins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "features/surface_lines.h"
#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr double kRounding = 1e-9;

/// A stretch of an arc; places count sample intervals.
struct Stretch {
    double first = 0, last = 0;
    double length = 0;
    Pin pin = Pin::None;
};

class Pinner {
public:
    Pinner(const FeatureCurveNetwork& network, const LoadedMesh& mesh,
           const std::vector<PinRule>& rules, const PaintedImportance& importance,
           const PinOptions& options)
        : in_(network),
          arrays_(mesh_arrays(mesh.mesh)),
          lines_(mesh.mesh, arrays_),
          rules_(rules),
          importance_(importance),
          options_(options),
          named_(network.arcs.size()),
          box_hits_(rules.size(), false) {}

    FeatureCurveNetwork run() {
        out_ = in_;
        name_arcs();
        std::vector<NetworkArc> parts;
        std::vector<bool> is_cut(in_.arcs.size(), false);
        for (std::size_t a = 0; a < in_.arcs.size(); ++a) {
            if (named_[a]) {
                out_.arcs[a].pin = named_[a]->pin;
            } else if (in_.arcs[a].kind == ArcKind::Feature) {
                is_cut[a] = pin_places(a, parts);
            }
        }
        for (std::size_t r = 0; r < rules_.size(); ++r)
            if (rules_[r].target == PinRule::Target::Box && !box_hits_[r])
                throw InputError(rules_[r].name + ": no feature passes through this box");
        if (absorbed_ > 0)
            out_.notes.push_back("pins: " + std::to_string(absorbed_) + " stretches shorter than " +
                                 std::to_string(options_.min_length) +
                                 " follow what is beside them");
        for (NetworkArc& part : parts) out_.arcs.push_back(std::move(part));
        forget_cut_arcs(is_cut);
        return std::move(out_);
    }

private:
    // --- by number -----------------------------------------------------------------------------

    void name_arcs() {
        FeatureCurveNetwork with_curves;
        for (const PinRule& rule : rules_) {
            if (rule.target == PinRule::Target::Arc) {
                require(rule, "arc", in_.arcs.size());
                name(rule.index, rule);
            } else if (rule.target == PinRule::Target::Curve) {
                if (with_curves.arcs.empty()) with_curves = in_;
                if (with_curves.curves.empty()) find_curves(with_curves);
                require(rule, "curve", with_curves.curves.size());
                for (int arc : with_curves.curves[rule.index].arcs) name(arc, rule);
            }
        }
    }

    static void require(const PinRule& rule, const std::string& what, std::size_t count) {
        if (rule.index >= 0 && rule.index < static_cast<int>(count)) return;
        throw InputError(rule.name + ": " + what + " " + std::to_string(rule.index) +
                         " does not exist (the network has " + std::to_string(count) +
                         ", numbered from 0)");
    }

    void name(int arc, const PinRule& rule) {
        if (named_[arc] && named_[arc]->pin != rule.pin)
            throw InputError("arc " + std::to_string(arc) + " is to be kept and to be dropped (" +
                             named_[arc]->name + ", " + rule.name + ")");
        named_[arc] = &rule;
    }

    // --- by place ------------------------------------------------------------------------------

    std::optional<double> importance_at(const ArcSample& sample) const {
        if (importance_.of_vertex.empty() || sample.surface.face < 0) return std::nullopt;
        double value = 0;
        for (int i = 0; i < 3; ++i) {
            const int v = arrays_.face_vertices[sample.surface.face][i];
            if (sample.surface.barycentric[i] > 0)
                value += sample.surface.barycentric[i] * importance_.of_vertex[v];
        }
        return value;
    }

    Pin pin_at(const Vec3& point, std::optional<double> importance) {
        const PinRule* box = nullptr;
        for (std::size_t r = 0; r < rules_.size(); ++r) {
            const PinRule& rule = rules_[r];
            if (rule.target != PinRule::Target::Box || !rule.box.contains(point)) continue;
            box_hits_[r] = true;
            if (box && box->pin != rule.pin)
                throw InputError("a feature is to be kept and to be dropped: " + box->name +
                                 " and " + rule.name + " overlap");
            box = &rule;
        }
        if (box) return box->pin;
        if (importance && *importance >= importance_.keep_above) return Pin::Keep;
        if (importance && *importance <= importance_.drop_below) return Pin::Drop;
        return Pin::None;
    }

    /// Where the word may change between two samples.
    std::vector<double> cuts_between(const ArcSample& a, const ArcSample& b) const {
        std::vector<double> cuts{0, 1};
        const auto add = [&](double from, double to, double limit) {
            const double t = (limit - from) / (to - from);
            if (std::isfinite(t) && t > kRounding && t < 1 - kRounding) cuts.push_back(t);
        };
        for (const PinRule& rule : rules_) {
            if (rule.target != PinRule::Target::Box) continue;
            for (int axis = 0; axis < 3; ++axis) {
                add(a.position[axis], b.position[axis], rule.box.min()[axis]);
                add(a.position[axis], b.position[axis], rule.box.max()[axis]);
            }
        }
        const auto one = importance_at(a), other = importance_at(b);
        if (one && other) {
            add(*one, *other, importance_.keep_above);
            add(*one, *other, importance_.drop_below);
        }
        std::ranges::sort(cuts);
        return cuts;
    }

    std::vector<Stretch> stretches(const NetworkArc& arc) {
        std::vector<Stretch> result;
        for (std::size_t i = 0; i + 1 < arc.samples.size(); ++i) {
            const ArcSample &a = arc.samples[i], &b = arc.samples[i + 1];
            const std::vector<double> cuts = cuts_between(a, b);
            const auto one = importance_at(a), other = importance_at(b);
            for (std::size_t k = 1; k < cuts.size(); ++k) {
                const double t = (cuts[k - 1] + cuts[k]) / 2, at = static_cast<double>(i);
                std::optional<double> value;
                if (one && other) value = (1 - t) * *one + t * *other;
                const Pin pin = pin_at((1 - t) * a.position + t * b.position, value);
                const double length = (cuts[k] - cuts[k - 1]) * (b.position - a.position).norm();
                if (result.empty() || result.back().pin != pin)
                    result.push_back({at + cuts[k - 1], at + cuts[k], length, pin});
                else
                    result.back() = {result.back().first, at + cuts[k],
                                     result.back().length + length, pin};
            }
        }
        return result;
    }

    /// Shortest first, short stretches take the word of the longer neighbour.
    std::vector<Stretch> without_short(std::vector<Stretch> list) {
        while (list.size() > 1) {
            const auto shortest = std::ranges::min_element(list, {}, &Stretch::length);
            if (shortest->length >= options_.min_length) break;
            absorbed_ += shortest->pin != Pin::None;
            const auto k = static_cast<std::size_t>(shortest - list.begin());
            const bool has_before = k > 0, has_after = k + 1 < list.size();
            const bool is_before_longer =
                has_before && (!has_after || list[k - 1].length >= list[k + 1].length);
            list[k].pin = list[is_before_longer ? k - 1 : k + 1].pin;
            std::vector<Stretch> joined;
            for (const Stretch& stretch : list) {
                if (joined.empty() || joined.back().pin != stretch.pin) {
                    joined.push_back(stretch);
                } else {
                    joined.back().last = stretch.last;
                    joined.back().length += stretch.length;
                }
            }
            list = std::move(joined);
        }
        return list;
    }

    ArcSample sample_at(const NetworkArc& arc, double at) const {
        const auto i = std::min(static_cast<std::size_t>(at), arc.samples.size() - 2);
        return lines_.between(arc.samples[i], arc.samples[i + 1], at - static_cast<double>(i));
    }

    /// True if the arc was cut.
    bool pin_places(std::size_t a, std::vector<NetworkArc>& parts) {
        const NetworkArc& arc = in_.arcs[a];
        const std::vector<Stretch> list = without_short(stretches(arc));
        // What the network itself says of an arc stands where the user says nothing.
        const auto word = [&](Pin pin) { return pin == Pin::None ? arc.pin : pin; };
        if (list.size() == 1) {
            out_.arcs[a].pin = word(list[0].pin);
            return false;
        }
        int node = arc.nodes[0];
        for (std::size_t k = 0; k < list.size(); ++k) {
            NetworkArc part = arc;
            part.pin = word(list[k].pin);
            part.curve = -1;
            part.origins.clear();
            part.samples = {k == 0 ? arc.samples.front() : part_end_};
            for (auto i = static_cast<std::size_t>(list[k].first) + 1;
                 static_cast<double>(i) < list[k].last; ++i)
                append(part, arc.samples[i]);
            const bool is_last = k + 1 == list.size();
            part_end_ = is_last ? arc.samples.back() : sample_at(arc, list[k].last);
            append(part, part_end_);
            part.nodes[0] = node;
            if (!is_last) {
                node = static_cast<int>(out_.nodes.size());
                out_.nodes.push_back({part_end_.position, part_end_.surface});
            }
            part.nodes[1] = is_last ? arc.nodes[1] : node;
            if (k == 0)
                out_.arcs[a] = std::move(part);
            else
                parts.push_back(std::move(part));
        }
        return true;
    }

    static void append(NetworkArc& arc, const ArcSample& sample) {
        if (sample.position != arc.samples.back().position) arc.samples.push_back(sample);
    }

    void forget_cut_arcs(const std::vector<bool>& is_cut) {
        if (std::ranges::find(is_cut, true) == is_cut.end()) return;
        out_.curves.clear();
        for (NetworkArc& arc : out_.arcs) arc.curve = -1;
        std::erase_if(out_.orbits, [&](const SymmetryOrbit& orbit) {
            return std::ranges::any_of(orbit.members,
                                       [&](const OrbitMember& m) { return is_cut[m.arc]; });
        });
    }

    const FeatureCurveNetwork& in_;
    MeshArrays arrays_;
    SurfaceLines lines_;
    const std::vector<PinRule>& rules_;
    const PaintedImportance& importance_;
    PinOptions options_;
    std::vector<const PinRule*> named_;  ///< per arc, the rule that names it
    std::vector<bool> box_hits_;
    ArcSample part_end_;
    int absorbed_ = 0;  ///< stretches to be pinned that were too short
    FeatureCurveNetwork out_;
};

}  // namespace

FeatureCurveNetwork apply_pins(const FeatureCurveNetwork& network, const LoadedMesh& mesh,
                               const std::vector<PinRule>& rules,
                               const PaintedImportance& importance, const PinOptions& options) {
    if (!importance.of_vertex.empty() && importance.of_vertex.size() != mesh.mesh.n_vertices())
        throw InputError(importance.name + ": " + std::to_string(importance.of_vertex.size()) +
                         " values, the mesh has " + std::to_string(mesh.mesh.n_vertices()) +
                         " vertices");
    for (const double value : importance.of_vertex)
        if (!std::isfinite(value)) throw InputError(importance.name + ": a value is not finite");
    return Pinner(network, mesh, rules, importance, options).run();
}

}  // namespace fcn
