#include "formats/bytes/standard_streams.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "formats/bytes/byte_cursor.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

std::string read_input(const std::filesystem::path& path, std::uint64_t most_bytes) {
    if (!is_standard_stream(path)) {
        std::error_code ignored;
        if (std::filesystem::is_fifo(path, ignored))
            throw InvalidInput(path.string() + ": a pipe is read as standard input: write - in its place, and <" +
                               path.string());
        return read_file(path, most_bytes);
    }
    constexpr std::size_t first_room = std::size_t{1} << 20;
    std::string bytes;
    for (std::size_t size = 0;;) {
        if (size == bytes.size()) bytes.resize(std::max(first_room, 2 * size));
        const ssize_t count = ::read(STDIN_FILENO, bytes.data() + size, bytes.size() - size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0)
            throw InvalidInput(input_name(path) + ": cannot be read: " + std::generic_category().message(errno));
        size += static_cast<std::size_t>(count);
        if (size > most_bytes)
            throw InvalidInput(input_name(path) + ": has more than the " + std::to_string(most_bytes) +
                               " bytes that are read; --max-file-bytes allows more");
        if (count > 0) continue;
        bytes.resize(size);
        return bytes;
    }
}

}  // namespace meniscus::formats
