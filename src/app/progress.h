#pragma once

#include <mutex>
#include <string>

namespace fcn::app {

/// One line that is redrawn on a terminal; silent when standard error is anything else.
class ProgressBar {
public:
    explicit ProgressBar(bool is_wanted = true);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// `fraction` in [0, 1]. May be called from any thread.
    void show(const std::string& what, double fraction);
    /// Takes the line away, so that other text can be printed.
    void clear();

private:
    bool is_drawing_;
    bool has_line_ = false;
    int last_percent_ = -1;
    std::string last_what_;
    std::mutex mutex_;
};

}  // namespace fcn::app
