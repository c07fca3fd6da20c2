#include "files/recording_checksums.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace meniscus::files {

namespace {

/// A fixed64 field: its tag, then the value, little-endian.
constexpr char checksum_tag = v1::RecordingEntry::kChecksumFieldNumber << 3 | 1;
constexpr std::size_t checksum_bytes = 1 + sizeof(std::uint64_t);

std::string checksum_field(std::uint64_t value) {
    std::string field(1, checksum_tag);
    for (std::size_t i = 0; i < sizeof value; ++i, value >>= std::numeric_limits<unsigned char>::digits)
        field += static_cast<char>(value & std::numeric_limits<unsigned char>::max());
    return field;
}

}  // namespace

std::uint64_t checksum(std::string_view bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

struct RunningChecksum::State {
    XXH3_state_t hash;
};

RunningChecksum::RunningChecksum() : state_(new State) {
    XXH3_64bits_reset(&state_->hash);
}
RunningChecksum::~RunningChecksum() = default;
RunningChecksum::RunningChecksum(RunningChecksum&&) noexcept = default;
RunningChecksum& RunningChecksum::operator=(RunningChecksum&&) noexcept = default;

void RunningChecksum::add(std::string_view bytes) {
    XXH3_64bits_update(&state_->hash, bytes.data(), bytes.size());
}

std::uint64_t RunningChecksum::value() const {
    return XXH3_64bits_digest(&state_->hash);
}

std::string seal(v1::RecordingEntry entry) {
    entry.clear_checksum();
    std::string bytes = entry.SerializeAsString();
    return bytes + checksum_field(checksum(bytes));
}

bool is_sealed(std::string_view entry) {
    if (entry.size() < checksum_bytes) return false;
    const std::string_view before = entry.substr(0, entry.size() - checksum_bytes);
    return entry.substr(before.size()) == checksum_field(checksum(before));
}

bool is_whole(const RandomAccessFile& file, const RecordedRange& range) {
    if (!range.checksum) return true;
    constexpr std::uint64_t piece = std::uint64_t{1} << 20U;
    RunningChecksum sum;
    const std::uint64_t end = range.first + range.size;
    for (std::uint64_t at = range.first; at < end; at += piece)
        sum.add(file.read(at, static_cast<std::size_t>(std::min(piece, end - at))));
    return sum.value() == *range.checksum;
}

}  // namespace meniscus::files
