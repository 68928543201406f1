// The last step of a wire: its points slide along their edges to where the path is cheapest. A
// dynamic program chooses among a few places on each edge, in windows that shrink around the last
// choice; moving points one by one would need as many rounds as the path has points, squared.

#include <algorithm>
#include <cmath>

#include "features/path_labels.h"
#include "features/wire_search.h"

namespace fcn {
namespace {

constexpr int kPlaces = 9;  ///< on each edge
constexpr int kSlides = 14;
constexpr double kFirstWindow = 0.25;  ///< to either side, of the edge
constexpr double kShrinking = 0.6;
constexpr double kMargin = 1e-9;  ///< from the ends of an edge

/// Places of one point of the path, each with its best cost from the start.
struct Stop {
    std::vector<WirePoint> places;
    std::vector<double> costs;
    std::vector<int> before;
};

}  // namespace

void WireSearch::tighten(WirePath& path) const {
    const int count = static_cast<int>(path.points.size());
    std::vector<int> faces;
    for (int i = 1; i < count; ++i)
        faces.push_back(common_face(path.points[i - 1], path.points[i]));
    double window = kFirstWindow;
    for (int slide = 0; slide < kSlides; ++slide, window *= kShrinking) {
        std::vector<Stop> stops(count);
        for (int i = 0; i < count; ++i) {
            const WirePoint& p = path.points[i];
            Stop& stop = stops[i];
            stop.places = {p};
            for (int k = 0; i > 0 && i + 1 < count && p.edge >= 0 && k < kPlaces; ++k) {
                const double t = p.t + window * (2.0 * k / (kPlaces - 1) - 1);
                if (k != kPlaces / 2 && t > kMargin && t < 1 - kMargin)
                    stop.places.push_back(on_edge(p.edge, t));
            }
            stop.costs.assign(stop.places.size(), i == 0 ? 0 : kUnreached);
            stop.before.assign(stop.places.size(), 0);
            for (std::size_t k = 0; i > 0 && k < stop.places.size(); ++k) {
                const Stop& last = stops[i - 1];
                for (std::size_t j = 0; j < last.places.size(); ++j) {
                    const double cost =
                        last.costs[j] + step(faces[i - 1], last.places[j], stop.places[k]);
                    if (cost >= stop.costs[k]) continue;
                    stop.costs[k] = cost;
                    stop.before[k] = static_cast<int>(j);
                }
            }
        }
        path.cost = stops[count - 1].costs[0];
        for (int i = count - 1, k = 0; i > 0; --i) {
            path.points[i] = stops[i].places[k];
            k = stops[i].before[k];
        }
    }
    path.length = 0;
    for (int i = 1; i < count; ++i)
        path.length += (path.points[i].position - path.points[i - 1].position).norm();
}

}  // namespace fcn
