#include "labeling/search_lanes.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace labeling {
namespace {

constexpr std::chrono::milliseconds kPollInterval{20};

}  // namespace

SearchLanes::SearchLanes(const SearchModel& model, const Solution& start, std::uint64_t seed,
                         std::size_t lanes, int threads, RunControl& control)
    : control_(control), threads_(threads) {
    for (std::size_t k = 0; k < lanes; ++k) {
        lanes_.push_back(std::make_unique<Annealer>(model, start, seed * 1000003 + k));
    }
}

void SearchLanes::run(std::size_t count, const Task& task) {
    const auto share = control_.work_left() / static_cast<std::int64_t>(count) + 1;
    std::int64_t before = 0, after = 0;
    for (std::size_t k = 0; k < count; ++k) before += lanes_[k]->work();
    if (threads_ > 1 && count > 1) {
        run_in_threads(count, share, task);
    } else {
        for (std::size_t k = 0; k < count; ++k) {
            lanes_[k]->allow(share, [this] {
                control_.check();
                return control_.is_over();
            });
            task(*lanes_[k], k);
        }
    }
    for (std::size_t k = 0; k < count; ++k) after += lanes_[k]->work();
    control_.spend(after - before);
}

/// The calling thread watches clock and stop token, the others share the lanes.
void SearchLanes::run_in_threads(std::size_t count, std::int64_t share, const Task& task) {
    std::atomic<bool> is_stopped{false};
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::condition_variable changed;
    std::size_t running = std::min(count, static_cast<std::size_t>(threads_));
    std::exception_ptr error;
    for (std::size_t k = 0; k < count; ++k) {
        lanes_[k]->allow(share, [&is_stopped] { return is_stopped.load(); });
    }
    auto work = [&] {
        try {
            for (std::size_t k = next++; k < count; k = next++) task(*lanes_[k], k);
        } catch (...) {
            const std::lock_guard lock(mutex);
            error = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        --running;
        changed.notify_one();
    };
    std::vector<std::jthread> threads;
    for (std::size_t k = running; k > 0; --k) threads.emplace_back(work);
    {
        std::unique_lock lock(mutex);
        while (!changed.wait_for(lock, kPollInterval, [&] { return running == 0; })) {
            control_.check();
            if (control_.is_over()) is_stopped = true;
        }
    }
    threads.clear();
    if (error) std::rethrow_exception(error);
}

}  // namespace labeling
