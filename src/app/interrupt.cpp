// std::stop_source::request_stop runs callbacks and takes locks, so no signal handler may call it.
// The signals are therefore blocked everywhere and waited for by a thread of their own, which is
// free to do both.

#include "app/interrupt.h"

#include <fmt/core.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "app/command.h"

namespace fcn::app {
namespace {

std::stop_source& source() {
    static std::stop_source instance;
    return instance;
}

std::atomic<int> nothing_to_finish{0};

[[noreturn]] void end_without_result() {
    fmt::print(stderr, "\nscalefcn: interrupted before there was a result\n");
    _exit(kNoResult);
}

void wait_for_signals(sigset_t signals) {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) return;
    if (nothing_to_finish > 0) end_without_result();
    fmt::print(stderr,
               "\nscalefcn: interrupted, finishing with the best result so far "
               "(once more to quit at once)\n");
    source().request_stop();
    if (sigwait(&signals, &signal) == 0) _exit(kKilled);
}

}  // namespace

void watch_for_interrupts() {
    source();  // constructed before any thread can ask for it
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread(wait_for_signals, signals).detach();
}

std::stop_token interrupt_token() { return source().get_token(); }

bool is_interrupted() { return source().stop_requested(); }

NothingToFinish::NothingToFinish() {
    ++nothing_to_finish;
    if (is_interrupted()) end_without_result();
}

NothingToFinish::~NothingToFinish() { --nothing_to_finish; }

}  // namespace fcn::app
