// One server at a time records in a folder: two would count each other's bytes, and offer each other's recordings.
#pragma once

#include <filesystem>

namespace meniscus::server {

/// Held for as long as it lives; the system takes it back however the server ends.
class FolderLock {
public:
    /// Writes DIR/.meniscusd.lock. Throws InvalidInput if another server holds it, or it cannot be written. A file
    /// system without locks lets any number of servers in.
    explicit FolderLock(const std::filesystem::path& directory);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int descriptor_ = -1;
};

}  // namespace meniscus::server
