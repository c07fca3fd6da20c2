// Holds a folder against other writers, until it is destroyed or the process ends.
#pragma once

#include <filesystem>

namespace meniscus::client {

class FolderLock {
public:
    /// Throws InvalidInput if another writer holds it, or if the folder cannot be opened. A file system without locks
    /// holds nothing.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int descriptor_;
};

}  // namespace meniscus::client
