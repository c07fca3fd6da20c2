// One server at a time records in a folder: two would count each other's bytes, and offer each other's recordings.
#pragma once

#include <filesystem>

#include "process/unavailable.hpp"

namespace meniscus::server {

/// Another server records in the folder, one that ends perhaps.
struct FolderInUse : Unavailable {
    using Unavailable::Unavailable;
};

/// Held for as long as it lives; the system takes it back however the server ends.
class FolderLock {
public:
    /// Writes DIR/.meniscusd.lock. Throws FolderInUse if another server holds it, InvalidInput if it cannot be written.
    /// A file system without locks lets any number of servers in.
    explicit FolderLock(const std::filesystem::path& directory);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int descriptor_ = -1;
};

}  // namespace meniscus::server
