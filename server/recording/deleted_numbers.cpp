#include "recording/deleted_numbers.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <mutex>
#include <system_error>

namespace meniscus::server {

namespace {

constexpr std::size_t id_size = 36;  // of a UUID: there are no recordings of others
constexpr std::size_t line_size = id_size + 12;

/// A session's line. All have the same length, so that it is written over in place.
std::string line_of(const std::string& session_id, std::uint32_t number) {
    return fmt::format("{} {:010}\n", session_id, number);
}

/// The mutex of the files: one server at a time has a folder, and several of its threads write there.
std::mutex mutex;

/// The file of a session, by the beginning of its id, so that each file stays short.
std::filesystem::path file_of(const std::filesystem::path& directory, const std::string& session_id) {
    return directory / ".deleted" / session_id.substr(0, 2);
}

struct Noted {
    std::size_t place = 0;     ///< of the session's line in the file, or of the next one
    std::uint32_t number = 0;  ///< 0: there is no such line
};

Noted noted(const std::filesystem::path& path, const std::string& session_id) {
    std::ifstream file(path, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    Noted found;
    // One that was cut short by the machine's end is none.
    for (; found.place + line_size <= text.size(); found.place += line_size) {
        if (text.compare(found.place, id_size, session_id) != 0) continue;
        const char* const line = text.data() + found.place;
        std::from_chars(line + id_size + 1, line + line_size, found.number);
        break;
    }
    return found;
}

[[noreturn]] void fail(const std::filesystem::path& path) {
    throw std::system_error(errno, std::generic_category(), path.string());
}

}  // namespace

std::uint32_t greatest_deleted(const std::filesystem::path& directory, const std::string& session_id) {
    const std::lock_guard lock(mutex);
    return noted(file_of(directory, session_id), session_id).number;
}

void note_deleted(const std::filesystem::path& directory, const std::string& session_id, std::uint32_t number) {
    if (session_id.size() != id_size) return;
    const std::lock_guard lock(mutex);
    const std::filesystem::path path = file_of(directory, session_id);
    const Noted before = noted(path, session_id);
    if (before.number >= number) return;
    if (::mkdir(path.parent_path().c_str(), S_IRWXU) != 0 && errno != EEXIST) fail(path.parent_path());
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
    if (file < 0) fail(path);
    const std::string line = line_of(session_id, number);
    const bool written =
        ::pwrite(file, line.data(), line.size(), static_cast<off_t>(before.place)) == static_cast<ssize_t>(line.size());
    const int error = errno;
    ::close(file);
    errno = error;
    if (!written) fail(path);
}

}  // namespace meniscus::server
