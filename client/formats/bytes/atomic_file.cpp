#include "formats/bytes/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {
namespace {

constexpr std::size_t most_gathered = std::size_t{1} << 20;

std::string text_of(int error) {
    return std::generic_category().message(error);
}

/// Whether there is something that a file must not take the place of.
bool stays(const std::filesystem::path& path) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

/// Where the file is that the path leads to: a link stays, /dev/stdout among them.
std::filesystem::path behind_links(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path place = std::filesystem::canonical(path, error);
    return error ? path : place;
}

/// A suffix that no other file has meanwhile, in this process or in others.
std::string unique_suffix() {
    static std::atomic<unsigned> files = 0;
    return ".partial-" + std::to_string(::getpid()) + "-" + std::to_string(files++);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
    if (is_standard_stream(path_)) {
        descriptor_ = ::dup(STDOUT_FILENO);
    } else {
        if (std::filesystem::is_directory(path_))
            throw InvalidInput(path_.string() + ": cannot be written: it is a directory");
        if (!stays(path_)) {
            place_ = behind_links(path_);
            (temporary_ = place_) += unique_suffix();
        }
        descriptor_ = ::open(temporary_.empty() ? path_.c_str() : temporary_.c_str(),
                             O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    }
    if (descriptor_ < 0) throw InvalidInput(output_name(path_) + ": cannot be written: " + text_of(errno));
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (temporary_.empty()) return;
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
    if (gathered_.size() + bytes.size() > most_gathered) flush();
    if (bytes.size() >= most_gathered)
        write_now(bytes);
    else
        gathered_ += bytes;
}

void AtomicFile::commit() {
    flush();
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno);
    if (temporary_.empty()) return;
    std::error_code error;
    std::filesystem::rename(temporary_, place_, error);
    if (error) throw InvalidInput(path_.string() + ": cannot be written: " + error.message());
    temporary_.clear();
}

void AtomicFile::flush() {
    write_now(gathered_);
    gathered_.clear();
}

void AtomicFile::write_now(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(errno);
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

void AtomicFile::fail(int error) const {
    throw std::runtime_error(output_name(path_) + ": writing failed: " + text_of(error));
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

void make_directory(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) throw InvalidInput(path.string() + ": cannot be made a directory: " + error.message());
}

}  // namespace meniscus::formats
