#pragma once

#include <pthread.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <stop_token>
#include <thread>

namespace labeling {

/// While it is true, there is nothing that a stop could save: the first SIGINT or SIGTERM ends the
/// program, with exit code 4.
inline std::atomic<bool>& has_nothing_to_save() {
    static std::atomic<bool> flag{false};
    return flag;
}

/// The first SIGINT or SIGTERM requests a stop; the next one ends the program, unless it is one
/// that has to clean up: a signal that is told by the kernel when a parent dies comes once for each
/// of the parent's threads. Call once, before any other thread starts: threads inherit the mask. A
/// thread of its own waits, since no signal handler may request a stop.
inline std::stop_token stop_at_signals(bool has_to_clean_up = false) {
    static std::stop_source source;
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([signals, has_to_clean_up] {
        int signal = 0;
        if (sigwait(&signals, &signal) != 0) return;
        if (has_nothing_to_save()) std::_Exit(4);
        source.request_stop();
        while (has_to_clean_up) sigwait(&signals, &signal);
        if (sigwait(&signals, &signal) == 0) std::_Exit(128 + signal);
    }).detach();
    return source.get_token();
}

}  // namespace labeling
