#include "experiment/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "labeling/errors.h"

namespace experiment {

FolderLock::FolderLock(const std::filesystem::path& folder) {
    const std::string name = (folder / "lock").string();
    file_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throw labeling::InputError(name + ": " + std::strerror(errno));
    if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
    const int reason = errno;
    ::close(file_);
    if (reason != EWOULDBLOCK) throw labeling::InputError(name + ": " + std::strerror(reason));
    throw labeling::InputError(folder.string() + ": another runner is at work in this folder");
}

FolderLock::~FolderLock() { ::close(file_); }

}  // namespace experiment
