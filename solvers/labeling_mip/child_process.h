#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace labeling {

/// Runs a function in a forked child and collects the messages it sends. The child writes nothing
/// to standard output or error and dies with its parent.
class ChildProcess {
public:
    /// The child's end: sends one message (any bytes). False when nobody listens any more.
    using Send = std::function<bool(std::span<const std::uint8_t>)>;

    /// Starts the child; `body` runs there and its return ends it.
    explicit ChildProcess(const std::function<void(const Send&)>& body);
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    /// Kills the child if it still runs.
    ~ChildProcess();

    enum class Event { Message, Timeout, Ended };
    /// Waits up to `seconds` for the next message; Ended when the child has closed its end.
    Event wait(double seconds, std::vector<std::uint8_t>& message);
    /// After Ended: whether the child's function returned (rather than crashed).
    bool has_succeeded();

private:
    bool take(std::vector<std::uint8_t>& message);

    int process_ = -1, pipe_ = -1;
    std::vector<std::uint8_t> buffer_;
};

}  // namespace labeling
