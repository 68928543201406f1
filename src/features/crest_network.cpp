// Crest lines become arcs between the points where lines end, fork or meet a crease. Which arcs are
// one curve is known here: they belong to one line. Arcs say so by the patch id of their line, in
// both places, since supporting curves follow what borders the same patch.
//
// A line that visits every mesh edge on a noisy surface goes up and down with its vertices: with a
// quarter of an edge of noise it is 7% too long, though it lies right on average. So samples are
// spaced by a share of the radius of the fits there: nothing finer was seen by them anyway.

#include "features/crest_network.h"

#include <algorithm>

namespace fcn {
namespace {

constexpr std::size_t kFewPoints = 40;  // in a loop

class ArcBuilder {
public:
    ArcBuilder(const CrestGraph& graph, const std::vector<int>& node_of_vertex, double spacing,
               FeatureCurveNetwork& network)
        : graph_(graph),
          node_of_vertex_(node_of_vertex),
          spacing_(spacing),
          network_(network),
          valence_(graph.points.size(), 0),
          node_of_point_(graph.points.size(), -1) {
        for (const auto& piece : graph.pieces) {
            for (int p : piece) ++valence_[p];
        }
    }

    void add(const CrestLine& line, const std::string& source, int patch) {
        std::vector<int> points = line.points;
        if (line.is_closed) start_at_node(points);
        NetworkArc arc;
        arc.source = source;
        arc.patches = {patch, patch};
        arc.nodes[0] = node(points.front());
        arc.samples = {sample(points.front())};
        for (std::size_t k = 1; k < points.size(); ++k) {
            const bool is_end = k + 1 == points.size() || is_node(points[k]);
            if (!is_end && is_close(arc, points, k)) continue;
            arc.samples.push_back(sample(points[k]));
            if (!is_end) continue;
            arc.nodes[1] = node(points[k]);
            if (!arc.is_closed() || arc.samples.size() >= 4) network_.arcs.push_back(arc);
            arc.nodes[0] = arc.nodes[1];
            arc.samples = {sample(points[k])};
        }
    }

private:
    int barrier_node(int point) const {
        const int vertex = graph_.points[point].vertex;
        return vertex >= 0 ? node_of_vertex_[vertex] : -1;
    }

    bool is_node(int point) const { return valence_[point] != 2 || barrier_node(point) >= 0; }

    void start_at_node(std::vector<int>& points) const {
        const auto found =
            std::find_if(points.begin(), points.end(), [&](int p) { return is_node(p); });
        if (found == points.end()) return;
        points.pop_back();
        std::rotate(points.begin(), found, points.end());
        points.push_back(points.front());
    }

    /// Closer to the sample before than the spacing, which a loop of few samples does not keep?
    bool is_close(const NetworkArc& arc, const std::vector<int>& points, std::size_t k) const {
        const CrestPoint& point = graph_.points[points[k]];
        const double distance = (point.position - arc.samples.back().position).norm();
        const bool is_short = points.front() == points.back() && points.size() < kFewPoints;
        return !is_short && distance < spacing_ * point.radius;
    }

    int node(int point) {
        int& id = node_of_point_[point];
        if (id < 0) id = barrier_node(point);
        if (id < 0) {
            id = static_cast<int>(network_.nodes.size());
            network_.nodes.push_back({graph_.points[point].position, graph_.points[point].surface});
        }
        return id;
    }

    ArcSample sample(int point) const {
        const int known = node_of_point_[point] >= 0 ? node_of_point_[point] : -1;
        if (known >= 0) return {network_.nodes[known].position, network_.nodes[known].surface};
        return {graph_.points[point].position, graph_.points[point].surface};
    }

    const CrestGraph& graph_;
    const std::vector<int>& node_of_vertex_;
    double spacing_;
    FeatureCurveNetwork& network_;
    std::vector<int> valence_;
    std::vector<int> node_of_point_;
};

}  // namespace

int add_crest_arcs(const CrestGraph& graph, const std::vector<int>& node_of_vertex,
                   const std::string& source, int first_line, double spacing,
                   FeatureCurveNetwork& network) {
    ArcBuilder builder(graph, node_of_vertex, spacing, network);
    for (const CrestLine& line : crest_lines(graph)) builder.add(line, source, first_line++);
    return first_line;
}

}  // namespace fcn
