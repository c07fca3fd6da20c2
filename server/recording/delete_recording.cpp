#include "recording/delete_recording.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "call_log.hpp"

namespace meniscus::server {

void delete_recording(const std::filesystem::path& path, const RecordingName& name, std::uint64_t frames,
                      std::uint64_t bytes, std::string_view reason) {
    if (::unlink(path.c_str()) != 0)
        throw std::system_error(errno, std::generic_category(), fmt::format("{} is not deleted", path.string()));
    ::rmdir(path.parent_path().c_str());  // refused where there is more in it
    call_log.write({.session = name.session_id}, "its recording {} is deleted: {} frames, {} bytes; {}", name.number,
                   frames, bytes, reason);
}

std::string fewer_frames_than(std::uint64_t min_frames) {
    return fmt::format("they are fewer than --record-min-frames {}", min_frames);
}

}  // namespace meniscus::server
