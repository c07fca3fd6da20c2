// The checksums of a recording: of each entry, and of the messages that follow it. XXH3, 64 bits.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "files/random_access_file.hpp"
#include "meniscus/v1/recording.pb.h"

namespace meniscus::files {

/// Where a frame's messages are in the file.
struct RecordedRange {
    std::uint64_t first = 0;                ///< byte
    std::uint64_t size = 0;                 ///< bytes
    std::optional<std::uint64_t> checksum;  ///< checksum of these bytes; none in older recordings
};

std::uint64_t checksum(std::string_view bytes);

/// The checksum of bytes that come piece by piece.
class RunningChecksum {
public:
    RunningChecksum();
    ~RunningChecksum();
    RunningChecksum(RunningChecksum&&) noexcept;
    RunningChecksum& operator=(RunningChecksum&&) noexcept;

    void add(std::string_view bytes);
    /// Of the bytes so far.
    std::uint64_t value() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The bytes of an entry, ending with its checksum.
std::string seal(v1::RecordingEntry entry);
/// Whether the bytes end with the checksum of those before it.
bool is_sealed(std::string_view entry);

/// Reads the range, a piece at a time. False if its bytes are not those that were written; true without a checksum.
bool is_whole(const RandomAccessFile& file, const RecordedRange& range);

}  // namespace meniscus::files
