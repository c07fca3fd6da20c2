#include "formats/atomic_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::formats {

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), temporary_(path_) {
    if (std::filesystem::is_directory(path_))
        throw InvalidInput(path_.string() + ": cannot be written: it is a directory");
    temporary_ += ".partial-" + std::to_string(::getpid());
    errno = 0;
    out_.open(temporary_, std::ios::binary | std::ios::trunc);
    if (!out_) throw InvalidInput(path_.string() + ": cannot be written: " + std::generic_category().message(errno));
}

AtomicFile::~AtomicFile() {
    if (temporary_.empty()) return;
    out_.close();
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
    errno = 0;
    out_.close();
    if (!out_) throw std::runtime_error(path_.string() + ": writing failed: " + std::generic_category().message(errno));
    std::error_code error;
    std::filesystem::rename(temporary_, path_, error);
    if (error) throw InvalidInput(path_.string() + ": cannot be written: " + error.message());
    temporary_.clear();
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
