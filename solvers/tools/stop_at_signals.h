#pragma once

#include <pthread.h>

#include <csignal>
#include <cstdlib>
#include <stop_token>
#include <thread>

namespace labeling {

/// The first SIGINT or SIGTERM requests a stop; the next one ends the program. Call once, before
/// any other thread starts: threads inherit the mask. A thread of its own waits, since no signal
/// handler may request a stop.
inline std::stop_token stop_at_signals() {
    static std::stop_source source;
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([signals] {
        int signal = 0;
        if (sigwait(&signals, &signal) != 0) return;
        source.request_stop();
        if (sigwait(&signals, &signal) == 0) std::_Exit(128 + signal);
    }).detach();
    return source.get_token();
}

}  // namespace labeling
