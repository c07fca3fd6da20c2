#include "rpc/messages/frame_chunk_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

namespace {

/// The tag of a field with a length, which takes one byte where the field's number is below 16.
constexpr std::byte length_delimited_tag(int field) {
    constexpr int length_delimited = 2;  // wire type
    return static_cast<std::byte>((field << 3) | length_delimited);
}

constexpr std::byte chunk_tag = length_delimited_tag(v1::StreamRequest::kFrameChunkFieldNumber);
constexpr std::byte data_tag = length_delimited_tag(v1::FrameChunk::kDataFieldNumber);

}  // namespace

FrameChunkReader::FrameChunkReader(google::protobuf::io::ZeroCopyInputStream& message, std::size_t message_bytes)
    : message_(message), left_(message_bytes) {
    if (enter_last_field(chunk_tag) && enter_last_field(data_tag)) bytes_ = left_;
}

void FrameChunkReader::copy_to(std::span<std::byte> place) {
    while (!place.empty() && (!block_.empty() || next_block())) {
        const std::size_t bytes = std::min(place.size(), block_.size());
        std::memcpy(place.data(), block_.data(), bytes);
        place = place.subspan(bytes);
        block_ = block_.subspan(bytes);
    }
}

void FrameChunkReader::skip(std::size_t bytes) {
    while (bytes > 0 && (!block_.empty() || next_block())) {
        const std::size_t part = std::min(bytes, block_.size());
        block_ = block_.subspan(part);
        bytes -= part;
    }
}

bool FrameChunkReader::next_block() {
    const void* data = nullptr;
    int size = 0;
    do {
        if (!message_.Next(&data, &size)) return false;
    } while (size == 0);
    block_ = {static_cast<const std::byte*>(data), static_cast<std::size_t>(size)};
    return true;
}

std::optional<std::byte> FrameChunkReader::next_byte() {
    if (left_ == 0 || (block_.empty() && !next_block())) return std::nullopt;
    const std::byte byte = block_.front();
    block_ = block_.subspan(1);
    --left_;
    return byte;
}

std::optional<std::size_t> FrameChunkReader::next_varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
        const auto byte = next_byte();
        if (!byte) return std::nullopt;
        const auto bits = std::to_integer<std::uint64_t>(*byte);
        value |= (bits & 0x7fU) << shift;
        if ((bits & 0x80U) != 0) continue;
        const bool shortest = bits != 0 || shift == 0;
        if (!shortest || value > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
        return static_cast<std::size_t>(value);
    }
    return std::nullopt;
}

bool FrameChunkReader::enter_last_field(std::byte tag) {
    if (next_byte() != tag) return false;
    const auto size = next_varint();
    return size && *size == left_;
}

}  // namespace meniscus::server
