#include "publications/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "meniscus/error.hpp"

namespace meniscus::client {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ < 0)
        throw InvalidInput(folder.string() + ": cannot be opened: " + std::generic_category().message(errno));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(descriptor_);
    throw InvalidInput(folder.string() + ": another process publishes there: wait for it, or take another folder");
}

FolderLock::~FolderLock() {
    ::close(descriptor_);
}

}  // namespace meniscus::client
