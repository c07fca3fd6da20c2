#include "recording/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "meniscus/error.hpp"
#include "process/log.hpp"

namespace meniscus::server {

namespace {

/// The lock's holder, for messages, by the process id that it has written.
std::string owner_in(int descriptor) {
    std::array<char, 64> text{};
    const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
    std::string owner(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    owner.resize(std::min(owner.size(), owner.find_first_not_of("0123456789")));
    return owner.empty() ? "another meniscusd" : "another meniscusd, process " + owner + ",";
}

void write_owner(int descriptor) {
    const std::string owner = std::to_string(::getpid()) + "\n";
    // It is for the words of a refusal alone.
    if (::ftruncate(descriptor, 0) != 0 || ::pwrite(descriptor, owner.data(), owner.size(), 0) < 0) return;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& directory) {
    const std::filesystem::path path = directory / ".meniscusd.lock";
    descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, S_IRUSR | S_IWUSR);
    if (descriptor_ < 0)
        throw InvalidInput(fmt::format("--record {}: {} cannot be opened: {}", directory.string(), path.string(),
                                       std::generic_category().message(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) {
        write_owner(descriptor_);
        return;
    }
    const int error = errno;
    if (error == EWOULDBLOCK) {
        const std::string owner = owner_in(descriptor_);
        ::close(descriptor_);
        throw FolderInUse(fmt::format("--record {}: {} records there: give each server a folder of its own",
                                      directory.string(), owner));
    }
    log_warning({}, "--record {}: its file system has no locks ({}): see that no other server records there",
                directory.string(), std::generic_category().message(error));
}

FolderLock::~FolderLock() {
    ::close(descriptor_);
}

}  // namespace meniscus::server
