#pragma once

#include <stop_token>

namespace fcn::app {

/// Makes Ctrl-C (SIGINT) and SIGTERM request a stop instead of ending the process; a second one
/// ends it at once. Call once, first thing in main: threads started later inherit the mask.
void watch_for_interrupts();

/// Requested by the first Ctrl-C or SIGTERM.
std::stop_token interrupt_token();

bool is_interrupted();

/// While one lives (a file is read before anything is made of it) there is nothing to finish: the
/// first Ctrl-C ends the process at once, with kNoResult.
class NothingToFinish {
public:
    NothingToFinish();
    ~NothingToFinish();
    NothingToFinish(const NothingToFinish&) = delete;
    NothingToFinish& operator=(const NothingToFinish&) = delete;
};

}  // namespace fcn::app
