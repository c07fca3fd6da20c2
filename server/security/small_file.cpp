#include "security/small_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

class File {
public:
    explicit File(int descriptor) : descriptor_(descriptor) {}
    ~File() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    int get() const noexcept { return descriptor_; }

private:
    const int descriptor_;
};

}  // namespace

std::string read_small_file(const std::string& path) {
    constexpr std::size_t limit = std::size_t{1} << 20;
    const auto fail = [&path](int error) -> InvalidInput {
        return InvalidInput(fmt::format("{} cannot be read: {}", path, std::strerror(error)));
    };
    // A pipe in the file's place must keep nobody waiting.
    const File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat status {};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0) throw fail(errno);
    if (S_ISDIR(status.st_mode)) throw fail(EISDIR);
    if (!S_ISREG(status.st_mode))
        throw InvalidInput(fmt::format("{} cannot be read: it is no file, but a device, a pipe or a socket", path));
    std::string bytes(limit + 1, '\0');
    std::size_t size = 0;
    while (size < bytes.size()) {
        const ssize_t count = ::read(file.get(), bytes.data() + size, bytes.size() - size);
        if (count < 0) throw fail(errno);
        if (count == 0) break;
        size += static_cast<std::size_t>(count);
    }
    bytes.resize(size);
    if (bytes.size() > limit) throw InvalidInput(fmt::format("{} has more than {} bytes", path, limit));
    return bytes;
}

void require_private(const std::string& path) {
    using std::filesystem::perms;
    std::error_code error;
    const perms mode = std::filesystem::status(path, error).permissions();
    if (error) throw InvalidInput(fmt::format("{} cannot be read: {}", path, error.message()));
    if ((mode & (perms::others_read | perms::others_write)) != perms::none)
        throw InvalidInput(
            fmt::format("{} holds secrets, and everyone may read or write it: chmod 600 {}", path, path));
}

}  // namespace meniscus::server
