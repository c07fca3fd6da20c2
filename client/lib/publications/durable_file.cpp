#include "publications/durable_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "meniscus/error.hpp"

namespace meniscus::client {
namespace {

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

private:
    int number_;
};

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
    throw std::runtime_error(path.string() + ": writing failed: " + std::generic_category().message(error));
}

void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(path, errno);
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

/// The names in it.
void sync_folder_of(const std::filesystem::path& path) {
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.number() < 0) fail(folder, errno);
    // Some file systems of networks sync no folders.
    if (::fsync(opened.number()) != 0 && errno != EINVAL && errno != ENOTSUP) fail(folder, errno);
}

}  // namespace

void write_durably(const std::filesystem::path& path, std::string_view bytes) {
    std::filesystem::path beside = path;
    beside += ".partial";
    {
        const Descriptor file(::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
        if (file.number() < 0) fail(path, errno);
        write_all(file.number(), bytes, path);
        if (::fsync(file.number()) != 0) fail(path, errno);
    }
    std::error_code error;
    std::filesystem::rename(beside, path, error);
    if (error) fail(path, error.value());
    sync_folder_of(path);
}

std::string read_whole(const std::filesystem::path& path, std::uint64_t most) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InvalidInput(path.string() + ": no such file");
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    // Of the file that is open: by now a writer may have put another one in its place.
    const std::streamoff size = in.tellg();
    if (size < 0) throw InvalidInput(path.string() + ": cannot be read");
    if (static_cast<std::uint64_t>(size) > most)
        throw InvalidInput(path.string() + ": it has " + std::to_string(size) + " bytes; at most " +
                           std::to_string(most) + " are expected");
    std::string bytes(static_cast<std::size_t>(size), '\0');
    in.seekg(0);
    if (!in.read(bytes.data(), size)) throw InvalidInput(path.string() + ": cannot be read");
    return bytes;
}

}  // namespace meniscus::client
