#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "labeling/annealer.h"
#include "labeling/run_control.h"

namespace labeling {

/// Annealers that work in rounds, side by side where threads allow. What a lane does depends on
/// what it was given at the start of the round alone, and a round's work is shared out beforehand:
/// the outcome is the same on any number of threads, unless clock or stop token end it.
class SearchLanes {
public:
    using Task = std::function<void(Annealer&, std::size_t)>;

    /// May stop in a guard on `control`.
    SearchLanes(const SearchModel& model, const Solution& start, std::uint64_t seed,
                std::size_t lanes, int threads, RunControl& control);

    std::size_t size() const { return lanes_.size(); }
    Annealer& lane(std::size_t k) { return *lanes_[k]; }
    /// Runs `task` on the first `count` lanes; together they get what the caller has left.
    void run(std::size_t count, const Task& task);

private:
    RunControl& control_;
    int threads_;
    std::vector<std::unique_ptr<Annealer>> lanes_;
};

}  // namespace labeling
