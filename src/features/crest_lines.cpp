// From pieces in faces to lines. Yoshizawa, Belyaev and Seidel (2005) filter connected components;
// a component can hold a strong line with weak ones hanging on it, so ours are filtered line by
// line: a line goes on through a fork where two of its ends continue each other.

#include "features/crest_lines.h"

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

constexpr double kStraightCosine = 0.70710678;  // 45 degrees
constexpr int kMostTwigRounds = 8;

/// Which pieces meet at a point, and which of them continue each other.
class Topology {
public:
    explicit Topology(const CrestGraph& graph) : graph_(graph) {
        at_.offsets.assign(graph.points.size() + 1, 0);
        for (const auto& piece : graph.pieces) {
            for (int p : piece) ++at_.offsets[p + 1];
        }
        for (std::size_t p = 0; p < graph.points.size(); ++p) at_.offsets[p + 1] += at_.offsets[p];
        at_.values.resize(at_.offsets.back());
        std::vector<int> next(at_.offsets.begin(), at_.offsets.end() - 1);
        for (std::size_t k = 0; k < graph.pieces.size(); ++k) {
            for (int p : graph.pieces[k]) at_.values[next[p]++] = static_cast<int>(k);
        }
    }

    int valence(int point) const { return at_.size(point); }
    const IndexRows& at() const { return at_; }

    int other(int piece, int point) const {
        const auto [a, b] = graph_.pieces[piece];
        return a == point ? b : a;
    }

    /// The points from `point` along `piece` up to where lines fork or end, or back to the start.
    CrestLine chain(int point, int piece) const {
        CrestLine line;
        line.points = {point};
        while (true) {
            line.pieces.push_back(piece);
            const int next = other(piece, line.points.back());
            line.points.push_back(next);
            if (valence(next) != 2 || next == point) break;
            const int* pair = at_.begin(next);
            piece = pair[0] == piece ? pair[1] : pair[0];
        }
        line.is_closed = line.points.front() == line.points.back();
        return line;
    }

    /// The piece that continues `piece` beyond `point`; -1 none.
    int continuation(int piece, int point) const {
        const int next = straightest(piece, point);
        return next >= 0 && straightest(next, point) == piece ? next : -1;
    }

private:
    /// Direction from a point along a piece, over about the neighbourhood's radius.
    Vec3 direction(int piece, int point) const {
        const Vec3 start = graph_.points[point].position;
        const double reach = 0.7 * graph_.points[point].radius;
        int at = point;
        Vec3 away = Vec3::Zero();
        while (true) {
            at = other(piece, at);
            away = graph_.points[at].position - start;
            if (away.norm() >= reach || valence(at) != 2 || at == point) break;
            const int* pair = at_.begin(at);
            piece = pair[0] == piece ? pair[1] : pair[0];
        }
        const double norm = away.norm();
        return norm > 0 ? Vec3(away / norm) : Vec3::Zero();
    }

    int straightest(int piece, int point) const {
        if (valence(point) == 2) {
            const int* pair = at_.begin(point);
            return pair[0] == piece ? pair[1] : pair[0];
        }
        const Vec3 in = -direction(piece, point);
        int best = -1;
        double best_cosine = kStraightCosine;
        for (const int* k = at_.begin(point); k != at_.end(point); ++k) {
            if (*k == piece) continue;
            const double cosine = in.dot(direction(*k, point));
            if (cosine <= best_cosine) continue;
            best = *k;
            best_cosine = cosine;
        }
        return best;
    }

    const CrestGraph& graph_;
    IndexRows at_;
};

}  // namespace

std::vector<CrestLine> crest_lines(const CrestGraph& graph) {
    const Topology topology(graph);
    std::vector<bool> is_used(graph.pieces.size(), false);
    std::vector<CrestLine> lines;
    const auto walk = [&](int point, int piece) {
        CrestLine line;
        line.points = {point};
        while (piece >= 0 && !is_used[piece]) {
            is_used[piece] = true;
            line.pieces.push_back(piece);
            line.points.push_back(topology.other(piece, line.points.back()));
            piece = topology.continuation(piece, line.points.back());
        }
        line.is_closed =
            piece >= 0 && piece == line.pieces.front() && line.points.front() == line.points.back();
        lines.push_back(std::move(line));
    };
    for (std::size_t k = 0; k < graph.pieces.size(); ++k) {
        for (int point : graph.pieces[k]) {
            if (is_used[k] || topology.continuation(static_cast<int>(k), point) >= 0) continue;
            walk(point, static_cast<int>(k));
        }
    }
    for (std::size_t k = 0; k < graph.pieces.size(); ++k) {
        if (!is_used[k]) walk(graph.pieces[k][0], static_cast<int>(k));
    }
    return lines;
}

void drop_pieces(CrestGraph& graph, const std::vector<bool>& is_dropped) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < graph.pieces.size(); ++k) {
        if (is_dropped[k]) continue;
        graph.pieces[kept] = graph.pieces[k];
        graph.piece_faces[kept++] = graph.piece_faces[k];
    }
    graph.pieces.resize(kept);
    graph.piece_faces.resize(kept);
}

void drop_twigs(CrestGraph& graph, double share) {
    for (int round = 0; round < kMostTwigRounds; ++round) {
        const Topology topology(graph);
        std::vector<bool> is_dropped(graph.pieces.size(), false);
        bool is_any = false;
        for (std::size_t p = 0; p < graph.points.size(); ++p) {
            const int point = static_cast<int>(p);
            if (topology.valence(point) < 3) continue;
            for (const int* k = topology.at().begin(point); k != topology.at().end(point); ++k) {
                const CrestLine chain = topology.chain(point, *k);
                const int last = chain.points.back();
                const double limit = share * graph.points[p].radius;
                const bool is_loose = topology.valence(last) == 1;
                const bool is_loop = last == point;
                if (!is_loose && !is_loop) continue;
                if (length_of(graph, chain) >= (is_loop ? 2 : 1) * limit) continue;
                for (int piece : chain.pieces) is_dropped[piece] = true;
                is_any = true;
            }
        }
        if (!is_any) return;
        drop_pieces(graph, is_dropped);
    }
}

Vec3 end_direction(const CrestGraph& graph, const CrestLine& line, int end, double reach) {
    const int count = static_cast<int>(line.points.size());
    const auto point = [&](int k) -> const Vec3& {
        return graph.points[line.points[end == 0 ? k : count - 1 - k]].position;
    };
    Vec3 away = Vec3::Zero();
    for (int k = 1; k < count; ++k) {
        away = point(0) - point(k);
        if (away.norm() >= reach) break;
    }
    const double norm = away.norm();
    return norm > 0 ? Vec3(away / norm) : Vec3::Zero();
}

double length_of(const CrestGraph& graph, const CrestLine& line) {
    double length = 0;
    for (std::size_t k = 1; k < line.points.size(); ++k) {
        length +=
            (graph.points[line.points[k]].position - graph.points[line.points[k - 1]].position)
                .norm();
    }
    return length;
}

}  // namespace fcn
