#include "recording/delete_recording.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "process/log.hpp"
#include "recording/deleted_numbers.hpp"

namespace meniscus::server {

namespace {

/// A disk so full that not even that can be written is a reason to delete.
void note_if_possible(const std::filesystem::path& directory, const RecordingName& name) {
    try {
        note_deleted(directory, name.session_id, name.number);
    } catch (const std::system_error& error) {
        log_warning({.session = name.session_id}, "a later recording of it may be given the number {} again: {}",
                    name.number, error.what());
    }
}

}  // namespace

void delete_recording(const std::filesystem::path& path, const RecordingName& name, std::uint64_t frames,
                      std::uint64_t bytes, std::string_view reason) {
    note_if_possible(path.parent_path().parent_path(), name);
    if (::unlink(path.c_str()) != 0)
        throw std::system_error(errno, std::generic_category(), fmt::format("{} is not deleted", path.string()));
    ::rmdir(path.parent_path().c_str());  // refused where there is more in it
    // However many there are: no more can go than were recorded.
    log_info({.session = name.session_id}, "its recording {} is deleted: {} frames, {} bytes; {}", name.number, frames,
             bytes, reason);
}

std::string fewer_frames_than(std::uint64_t min_frames) {
    return fmt::format("they are fewer than --record-min-frames {}", min_frames);
}

}  // namespace meniscus::server
