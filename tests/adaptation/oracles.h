#pragma once

#include <array>
#include <set>
#include <utility>
#include <vector>

#include "geometry/mesh.h"

namespace fcn::test {

// Brute-force answers to what the adaptation computes cleverly, written from the paper's text and
// the design decisions alone. They share no code with the adaptation and know only plain arrays.

/// Where a chain may use one segment longer than rmax.
enum class LongSegment { Nowhere, AtAnEnd, Anywhere };

struct ChainQuestion {
    std::vector<Vec3> points;  ///< chain from the first to the last
    double rmin = 1, rmax = 1.5;
    double evenness = 0;  ///< factor of ((length - sqrt(rmin rmax)) / rmin)^2 per segment
    int min_segments = 1;
    LongSegment long_segment = LongSegment::Nowhere;  ///< exactly one, unless Nowhere
};

struct ChainAnswer {
    bool exists = false;
    double cost = 0;  ///< integral deviation / rmin^2 plus evenness
    std::vector<int> chain;
    long tried = 0;  ///< complete chains that were compared
};

/// Best of all subsets of the points that contain both ends. Exponential.
ChainAnswer best_chain(const ChainQuestion& question);

/// Cost of a given chain, however long its segments.
double chain_cost(const ChainQuestion& question, const std::vector<int>& chain);

/// Integral of the distance to the chord along points[first..last], trapezoidal rule.
double deviation(const std::vector<Vec3>& points, int first, int last);

/// A network of straight segments, as the conflict rules see it.
struct PlainNetwork {
    std::vector<Vec3> points;
    std::vector<std::array<int, 2>> segments;

    double length(int segment) const;
    int valence(int point) const;
    bool share_point(int e, int f) const;
};

/// Random network in a box: segments of lengths between `low` and `high` that often continue or
/// branch from earlier ones, plus crossings and close passes.
PlainNetwork random_network(std::uint64_t seed, int segment_count, double box, bool is_planar,
                            double low, double high);

struct ConflictQuestion {
    PlainNetwork network;
    double rmin = 1, ratio = 1.5;
    bool is_quad = false;
    bool is_best_mode = true;
};

struct ConflictAnswer {
    std::set<std::pair<int, int>> conflicts;         ///< segments
    std::set<std::pair<int, int>> vertex_conflicts;  ///< extraordinary nodes
    /// Pairs for which some comparison is within 1e-5 of its limit: either answer is right.
    std::set<std::pair<int, int>> doubtful;
    std::set<std::pair<int, int>> doubtful_nodes;
};

/// All pairs, by the rules of DESIGN 4.2 (paper mode) and 4.3 (best mode). Segments shorter than
/// rmin are short edges: segments that they join count as adjacent; in best mode whole clusters of
/// them do (where the ends that meet the cluster are closer than rmin), and pairs with a short
/// segment are only held to the distance h.
ConflictAnswer all_conflicts(const ConflictQuestion& question);

/// Distance of two segments by ternary search; parameters in [0, 1].
struct NumericDistance {
    double distance = 0, s = 0, t = 0;
};
NumericDistance numeric_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

}  // namespace fcn::test
