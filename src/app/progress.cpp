#include "app/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace fcn::app {
namespace {
constexpr int kBarWidth = 24;
}

ProgressBar::ProgressBar(bool is_wanted) : is_drawing_(is_wanted && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::show(const std::string& what, double fraction) {
    if (!is_drawing_) return;
    const std::lock_guard lock(mutex_);
    const double share = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
    const int percent = static_cast<int>(share * 100);
    if (has_line_ && percent == last_percent_ && what == last_what_) return;
    last_percent_ = percent;
    last_what_ = what;
    has_line_ = true;
    const int filled = static_cast<int>(share * kBarWidth);
    fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:3}% {}", "", filled, "", kBarWidth - filled,
               percent, what);
    std::fflush(stderr);
}

void ProgressBar::clear() {
    const std::lock_guard lock(mutex_);
    if (!has_line_) return;
    fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
    has_line_ = false;
}

}  // namespace fcn::app
