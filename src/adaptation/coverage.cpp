#include "adaptation/coverage.h"

#include <algorithm>

#include "adaptation/box_grid.h"
#include "adaptation/conflicts.h"

namespace fcn {

double measure_coverage(const std::vector<CoverageSample>& samples,
                        const FeatureCurveNetwork& network, double reach) {
    std::vector<BoxGrid::Box> boxes;
    for (const NetworkSegment& segment : network.segments) {
        boxes.push_back(BoxGrid::around(network.nodes[segment.nodes[0]].position,
                                        network.nodes[segment.nodes[1]].position, 0));
    }
    const BoxGrid grid(boxes, 2 * reach);
    std::vector<int> near;
    double total = 0, covered = 0;
    for (const CoverageSample& sample : samples) {
        total += sample.worth;
        grid.find(BoxGrid::around(sample.position, sample.position, reach), near);
        const bool is_covered = std::ranges::any_of(near, [&](int s) {
            const NetworkSegment& segment = network.segments[s];
            return segment_distance(sample.position, sample.position,
                                    network.nodes[segment.nodes[0]].position,
                                    network.nodes[segment.nodes[1]].position)
                       .distance <= reach;
        });
        if (is_covered) covered += sample.worth;
    }
    return total > 0 ? covered / total : 1.0;
}

}  // namespace fcn
