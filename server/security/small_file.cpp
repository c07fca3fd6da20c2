#include "security/small_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "meniscus/error.hpp"

namespace meniscus::server {

std::string read_small_file(const std::string& path) {
    constexpr std::size_t limit = std::size_t{1} << 20;
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::string bytes(limit + 1, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file.is_open() || file.bad())
        throw InvalidInput(fmt::format("{} cannot be read: {}", path, std::strerror(errno)));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
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
