// Disks of one size thrown into a square whose side makes the mean degree what was asked for, up to
// the border: two are in conflict when their centres are closer than 1. Neighbours are looked for
// in a grid of unit cells.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "labeling/generators.h"
#include "labeling/random.h"

namespace labeling {

GeneratedProblem unit_disks(const UnitDiskOptions& options) {
    Random random(options.seed);
    ProblemBuilder builder;
    const double count = options.labels;
    const double side = std::sqrt(count * std::numbers::pi / std::max(1e-3, options.degree));
    struct Point {
        double x = 0, y = 0;
    };
    std::vector<Point> points(options.labels);
    std::map<std::pair<int, int>, std::vector<Label>> cells;
    for (Label i = 0; i < options.labels; ++i) {
        Point& p = points[i];
        p.x = side * random.unit();
        p.y = side * random.unit();
        builder.add_label(1 + random.below(1000));
        const int column = static_cast<int>(p.x), row = static_cast<int>(p.y);
        for (int c = column - 1; c <= column + 1; ++c) {
            for (int r = row - 1; r <= row + 1; ++r) {
                const auto cell = cells.find({c, r});
                if (cell == cells.end()) continue;
                for (Label j : cell->second) {
                    if (std::hypot(p.x - points[j].x, p.y - points[j].y) < 1) {
                        builder.add_conflict(j, i);
                    }
                }
            }
        }
        cells[{column, row}].push_back(i);
    }
    return {builder.build(), std::nullopt};
}

}  // namespace labeling
