#include "recording/recorded_bytes.hpp"

#include <system_error>

#include "files/recording_format.hpp"

namespace meniscus::server {

namespace {

std::uint64_t bytes_of_recordings(const std::filesystem::path& directory) {
    constexpr auto options = std::filesystem::directory_options::skip_permission_denied;
    std::uint64_t bytes = 0;
    std::error_code error;
    for (auto i = std::filesystem::recursive_directory_iterator(directory, options, error);
         i != std::filesystem::recursive_directory_iterator(); i.increment(error)) {
        if (i->path().extension() != files::recording_extension) continue;
        const std::uintmax_t size = i->file_size(error);
        if (!error) bytes += size;
    }
    return bytes;
}

}  // namespace

std::uint64_t RecordedBytes::sum() {
    return sum_ ? *sum_ : newest_sum();
}

std::uint64_t RecordedBytes::newest_sum() {
    const auto begun = std::chrono::steady_clock::now();
    if (sum_ && begun < next_) return *sum_;
    sum_ = bytes_of_recordings(directory_);
    const auto end = std::chrono::steady_clock::now();
    constexpr auto short_time = std::chrono::milliseconds(50);  // thousands of files: costs nobody anything
    next_ = end - begun < short_time ? end : end + 9 * (end - begun);
    return *sum_;
}

}  // namespace meniscus::server
