#include "network/written_network.h"

namespace fcn {
namespace {

class Flattening {
public:
    Flattening(const FeatureCurveNetwork& network, NetworkDetail detail) : network_(network) {
        out_.has_segments = detail == NetworkDetail::Segments && !network.segments.empty();
        point_of_.assign(network.nodes.size(), -1);
        valences_ = network.valences();
        segments_of_.resize(network.arcs.size());
        for (std::size_t s = 0; s < network.segments.size(); ++s)
            segments_of_[network.segments[s].arc].push_back(static_cast<int>(s));
    }

    WrittenNetwork run() {
        for (const NetworkArc& arc : network_.arcs)
            for (int node : arc.nodes) point_at_node(node);
        for (std::size_t a = 0; a < network_.arcs.size(); ++a) {
            const NetworkArc& arc = network_.arcs[a];
            WrittenNetwork::Arc written;
            written.is_pinned = arc.pin == Pin::Keep;
            written.kind = arc.kind;
            out_.has_segments ? add_segments(a, written) : add_samples(a, written);
            out_.arcs.push_back(std::move(written));
        }
        out_.dropped = network_.dropped;
        return std::move(out_);
    }

private:
    int add_point(const Vec3& position, const SurfacePoint& surface, int valence) {
        out_.points.push_back(position);
        out_.surfaces.push_back(surface);
        out_.valences.push_back(valence);
        return static_cast<int>(out_.points.size()) - 1;
    }

    int point_at_node(int node) {
        if (point_of_[node] < 0)
            point_of_[node] = add_point(network_.nodes[node].position, network_.nodes[node].surface,
                                        valences_[node]);
        return point_of_[node];
    }

    void add_segments(std::size_t a, WrittenNetwork::Arc& written) {
        written.points.push_back(point_at_node(network_.arcs[a].nodes[0]));
        for (int s : segments_of_[a]) {
            written.points.push_back(point_at_node(network_.segments[s].nodes[1]));
            written.weights.push_back(network_.segments[s].weight);
            written.segments.push_back(s);
        }
    }

    void add_samples(std::size_t a, WrittenNetwork::Arc& written) {
        const NetworkArc& arc = network_.arcs[a];
        const std::size_t last = arc.samples.size() - 1;
        written.points.push_back(point_at_node(arc.nodes[0]));
        for (std::size_t s = 1; s < last; ++s)
            written.points.push_back(add_point(arc.samples[s].position, arc.samples[s].surface, 0));
        written.points.push_back(point_at_node(arc.nodes[1]));
        written.weights.assign(last, 0.0);
        written.segments.assign(last, -1);
        for (int s : segments_of_[a])
            for (int k = network_.segments[s].first_sample; k < network_.segments[s].last_sample;
                 ++k) {
                written.weights[k] = network_.segments[s].weight;
                written.segments[k] = s;
            }
    }

    const FeatureCurveNetwork& network_;
    WrittenNetwork out_;
    std::vector<int> point_of_;  ///< per node
    std::vector<int> valences_;
    std::vector<std::vector<int>> segments_of_;
};

}  // namespace

std::size_t WrittenNetwork::edge_count() const {
    std::size_t count = 0;
    for (const Arc& arc : arcs) count += arc.weights.size();
    return count;
}

WrittenNetwork polylines_to_write(const FeatureCurveNetwork& network, NetworkDetail detail) {
    return Flattening(network, detail).run();
}

}  // namespace fcn
