#include "files/writing_mark.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace meniscus::files {

namespace {

/// A lock of the whole file, of its open file description: locks of fcntl's other kind do not show within one process.
struct flock whole_file(short type) {
    struct flock lock {};
    lock.l_type = type;
    lock.l_whence = SEEK_SET;
    return lock;
}

}  // namespace

void mark_as_being_written(int descriptor) noexcept {
    const struct flock lock = whole_file(F_WRLCK);
    ::fcntl(descriptor, F_OFD_SETLK, &lock);
}

bool is_being_written(int descriptor) noexcept {
    struct flock lock = whole_file(F_RDLCK);
    return ::fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

bool is_closed_by_its_writer(int descriptor) noexcept {
    struct flock lock = whole_file(F_RDLCK);
    return ::fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type == F_UNLCK;
}

}  // namespace meniscus::files
