#include "network/network.h"

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

}  // namespace fcn
