#pragma once

#include <stop_token>

namespace fcn::app {

/// Makes Ctrl-C (SIGINT) and SIGTERM request a stop instead of ending the process; a second one
/// ends it at once. Call once, first thing in main: threads started later inherit the mask.
void watch_for_interrupts();

/// Requested by the first Ctrl-C or SIGTERM.
std::stop_token interrupt_token();

bool is_interrupted();

}  // namespace fcn::app
