// Quads of edge length h are made from triangles of length 2 h, whose edges are halved. A segment
// of length h that is an edge of these triangles would end as two edges of h / 2; two segments in
// one edge, whose middle goes to the node between them, end as one edge each. Which are joined is
// decided along each arc by dynamic programming: a segment left alone costs 1, a pair what it turns
// and how uneven it is.
#include "meshing/coarse_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr double kMaxTurn = 40 * std::numbers::pi / 180;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class Joiner {
public:
    Joiner(const FeatureCurveNetwork& network, double longest, const std::vector<bool>& kept_apart)
        : network_(network), longest_(longest), kept_apart_(kept_apart) {
        ends_.assign(network.nodes.size(), 0);
        const auto is_below = [](int i, std::size_t end) { return i >= 0 && at(i) < end; };
        for (std::size_t s = 0; s < network.segments.size(); ++s) {
            const NetworkSegment& segment = network.segments[s];
            if (!is_below(segment.arc, network.arcs.size()))
                throw InputError("network: segment " + std::to_string(s) + " names no arc");
            for (const int node : segment.nodes) {
                if (!is_below(node, network.nodes.size()))
                    throw InputError("network: segment " + std::to_string(s) + " names no node");
                ++ends_[at(node)];
            }
        }
    }

    CoarseNetwork run() {
        std::vector<std::vector<int>> of_arc(network_.arcs.size());
        for (int s = 0; s < static_cast<int>(network_.segments.size()); ++s)
            of_arc[at(network_.segments[at(s)].arc)].push_back(s);
        std::vector<std::array<int, 2>> all;
        for (auto& segments : of_arc) {
            std::sort(segments.begin(), segments.end(), [&](int a, int b) {
                return network_.segments[at(a)].first_sample <
                       network_.segments[at(b)].first_sample;
            });
            const auto parts = join(segments);
            all.insert(all.end(), parts.begin(), parts.end());
        }
        separate_equal_ends(all);
        return build(all);
    }

private:
    const Vec3& position(int node) const { return network_.nodes[at(node)].position; }

    /// The node through which b continues a; -1: none that vanishes.
    int joint(int a, int b) const {
        const NetworkSegment &first = network_.segments[at(a)], &second = network_.segments[at(b)];
        const bool is_joint = first.nodes[1] == second.nodes[0] && ends_[at(first.nodes[1])] == 2 &&
                              first.nodes[0] != second.nodes[1] &&
                              first.last_sample == second.first_sample;
        return is_joint ? first.nodes[1] : -1;
    }

    double cost_of(int a, int b) const {
        constexpr double kNever = 1e9;
        const int node = joint(a, b);
        if (node < 0) return kNever;
        if (!kept_apart_.empty() && (kept_apart_[at(a)] || kept_apart_[at(b)])) return kNever;
        const Vec3 in = position(node) - position(network_.segments[at(a)].nodes[0]);
        const Vec3 out = position(network_.segments[at(b)].nodes[1]) - position(node);
        const double turn = std::atan2(in.cross(out).norm(), in.dot(out));
        if (turn > kMaxTurn || (in + out).norm() > longest_) return kNever;
        const double uneven = std::log(std::max(in.norm(), 1e-300) / std::max(out.norm(), 1e-300));
        return 0.5 * turn * turn / (kMaxTurn * kMaxTurn) + uneven * uneven;
    }

    std::vector<std::array<int, 2>> join(const std::vector<int>& segments) const {
        const std::size_t count = segments.size();
        std::vector<double> cost(count + 1, 0);
        std::vector<bool> is_pair(count + 1, false);
        for (std::size_t i = 1; i <= count; ++i) {
            cost[i] = cost[i - 1] + 1;
            if (i < 2) continue;
            const double joined = cost[i - 2] + cost_of(segments[i - 2], segments[i - 1]);
            is_pair[i] = joined < cost[i];
            cost[i] = std::min(cost[i], joined);
        }
        std::vector<std::array<int, 2>> parts;
        for (std::size_t i = count; i > 0; i -= is_pair[i] ? 2 : 1) {
            if (is_pair[i])
                parts.push_back({segments[i - 2], segments[i - 1]});
            else
                parts.push_back({segments[i - 1], -1});
        }
        std::reverse(parts.begin(), parts.end());
        return parts;
    }

    std::array<int, 2> ends(const std::array<int, 2>& parts) const {
        return {network_.segments[at(parts[0])].nodes[0],
                network_.segments[at(parts[1] < 0 ? parts[0] : parts[1])].nodes[1]};
    }

    /// An edge of a mesh is known by its ends: pairs that would share theirs come apart.
    void separate_equal_ends(std::vector<std::array<int, 2>>& all) const {
        std::map<std::pair<int, int>, int> count;
        for (const auto& parts : all) {
            const auto [a, b] = ends(parts);
            ++count[{std::min(a, b), std::max(a, b)}];
        }
        std::vector<std::array<int, 2>> result;
        for (const auto& parts : all) {
            const auto [a, b] = ends(parts);
            if (parts[1] >= 0 && count[{std::min(a, b), std::max(a, b)}] > 1) {
                result.push_back({parts[0], -1});
                result.push_back({parts[1], -1});
            } else {
                result.push_back(parts);
            }
        }
        all = std::move(result);
    }

    CoarseNetwork build(const std::vector<std::array<int, 2>>& all) const {
        CoarseNetwork result;
        result.network = network_;
        result.network.segments.clear();
        result.parts = all;
        for (const auto& [first, second] : all) {
            NetworkSegment segment = network_.segments[at(first)];
            result.middle.push_back(second < 0 ? -1 : segment.nodes[1]);
            if (second >= 0) {
                segment.nodes[1] = network_.segments[at(second)].nodes[1];
                segment.last_sample = network_.segments[at(second)].last_sample;
                segment.weight += network_.segments[at(second)].weight;
            }
            result.network.segments.push_back(segment);
        }
        return result;
    }

    const FeatureCurveNetwork& network_;
    double longest_;
    const std::vector<bool>& kept_apart_;
    std::vector<int> ends_;  ///< of segments, per node
};

}  // namespace

CoarseNetwork join_segments(const FeatureCurveNetwork& network, double longest,
                            const std::vector<bool>& kept_apart) {
    return Joiner(network, longest, kept_apart).run();
}

}  // namespace fcn
