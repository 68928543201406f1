#include "labeling/search_lanes.h"

#include "labeling/side_by_side.h"

namespace labeling {

SearchLanes::SearchLanes(const SearchModel& model, const Solution& start, std::uint64_t seed,
                         std::size_t lanes, int threads, RunControl& control)
    : control_(control), threads_(threads) {
    for (std::size_t k = 0; k < lanes; ++k) {
        lanes_.push_back(
            std::make_unique<Annealer>(model, start, seed * 1000003 + k, PassGuard(control)));
    }
}

void SearchLanes::run(std::size_t count, const Task& task) {
    const auto share = control_.work_left() / static_cast<std::int64_t>(count) + 1;
    std::int64_t before = 0, after = 0;
    for (std::size_t k = 0; k < count; ++k) before += lanes_[k]->work();
    run_side_by_side(count, threads_, control_, [&](std::size_t k, const StopQuestion& is_stopped) {
        lanes_[k]->allow(share, is_stopped);
        task(*lanes_[k], k);
    });
    for (std::size_t k = 0; k < count; ++k) after += lanes_[k]->work();
    control_.spend(after - before);
}

}  // namespace labeling
