#include "recording/recording_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "files/recording_format.hpp"
#include "files/writing_mark.hpp"
#include "recording/deleted_numbers.hpp"
#include "recording/free_number.hpp"

namespace meniscus::server {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
    throw std::runtime_error(fmt::format("{}: {}", path.string(), std::generic_category().message(error)));
}

/// The next one of the session that no recording has, or had. Those above the greatest that was deleted were taken in
/// order, whatever is missing among those below.
std::uint32_t next_number(const std::filesystem::path& directory, const std::string& session_id) {
    for (;;) {
        const std::uint32_t deleted = greatest_deleted(directory, session_id);
        const std::uint32_t number =
            deleted + free_number([&](std::uint32_t above) {
                struct stat ignored {};
                return ::lstat((directory / session_id / recording_file_name(deleted + above)).c_str(), &ignored) == 0;
            });
        // One that was deleted meanwhile was noted before it was missed.
        if (greatest_deleted(directory, session_id) == deleted) return number;
    }
}

}  // namespace

std::string recording_file_name(std::uint32_t number) {
    return fmt::format("{:06}{}", number, files::recording_extension);
}

RecordingFile::RecordingFile(const std::filesystem::path& directory, const std::string& session_id) {
    const std::filesystem::path folder = directory / session_id;
    // The folder may just be going with its last recording.
    constexpr int most_attempts = 8;
    for (int attempt = 1; descriptor_ < 0; ++attempt) {
        if (::mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) fail(folder, errno);
        number_ = next_number(directory, session_id);
        path_ = folder / recording_file_name(number_);
        descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
        if (descriptor_ < 0 && (errno != ENOENT || attempt == most_attempts)) fail(path_, errno);
    }
    files::mark_as_being_written(descriptor_);
}

RecordingFile::~RecordingFile() {
    ::close(descriptor_);
}

void RecordingFile::append(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written >= 0)
            bytes.remove_prefix(static_cast<std::size_t>(written));
        else if (errno != EINTR)
            fail(path_, errno);
    }
}

}  // namespace meniscus::server
