#include "labeling/side_by_side.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace labeling {
namespace {

constexpr std::chrono::milliseconds kPollInterval{20};

}  // namespace

void run_side_by_side(std::size_t count, int threads, RunControl& control,
                      const std::function<void(std::size_t, const StopQuestion&)>& task) {
    if (threads <= 1 || count <= 1) {
        const StopQuestion is_over = [&control] {
            control.check();
            return control.is_over();
        };
        for (std::size_t k = 0; k < count; ++k) task(k, is_over);
        return;
    }
    std::atomic<bool> is_stopped{false};
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::condition_variable changed;
    std::size_t running = std::min(count, static_cast<std::size_t>(threads));
    std::exception_ptr error;
    const StopQuestion question = [&is_stopped] { return is_stopped.load(); };
    auto work = [&] {
        try {
            for (std::size_t k = next++; k < count; k = next++) task(k, question);
        } catch (...) {
            const std::lock_guard lock(mutex);
            error = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        --running;
        changed.notify_one();
    };
    std::vector<std::jthread> workers;
    for (std::size_t k = running; k > 0; --k) workers.emplace_back(work);
    {
        std::unique_lock lock(mutex);
        while (!changed.wait_for(lock, kPollInterval, [&] { return running == 0; })) {
            control.check();
            if (control.is_over()) is_stopped = true;
        }
    }
    workers.clear();
    if (error) std::rethrow_exception(error);
}

}  // namespace labeling
