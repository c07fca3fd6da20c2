#include "files/random_access_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "files/writing_mark.hpp"
#include "meniscus/error.hpp"

namespace meniscus::files {

RandomAccessFile::RandomAccessFile(std::filesystem::path path) : path_(std::move(path)) {
    // Without O_NONBLOCK a named pipe would wait for its writer.
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0) fail("cannot be opened for reading: " + std::generic_category().message(errno));
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
        size_ = static_cast<std::uint64_t>(status.st_size);
        return;
    }
    ::close(descriptor_);
    fail("not a regular file");
}

RandomAccessFile::~RandomAccessFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

RandomAccessFile::RandomAccessFile(RandomAccessFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

RandomAccessFile& RandomAccessFile::operator=(RandomAccessFile&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(descriptor_, other.descriptor_);
    std::swap(size_, other.size_);
    return *this;
}

bool RandomAccessFile::being_written() const noexcept {
    return is_being_written(descriptor_);
}

bool RandomAccessFile::is_closed() const noexcept {
    return is_closed_by_its_writer(descriptor_);
}

std::string RandomAccessFile::read(std::uint64_t first, std::size_t size) const {
    std::string bytes(size, '\0');
    std::size_t filled = 0;
    while (filled < size) {
        const ssize_t got =
            ::pread(descriptor_, bytes.data() + filled, size - filled, static_cast<off_t>(first + filled));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail("cannot be read: " + std::generic_category().message(errno));
        if (got == 0) fail("ends at byte " + std::to_string(first + filled) + ": it has been cut while it was read");
        filled += static_cast<std::size_t>(got);
    }
    return bytes;
}

void RandomAccessFile::fail(const std::string& message) const {
    throw InvalidInput(path_.string() + ": " + message);
}

}  // namespace meniscus::files
