// std::stop_source::request_stop runs callbacks and takes locks, so no signal handler may call it.
// The signals are therefore blocked everywhere and waited for by a thread of their own, which is
// free to do both.

#include "app/interrupt.h"

#include <fmt/core.h>
#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "app/command.h"

namespace fcn::app {
namespace {

std::stop_source& source() {
    static std::stop_source instance;
    return instance;
}

void wait_for_signals(sigset_t signals) {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) return;
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

}  // namespace fcn::app
