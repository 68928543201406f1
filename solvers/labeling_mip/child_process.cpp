// A forked child and a pipe. Messages are framed by an 8-byte length. The child dies with its
// parent (PR_SET_PDEATHSIG) and never returns into the caller's stack: it ends by _exit.
#include "labeling_mip/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>

#include "labeling/errors.h"

namespace labeling {
namespace {

bool write_all(int pipe, const void* bytes, std::size_t size) {
    const char* at = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t written = ::write(pipe, at, size);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        at += written;
        size -= static_cast<std::size_t>(written);
    }
    return true;
}

[[noreturn]] void run_child(int pipe, const std::function<void(const ChildProcess::Send&)>& body) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::signal(SIGPIPE, SIG_IGN);
    ::signal(SIGINT, SIG_IGN);  // the parent decides what an interrupt means
    const int nowhere = ::open("/dev/null", O_RDWR);
    if (nowhere >= 0) {
        ::dup2(nowhere, STDIN_FILENO);
        ::dup2(nowhere, STDOUT_FILENO);
        ::dup2(nowhere, STDERR_FILENO);
    }
    try {
        body([pipe](std::span<const std::uint8_t> message) {
            const std::uint64_t size = message.size();
            return write_all(pipe, &size, sizeof size) &&
                   write_all(pipe, message.data(), message.size());
        });
    } catch (...) {
        ::_exit(1);
    }
    ::_exit(0);
}

}  // namespace

ChildProcess::ChildProcess(const std::function<void(const Send&)>& body) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) {
        throw LogicError(std::string("cannot make a pipe: ") + std::strerror(errno));
    }
    const pid_t child = ::fork();
    if (child < 0) {
        const std::string reason = std::strerror(errno);
        ::close(ends[0]);
        ::close(ends[1]);
        throw LogicError("cannot start a child process: " + reason);
    }
    if (child == 0) {
        ::close(ends[0]);
        run_child(ends[1], body);
    }
    ::close(ends[1]);
    process_ = child;
    pipe_ = ends[0];
}

ChildProcess::~ChildProcess() {
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        has_succeeded();
    }
    ::close(pipe_);
}

bool ChildProcess::has_succeeded() {
    if (process_ <= 0) return false;
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool ChildProcess::take(std::vector<std::uint8_t>& message) {
    std::uint64_t size = 0;
    if (buffer_.size() < sizeof size) return false;
    std::memcpy(&size, buffer_.data(), sizeof size);
    if (buffer_.size() - sizeof size < size) return false;
    const auto from = buffer_.begin() + sizeof size;
    message.assign(from, from + static_cast<std::ptrdiff_t>(size));
    buffer_.erase(buffer_.begin(), from + static_cast<std::ptrdiff_t>(size));
    return true;
}

ChildProcess::Event ChildProcess::wait(double seconds, std::vector<std::uint8_t>& message) {
    if (take(message)) return Event::Message;
    const int milliseconds = static_cast<int>(std::ceil(std::clamp(seconds, 0.0, 1e6) * 1000));
    pollfd waiting{pipe_, POLLIN, 0};
    if (::poll(&waiting, 1, milliseconds) <= 0) return Event::Timeout;
    std::uint8_t chunk[1 << 16];
    const ssize_t size = ::read(pipe_, chunk, sizeof chunk);
    if (size < 0) return errno == EINTR ? Event::Timeout : Event::Ended;
    if (size == 0) return Event::Ended;
    buffer_.insert(buffer_.end(), chunk, chunk + size);
    return take(message) ? Event::Message : Event::Timeout;
}

}  // namespace labeling
