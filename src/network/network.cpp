#include "network/network.h"

#include "network/drop_unused_nodes.h"

namespace fcn {

double NetworkArc::length() const {
    double sum = 0;
    for (std::size_t i = 1; i < samples.size(); ++i)
        sum += (samples[i].position - samples[i - 1].position).norm();
    return sum;
}

double FeatureCurveNetwork::total_length() const {
    double sum = 0;
    for (const NetworkArc& arc : arcs) sum += arc.length();
    return sum;
}

std::vector<int> FeatureCurveNetwork::valences() const {
    std::vector<int> valence(nodes.size(), 0);
    for (const NetworkArc& arc : arcs)
        for (int node : arc.nodes)
            if (node >= 0 && node < static_cast<int>(nodes.size())) ++valence[node];
    return valence;
}

void drop_unused_nodes(FeatureCurveNetwork& network) {
    std::vector<int> number(network.nodes.size(), -1);
    for (const NetworkArc& arc : network.arcs)
        for (int node : arc.nodes) number[node] = 0;
    for (const NetworkSegment& segment : network.segments)
        for (int node : segment.nodes) number[node] = 0;
    int count = 0;
    for (std::size_t n = 0; n < number.size(); ++n) {
        if (number[n] < 0) continue;
        network.nodes[count] = network.nodes[n];
        number[n] = count++;
    }
    network.nodes.resize(count);
    for (NetworkArc& arc : network.arcs)
        for (int& node : arc.nodes) node = number[node];
    for (NetworkSegment& segment : network.segments)
        for (int& node : segment.nodes) node = number[node];
}

}  // namespace fcn
