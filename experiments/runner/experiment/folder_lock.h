#pragma once

#include <filesystem>

namespace experiment {

/// One runner for one folder. Held until the object, or the process, ends.
class FolderLock {
public:
    /// Throws InputError when another process holds it.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int file_ = -1;
};

}  // namespace experiment
